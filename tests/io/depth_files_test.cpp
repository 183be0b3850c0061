// SPDX-License-Identifier: Apache-2.0
// Depth in EXR by its channels: tests/python/test_files.py reads TIFF and EXR of other libraries.
#include "files.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <io/files/image_file.hpp>

namespace penumbra::io {
namespace {

constexpr int columns = 7, rows = 5;

float depth_at(int u, int v) { return 0.5F + 0.25F * static_cast<float>(u + columns * v); }

class DepthFiles : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "depth"; }

  /// The first channel is depth, the others are 9.
  void write_exr(const std::vector<std::string>& channels, Imf::PixelType type = Imf::FLOAT) const {
    std::vector<float> depth, other(columns * rows, 9.0F);
    for (const auto [u, v] : test::each_pixel(0, 0, columns, rows)) depth.push_back(depth_at(u, v));
    std::vector<std::uint16_t> half(columns * rows, 0x3E00);  // 1.5, 1.5, ...
    Imf::Header header(columns, rows);
    Imf::FrameBuffer pixels;
    for (const std::string& name : channels) {
      header.channels().insert(name, Imf::Channel(type));
      char* const data = type == Imf::HALF          ? reinterpret_cast<char*>(half.data())
                         : name == channels.front() ? reinterpret_cast<char*>(depth.data())
                                                    : reinterpret_cast<char*>(other.data());
      const std::size_t size = type == Imf::HALF ? 2 : sizeof(float);
      pixels.insert(name, Imf::Slice(type, data, size, size * columns));
    }
    Imf::OutputFile output(file().c_str(), header, 0);
    output.setFrameBuffer(pixels);
    output.writePixels(rows);
  }
  FileResult read() { return read_depth(file(), ImageSize{columns, rows}, std::nullopt, depth_); }
  [[nodiscard]] float pixel(int u, int v) const {
    return std::get<ImageView<const float>>(depth_.view)(u, v);
  }
  void expect_the_depth() {
    ASSERT_EQ(read().message, "");
    for (const auto [u, v] : test::each_pixel(0, 0, columns, rows))
      EXPECT_EQ(pixel(u, v), depth_at(u, v));
  }
  test::TemporaryFolder folder_;
  SharedDepth depth_;
};

TEST_F(DepthFiles, ReadsTheDepthChannelOfExr) {
  for (const std::vector<std::string>& channels :
       {std::vector<std::string>{"Z"},
        {"distance"},
        {"Z", "A", "B", "G", "R"},
        {"View Layer.Depth.Z", "View Layer.Combined.R"}}) {
    write_exr(channels);
    expect_the_depth();
  }
  write_exr({"V"}, Imf::HALF);
  ASSERT_EQ(read().message, "");
  EXPECT_EQ(pixel(3, 2), 1.5F);
}

TEST_F(DepthFiles, RefusesExrWithoutAClearDepth) {
  write_exr({"R", "G", "B"});
  const FileResult result = read();
  EXPECT_EQ(result.status, FileStatus::bad);
  EXPECT_HAS(result.message, "B, G, R");
  write_exr({"left.Z", "right.Z"});
  EXPECT_EQ(read().status, FileStatus::bad);
}

}  // namespace
}  // namespace penumbra::io
