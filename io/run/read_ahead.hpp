// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <io/files/frame_source.hpp>

namespace penumbra::io {

/// Reads each frame of a source on another thread while the frame before it is judged.
class ReadAhead final : public FrameSource {
 public:
  explicit ReadAhead(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  /// Throws what the source throws, in the place of the frame that it could not read.
  bool next(Frame& frame) override {
    if (!ahead_.valid()) begin();
    std::optional<Frame> read = ahead_.get();
    if (!read) return false;
    frame = std::move(*read);
    begin();
    return true;
  }
  [[nodiscard]] std::optional<std::size_t> size() const override { return source_->size(); }
  [[nodiscard]] std::vector<std::string> notes() const override {
    if (ahead_.valid()) ahead_.wait();
    return source_->notes();
  }

 private:
  void begin() {
    ahead_ = std::async(std::launch::async, [this] {
      std::optional<Frame> frame(std::in_place);
      if (!source_->next(*frame)) frame.reset();
      return frame;
    });
  }

  std::unique_ptr<FrameSource> source_;
  std::future<std::optional<Frame>> ahead_;  // goes first: its end waits for the thread
};

}  // namespace penumbra::io
