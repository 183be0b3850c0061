// SPDX-License-Identifier: Apache-2.0
#include "jpeg_file.hpp"
#include "ros_images.hpp"
#include "ros_samples.hpp"

#include <io/ros/cdr_reader.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::io {
namespace {

using test::bytes_of;
using test::each_pixel;
using test::same_pixels;

// An image as it lies in a message: rows of `step` bytes, `offset` bytes from an aligned place.
class Laid {
 public:
  template <typename T>
  Laid(const Image<T>& image, std::string encoding, std::size_t step, std::size_t offset, bool big)
      : memory_(offset + step * static_cast<std::size_t>(image.height())) {
    for (const auto [u, v] : each_pixel(image)) {
      T value = image(u, v);
      if (big) {
        auto* bytes = reinterpret_cast<std::byte*>(&value);
        std::reverse(bytes, bytes + sizeof value);
      }
      const std::size_t at =
          offset + step * static_cast<std::size_t>(v) + sizeof(T) * static_cast<std::size_t>(u);
      std::memcpy(memory_.data() + at, &value, sizeof(T));
    }
    message_.encoding = std::move(encoding);
    message_.width = static_cast<std::uint32_t>(image.width());
    message_.height = static_cast<std::uint32_t>(image.height());
    message_.step = static_cast<std::uint32_t>(step);
    message_.is_bigendian = big ? 1 : 0;
    message_.data = std::span(memory_).subspan(offset);
  }

  ImageMessage message_;

 private:
  std::vector<std::byte> memory_;
};

/// Expects `decode` to find a fault in each beginning of `whole`.
template <typename Decode>
void expect_cuts_are_faults(const std::vector<std::byte>& whole, const Decode& decode) {
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const test::ExactCopy cut{std::span(whole).first(size)};
    EXPECT_TRUE(decode(cut.bytes())) << size;
  }
}

template <typename T>
void check_depth(const Image<T>& image, const std::string& encoding) {
  SharedDepth depth;
  const std::size_t row = sizeof(T) * static_cast<std::size_t>(image.width());
  for (const std::size_t step : {row, row + sizeof(T), row + 1})
    for (const std::size_t offset : {std::size_t{0}, std::size_t{4}, std::size_t{1}})
      for (const bool big : {false, true}) {
        const Laid laid(image, encoding, step, offset, big);
        const auto fault = decode_depth(laid.message_, depth);
        ASSERT_FALSE(fault) << *fault;
        const auto view = std::get<ImageView<const T>>(depth.view);
        EXPECT_TRUE(same_pixels(image.view(), view)) << step << ' ' << offset << ' ' << big;
        const void* data = view.data;
        const bool in_place = data == laid.message_.data.data();
        EXPECT_EQ(in_place, !big && offset != 1 && step != row + 1);
      }
}

TEST(RosImage, DepthOfAnyOrderStepAndAlignment) {
  std::mt19937_64 random = test::seeded_random(1);
  const auto millimetres = test::depth_image(13, 7, random);
  check_depth(millimetres, "16UC1");
  check_depth(millimetres, "mono16");
  Image<float> metres(13, 7);
  for (std::size_t i = 0; i < metres.size(); ++i)
    metres.data()[i] = i % 5 == 0 ? NAN : 0.001F * millimetres.data()[i];
  check_depth(metres, "32FC1");
}

TEST(RosImage, SizesThatDoNotFitAreFaults) {
  const std::vector<std::byte> data(24);
  const ImageMessage good{.height = 3, .width = 4, .encoding = "16UC1", .step = 8, .data = data};
  SharedDepth depth;
  EXPECT_FALSE(decode_depth(good, depth));
  using M = ImageMessage;
  const std::pair<void (*)(M&), const char*> changes[] = {
      {[](M& m) { m.step = 6; }, "steps of 6 bytes"},
      {[](M& m) { m.height = 4; }, "4 x 4"},
      {[](M& m) { m.width = 0; }, "0 x 3"},
      {[](M& m) { m.width = 4'000'000'000; }, "4000000000 x 3"},
      {[](M& m) { m.step = 4'000'000'000; }, "steps of 4000000000"},
      {[](M& m) { m.encoding = "rgb8"; }, "'rgb8'"},
      {[](M& m) { m.encoding = "\x1b[2J\nok"; }, "'?[2J?ok'"}};
  for (const auto& [change, named] : changes) {
    ImageMessage message = good;
    change(message);
    const auto fault = decode_depth(message, depth);
    EXPECT_HAS(fault.value_or(""), named);
    EXPECT_TRUE(std::visit([](const auto& view) { return view.empty(); }, depth.view));
  }
}

TEST(RosImage, Colours) {
  const std::vector<std::byte> data = bytes_of("abcdefgh0123");
  const auto decoded = [&](const char* encoding, std::uint32_t width, std::uint32_t height) {
    ImageMessage message{.height = height, .width = width, .encoding = encoding, .data = data};
    message.step = static_cast<std::uint32_t>(data.size()) / height;
    Image<Rgb8> image;
    const auto fault = decode_color(message, image);
    EXPECT_FALSE(fault) << *fault;
    return image;
  };
  EXPECT_EQ(decoded("rgb8", 2, 2)(1, 1), (Rgb8{'1', '2', '3'}));
  EXPECT_EQ(decoded("bgr8", 4, 1)(1, 0), (Rgb8{'f', 'e', 'd'}));
  EXPECT_EQ(decoded("rgba8", 1, 3)(0, 1), (Rgb8{'e', 'f', 'g'}));
  EXPECT_EQ(decoded("bgra8", 3, 1)(2, 0), (Rgb8{'2', '1', '0'}));
  EXPECT_EQ(decoded("mono8", 5, 2)(4, 1), (Rgb8{'2', '2', '2'}));
}

// BT.601 in doubles: the factors come from its definition.
Rgb8 bt601(int y, int u, int v) {
  const double grey = (y - 16) * 255.0 / 219, blue = (u - 128) * 255.0 / 224,
               red = (v - 128) * 255.0 / 224;
  const double kr = 0.299, kb = 0.114, kg = 1 - kr - kb;
  const auto octet = [](double x) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0, 255.0)));
  };
  return {octet(grey + 2 * (1 - kr) * red),
          octet(grey - 2 * (1 - kb) * kb / kg * blue - 2 * (1 - kr) * kr / kg * red),
          octet(grey + 2 * (1 - kb) * blue)};
}

TEST(RosImage, YuvIsBt601) {
  constexpr int rounding = 1;  // of factors in 1/256
  const auto near = [](int a, int b) { return std::abs(a - b) <= rounding; };
  Image<Rgb8> image;
  for (int y = 0; y < 256; y += 5)
    for (int u = 0; u < 256; u += 15)
      for (int v = 0; v < 256; v += 15) {
        const int other = 255 - y;
        for (const bool uv_first : {true, false}) {
          std::vector<std::byte> data;
          for (const int x : uv_first ? std::array{u, y, v, other} : std::array{y, u, other, v})
            data.push_back(static_cast<std::byte>(x));
          const ImageMessage message{{}, 1, 2, uv_first ? "yuv422" : "yuv422_yuy2", 0, 4, data};
          ASSERT_FALSE(decode_color(message, image));
          for (int i = 0; i < 2; ++i) {
            const Rgb8 wanted = bt601(i == 0 ? y : other, u, v), got = image(i, 0);
            ASSERT_TRUE(near(wanted.r, got.r) && near(wanted.g, got.g) && near(wanted.b, got.b))
                << y << ' ' << u << ' ' << v;
          }
        }
      }
}

Image<Rgb8> smooth_colours(int width, int height) {
  Image<Rgb8> image(width, height);
  for (const auto [u, v] : each_pixel(image))
    image(u, v) = {static_cast<std::uint8_t>(4 * u), static_cast<std::uint8_t>(6 * v),
                   static_cast<std::uint8_t>(2 * u + 2 * v)};
  return image;
}

TEST(RosImage, Jpeg) {
  constexpr int loss = 6;  // of smooth colours at quality 95
  const auto image = smooth_colours(40, 30);
  for (const bool progressive : {false, true}) {
    const auto file = test::jpeg_of(image, progressive);
    Image<Rgb8> read;
    const CompressedImageMessage message{.format = "rgb8; jpeg compressed bgr8", .data = file};
    const auto fault = decode_color(message, read);
    ASSERT_FALSE(fault) << *fault;
    ASSERT_EQ(read.width(), 40);
    for (const auto [u, v] : each_pixel(image)) {
      EXPECT_NEAR(read(u, v).r, image(u, v).r, loss);
      EXPECT_NEAR(read(u, v).g, image(u, v).g, loss);
      EXPECT_NEAR(read(u, v).b, image(u, v).b, loss);
    }
    expect_cuts_are_faults(
        file, [&](auto cut) { return decode_color(CompressedImageMessage{.data = cut}, read); });
  }
}

TEST(RosImage, CompressedDepth) {
  std::mt19937_64 random = test::seeded_random(2);
  const auto image = test::depth_image(33, 21, random);
  constexpr float a = 6500.0F, b = 12.5F;
  SharedDepth depth;
  for (const bool rvl : {false, true}) {
    const std::string codec = rvl ? " rvl" : " png";
    const auto data = test::compressed_depth(image, rvl, a, b);
    for (const std::string& format :
         {"16UC1; compressedDepth" + codec,
          rvl ? "16UC1;compressedDepth rvl" : std::string("16UC1; compressedDepth")}) {
      const auto fault =
          decode_depth(CompressedImageMessage{.format = format, .data = data}, depth);
      ASSERT_FALSE(fault) << *fault;
      EXPECT_TRUE(same_pixels(image.view(), std::get<ImageView<const std::uint16_t>>(depth.view)));
    }
    const auto fault = decode_depth(
        CompressedImageMessage{.format = "32FC1; compressedDepth" + codec, .data = data}, depth);
    ASSERT_FALSE(fault) << *fault;
    const auto metres = std::get<ImageView<const float>>(depth.view);
    for (const auto [u, v] : each_pixel(image)) {
      const std::uint16_t q = image(u, v);
      const float wanted = a / (static_cast<float>(q) - b);
      EXPECT_TRUE(q == 0 ? std::isnan(metres(u, v)) : metres(u, v) == wanted) << q;
    }
    const std::string format = "16UC1; compressedDepth" + codec;
    expect_cuts_are_faults(data, [&](auto cut) {
      return decode_depth(CompressedImageMessage{.format = format, .data = cut}, depth);
    });
  }
}

TEST(RosImage, CompressedDepthFaults) {
  const Image<std::uint16_t> image(2, 2, 900);
  SharedDepth depth;
  const auto fault = [&](const std::string& format, const std::vector<std::byte>& data) {
    return decode_depth(CompressedImageMessage{.format = format, .data = data}, depth)
        .value_or("none");
  };
  const auto good = test::compressed_depth(image, true, 1, 1);
  EXPECT_HAS(fault("32FC1; compressedDepth jpeg", good), "png or rvl");
  EXPECT_HAS(fault("rgb8; compressedDepth png", good), "has format 'rgb8; compressedDepth png'");
  EXPECT_HAS(fault("32FC1; compressedDepth rvl", test::compressed_depth(image, true, NAN, 1)),
             "no parameters");
  EXPECT_HAS(fault("32FC1; compressedDepth rvl", test::compressed_depth(image, true, 0, 1)),
             "no parameters");
  auto longer = good;
  longer.resize(good.size() + 4);
  EXPECT_HAS(fault("16UC1; compressedDepth rvl", longer), "after the last pixel");
  auto huge = good;
  huge[15] = std::byte{1};  // the width
  EXPECT_HAS(fault("16UC1; compressedDepth rvl", huge), "has 16777218 x 2 pixels");
  huge = good;
  huge[13] = huge[17] = std::byte{0x20};
  EXPECT_HAS(fault("16UC1; compressedDepth rvl", huge), "8194 x 8194 pixels");
}

}  // namespace
}  // namespace penumbra::io
