// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <io/frame_source.hpp>

namespace penumbra::io {

/// What the pipeline takes of a recorded frame; refers to `data`.
[[nodiscard]] Frame frame_of(const FrameData& data);

/// Some frames of a recording folder.
class RecordingSource final : public FrameSource {
 public:
  /// `selected`: positions in the reader, in the order wanted. `with_color`: for pictures.
  RecordingSource(FrameReader reader, std::vector<std::size_t> selected, bool with_color)
      : reader_(std::move(reader)), selected_(std::move(selected)), with_color_(with_color) {}

  bool next(FrameData& data, Frame& frame) override;
  [[nodiscard]] std::optional<std::size_t> size() const override { return selected_.size(); }
  [[nodiscard]] std::vector<std::string> notes() const override { return {}; }

 private:
  FrameReader reader_;
  std::vector<std::size_t> selected_;
  std::size_t next_ = 0;
  bool with_color_;
};

}  // namespace penumbra::io
