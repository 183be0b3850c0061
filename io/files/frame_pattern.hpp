// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// A file name with one frame number in it: "depth_%d.png", "depth/%06d.npy" (%% is a percent
/// sign), or a video's name.
class FramePattern {
 public:
  /// Relative patterns start at `folder`. Throws InputError unless there is exactly one %d or %0Nd
  /// (N from 1 to 9) and no other %, or none and the ending of a video.
  FramePattern(std::string_view pattern, const std::filesystem::path& folder);

  /// Returns whether one file holds all frames.
  [[nodiscard]] bool is_video() const { return is_video_; }

  /// Returns the file of frame `index` >= 0, or the video.
  [[nodiscard]] std::filesystem::path file(std::int64_t index) const;

  /// Returns the pattern of the same file names in another folder. Throws InputError if the number
  /// is in the name of a folder.
  [[nodiscard]] FramePattern moved_to(const std::filesystem::path& folder) const;

  /// Returns whether file() makes a file of this name, which is given without its folder.
  [[nodiscard]] bool makes(std::string_view name) const;

  /// Returns the numbers of frames whose file exists, ascending. Throws InputError if the folder
  /// exists and cannot be listed.
  [[nodiscard]] std::vector<std::int64_t> existing() const;

 private:
  [[nodiscard]] std::string written(std::int64_t index) const;

  /// Returns the number in a name that file() would make.
  [[nodiscard]] std::optional<std::int64_t> index(std::string_view name, std::string_view before,
                                                  std::string_view after) const;

  [[nodiscard]] std::string_view name_before() const;

  std::filesystem::path folder_;
  std::string before_, after_;
  bool is_video_ = false;
  std::size_t digits_ = 0;  // 0: as many as the number has
};

}  // namespace penumbra::io
