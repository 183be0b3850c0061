// SPDX-License-Identifier: Apache-2.0
// Depth in TIFF and EXR: tests/python/test_files.py reads those of other libraries; here are the
// channels of EXR, and damage.
#include "files.hpp"
#include "memory_file.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <tiffio.h>

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
  void write_tiff() const {
    TIFF* const tiff = TIFFOpen(file().c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, columns);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, rows);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
    for (int v = 0; v < rows; ++v) {
      std::vector<float> row;
      for (int u = 0; u < columns; ++u) row.push_back(depth_at(u, v));
      TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(v));
    }
    TIFFClose(tiff);
  }
  FileResult read(const std::filesystem::path& from) {
    return read_depth(from, ImageSize{columns, rows}, std::nullopt, depth_);
  }
  FileResult read() { return read(file()); }
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

TEST_F(DepthFiles, DamagedOnesAreReadOrRefused) {
  for (const bool is_tiff : {false, true}) {
    if (is_tiff)
      write_tiff();
    else
      write_exr({"Z"});
    expect_the_depth();
    test::read_damaged(test::read_bytes(file()), 2000, [&](const std::string& bytes) {
      return read(test::MemoryFile(bytes).path());
    });
  }
}

}  // namespace
}  // namespace penumbra::io
