// SPDX-License-Identifier: Apache-2.0
// Damaged payloads and images: faults or other values, never a crash, a hang or large memory.
#include "../support/allocations.hpp"
#include "../support/run_length.hpp"
#include "jpeg_file.hpp"
#include "ros_images.hpp"
#include "ros_samples.hpp"

#include <io/ros/image_codec.hpp>

namespace penumbra::io {
namespace {

using Bytes = std::vector<std::byte>;

// Of one piece: images of at most 2^24 depths (RVL, where few bytes may be of any image).
constexpr std::size_t large_memory = std::size_t{64} << 20;

Bytes damaged(const Bytes& whole, std::mt19937_64& random) {
  Bytes bytes = whole;
  if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
  for (std::size_t n = 1 + random() % 6; n > 0 && !bytes.empty(); --n) {
    std::byte& byte = bytes[random() % bytes.size()];
    const std::byte bit = static_cast<std::byte>(1U << random() % 8);
    const std::byte others[] = {std::byte{0xff}, byte ^ bit, std::byte{0}, std::byte(random())};
    byte = others[random() % 4];
  }
  return bytes;
}

template <typename Call>
void fuzz(const Bytes& whole, int times, std::mt19937_64& random, const Call& call) {
  for (int i = 0; i < times; ++i) {
    const test::ExactCopy copy(damaged(whole, random));
    const std::optional<std::string> fault = call(copy.bytes());
    ASSERT_EQ(fault.value_or("").find('\n'), std::string::npos) << *fault;
  }
}

int rounds(int all) { return test::is_full_run() ? 40 * all : test::samples(all); }

TEST(RosFuzz, Messages) {
  std::mt19937_64 random = test::seeded_random(11);
  const test::MemoryShortage shortage(large_memory, 0);
  const auto fuzz_as = [&]<typename M>(M out, const Bytes& payload) {
    fuzz(payload, rounds(1500), random,
         [&, decoder = Decoder<M>()](auto bytes) { return decoder.decode(bytes, out); });
  };
  test::for_each_sample([&](const auto& message) {
    fuzz_as(std::decay_t<decltype(message)>(), test::encoded(message));
  });
  fuzz_as(Detection2DArrayMessage(), test::detection_2d_payload());
  fuzz_as(Detection3DArrayMessage(), test::detection_3d_payload());
  EXPECT_EQ(shortage.asked(), 0U);
}

TEST(RosFuzz, Images) {
  std::mt19937_64 random = test::seeded_random(13);
  const test::MemoryShortage shortage(large_memory, 0);
  SharedDepth depth;
  const auto image = test::depth_image(24, 16, random);
  for (const bool rvl : {false, true})
    for (const char* encoding : {"16UC1", "32FC1"}) {
      const std::string format =
          std::string(encoding) + "; compressedDepth " + (rvl ? "rvl" : "png");
      fuzz(test::compressed_depth(image, rvl, 100, 1), rounds(1000), random, [&](auto bytes) {
        return decode_depth(CompressedImageMessage{.format = format, .data = bytes}, depth);
      });
    }
  Image<Rgb8> colours;
  Image<Rgb8> small(24, 16, Rgb8{90, 120, 30});
  for (int v = 0; v < 16; ++v) small(v, v) = {9, static_cast<std::uint8_t>(16 * v), 200};
  Bytes png;
  encode_png(std::as_const(small).view(), png);
  for (const Bytes& file : {test::jpeg_of(small, false), test::jpeg_of(small, true), png})
    fuzz(file, rounds(1000), random, [&](auto bytes) {
      return decode_color(CompressedImageMessage{.format = "any", .data = bytes}, colours);
    });
  EXPECT_EQ(shortage.asked(), 0U);
}

}  // namespace
}  // namespace penumbra::io
