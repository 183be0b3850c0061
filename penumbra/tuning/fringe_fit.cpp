// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>

#include <penumbra/base/error.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/tuning/carried_points-inl.hpp>
#include <penumbra/tuning/stages-inl.hpp>

namespace penumbra::tuning {
namespace {

constexpr double may_stay =
    0.0005;  // fraction of the arm's points left, beyond that of the largest reach
constexpr int candidates = FringeFit::farthest / FringeFit::step + 1;

/// Draws the parts found over the robot.
class PartPainter {
 public:
  PartPainter(const Scene& scene, const std::vector<ExtraPart>& parts) : parts_(parts) {
    if (parts.empty()) return;
    for (const ExtraPart& part : parts) meshes_.emplace_back(part.mesh);
    std::vector<Body> bodies;
    for (const PreparedMesh& mesh : meshes_)
      bodies.push_back({.name = "part", .meshes = std::span(&mesh, 1)});
    renderer_ = make_depth_renderer(Backend::cpu, scene.camera, bodies);
  }

  /// Returns the frame as it looks with the parts.
  [[nodiscard]] KeptFrame draw(KeptFrame frame) {
    if (parts_.empty()) return frame;
    std::vector<Eigen::Isometry3d> poses;
    for (const ExtraPart& part : parts_)
      poses.push_back(frame.T_root_camera->inverse() * frame.T_root_link[part.link]);
    const VirtualDepthView parts = renderer_->render(poses);
    for (int v = 0; v < parts.depth.height; ++v)
      for (int u = 0; u < parts.depth.width; ++u) {
        const float z = parts.depth(u, v);
        float& robot = frame.virtual_depth(u, v);
        if (!(z > 0.0f) || (robot > 0.0f && robot <= z)) continue;
        robot = z;
        frame.links(u, v) =
            static_cast<std::uint16_t>(parts_[parts.links(u, v) - 1U].link + std::size_t{1});
      }
    return frame;
  }

 private:
  const std::vector<ExtraPart>& parts_;
  std::vector<PreparedMesh> meshes_;
  std::unique_ptr<DepthRenderer> renderer_;
};

/// What is measured of the arm: of its links that move, because those that do not may touch what
/// they stand on.
struct ArmPixels {
  std::vector<NearestPixels::Pixel> carried;  // past its outline
  std::size_t on_arm = 0, checked = 0;
  std::array<std::size_t, FringeFit::farthest + 1> by_distance{};  // of `carried`
};

class FringeSearch {
 public:
  FringeSearch(const Scene& scene, const LabelRule& rule, const std::vector<ExtraPart>& parts)
      : scene_(scene), painter_(scene, parts), moves_(moving_links(scene.frames)) {
    LabelRule tried = rule;
    for (int i = 0; i < candidates; ++i) {
      tried.fringe_reach = i * FringeFit::step;
      classifiers_.emplace_back(scene.camera.width(), scene.camera.height(), tried);
    }
  }

  /// Returns the numbers of all frames, without their pixels.
  ArmPixels search(FringeFit& fit) {
    ArmPixels sum;
    std::array<std::size_t, candidates> left{};
    std::size_t most = 0;
    for (std::size_t i = 0; i < scene_.frames.size(); ++i) {
      const KeptFrame frame = painter_.draw(scene_.frames[i]);
      const ArmPixels found = find(frame);
      if (found.carried.size() > most) most = found.carried.size(), fit.shown_frame = i;
      for (std::size_t k = 0; k < left.size(); ++k)
        left[k] += count_left(label(classifiers_[k], frame), found);
      sum.on_arm += found.on_arm;
      sum.checked += found.checked;
      for (std::size_t k = 0; k < sum.by_distance.size(); ++k)
        sum.by_distance[k] += found.by_distance[k];
      fit.found += found.carried.size();
    }
    const std::size_t all = std::max<std::size_t>(sum.on_arm + fit.found, 1);
    for (const std::size_t pixels : left)
      fit.left_over.push_back(static_cast<double>(pixels) / static_cast<double>(all));
    return sum;
  }

  void show(FringeFit& fit) {
    const KeptFrame frame = painter_.draw(scene_.frames[fit.shown_frame]);
    const LabelView labels =
        label(classifiers_[static_cast<std::size_t>(fit.reach / FringeFit::step)], frame);
    fit.shown = Image<std::uint8_t>(scene_.camera.width(), scene_.camera.height());
    for (const auto [u, v] : find(frame).carried)
      fit.shown(u, v) = is_fringe(labels, u, v) ? FringeFit::removed : FringeFit::left;
  }

 private:
  [[nodiscard]] static bool is_fringe(const LabelView& labels, int u, int v) {
    return labels.labels(u, v) == static_cast<std::uint8_t>(Label::fringe);
  }

  [[nodiscard]] static std::size_t count_left(const LabelView& labels, const ArmPixels& arm) {
    return static_cast<std::size_t>(std::count_if(
        arm.carried.begin(), arm.carried.end(),
        [&](const NearestPixels::Pixel& at) { return !is_fringe(labels, at.u, at.v); }));
  }

  [[nodiscard]] bool moves(std::uint16_t link) const {
    return link > moves_.size() || moves_[link - 1U];  // more: an attached body
  }

  [[nodiscard]] ArmPixels find(const KeptFrame& frame) const {
    const ImageView<const float> virtual_depth = frame.virtual_depth.view();
    const NearestPixels robot = robot_pixels(virtual_depth);
    ArmPixels found;
    for (int v = 0; v < scene_.camera.height(); ++v) {
      for (int u = 0; u < scene_.camera.width(); ++u) {
        const float z = frame.depth(u, v);
        const double distance = robot.distance(u, v);
        if (!(z > 0.0f) || distance > carried_pixels) continue;
        const auto at = robot.at(u, v);
        if (!moves(frame.links(at.u, at.v))) continue;
        if (virtual_depth(u, v) > 0.0f) {
          ++found.on_arm;
          continue;
        }
        ++found.checked;
        if (!is_carried(robot, virtual_depth, u, v, static_cast<double>(z)) ||
            scene_.is_background(u, v, z))
          continue;
        found.carried.push_back({static_cast<std::int16_t>(u), static_cast<std::int16_t>(v)});
        ++found.by_distance[static_cast<std::size_t>(std::ceil(distance))];
      }
    }
    return found;
  }

  const Scene& scene_;
  PartPainter painter_;
  std::vector<bool> moves_;
  std::vector<Classifier> classifiers_;  // by reach / step
};

double distance_of(const ArmPixels& arm, std::size_t found, double quantile) {
  const double wanted = quantile * static_cast<double>(found);
  std::size_t sum = 0;
  for (std::size_t i = 0; i < arm.by_distance.size(); ++i)
    if (static_cast<double>(sum += arm.by_distance[i]) >= wanted) return static_cast<double>(i);
  return FringeFit::farthest;
}

}  // namespace

FringeFit fit_fringe(const Scene& scene, const LabelRule& rule,
                     const std::vector<ExtraPart>& parts) {
  FringeFit fit;
  FringeSearch search(scene, rule, parts);
  const ArmPixels arm = search.search(fit);
  if (arm.checked < least_pixels)
    throw InputError("only " + std::to_string(arm.checked) +
                     " pixels are measured next to links that move; tune needs " +
                     std::to_string(least_pixels) +
                     ": record the arm while it moves through free space");
  fit.checked = arm.checked;
  fit.median = distance_of(arm, fit.found, 0.5);
  fit.percent_90 = distance_of(arm, fit.found, 0.9);
  fit.percent_99 = distance_of(arm, fit.found, 0.99);
  static_assert(LabelRule().fringe_reach % FringeFit::step == 0);
  const double of_default =
      fit.left_over[static_cast<std::size_t>(LabelRule().fringe_reach / FringeFit::step)];
  const double allowed = std::min(of_default, fit.left_over.back() + may_stay);
  const auto first = std::find_if(fit.left_over.begin(), fit.left_over.end(),
                                  [allowed](double fraction) { return fraction <= allowed; });
  fit.reach = static_cast<int>(first - fit.left_over.begin()) * FringeFit::step;
  search.show(fit);
  return fit;
}

}  // namespace penumbra::tuning
