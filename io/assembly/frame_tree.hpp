// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// Returns a frame's name as TF compares it: without one leading "/".
[[nodiscard]] std::string_view frame_name(std::string_view name);

/// The tree of frames, by TF.
class FrameTree {
 public:
  static constexpr std::size_t max_frames = 4096;  ///< as in TransformBuffer

  /// Adds a frame. A frame keeps its first parent. Returns whether the frame is new.
  bool add(std::string_view parent, std::string_view child);

  [[nodiscard]] bool has_parent(std::string_view frame) const { return parents_.contains(frame); }
  [[nodiscard]] bool knows(std::string_view frame) const;
  /// Returns the frame and the frames above it, nearest first.
  [[nodiscard]] std::vector<std::string> chain(std::string_view frame) const;
  /// Returns whether two frames are connected.
  [[nodiscard]] bool connects(std::string_view a, std::string_view b) const;

 private:
  std::map<std::string, std::string, std::less<>> parents_;
};

}  // namespace penumbra::io
