// SPDX-License-Identifier: Apache-2.0
#include "../support/data.hpp"
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "files.hpp"
#include "mini_png.hpp"

#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <io/files/png.hpp>

namespace penumbra::io {
namespace {

using test::input_error;
using test::mini_png::Format;

class Png : public testing::Test {
 protected:
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

// Big-endian samples as they lie in a PNG file.
std::string samples(const Image<std::uint16_t>& image) {
  std::string bytes;
  for (std::size_t i = 0; i < image.size(); ++i) {
    bytes += static_cast<char>(image.data()[i] >> 8);
    bytes += static_cast<char>(image.data()[i] & 0xff);
  }
  return bytes;
}

template <typename T>
bool same(const Image<T>& a, const Image<T>& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::equal(a.data(), a.data() + a.size(), b.data());
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
      EXPECT_TRUE(same(image, read)) << width << " x " << height << " " << interlaced;
    }
  }
}

TEST_F(Png, WritesWhatAnotherReaderReads) {
  std::mt19937_64 random = test::seeded_random(2);
  const auto image = random_image<std::uint16_t>(37, 21, random);
  write_png(file_, image.view());
  Format format;
  EXPECT_EQ(test::mini_png::decode(test::read_bytes(file_), format), samples(image));
  EXPECT_EQ(format.bits, 16);
  EXPECT_EQ(format.color_type, 0);

  const auto grey = random_image<std::uint8_t>(37, 21, random);
  write_png(file_, grey.view());
  EXPECT_EQ(test::mini_png::decode(test::read_bytes(file_), format),
            std::string(grey.data(), grey.data() + grey.size()));
  EXPECT_EQ(format.bits, 8);

  Image<Rgb8> color(37, 21);
  std::string bytes;
  for (std::size_t i = 0; i < color.size(); ++i) {
    const std::uint64_t r = random();
    color.data()[i] = {static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(r >> 8),
                       static_cast<std::uint8_t>(r >> 16)};
    for (int shift = 0; shift < 24; shift += 8) bytes += static_cast<char>(r >> shift);
  }
  write_png(file_, std::as_const(color).view());
  EXPECT_EQ(test::mini_png::decode(test::read_bytes(file_), format), bytes);
  EXPECT_EQ(format.color_type, 2);
}

TEST_F(Png, ReturnsWhatWasWrittenWithAnyStride) {
  std::mt19937_64 random = test::seeded_random(3);
  const auto image = random_image<std::uint16_t>(40, 30, random);
  // The lower right part, upside down.
  const ImageView<const std::uint16_t> part{&image(7, 29), 33, 25, -40};
  write_png(file_, part);
  Image<std::uint16_t> read;
  ASSERT_EQ(read_png(file_, read).message, "");
  ASSERT_EQ(read.width(), 33);
  ASSERT_EQ(read.height(), 25);
  for (int v = 0; v < 25; ++v)
    for (int u = 0; u < 33; ++u) ASSERT_EQ(read(u, v), image(7 + u, 29 - v));
}

TEST_F(Png, KeepsTheBufferWhereTheSizeStays) {
  write_png(file_, Image<std::uint16_t>(8, 4, 1).view());
  Image<std::uint16_t> read(8, 4);
  const std::uint16_t* before = read.data();
  EXPECT_TRUE(read_png(file_, read).ok());
  EXPECT_EQ(read.data(), before);
  EXPECT_EQ(read(7, 3), 1);
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
    std::string extra, told;
  } cases[] = {
      {8, 0, "", "is 8-bit grey; 16-bit grey is wanted"},
      {8, 2, "", "is 8-bit RGB; 16-bit grey is wanted"},
      {16, 2, "", "is 16-bit RGB; 16-bit grey is wanted"},
      {8, 3, test::mini_png::chunk("PLTE", "abc"), "is 8-bit palette; 16-bit grey is wanted"},
      {16, 4, "", "is 16-bit grey with alpha; 16-bit grey is wanted"},
      {16, 6, "", "is 16-bit RGB with alpha; 16-bit grey is wanted"},
      {16, 0, test::mini_png::chunk("tRNS", std::string(2, '\0')),
       "is 16-bit grey with transparency; 16-bit grey is wanted"},
  };
  for (const auto& c : cases) {
    const Format format{2, 2, c.bits, c.color_type, false};
    folder_.write("image.png",
                  test::mini_png::encode(format, std::string(std::size_t{64}, '\0'), c.extra));
    Image<std::uint16_t> read;
    const FileResult result = read_png(file_, read);
    EXPECT_EQ(result.status, FileStatus::bad);
    EXPECT_EQ(result.message, file_.string() + ": " + c.told);
  }
}

TEST_F(Png, TellsMissingFromBad) {
  Image<std::uint16_t> read;
  EXPECT_EQ(read_png(folder_.path() / "none.png", read).status, FileStatus::missing);
  const FileResult of_folder = read_png(folder_.path(), read);
  EXPECT_EQ(of_folder.status, FileStatus::bad);
  EXPECT_HAS(of_folder.message, "is not a regular file");
}

TEST_F(Png, NamesWhatIsWantedOfAnotherFormat) {
  folder_.write("image.png", "\xff\xd8\xff\xe0 a JPEG's first bytes, named wrongly");
  Image<std::uint16_t> read;
  EXPECT_HAS(read_png(file_, read).message, "is no PNG; convert it");
}

TEST_F(Png, DoesNotWaitForAPipe) {
  ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
  Image<std::uint16_t> read;
  EXPECT_HAS(read_png(file_, read).message, "is not a regular file");
}

TEST_F(Png, RefusesAnotherSizeThanWanted) {
  write_png(file_, Image<std::uint16_t>(8, 4, 1).view());
  Image<std::uint16_t> read;
  EXPECT_TRUE(read_png(file_, read, ImageSize{8, 4}).ok());
  EXPECT_EQ(read_png(file_, read, ImageSize{4, 8}).message,
            file_.string() + ": has 8 x 4 pixels; the camera has 4 x 8");
}

TEST_F(Png, RefusesAbsurdSizesBeforeAllocating) {
  const struct {
    std::uint32_t width, height;
    std::string told;
  } cases[] = {
      {0x7fffffff, 0x7fffffff, "has 2147483647 x 2147483647 pixels; at most 32767 each"},
      {32768, 1, "has 32768 x 1 pixels; at most 32767 each"},
      {32767, 32767, "more than a file of"},
      {0, 5, "is a damaged PNG"},
  };
  for (const auto& c : cases) {
    folder_.write("image.png", test::mini_png::signature() +
                                   test::mini_png::header({c.width, c.height, 16, 0, false}) +
                                   test::mini_png::chunk("IDAT", "abc"));
    Image<std::uint16_t> read;
    const FileResult result = read_png(file_, read);
    EXPECT_EQ(result.status, FileStatus::bad);
    EXPECT_HAS(result.message, c.told);
    EXPECT_TRUE(read.empty());
  }
}

TEST_F(Png, FindsEveryTruncation) {
  std::mt19937_64 random = test::seeded_random(4);
  write_png(file_, random_image<std::uint16_t>(23, 19, random).view());
  const std::string whole = test::read_bytes(file_);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    folder_.write("image.png", whole.substr(0, length));
    Image<std::uint16_t> read;
    const FileResult result = read_png(file_, read);
    ASSERT_EQ(result.status, FileStatus::bad) << length << " of " << whole.size();
    EXPECT_HAS(result.message, "damaged PNG");
  }
}

TEST_F(Png, FindsEveryFlippedBit) {
  std::mt19937_64 random = test::seeded_random(5);
  write_png(file_, random_image<std::uint16_t>(11, 9, random).view());
  const std::string whole = test::read_bytes(file_);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    folder_.write("image.png", damaged);
    Image<std::uint16_t> read;
    ASSERT_EQ(read_png(file_, read).status, FileStatus::bad) << "bit " << bit;
  }
}

// With right checksums the damage reaches the decoder: anything may come back, but no crash.
void survive_damage_under_right_checksums(int rounds) {
  std::mt19937_64 random = test::seeded_random(6);
  const test::TemporaryFolder folder;
  const auto image = random_image<std::uint16_t>(16, 16, random);
  for (int i = 0; i < rounds; ++i) {
    const Format format{16, 16, 16, 0, i % 2 == 0};
    const std::string good = test::mini_png::encode(format, samples(image));
    const std::size_t start = test::mini_png::signature().size() + 25;
    const std::uint32_t length = test::mini_png::big_endian(good, start);
    std::string data = good.substr(start + 8, length);
    for (int n = 0; n < 1 + i % 4; ++n) data[random() % data.size()] = static_cast<char>(random());
    if (i % 3 == 0) data.resize(random() % data.size());
    const auto file =
        folder.write("image.png", good.substr(0, start) + test::mini_png::chunk("IDAT", data) +
                                      test::mini_png::chunk("IEND", ""));
    Image<std::uint16_t> read;
    static_cast<void>(read_png(file, read));
    Image<Rgb8> color;
    static_cast<void>(read_png(file, color));
  }
}

TEST_F(Png, SurvivesDamageUnderRightChecksums) { survive_damage_under_right_checksums(1000); }

TEST(PngFull, SurvivesDamageUnderRightChecksums) {
  if (!test::is_full_run()) GTEST_SKIP() << "skipped: PENUMBRA_FULL is not set";
  survive_damage_under_right_checksums(20000);
}

TEST_F(Png, SaysWhenItCannotWrite) {
  const Image<std::uint8_t> image(4, 4);
  const std::string message =
      input_error([&] { write_png(folder_.path() / "none" / "x.png", image.view()); });
  EXPECT_HAS(message, "none/x.png: cannot be written: No such file or directory");
  EXPECT_HAS(input_error([&] { write_png("/dev/full", image.view()); }), "No space left");
}

TEST_F(Png, ReadsTheRealRecording) {
  PENUMBRA_REQUIRE_DATA();
  const auto data = test::data_folder() / "xarm7_realsense";
  Image<std::uint16_t> depth;
  Image<std::uint8_t> mask;
  Image<Rgb8> color;
  for (int i = 0; i < 10; ++i) {
    const std::string number = std::to_string(i) + ".png";
    EXPECT_EQ(read_png(data / ("depth_" + number), depth, ImageSize{1280, 720}).message, "");
    EXPECT_EQ(read_png(data / ("robot_mask_" + number), mask, ImageSize{1280, 720}).message, "");
    EXPECT_EQ(read_png(data / ("color_" + number), color, ImageSize{1280, 720}).message, "");
  }
  // Against the decoder that follows the specification alone.
  Format format;
  const std::string rows = test::mini_png::decode(test::read_bytes(data / "depth_9.png"), format);
  EXPECT_EQ(rows, samples(depth));
}

}  // namespace
}  // namespace penumbra::io
