// SPDX-License-Identifier: Apache-2.0
// The labels of the gl backend's device beside those of the scalar classifier, given the virtual
// depth that the same device draws.
#include "opengl.hpp"
#include "random.hpp"
#include "shapes.hpp"
#include "slab_scene.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/gl/gl_labeller.hpp>

namespace penumbra::test {
namespace {

using Eigen::Isometry3d;
using gl::PixelRectangle;

const Intrinsics uneven_camera(203, 157, 180.0, 185.0, 99.7, 81.2);  // of no round size
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Two links that overlap in the image.
struct TwoLinks {
  std::vector<TriangleMesh> upper{sphere(0.15F, 16)};
  std::vector<TriangleMesh> lower{box({0.08F, 0.3F, 0.06F})};
  std::vector<Body> bodies{{"upper", upper}, {"lower", lower}};

  [[nodiscard]] static std::vector<Isometry3d> poses(std::mt19937_64& random) {
    return {random_pose(random, {-0.3, -0.2, 0.6}, {0.3, 0.2, 0.9}),
            random_pose(random, {-0.3, -0.2, 0.8}, {0.3, 0.2, 1.6})};
  }
};

/// What a sensor might see: the robot with noise, a wall, objects before and behind, holes.
Image<float> sensor_image(const VirtualDepthView& robot, std::mt19937_64& random) {
  std::normal_distribution<float> noise(0.0F, 0.01F);
  std::uniform_int_distribution<int> size(2, 40);
  Image<float> image(robot.depth.width, robot.depth.height, 2.0F);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      if (robot.depth(u, v) > 0) image(u, v) = robot.depth(u, v) + noise(random);
    }
  }
  const auto fill = [&](float depth, bool relative) {
    const int u0 = static_cast<int>(random() % 200);
    const int v0 = static_cast<int>(random() % 150);
    const int u1 = std::min(u0 + size(random), image.width());
    const int v1 = std::min(v0 + size(random), image.height());
    for (int v = v0; v < v1; ++v) {
      for (int u = u0; u < u1; ++u) image(u, v) = relative ? image(u, v) + depth : depth;
    }
  };
  for (int i = 0; i < 12; ++i) fill(0.02F * static_cast<float>(random() % 30) - 0.4F, true);
  for (const float value : {0.0F, nan, 0.5F, -1.0F, std::numeric_limits<float>::infinity()}) {
    fill(value, false);
  }
  for (int i = 0; i < 1500; ++i) {
    image(static_cast<int>(random() % 203), static_cast<int>(random() % 157)) = 0.0F;
  }
  return image;
}

Image<std::uint16_t> in_millimetres(const Image<float>& metres) {
  Image<std::uint16_t> image(metres.width(), metres.height());
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const float z = metres.data()[i];
    image.data()[i] = z > 0.0F && z < 60.0F ? static_cast<std::uint16_t>(1000.0F * z) : 0;
  }
  return image;
}

std::vector<LabelRule> rules() {
  LabelRule far_margin;
  far_margin.edge_margin = LabelRule::max_edge_margin;
  far_margin.front_min_width = 3;
  LabelRule wide;
  wide.front_min_width = LabelRule::max_width;
  LabelRule no_margin;
  no_margin.edge_margin = 0;
  LabelRule ranged;
  ranged.range = {0.4, 1.2};
  ranged.fold_beyond = true;
  ranged.tolerance = {0.002, 0.003, 0.001};
  return {LabelRule{}, LabelRule::paper(), far_margin, wide, no_margin, ranged};
}

void expect_equal(const DeviceLabels& actual, const LabelView& expected,
                  std::span<const PixelRectangle> boxes) {
  for (int v = 0; v < uneven_camera.height(); ++v) {
    for (int u = 0; u < uneven_camera.width(); ++u) {
      ASSERT_EQ(actual.image.labels(u, v), expected.labels(u, v)) << u << ", " << v;
    }
  }
  EXPECT_EQ(actual.image.pixels, expected.pixels);
  ASSERT_EQ(actual.boxes.size(), boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    std::array<std::size_t, label_count> counts{};
    for (int v = std::max(boxes[i].v0, 0); v < std::min(boxes[i].v1, uneven_camera.height()); ++v) {
      for (int u = std::max(boxes[i].u0, 0); u < std::min(boxes[i].u1, uneven_camera.width());
           ++u) {
        ++counts[expected.labels(u, v)];
      }
    }
    EXPECT_EQ(actual.boxes[i], counts) << "box " << i;
  }
}

class GlLabels : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
  }
};

TEST_F(GlLabels, AreTheClassifiers) {
  std::mt19937_64 random = seeded_random(501);
  const TwoLinks robot;
  const auto renderer = make_depth_renderer(Backend::gl, uneven_camera, robot.bodies);
  const std::vector<PixelRectangle> boxes{{0, 0, 203, 157},
                                          {40, 30, 140, 120},
                                          {-50, -50, 20, 500},
                                          {90, 70, 91, 71},
                                          {300, 0, 310, 9}};
  std::array<std::size_t, label_count> seen{};
  for (const LabelRule& rule : rules()) {
    GlLabeller labeller(uneven_camera, robot.bodies, rule);
    Classifier classifier(uneven_camera.width(), uneven_camera.height(), rule, "scalar");
    for (int frame = 0; frame < 6; ++frame) {
      const auto poses = TwoLinks::poses(random);
      const VirtualDepthView drawn = renderer->render(poses);
      const Image<float> metres = sensor_image(drawn, random);
      const Image<std::uint16_t> millimetres = in_millimetres(metres);
      DepthView measured = metres.view();
      if (frame % 2 != 0) measured = millimetres.view();
      labeller.submit(poses, measured, boxes);
      const LabelView expected = classifier.classify(drawn, measured);
      expect_equal(labeller.collect(), expected, boxes);
      for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += expected.pixels[i];
    }
  }
  for (const std::size_t pixels : seen) EXPECT_GT(pixels, 1000U);
}

TEST_F(GlLabels, ComeInTheOrderOfTheFrames) {
  std::mt19937_64 random = seeded_random(503);
  const TwoLinks robot;
  const auto renderer = make_depth_renderer(Backend::gl, uneven_camera, robot.bodies);
  GlLabeller labeller(uneven_camera, robot.bodies, {});
  Classifier classifier(uneven_camera.width(), uneven_camera.height(), {});
  for (int round = 0; round < 4; ++round) {
    std::vector<std::vector<Isometry3d>> poses;
    std::vector<Image<float>> images;
    for (int i = 0; i < GlLabeller::max_pending; ++i) {
      poses.push_back(TwoLinks::poses(random));
      // Out of view now and then: nothing of an earlier frame may stay.
      if ((round + i) % 4 == 3) poses.back() = {at(0, 0, -2), at(9, 0, 1)};
      images.push_back(sensor_image(renderer->render(poses.back()), random));
      labeller.submit(poses.back(), images.back().view());
    }
    EXPECT_THROW(labeller.submit(poses[0], images[0].view()), std::logic_error);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const LabelView expected = classifier.classify(renderer->render(poses[i]), images[i].view());
      expect_equal(labeller.collect(), expected, {});
    }
  }
  EXPECT_THROW(static_cast<void>(labeller.collect()), std::logic_error);
}

TEST_F(GlLabels, TakeImagesOfAnyStride) {
  std::mt19937_64 random = seeded_random(505);
  const TwoLinks robot;
  const auto poses = TwoLinks::poses(random);
  const auto renderer = make_depth_renderer(Backend::gl, uneven_camera, robot.bodies);
  const Image<float> image = sensor_image(renderer->render(poses), random);
  GlLabeller labeller(uneven_camera, robot.bodies, {});
  Classifier classifier(uneven_camera.width(), uneven_camera.height(), {});
  Image<float> wide(uneven_camera.width() + 13, uneven_camera.height());
  Image<float> flipped(uneven_camera.width(), uneven_camera.height());
  for (int v = 0; v < uneven_camera.height(); ++v) {
    for (int u = 0; u < uneven_camera.width(); ++u) {
      wide(u, v) = flipped(u, uneven_camera.height() - 1 - v) = image(u, v);
    }
  }
  const ImageView<const float> padded{wide.data(), uneven_camera.width(), uneven_camera.height(),
                                      wide.width()};
  const ImageView<const float> upwards{flipped.view().row(uneven_camera.height() - 1),
                                       uneven_camera.width(), uneven_camera.height(),
                                       -uneven_camera.width()};
  for (const ImageView<const float>& view : {padded, upwards}) {
    labeller.submit(poses, view);
    expect_equal(labeller.collect(), classifier.classify(renderer->render(poses), image.view()),
                 {});
  }
}

TEST_F(GlLabels, ServeThePipeline) {
  const Camera slab_view = slab_camera();
  PipelineConfig config = plain_config(Backend::gl);
  config.rule.front_min_width = 5;
  config.rule.edge_margin = 4;
  Pipeline with_images(slab_robot(), slab_view, config);
  config.labels_on_device = true;
  Pipeline labels_alone(slab_robot(), slab_view, config);
  EXPECT_EQ(labels_alone.renderer().device, with_images.renderer().device);
  EXPECT_EQ(labels_alone.triangle_count(), with_images.triangle_count());
  for (const double slide : {0.0, 0.2, -0.1}) {
    Image<float> depth = scene_depth(slab_view, slide);
    for (int v = 5; v < 40; ++v) {
      for (int u = 5; u < 60; ++u) depth(u, v) = 0.5F;
    }
    const std::vector<double> positions = {slide};
    for (const DepthView& measured : {DepthView(depth.view()), DepthView{}}) {
      const FrameReport& expected = with_images.process({.depth = measured, .joints = positions});
      const FrameReport& report = labels_alone.process({.depth = measured, .joints = positions});
      EXPECT_EQ(report.status, expected.status);
      EXPECT_TRUE(report.virtual_depth.depth.empty());
      EXPECT_EQ(pixels_of(report.labels), pixels_of(expected.labels));
      EXPECT_GT(report.pixels.robot, 500U);
      EXPECT_EQ(report.pixels.robot, expected.pixels.robot);
      EXPECT_EQ(report.pixels.front, expected.pixels.front);
      EXPECT_EQ(report.pixels.unknown, expected.pixels.unknown);
    }
  }
  const FrameReport& lost = labels_alone.process({.depth = DepthView{}, .joints = {}});
  EXPECT_EQ(lost.status, FrameStatus::missing_joints);
  EXPECT_EQ(lost.labels(0, 0), static_cast<std::uint8_t>(Label::unknown));

  config.backend = Backend::cpu;
  EXPECT_THROW(Pipeline(slab_robot(), slab_view, config), InputError);
  config.backend = Backend::gl;
  Camera lens = slab_view;
  lens.distortion = Distortion("plumb_bob", std::array{-0.1, 0.0, 0.0, 0.0});
  EXPECT_THROW(Pipeline(slab_robot(), lens, config), InputError);
}

TEST_F(GlLabels, RefusesWhatItCannotDo) {
  const TwoLinks robot;
  LabelRule bad;
  bad.front_min_width = -1;
  EXPECT_THROW(GlLabeller(uneven_camera, robot.bodies, bad), InputError);
  EXPECT_THROW(GlLabeller(uneven_camera, robot.bodies, {}, {.gl_device = 4711}), InputError);
  GlLabeller labeller(uneven_camera, robot.bodies, {});
  EXPECT_FALSE(labeller.info().device.empty());
  const Image<float> image(uneven_camera.width(), uneven_camera.height(), 1.0F);
  const std::vector<PixelRectangle> boxes(GlLabeller::max_boxes + 1);
  const std::vector<Isometry3d> poses(2, at(0, 0, 1));
  EXPECT_THROW(labeller.submit(poses, image.view(), boxes), std::logic_error);
  EXPECT_THROW(labeller.submit({poses.data(), 1}, image.view()), std::logic_error);
  EXPECT_THROW(labeller.submit(poses, DepthView{}), std::logic_error);
  const Image<std::uint16_t> small(uneven_camera.width(), uneven_camera.height() - 1);
  EXPECT_THROW(labeller.submit(poses, small.view()), std::logic_error);
  ImageView<const float> nowhere = image.view();
  nowhere.data = nullptr;
  EXPECT_THROW(labeller.submit(poses, nowhere), std::logic_error);
  labeller.submit(poses, image.view());  // none of these has spoilt it
  EXPECT_GT(labeller.collect().image.pixels[static_cast<std::size_t>(Label::occluded)], 0U);
}

TEST_F(GlLabels, OfMoreLinksThanTheRendererTakesAreRefused) {
  const TwoLinks robot;
  const std::vector<Body> drawn(DepthRenderer::max_drawn_bodies + 1, robot.bodies[0]);
  EXPECT_THROW(GlLabeller(uneven_camera, drawn, {}), InputError);
  const std::vector<Body> empty(DepthRenderer::max_bodies + 1, Body{"link", {}});
  EXPECT_THROW(GlLabeller(uneven_camera, empty, {}), InputError);
}

}  // namespace
}  // namespace penumbra::test
