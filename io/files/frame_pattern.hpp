// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// The stamps of frames, nanoseconds, by the frames' numbers.
using FrameStamps = std::map<std::int64_t, std::int64_t>;

/// A file name with one frame number in it: "depth_%d.png", "depth/%06d.npy" (%% is a percent
/// sign), or a frame's stamp: "depth/%t.png"; or a video's name.
class FramePattern {
 public:
  /// Relative patterns start at `folder`. Throws InputError unless there is exactly one %d or %0Nd
  /// (N from 1 to 9) or %t, and no other %, or none and the ending of a video.
  ///
  /// %t is a time in seconds with a point, or in whole nanoseconds, microseconds or milliseconds. A
  /// file belongs to the frame whose stamp is its time, up to 1 ms; others get numbers behind the
  /// last frame's. Throws InputError without `stamps`.
  FramePattern(std::string_view pattern, const std::filesystem::path& folder,
               const std::optional<FrameStamps>& stamps = {});

  /// Returns whether one file holds all frames.
  [[nodiscard]] bool is_video() const { return is_video_; }

  /// Returns whether the files' names are times.
  [[nodiscard]] bool is_by_time() const { return is_by_time_; }
  /// Returns why no file's time fits; empty if one does, or there are no files.
  [[nodiscard]] const std::string& fault() const { return fault_; }

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

  /// Returns what stands for the number in a name that file() would make.
  [[nodiscard]] static std::optional<std::string_view> between(std::string_view name,
                                                               std::string_view before,
                                                               std::string_view after);
  /// Returns the number in such a text.
  [[nodiscard]] std::optional<std::int64_t> index(std::string_view text) const;
  /// Returns such texts of all files that exist.
  [[nodiscard]] std::vector<std::string> texts() const;
  void match(const FrameStamps& stamps);

  [[nodiscard]] std::string_view name_before() const;

  std::filesystem::path folder_;
  std::string before_, after_;
  bool is_video_ = false, is_by_time_ = false;
  std::size_t digits_ = 0;                     // 0: as many as the number has
  std::map<std::int64_t, std::string> names_;  // of frames whose file is named by time
  std::string fault_;
};

}  // namespace penumbra::io
