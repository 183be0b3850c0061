// SPDX-License-Identifier: Apache-2.0
// COCO's masks, by a plain decoder of its format.
#include "../support/random.hpp"
#include "../support/test.hpp"

#include <io/files/coco_mask.hpp>

namespace penumbra::test {
namespace {

/// Reads the text one character and one pixel at a time; returns the columns, one after the other.
std::vector<bool> decoded(const std::string& text) {
  std::vector<std::int64_t> counts;
  for (std::size_t at = 0; at < text.size();) {
    std::int64_t value = 0;
    int bits = 0;
    for (bool more = true; more; ++at, bits += 5) {
      const std::int64_t code = text[at] - 48;
      value |= (code & 31) << bits;
      more = (code & 32) != 0;
      if (!more && (code & 16) != 0) value -= std::int64_t{1} << (bits + 5);
    }
    counts.push_back(value + (counts.size() > 2 ? counts[counts.size() - 2] : 0));
  }
  std::vector<bool> pixels;
  for (std::size_t i = 0; i < counts.size(); ++i)
    pixels.insert(pixels.end(), static_cast<std::size_t>(counts[i]), i % 2 == 1);
  return pixels;
}

Image<float> image_of(int width, int height, const std::function<bool(int, int)>& is_in) {
  Image<float> image(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) image(u, v) = is_in(u, v) ? 1.5F : 0.0F;
  return image;
}

TEST(CocoMask, IsReadBackByAPlainDecoder) {
  auto random = seeded_random(1);
  const auto share = [&](int part) { return [&, part](int, int) { return random() % part == 0; }; };
  std::vector<Image<float>> images{image_of(5, 7, [](int, int) { return false; }),
                                   image_of(5, 7, [](int, int) { return true; }),
                                   image_of(1, 1, [](int, int) { return true; }),
                                   image_of(30, 40, share(2)),
                                   image_of(640, 480, share(1000)),
                                   image_of(9, 9, [](int u, int v) { return u == v; })};
  for (int k = 0; k < 50; k += 7)
    images.push_back(image_of(50, 33, [k](int u, int v) { return (u + k) % 50 <= v; }));
  for (const Image<float>& image : images) {
    const io::CocoMask mask = io::coco_mask(image.view());
    std::vector<bool> columns;
    std::int64_t area = 0;
    Eigen::AlignedBox2i box;
    for (int u = 0; u < image.width(); ++u)
      for (int v = 0; v < image.height(); ++v) {
        columns.push_back(image(u, v) > 0.0F);
        if (!columns.back()) continue;
        ++area;
        box.extend(Eigen::Vector2i(u, v));
      }
    EXPECT_EQ(decoded(mask.counts), columns);
    EXPECT_EQ(mask.area, area);
    const std::array<int, 4> expected =
        area == 0
            ? std::array<int, 4>{}
            : std::array{box.min().x(), box.min().y(), box.sizes().x() + 1, box.sizes().y() + 1};
    EXPECT_EQ(mask.box, expected);
  }
}

// Counted by hand: runs 1, 2, 6 of a 3 x 3 image, and 40 = 8 + 32.
TEST(CocoMask, HasCocosText) {
  const auto below = image_of(3, 3, [](int u, int v) { return u == 0 && v > 0; });
  EXPECT_EQ(io::coco_mask(below.view()).counts, "126");
  const auto column = image_of(1, 80, [](int, int v) { return v >= 40; });
  EXPECT_EQ(io::coco_mask(column.view()).counts, "X1X1");
}

}  // namespace
}  // namespace penumbra::test
