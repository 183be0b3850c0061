// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <exception>
#include <optional>
#include <thread>

#include <apps/penumbra/arguments.hpp>
#include <io/run/judging.hpp>
#include <io/web/frame_store.hpp>
#include <io/web/run_folder.hpp>
#include <io/web/stored_view.hpp>

namespace penumbra::app {

/// What the viewer shows of files: an input, which is judged meanwhile, or the results of a run.
class ViewSource {
 public:
  /// `arguments` must outlive this. Throws InputError where there is nothing to show.
  explicit ViewSource(const ViewArguments& arguments);
  ~ViewSource();
  ViewSource(const ViewSource&) = delete;
  ViewSource& operator=(const ViewSource&) = delete;

  [[nodiscard]] io::StoredView& view() { return *view_; }

  /// Begins to judge, in a thread of its own.
  void start();
  [[nodiscard]] bool is_over() const { return over_; }
  /// Prints what came of it, to be called when it is over. Throws what judging threw.
  void tell();

 private:
  void open_input(const io::JudgingOptions& options);
  void open_run(const ViewArguments& arguments);
  void judge();

  std::optional<io::Judging> judging_;
  std::optional<io::FrameStore> store_;
  std::optional<io::RunFolder> folder_;
  std::optional<io::StoredView> view_;
  std::atomic<bool> stop_ = false, over_ = false;
  std::exception_ptr error_;
  io::RunResult result_;
  std::thread thread_;
};

}  // namespace penumbra::app
