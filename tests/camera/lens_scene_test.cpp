// SPDX-License-Identifier: Apache-2.0
// A scene seen through a lens: rays of raw pixels, bent back by the lens model and cast in double,
// against what is rendered in the pinhole image and mapped to the raw one.
#include "../support/opengl.hpp"
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "closed_form_scene.hpp"
#include "lens_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
namespace {

using test::Hit;
using test::Solid;

// A sphere's triangles, and what depth does between the rays that are cast about a pixel.
constexpr double surface_error = 5 * Solid::sphere_error;
constexpr double between_rays = 0.05;  // of the depths' span
constexpr double background = 4;       // metres

/// What rays a quarter of a pixel apart meet, out to a pixel around the raw image.
class CastScene {
 public:
  static constexpr int steps = 4;  // to a pixel

  CastScene(const Camera& camera, const std::vector<Solid>& solids)
      : solids_(solids),
        hits_((camera.intrinsics.width() + 1) * steps + 1,
              (camera.intrinsics.height() + 1) * steps + 1) {
    constexpr double step = 1.0 / steps;
    for (int j = 0; j < hits_.height(); ++j)
      for (int i = 0; i < hits_.width(); ++i)
        if (const auto ray = camera.distortion.undistort(
                camera.intrinsics.ray(step * i - 1, step * j - 1).head<2>()))
          hits_(i, j) = nearest_hit(solids, *ray);
  }

  [[nodiscard]] const std::vector<Solid>& solids() const { return solids_; }

  /// The ray at raw pixel (u, v), moved by that many steps; nothing where the lens does not reach.
  [[nodiscard]] const std::optional<Hit>& hit(int u, int v, int i, int j) const {
    return hits_((u + 1) * steps + i, (v + 1) * steps + j);
  }

 private:
  const std::vector<Solid>& solids_;
  Image<std::optional<Hit>> hits_;
};

/// What the rays within a pixel of a raw pixel meet.
class Surroundings {
 public:
  Surroundings(const CastScene& scene, int u, int v) : solids_(scene.solids()) {
    constexpr int n = CastScene::steps;
    for (int j = -n; j <= n; ++j)
      for (int i = -n; i <= n; ++i)
        if (const auto& hit = scene.hit(u, v, i, j)) hits_.push_back(*hit);
  }

  /// Span of depths of a solid, widened by the tolerance, and at a silhouette, where a sphere bends
  /// away between two rays, to its end; nothing if none of the rays meets it.
  [[nodiscard]] std::optional<std::pair<double, double>> depths(std::size_t index) const {
    double low = 1e9;
    double high = 0;
    for (const Hit& hit : hits_) {
      if (hit.index != index) continue;
      low = std::min(low, hit.depth);
      high = std::max(high, hit.depth);
    }
    if (high < low) return std::nullopt;
    if (index != 0 && !uniform()) high = solids_[index - 1].farthest();
    const double margin = surface_error + between_rays * (high - low);
    return std::make_pair(low - margin, high + margin);
  }

  /// Whether the lens reaches all of it. At a fold a step of a pinhole pixel, which is none of the
  /// raw image's, may lead to rays that no raw pixel has.
  [[nodiscard]] bool inside_lens() const {
    return hits_.size() == (2 * CastScene::steps + 1) * (2 * CastScene::steps + 1);
  }

  [[nodiscard]] bool uniform() const {
    return std::all_of(hits_.begin(), hits_.end(),
                       [&](const Hit& hit) { return hit.index == hits_.front().index; });
  }

  /// Whether any of the rays, and what lies about them, gives the label.
  [[nodiscard]] bool allows(Label label, double measured, const LabelRule& rule) const {
    for (std::size_t index = 0; index <= solids_.size(); ++index) {
      const auto span = depths(index);
      if (!span) continue;
      if (index == 0 && label == Label::clear) return true;
      if (index == 0 || label == Label::clear) continue;
      const int nearest = rank(label_of(span->first, measured, rule));
      const int farthest = rank(label_of(span->second, measured, rule));
      if (nearest <= rank(label) && rank(label) <= farthest) return true;
    }
    return false;
  }

 private:
  static Label label_of(double model, double measured, const LabelRule& rule) {
    const double e = rule.tolerance.at(model);
    if (!(measured > 0)) return Label::unknown;
    if (measured < model - e) return Label::front;
    return measured > model + rule.beyond_factor * e ? Label::beyond : Label::occluded;
  }

  /// In the order in which labels follow each other as the model moves away from the camera.
  static int rank(Label label) {
    switch (label) {
      case Label::beyond:
        return 1;
      case Label::occluded:
        return 2;
      case Label::front:
        return 3;
      case Label::unknown:
        return 9;
      case Label::clear:
      case Label::fringe:
        break;
    }
    return 0;
  }

  const std::vector<Solid>& solids_;
  std::vector<Hit> hits_;
};

/// The robot rendered in a lens's pinhole image and mapped to its raw image tile by tile.
struct RawRender {
  Rectification maps;
  Image<float> depth;
  Image<std::uint16_t> links;
  TileMask touched;

  RawRender(const Camera& camera, const std::vector<Solid>& robot, Backend backend)
      : maps(camera),
        depth(camera.intrinsics.width(), camera.intrinsics.height()),
        links(depth.width(), depth.height()),
        touched(depth.width(), depth.height()) {
    std::vector<PreparedMesh> meshes;
    std::vector<Eigen::Isometry3d> poses;
    for (const Solid& solid : robot) {
      meshes.emplace_back(solid.mesh());
      poses.push_back(solid.T_camera_solid);
    }
    std::vector<Body> bodies;
    bodies.reserve(meshes.size());
    for (const PreparedMesh& mesh : meshes) bodies.push_back({"solid", {&mesh, 1}});
    const auto renderer = make_depth_renderer(backend, maps.pinhole(), bodies);
    const VirtualDepthView pinhole = renderer->render(poses);
    maps.touched_raw(*pinhole.touched, touched);
    touched.for_each_span([&](int u0, int u1, int v0, int v1) {
      const auto window = [&](auto view) {
        return decltype(view){view.data + v0 * view.stride + u0, u1 - u0, v1 - v0, view.stride};
      };
      const auto map = window(maps.raw_to_pinhole());
      remap<float>(map, pinhole.depth, 0.0F, window(depth.view()));
      remap<std::uint16_t>(map, pinhole.links, 0, window(links.view()));
    });
  }
};

struct Tally {
  int at_lens_edge = 0;  // not checked
  int reached = 0;       // pixels that the lens maps, but for these
  int robot = 0;
  int uniform = 0;  // of `robot`: no silhouette within a pixel
  std::array<int, label_count> labels{};
};

void check_depth(const CastScene& robot, const RawRender& raw, Tally& tally) {
  for (int v = 0; v < raw.depth.height(); v += test::sample_stride) {
    for (int u = 0; u < raw.depth.width(); ++u) {
      const std::size_t link = raw.links(u, v);
      if (raw.maps.raw_to_pinhole()(u, v) == Rectification::no_pixel) {
        ASSERT_EQ(link, 0U);
        continue;
      }
      const Surroundings truth(robot, u, v);
      tally.at_lens_edge += !truth.inside_lens();
      if (!truth.inside_lens()) continue;
      const auto span = truth.depths(link);
      ASSERT_TRUE(span) << "link " << link << " is not seen at " << u << ' ' << v;
      ++tally.reached;
      if (link == 0) {
        ASSERT_EQ(raw.depth(u, v), 0) << u << ' ' << v;
        continue;
      }
      ++tally.robot;
      tally.uniform += truth.uniform();
      ASSERT_GE(raw.depth(u, v), span->first) << u << ' ' << v;
      ASSERT_LE(raw.depth(u, v), span->second) << u << ' ' << v;
    }
  }
}

/// What a perfect sensor measures through the lens, with a hole here and there.
Image<float> measure(const Camera& camera, const std::vector<Solid>& scene,
                     std::mt19937_64& random) {
  Image<float> depth(camera.intrinsics.width(), camera.intrinsics.height());
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u)
      if (const auto ray = camera.distortion.undistort(camera.intrinsics.ray(u, v).head<2>());
          ray && random() % 32 != 0) {
        const Hit hit = nearest_hit(scene, *ray);
        depth(u, v) = static_cast<float>(hit.index == 0 ? background : hit.depth);
      }
  return depth;
}

void check_labels(const CastScene& robot, const RawRender& raw, const Image<float>& measured,
                  Tally& tally) {
  LabelRule rule;
  rule.front_min_width = 0;  // neither the clean-up nor the fringe is a matter of single rays
  rule.fringe_reach = 0;
  Classifier classifier(raw.depth.width(), raw.depth.height(), rule);
  const LabelView view =
      classifier.classify({raw.depth.view(), raw.links.view(), &raw.touched}, measured.view());
  for (int v = 0; v < raw.depth.height(); v += test::sample_stride) {
    for (int u = 0; u < raw.depth.width(); ++u) {
      if (raw.maps.raw_to_pinhole()(u, v) == Rectification::no_pixel) continue;
      const auto label = static_cast<Label>(view.labels(u, v));
      ++tally.labels[static_cast<std::size_t>(label)];
      const Surroundings truth(robot, u, v);
      if (!truth.inside_lens()) continue;
      ASSERT_TRUE(truth.allows(label, measured(u, v), rule))
          << "label " << static_cast<int>(label) << " at " << u << ' ' << v << ", measured "
          << measured(u, v) << ", model " << raw.depth(u, v);
    }
  }
}

class LensScene : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (!test::can_draw(GetParam())) GTEST_SKIP() << test::no_opengl;
  }
};

TEST_P(LensScene, DepthLinksAndLabelsAreRightWithinAPixel) {
  auto random = test::seeded_random(41);
  Tally total;
  std::size_t lenses = 0;
  for (const test::Lens& sample : test::typical_lenses()) {
    if (test::sanitized && ++lenses > 3) break;
    SCOPED_TRACE(sample.name);
    const Camera camera{Intrinsics(160, 120, 82, 81, 83.2, 57.4), sample.distortion(), {}, {}};
    const std::vector<Solid> robot = test::random_solids(8, 0.9, random);
    const RawRender raw(camera, robot, GetParam());
    const CastScene truth(camera, robot);
    check_depth(truth, raw, total);
    if (HasFatalFailure()) return;

    // The first solid of the model is not there in truth, so that the sensor sees past it.
    std::vector<Solid> scene = test::random_solids(5, 0.9, random);
    scene.insert(scene.end(), robot.begin() + 1, robot.end());
    check_labels(truth, raw, measure(camera, scene, random), total);
    if (HasFatalFailure()) return;
  }
  std::cout << total.reached << " pixels inside the lens (" << total.at_lens_edge
            << " at its edge), " << total.robot << " of them robot, " << total.uniform
            << " of these a pixel or more from silhouettes; labels:";
  for (const int count : total.labels) std::cout << ' ' << count;
  std::cout << '\n';
  EXPECT_GT(total.uniform, 0.7 * total.robot);  // else the check would say little
  for (std::size_t i = 0; i < total.labels.size(); ++i) {
    if (static_cast<Label>(i) == Label::fringe) continue;
    EXPECT_GT(total.labels[i], test::sanitized ? 10 : 100) << i;
  }
  EXPECT_LT(total.at_lens_edge, 0.02 * total.reached);
}

INSTANTIATE_TEST_SUITE_P(Backends, LensScene,
                         testing::Values(Backend::reference, Backend::cpu, Backend::gl),
                         [](const auto& backend) { return std::string(to_string(backend.param)); });

}  // namespace
}  // namespace penumbra
