// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

class ChildProgram;
struct H264Frame;

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

/// Decodes a video in H.264 whose frames come in messages, through the program ffmpeg.
class VideoStream {
 public:
  /// `patience`: milliseconds that ffmpeg may take for a frame.
  explicit VideoStream(int patience = 20'000);
  ~VideoStream();
  VideoStream(const VideoStream&) = delete;
  VideoStream& operator=(const VideoStream&) = delete;

  /// Decodes the frame of the next message. Call this with all messages, in their order: most
  /// frames need those before them. Returns why there is no image, or an empty text. After a
  /// missing or damaged message there is none until the next keyframe.
  [[nodiscard]] std::string decode(std::string_view format, std::span<const std::byte> message,
                                   Image<Rgb8>& image);

 private:
  [[nodiscard]] std::string check(const H264Frame& frame);
  void start(const H264Frame& frame);
  [[nodiscard]] bool read(Image<Rgb8>& image);

  int patience_;
  std::unique_ptr<ChildProgram> decoder_;  // ffmpeg; null until a keyframe
  std::string parameters_;                 // of the keyframe that it started with
  int number_bits_ = 0;                    // see read_h264
  std::uint32_t last_ = 0;                 // number of the last reference frame
  std::uint64_t frames_ = 0;               // written
  std::string refusal_;                    // of all further frames
};

}  // namespace penumbra::io
