// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <apps/penumbra/live_arguments.hpp>
#include <io/live/live_runner.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::app {

/// The viewer's pages of `penumbra live`: one for each camera, then one for each sensor of clouds,
/// with `--port`; none without.
class LivePages {
 public:
  /// Serves them. Throws InputError as io::WebServer.
  LivePages(const LiveArguments& arguments, int domain);
  ~LivePages();
  LivePages(const LivePages&) = delete;
  LivePages& operator=(const LivePages&) = delete;

  /// Prints the addresses to open.
  void print() const;

  /// Shows the frames that `runner` judges. Must outlive its threads.
  void watch(io::LiveRunner& runner, const std::vector<io::CameraInputOptions>& cameras);

  /// Shows statuses as LiveDiagnostics reports them.
  void publish(const io::DiagnosticArrayMessage& message);

  /// Returns whether a page needs colour images.
  [[nodiscard]] bool need_color() const;

 private:
  class Page;
  std::vector<std::unique_ptr<Page>> pages_;
};

}  // namespace penumbra::app
