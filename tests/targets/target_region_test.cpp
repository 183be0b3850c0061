// SPDX-License-Identifier: Apache-2.0
// Which pixels regions cover, against geometry asked pixel by pixel.
#include "../support/random.hpp"
#include "target_regions.hpp"

#include <functional>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/targets/region_spans-inl.hpp>

namespace penumbra {
namespace {

using test::Corners;
using test::Place;

constexpr int width = 61, height = 47;
constexpr int margin = 90;  // pixels around the image in which regions are looked for

using PlaceOf = std::function<Place(const Eigen::Vector2d&)>;

/// How often each pixel of the image is in a span.
Image<int> painted(const RegionSpans& region) {
  Image<int> image(width, height);
  for (const RowSpan& span : region.spans())
    for (int u = span.u0; u < span.u1; ++u) ++image(u, span.v);
  return image;
}

/// `by_area`: how many pixels the count of those outside the image may be off.
void expect_covers(const RegionSpans& region, const PlaceOf& place, double by_area = 0) {
  const Image<int> image = painted(region);
  std::size_t inside = 0, covered = 0, close = 0;
  for (int v = -margin; v < height + margin; ++v) {
    for (int u = -margin; u < width + margin; ++u) {
      const Place there = place(Eigen::Vector2d(u, v));
      const bool in_image = u >= 0 && v >= 0 && u < width && v < height;
      covered += there == Place::inside ? 1 : 0;
      close += there == Place::close ? 1 : 0;
      if (!in_image) continue;
      inside += static_cast<std::size_t>(image(u, v));
      if (there == Place::close) continue;
      ASSERT_EQ(image(u, v), there == Place::inside ? 1 : 0) << u << ", " << v;
    }
  }
  EXPECT_EQ(region.inside(), inside);
  EXPECT_GE(region.covered(), inside);
  EXPECT_GE(static_cast<double>(region.covered()), static_cast<double>(covered) - by_area);
  EXPECT_LE(static_cast<double>(region.covered()), static_cast<double>(covered + close) + by_area);
}

/// How far the number of pixels in an ellipse can be from its area: half the length of a convex
/// outline and 1 (Nosarzewska 1948), and half a pixel that rounding adds. 0 if all of the ellipse
/// lies in the image: then its pixels are counted.
double area_error(const PixelEllipse& ellipse) {
  const double c = std::cos(ellipse.angle), s = std::sin(ellipse.angle);
  const double a = ellipse.semi_axes.x(), b = ellipse.semi_axes.y();
  const Eigen::Array2d reach(std::hypot(a * c, b * s), std::hypot(a * s, b * c));
  const Eigen::Array2d low = ellipse.centre.array() - reach, high = ellipse.centre.array() + reach;
  if (low.minCoeff() >= 0 && high.x() <= width - 1 && high.y() <= height - 1) return 0;
  const double longest_outline = std::numbers::pi * std::sqrt(2 * (a * a + b * b));
  return longest_outline / 2 + 1.5;
}

class RandomRegions : public testing::Test {
 protected:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  Eigen::Vector2d near_image() { return {number(-30, width + 30), number(-30, height + 30)}; }

  std::mt19937_64 random = test::seeded_random(41);
  RegionSpans region{width, height};
};

TEST_F(RandomRegions, Boxes) {
  for (int i = 0; i < 150; ++i) {
    const Eigen::Vector2d corner = near_image();
    PixelBox box{corner.x(), corner.y(), number(1, 50), number(1, 50)};
    if (i % 3 == 0) box = {std::round(box.u), std::round(box.v), std::round(box.width), 7};
    region.fill(box);
    expect_covers(region, [&](const auto& p) { return test::place_in_box(box, p); });
  }
}

TEST_F(RandomRegions, Ellipses) {
  for (int i = 0; i < 150; ++i) {
    const PixelEllipse ellipse{near_image(), {number(0.8, 50), number(0.8, 50)}, number(-9, 9)};
    region.fill(ellipse);
    const auto place = [&](const auto& p) { return test::place_in_ellipse(ellipse, p); };
    expect_covers(region, place, area_error(ellipse));
  }
}

TEST_F(RandomRegions, Polygons) {
  for (int i = 0; i < 60; ++i) {
    const Corners corners =
        test::random_star(random, near_image(), number(5, 60), 3 + random() % 30);
    region.fill(PixelPolygon{corners});
    expect_covers(region, [&](const auto& p) { return test::place_in_polygon(corners, p); });
  }
}

TEST_F(RandomRegions, PolygonsThatCrossThemselvesCoverWhatTheyWindAround) {
  for (int i = 0; i < 60; ++i) {
    Corners corners;
    for (std::size_t n = 4 + random() % 8; n > 0; --n) corners.push_back(near_image());
    region.fill(PixelPolygon{corners});
    expect_covers(region, [&](const auto& p) { return test::place_in_polygon(corners, p); });
  }
}

TEST_F(RandomRegions, PolygonsOnTheGridThatShareEdgesShareNoPixel) {
  for (int i = 0; i < 100; ++i) {
    // A frame of four corners cut into triangles at a point of it: each pixel is in one of them.
    const auto grid = [&](double low, double high) { return std::round(number(low, high)); };
    const Corners frame = {{grid(-9, 5), grid(-9, 5)},
                           {grid(50, 70), grid(-9, 5)},
                           {grid(50, 70), grid(40, 60)},
                           {grid(-9, 5), grid(40, 60)}};
    const Eigen::Vector2d middle(grid(10, 45), grid(10, 35));
    region.fill(PixelPolygon{frame});
    const Image<int> whole = painted(region);
    const std::size_t covered = region.covered();
    Image<int> sum(width, height);
    std::size_t parts = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Corners part = {frame[k], frame[(k + 1) % 4], middle};
      region.fill(PixelPolygon{part});
      parts += region.covered();
      const Image<int> image = painted(region);
      for (std::size_t j = 0; j < image.size(); ++j) sum.data()[j] += image.data()[j];
    }
    EXPECT_EQ(parts, covered);
    for (std::size_t j = 0; j < sum.size(); ++j) ASSERT_EQ(sum.data()[j], whole.data()[j]) << j;
  }
}

TEST_F(RandomRegions, MasksAndTheirRunLengths) {
  for (int i = 0; i < 200; ++i) {
    Image<std::uint8_t> mask(width, height);
    const unsigned density = 1 + static_cast<unsigned>(random() % 40);
    for (std::size_t j = 0; j < mask.size(); ++j)
      mask.data()[j] = random() % 40 < density ? static_cast<std::uint8_t>(1 + random() % 255) : 0;
    if (i % 2 == 0) {  // blocks, whose columns run on
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) mask(u, v) = mask(u / 9 * 9, v / 7 * 7);
    }
    if (i == 0) std::fill_n(mask.data(), mask.size(), std::uint8_t{1});
    mask(static_cast<int>(random() % width), static_cast<int>(random() % height)) = 1;
    const auto place = [&](const Eigen::Vector2d& p) {
      const bool in_image = p.x() >= 0 && p.y() >= 0 && p.x() < width && p.y() < height;
      return in_image && mask(static_cast<int>(p.x()), static_cast<int>(p.y())) != 0
                 ? Place::inside
                 : Place::outside;
    };
    region.fill(PixelMask{mask.view()});
    expect_covers(region, place);
    const std::vector<std::uint32_t> counts = test::run_lengths(mask.view());
    region.fill(RunLengthMask{width, height, counts});
    expect_covers(region, place);
  }
}

TEST_F(RandomRegions, RenderedOnes) {
  for (int i = 0; i < 50; ++i) {
    Image<float> depth(width, height);
    TileMask tiles(width, height);
    for (std::size_t j = random() % 900; j > 0; --j) {
      const int u = static_cast<int>(random() % width), v = static_cast<int>(random() % height);
      depth(u, v) = static_cast<float>(number(0.1, 3));
      tiles.mark(u, v, u, v);
    }
    const auto place = [&](const Eigen::Vector2d& p) {
      const bool in_image = p.x() >= 0 && p.y() >= 0 && p.x() < width && p.y() < height;
      return in_image && depth(static_cast<int>(p.x()), static_cast<int>(p.y())) > 0
                 ? Place::inside
                 : Place::outside;
    };
    region.fill(RenderedRegion{.depth = depth.view(), .touched = nullptr});
    expect_covers(region, place);
    region.fill(RenderedRegion{.depth = depth.view(), .touched = &tiles});
    expect_covers(region, place);
  }
}

TEST(Regions, CountPixelsOutsideOfTheImage) {
  RegionSpans region(width, height);
  region.fill(PixelBox{-10, -5, 20, 10});
  EXPECT_EQ(region.covered(), 200u);
  EXPECT_EQ(region.inside(), 50u);
  region.fill(PixelBox{1000, 1000, 10, 10});
  EXPECT_EQ(region.covered(), 100u);
  EXPECT_EQ(region.inside(), 0u);
  region.fill(PixelBox{-1e9, -1e9, 1e9, 1e9});
  EXPECT_EQ(region.covered(), std::size_t{1000000000} * 1000000000);
  EXPECT_EQ(region.inside(), 0u);
  const Corners square = {{-4, -2000}, {4, -2000}, {4, -1990}, {-4, -1990}};
  region.fill(PixelPolygon{square});
  EXPECT_EQ(region.covered(), 80u);
}

TEST(Regions, LargeOnesCountByTheirArea) {
  // Of 256 rows above and 256 below the image the midpoint rule misses less than a row's share of
  // the triangle's height.
  constexpr double sampled = 1.0 / 256;
  constexpr double tolerance = 1e-9;  // rounding to whole pixels
  RegionSpans region(width, height);
  const std::size_t all = std::size_t{width} * height;
  region.fill(PixelEllipse{{20, 30}, {1e5, 2e5}, 0.4});
  EXPECT_NEAR(static_cast<double>(region.covered()) / (std::numbers::pi * 2e10), 1, tolerance);
  EXPECT_EQ(region.inside(), all);
  region.fill(PixelEllipse{{20, 1e6}, {1e5, 2e5}, 0});
  EXPECT_NEAR(static_cast<double>(region.covered()) / (std::numbers::pi * 2e10), 1, tolerance);
  EXPECT_EQ(region.inside(), 0u);
  const Corners triangle = {{-1e6, -1e6}, {1e6, -1e6}, {0, 2e6}};
  region.fill(PixelPolygon{triangle});
  EXPECT_NEAR(static_cast<double>(region.covered()) / 3e12, 1, sampled);
  EXPECT_EQ(region.inside(), all);
  const Corners bow = {{-1e6, -1e6}, {1e6, 1e6}, {1e6, -1e6}, {-1e6, 1e6}};
  region.fill(PixelPolygon{bow});
  EXPECT_NEAR(static_cast<double>(region.covered()) / 2e12, 1, sampled)
      << "no part cancels another";
}

TEST(Regions, CoverOnePixelAtLeast) {
  RegionSpans region(width, height);
  const Corners small = {{10.2, 10.2}, {10.4, 10.2}, {10.3, 10.4}};
  const Region regions[] = {PixelBox{10.2, 10.2, 0.3, 0.3}, PixelPolygon{small},
                            PixelEllipse{{10.3, 10.3}, {0.1, 0.1}, 0}};
  for (const Region& one : regions) {
    region.fill(one);
    EXPECT_EQ(region.covered(), 1u);
    ASSERT_EQ(region.inside(), 1u);
    EXPECT_EQ(region.middle(), Eigen::Vector2d(10, 10));
  }
  region.fill(PixelEllipse{{-0.6, 3}, {0.1, 0.1}, 0});
  EXPECT_EQ(region.covered(), 1u);
  EXPECT_EQ(region.inside(), 0u);
}

TEST(Regions, RoundCirclesHoldThePixelsOnThem) {
  RegionSpans region(width, height);
  region.fill(PixelEllipse{{20, 20}, {5, 5}, 0});
  EXPECT_EQ(region.inside(), 81u);  // Gauss's circle problem
}

TEST(Regions, OutlinesMayTouchThemselves) {
  RegionSpans region(width, height);
  // As contour tracing gives it: out to a point and back on the same pixels, corners twice.
  const Corners spike = {{5, 5}, {10, 5}, {20, 5}, {10, 5}, {10, 10}, {10, 10}, {5, 10}, {5, 5}};
  region.fill(PixelPolygon{spike});
  EXPECT_EQ(region.inside(), 25u);
  const Corners two = {{0, 0}, {8, 8}, {16, 0}, {16, 16}, {8, 8}, {0, 16}};
  region.fill(PixelPolygon{two});
  EXPECT_EQ(region.inside(), 128u);
}

TEST(Regions, OutlinesMayCrossThemselves) {
  RegionSpans region(width, height);
  const Corners bow = {{0, 0}, {10, 10}, {10, 0}, {0, 10}};
  region.fill(PixelPolygon{bow});
  EXPECT_EQ(region.inside(), 50u);
  EXPECT_EQ(region.covered(), 50u);
  const Corners twice = {{2, 2}, {9, 2}, {9, 9}, {2, 9}, {2, 2}, {9, 2}, {9, 9}, {2, 9}};
  region.fill(PixelPolygon{twice});
  EXPECT_EQ(region.inside(), 49u);
  const Corners outside = {{-20, 0}, {-10, 10}, {-10, 0}, {-20, 10}};
  region.fill(PixelPolygon{outside});
  EXPECT_EQ(region.inside(), 0u);
  EXPECT_EQ(region.covered(), 50u);
}

std::string fault_of(const Region& bad) {
  RegionSpans region(width, height);
  try {
    region.fill(bad);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

std::string polygon_fault(const Corners& corners) { return fault_of(PixelPolygon{corners}); }

const double nan = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

TEST(BadRegions, Boxes) {
  EXPECT_EQ(fault_of(PixelBox{1, 2, 0, 5}),
            "box 1, 2, 0 x 5: has no area: width and height must be above 0");
  EXPECT_NE(fault_of(PixelBox{1, 2, 3, -5}), "no fault");
  EXPECT_EQ(fault_of(PixelBox{nan, 2, 3, 5}), "box nan, 2, 3 x 5: must be numbers");
  EXPECT_NE(fault_of(PixelBox{1, 2, infinity, 5}), "no fault");
  EXPECT_EQ(fault_of(PixelBox{1, 2e9, 3, 5}), "box 1, 2e+09, 3 x 5: is too far out, or too large");
}

TEST(BadRegions, Polygons) {
  EXPECT_EQ(polygon_fault({{1, 1}, {5, 5}}), "polygon of 2 corners: needs 3 or more");
  EXPECT_EQ(polygon_fault({{1, 1}, {5, 5}, {3, 3}}), "polygon of 3 corners has no area");
  EXPECT_EQ(polygon_fault({{0.1, 0.1}, {0.7, 0.7}, {0.3, 0.3}}),
            "polygon of 3 corners has no area");
  EXPECT_EQ(polygon_fault({{1, 1}, {1, 1}, {1, 1}}), "polygon of 3 corners has no area");
  EXPECT_EQ(polygon_fault({{1, 1}, {5, nan}, {3, 1}}),
            "polygon corner 1 (5, nan): must be numbers up to 1e+09");
  EXPECT_NE(polygon_fault(Corners(10001, {1, 1})), "no fault");
}

TEST(BadRegions, Masks) {
  Image<std::uint8_t> mask(width, height), small(width - 1, height);
  EXPECT_EQ(fault_of(PixelMask{mask.view()}), "mask without any pixel");
  EXPECT_EQ(fault_of(PixelMask{small.view()}), "mask of 60 x 47 pixels: the image has 61 x 47");
  EXPECT_NE(fault_of(PixelMask{}), "no fault");
  const std::vector<std::uint32_t> none = {width * height}, short_ones = {5, 6},
                                   long_ones = {4000000000u, 4000000000u};
  EXPECT_EQ(fault_of(RunLengthMask{width, height, none}), "run-length mask without any pixel");
  EXPECT_EQ(fault_of(RunLengthMask{width, height, short_ones}),
            "run-length mask: its counts add up to 11 pixels, the image has 2867");
  EXPECT_EQ(fault_of(RunLengthMask{width, height, long_ones}),
            "run-length mask: its counts add up to 8000000000 pixels, the image has 2867");
  EXPECT_NE(fault_of(RunLengthMask{height, width, none}), "no fault");
  EXPECT_NE(fault_of(RunLengthMask{width, height, {}}), "no fault");
}

TEST(BadRegions, Ellipses) {
  EXPECT_EQ(fault_of(PixelEllipse{{1, 2}, {3, 0}, 0}),
            "ellipse at (1, 2) of 3 x 0 pixels: semi-axes must be above 0");
  EXPECT_NE(fault_of(PixelEllipse{{1, nan}, {3, 2}, 0}), "no fault");
  EXPECT_NE(fault_of(PixelEllipse{{1, 2}, {3, infinity}, 0}), "no fault");
  EXPECT_NE(fault_of(PixelEllipse{{1, 2}, {3, 2}, nan}), "no fault");
  EXPECT_NE(fault_of(PixelEllipse{{1, 2}, {3, 2e9}, 0}), "no fault");
}

TEST(BadRegions, RenderedOnes) {
  for (const float bad :
       {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image<float> depth(width, height, 1.0f);
    depth(60, 3) = bad;
    EXPECT_NE(fault_of(RenderedRegion{.depth = depth.view(), .touched = nullptr}), "no fault");
  }
  const Image<float> depth(width, height + 1);
  EXPECT_NE(fault_of(RenderedRegion{.depth = depth.view(), .touched = nullptr}), "no fault");
}

}  // namespace
}  // namespace penumbra
