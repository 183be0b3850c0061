// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// A frame's name as TF compares it: without one leading "/".
[[nodiscard]] std::string_view frame_name(std::string_view name);

/// Which frames hang below which, as TF tells it.
class FrameTree {
 public:
  static constexpr std::size_t max_frames = 4096;  ///< as a TransformBuffer has

  /// The first parent of a frame stays. Answers whether it is news.
  bool add(std::string_view parent, std::string_view child);

  [[nodiscard]] bool has_parent(std::string_view frame) const { return parents_.contains(frame); }
  /// The frame and those above it, nearest first.
  [[nodiscard]] std::vector<std::string> chain(std::string_view frame) const;
  /// Whether there is a way from one frame to the other.
  [[nodiscard]] bool connects(std::string_view a, std::string_view b) const;

 private:
  std::map<std::string, std::string, std::less<>> parents_;
};

}  // namespace penumbra::io
