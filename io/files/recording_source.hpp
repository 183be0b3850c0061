// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include <io/files/frame_source.hpp>

namespace penumbra::io {

/// What the pipeline takes of a recorded frame; refers to `data`.
[[nodiscard]] Frame frame_of(const FrameData& data);

/// Some frames of a recording folder.
class RecordingSource final : public FrameSource {
 public:
  /// `selected`: positions in the reader, in the order wanted. `with_color`: for pictures. `fps`:
  /// frames per second of a recording without stamps; nothing: its frames have none.
  RecordingSource(FrameReader reader, std::vector<std::size_t> selected, bool with_color,
                  std::optional<double> fps = {})
      : reader_(std::move(reader)),
        selected_(std::move(selected)),
        with_color_(with_color),
        fps_(fps) {}

  /// Throws InputError if the recording has stamps of its own and `fps` is given.
  bool next(FrameData& data, Frame& frame) override;
  [[nodiscard]] std::optional<std::size_t> size() const override { return selected_.size(); }
  [[nodiscard]] std::vector<std::string> notes() const override { return {}; }

 private:
  FrameReader reader_;
  std::vector<std::size_t> selected_;
  std::size_t next_ = 0;
  bool with_color_;
  std::optional<double> fps_;
};

}  // namespace penumbra::io
