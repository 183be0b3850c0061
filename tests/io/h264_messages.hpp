// SPDX-License-Identifier: Apache-2.0
// Videos in H.264, encoded and decoded by the program ffmpeg from and to files.
#pragma once

#include "files.hpp"

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace penumbra::test {

using ColorFrames = std::vector<Image<Rgb8>>;

/// Returns whether `ffmpeg ARGUMENTS` succeeds.
inline bool ffmpeg(const std::string& arguments) {
  return std::system(("ffmpeg -nostdin -v quiet " + arguments + " >/dev/null 2>&1").c_str()) == 0;
}

/// Skips the running test where no ffmpeg encodes H.264.
#define PENUMBRA_REQUIRE_FFMPEG()                                                        \
  if (!penumbra::test::ffmpeg("-f lavfi -i color=s=64x48:d=0.1 -c:v libx264 -f null -")) \
  GTEST_SKIP() << "skipped: no ffmpeg with libx264"

/// Returns a message for each frame in the order of encoding. Every fourth is a keyframe.
/// `options`: of the encoder.
inline std::vector<std::string> h264_messages(const ColorFrames& frames,
                                              const std::string& options = "-bf 0") {
  const TemporaryFolder folder;
  std::string pixels;
  for (const Image<Rgb8>& frame : frames)
    pixels.append(reinterpret_cast<const char*>(frame.data()), frame.size() * sizeof(Rgb8));
  const std::string size =
      std::to_string(frames.front().width()) + "x" + std::to_string(frames.front().height());
  const auto from = folder.write("in.rgb", pixels), to = folder.path() / "out.h264";
  EXPECT_TRUE(ffmpeg("-f rawvideo -pix_fmt rgb24 -s " + size + " -i " + from.string() +
                     " -c:v libx264 -pix_fmt yuv420p -g 4 " + options +
                     " -bsf:v h264_metadata=aud=insert " + to.string()));
  const std::string stream = read_bytes(to), delimiter("\0\0\0\1\x09", 5);  // begins each frame
  std::vector<std::string> messages;
  for (std::size_t at = stream.find(delimiter); at != std::string::npos;) {
    const std::size_t next = stream.find(delimiter, at + 1);
    messages.push_back(stream.substr(at, next - at));
    at = next;
  }
  EXPECT_EQ(messages.size(), frames.size());
  return messages;
}

/// Returns the frames of a stream without faults, of the size of `like`.
inline ColorFrames h264_frames(const std::vector<std::string>& messages, const Image<Rgb8>& like) {
  const TemporaryFolder folder;
  std::string stream;
  for (const std::string& message : messages) stream += message;
  const auto from = folder.write("in.h264", stream), to = folder.path() / "out.rgb";
  EXPECT_TRUE(ffmpeg("-i " + from.string() + " -vsync passthrough -f rawvideo -pix_fmt rgb24 " +
                     to.string()));
  const std::string pixels = read_bytes(to);
  ColorFrames frames;
  const std::size_t size = like.size() * sizeof(Rgb8);
  for (std::size_t at = 0; at + size <= pixels.size(); at += size)
    std::memcpy(frames.emplace_back(like).data(), pixels.data() + at, size);
  EXPECT_EQ(frames.size(), messages.size());
  return frames;
}

}  // namespace penumbra::test
