// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

class ChildProgram;

/// Returns whether a file's name ends as that of a video.
[[nodiscard]] bool is_video_name(const std::filesystem::path& file);

/// A video's frames, which the programs ffprobe and ffmpeg find and decode, so that a build needs
/// none of their libraries. T: Rgb8, or uint16 for videos of 16-bit grey.
template <typename T>
class VideoFile {
 public:
  /// Throws InputError if the file holds no such video, or ffmpeg is not installed.
  explicit VideoFile(const std::filesystem::path& file);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  [[nodiscard]] ImageSize size() const { return size_; }

  /// Reads a frame, counted from 0 in the order in which they are shown. In another order than
  /// ascending it takes as long as starting ffmpeg. Several threads may call this.
  [[nodiscard]] FileResult read(std::size_t index, std::shared_ptr<const Image<T>>& image);

 private:
  void start(std::size_t index);

  std::filesystem::path file_;
  ImageSize size_;
  std::vector<double> times_;  // of the frames, seconds, ascending
  std::mutex mutex_;
  std::unique_ptr<ChildProgram> decoder_;  // ffmpeg
  std::size_t next_ = 0;                   // frame of the decoder
  std::deque<std::pair<std::size_t, std::shared_ptr<const Image<T>>>> recent_;
};

}  // namespace penumbra::io
