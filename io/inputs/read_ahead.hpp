// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <io/files/background_jobs.hpp>
#include <io/files/frame_source.hpp>

namespace penumbra::io {

/// Reads the next frames of a source on other threads while one is judged.
class ReadAhead final : public FrameSource {
 public:
  explicit ReadAhead(std::unique_ptr<FrameSource> source)
      : source_(std::move(source)), readers_(source_->at_once()) {}

  [[nodiscard]] std::optional<std::size_t> size() const override { return source_->size(); }
  [[nodiscard]] std::vector<std::string> notes() const override {
    for (const auto& frame : ahead_) frame.wait();
    return source_->notes();
  }

  /// Reads without the others.
  bool read(std::size_t number, Frame& frame) override { return source_->read(number, frame); }

  /// Throws what the source throws, in the place of the frame that it could not read.
  bool next(Frame& frame) override {
    if (ahead_.empty()) begin();
    std::future<std::optional<Frame>> first = std::move(ahead_.front());
    ahead_.pop_front();
    std::optional<Frame> read = first.get();
    if (!read) return false;
    frame = std::move(*read);
    while (ahead_.size() < source_->at_once()) begin();
    return true;
  }

 private:
  void begin() {
    const auto task =
        std::make_shared<std::packaged_task<std::optional<Frame>()>>([this, number = begun_++] {
          std::optional<Frame> frame(std::in_place);
          if (!source_->read(number, *frame)) frame.reset();
          return frame;
        });
    ahead_.push_back(task->get_future());
    readers_.add([task] { (*task)(); });
  }

  std::unique_ptr<FrameSource> source_;
  std::deque<std::future<std::optional<Frame>>> ahead_;  // null: the end
  std::size_t begun_ = 0;
  BackgroundJobs readers_;  // goes first: it waits for its jobs
};

}  // namespace penumbra::io
