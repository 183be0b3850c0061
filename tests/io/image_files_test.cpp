// SPDX-License-Identifier: Apache-2.0
// Images in PNG and NPY.
#include "cloud_samples.hpp"
#include "memory_file.hpp"
#include "mini_png.hpp"

#include <sys/stat.h>

#include <io/files/npy.hpp>
#include <io/files/png.hpp>
#include <io/files/png_depth.hpp>

namespace penumbra::io {
namespace {

using test::mini_png::Format;
using test::mini_png::samples;

class Png : public testing::Test {
 protected:
  static Image<std::uint16_t> expect_bad(const std::filesystem::path& file,
                                         const std::string& named) {
    Image<std::uint16_t> read;
    const FileResult result = read_png(file, read);
    EXPECT_EQ(result.status, FileStatus::bad);
    EXPECT_TRUE(result.message.starts_with(file.string() + ": ")) << result.message;
    EXPECT_HAS(result.message, named);
    return read;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "image.png";
};

template <typename T>
Image<T> random_image(int width, int height, std::mt19937_64& random) {
  Image<T> image(width, height);
  // Runs and noise: both kinds of matches that deflate looks for.
  for (std::size_t i = 0; i < image.size(); ++i)
    image.data()[i] = random() % 3 == 0 || i == 0 ? static_cast<T>(random()) : image.data()[i - 1];
  return image;
}

TEST_F(Png, ReadsGrey16OfAnotherWriter) {
  std::mt19937_64 random = test::seeded_random(1);
  for (const bool interlaced : {false, true}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {5, 3}, {33, 17}, {64, 64}}) {
      const auto image = random_image<std::uint16_t>(width, height, random);
      const Format format{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 16,
                          0, interlaced};
      folder_.write("image.png", test::mini_png::encode(format, samples(image)));
      Image<std::uint16_t> read;
      EXPECT_EQ(read_png(file_, read).message, "");
      EXPECT_TRUE(test::same_pixels(image.view(), read.view()))
          << width << " x " << height << " " << interlaced;
    }
  }
}

TEST_F(Png, BringsAnyFormatToRgb) {
  const std::string two_reds("\x00\x01", 2);
  const std::string palette =
      test::mini_png::chunk("PLTE", std::string("\x0a\x14\x1e\xff\x00\x00", 6));
  const struct {
    int bits, color_type;
    std::string samples, extra;
    Rgb8 first, second;
  } cases[] = {
      {8, 0, "\x05\x80", "", {5, 5, 5}, {128, 128, 128}},
      {16, 0, std::string("\x05\x05\x80\x80", 4), "", {5, 5, 5}, {128, 128, 128}},
      {8, 2, "\x01\x02\x03\x04\x05\x06", "", {1, 2, 3}, {4, 5, 6}},
      {8, 3, two_reds, palette, {10, 20, 30}, {255, 0, 0}},
      {8, 4, "\x05\x01\x80\x01", "", {5, 5, 5}, {128, 128, 128}},
      {8, 6, "\x01\x02\x03\x09\x04\x05\x06\x09", "", {1, 2, 3}, {4, 5, 6}},
  };
  for (const auto& c : cases) {
    const Format format{2, 1, c.bits, c.color_type, false};
    folder_.write("image.png", test::mini_png::encode(format, c.samples, c.extra));
    Image<Rgb8> read;
    ASSERT_EQ(read_png(file_, read).message, "");
    EXPECT_EQ(read(0, 0), c.first) << c.color_type;
    EXPECT_EQ(read(1, 0), c.second) << c.color_type;
  }
}

TEST_F(Png, RefusesEveryOtherFormatAsDepth) {
  const struct {
    int bits, color_type;
    std::string extra, named;
  } cases[] = {
      {8, 0, "", "8-bit grey"},
      {8, 2, "", "8-bit RGB"},
      {16, 2, "", "16-bit RGB"},
      {8, 3, test::mini_png::chunk("PLTE", "abc"), "8-bit palette"},
      {16, 4, "", "16-bit grey with alpha"},
      {16, 6, "", "16-bit RGB with alpha"},
      {16, 0, test::mini_png::chunk("tRNS", std::string(2, '\0')), "transparency"},
  };
  for (const auto& c : cases) {
    const Format format{2, 2, c.bits, c.color_type, false};
    folder_.write("image.png", test::mini_png::encode(format, std::string(64, '\0'), c.extra));
    expect_bad(file_, c.named);
  }
}

TEST_F(Png, NamesFilesThatAreNone) {
  Image<std::uint16_t> read;
  EXPECT_EQ(read_png(folder_.path() / "none.png", read).status, FileStatus::missing);
  expect_bad(folder_.path(), "is not a regular file");
  expect_bad(folder_.write("image.png", "\xff\xd8\xff\xe0 a JPEG's first bytes"), "is no PNG");
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  expect_bad(folder_.path() / "pipe", "is not a regular file");
  write_png(file_, Image<std::uint16_t>(8, 4, 1).view());
  EXPECT_TRUE(read_png(file_, read, ImageSize{8, 4}).ok());
  EXPECT_EQ(read_png(file_, read, ImageSize{4, 8}).status, FileStatus::bad);
}

TEST_F(Png, RefusesAbsurdSizesBeforeAllocating) {
  const struct {
    std::uint32_t width, height;
    std::string named;
  } cases[] = {
      {0x7fffffff, 0x7fffffff, "2147483647 x 2147483647"},
      {32768, 1, "32768 x 1"},
      {32767, 32767, "more than a file of"},
      {0, 5, "damaged"},
  };
  for (const auto& c : cases) {
    folder_.write("image.png", test::mini_png::signature() +
                                   test::mini_png::header({c.width, c.height, 16, 0, false}) +
                                   test::mini_png::chunk("IDAT", "abc"));
    EXPECT_TRUE(expect_bad(file_, c.named).empty());
  }
}

// Rows of Paeth's filter are decoded by fours, all others one by one.
TEST_F(Png, DecodesDepthOfEveryFilterLikeTheSpecification) {
  std::mt19937_64 random = test::seeded_random(7);
  for (int i = 0; i < 2000; ++i) {
    const auto width = static_cast<std::uint32_t>(1 + random() % 9);
    const auto height = static_cast<std::uint32_t>(1 + random() % 13);
    std::string raw;
    for (std::uint32_t v = 0; v < height; ++v) {
      raw += static_cast<char>(i % 2 == 0 ? random() % 5 : 4 - (random() % 16 == 0 ? 1 : 0));
      for (std::uint32_t k = 0; k < 2 * width; ++k) raw += static_cast<char>(random());
    }
    const std::string packed = test::mini_png::deflated(raw);
    const std::size_t cut = random() % packed.size();
    const std::string file =
        test::mini_png::signature() + test::mini_png::header({width, height, 16, 0, false}) +
        test::mini_png::chunk("tEXt", "Title") +
        test::mini_png::chunk("IDAT", packed.substr(0, cut)) +
        test::mini_png::chunk("IDAT", packed.substr(cut)) + test::mini_png::chunk("IEND", "");
    Image<std::uint16_t> read;
    ASSERT_TRUE(decode_depth_png(std::as_bytes(std::span(file)), read, {}));
    ASSERT_EQ(samples(read), test::mini_png::unfiltered(raw, 2 * width, 2))
        << "round " << i << ", " << width << " x " << height;
  }
}

TEST_F(Png, FindsEveryTruncationAndFlippedBit) {
  std::mt19937_64 random = test::seeded_random(5);
  write_png(file_, random_image<std::uint16_t>(11, 9, random).view());
  const std::string whole = test::read_bytes(file_);
  for (std::size_t length = 0; length < whole.size(); ++length)
    expect_bad(test::MemoryFile(whole.substr(0, length)).path(), "");
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    Image<std::uint16_t> read;
    ASSERT_EQ(read_png(test::MemoryFile(damaged).path(), read).status, FileStatus::bad)
        << "bit " << bit;
  }
}

const std::string npy_header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
const std::string six_bytes = test::raw(1.5F, -2.0F, 0.0F, 4.25F, 5.0F, 6.0F);

std::string npy_file(int version, const std::string& header,
                     const std::string& values = six_bytes) {
  return test::npy(header, values, static_cast<char>(version));
}

class Npy : public testing::Test {
 protected:
  FileResult read(const std::string& bytes) {
    return read_npy(test::MemoryFile(bytes).path(), image_);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "depth.npy";
  Image<float> image_;
};

TEST_F(Npy, ReadsEveryVersionAndSpelling) {
  const std::string headers[] = {
      npy_header,
      "{\"shape\":(2,3),\"fortran_order\":False,\"descr\":\"<f4\"}",
      "{'fortran_order': False, 'descr': '<f4', 'shape': (2, 3,)}            \n",
  };
  for (const int version : {1, 2, 3}) {
    for (const std::string& header : headers) {
      image_ = {};
      ASSERT_EQ(read(npy_file(version, header)).message, "");
      ASSERT_EQ(image_.width(), 3);
      ASSERT_EQ(image_.height(), 2);
      EXPECT_EQ(std::memcmp(image_.data(), six_bytes.data(), six_bytes.size()), 0);
    }
  }
}

TEST_F(Npy, NamesWhatItDoesNotRead) {
  const auto header = [](const std::string& type, const std::string& order,
                         const std::string& shape) {
    return npy_file(
        1, "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n");
  };
  const std::string two = npy_file(1, "{'descr': '<f4', 'shape': (2, 3), }");
  const test::BadInputs cases = {{header("<f8", "False", "(2, 3)"), "'<f8'"},
                                 {header("<f4", "True", "(2, 3)"), "Fortran"},
                                 {header("<f4", "False", "(6,)"), "1 dimensions"},
                                 {header("<f4", "False", "(0, 3)"), "a side of 0"},
                                 {header("<f4", "False", "(40000, 3)"), "a side of 40000"},
                                 {header("<f4", "False", "(30000, 30000)"), "ends before"},
                                 {two, "header"},
                                 {npy_file(4, npy_header), "version 4.0"},
                                 {npy_file(2, std::string(70000, ' '), ""), "70000"},
                                 {"frame,joint1\n0,1", "NumPy"},
                                 {npy_file(1, npy_header, six_bytes + "x"), "after"}};
  for (const auto& [bytes, named] : cases) {
    const FileResult result = read_npy(folder_.write("depth.npy", bytes), image_);
    EXPECT_EQ(result.status, FileStatus::bad);
    EXPECT_HAS(result.message, "depth.npy: ");
    EXPECT_HAS(result.message, named);
  }
  EXPECT_EQ(read_npy(folder_.path() / "none.npy", image_).status, FileStatus::missing);
  folder_.write("depth.npy", npy_file(1, npy_header));
  EXPECT_TRUE(read_npy(file_, image_, ImageSize{3, 2}).ok());
  EXPECT_HAS(read_npy(file_, image_, ImageSize{2, 3}).message, "3 x 2");
}

TEST_F(Npy, FindsEveryTruncation) {
  const std::string whole = npy_file(1, npy_header);
  for (std::size_t length = 0; length < whole.size(); ++length)
    ASSERT_EQ(read(whole.substr(0, length)).status, FileStatus::bad) << length;
}

}  // namespace
}  // namespace penumbra::io
