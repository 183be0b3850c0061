// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/diagnosis/hypothesis-inl.hpp>
#include <penumbra/mesh/simplified.hpp>

namespace penumbra::diagnosis {
namespace {

constexpr int small_width = 128;            // pixels
constexpr double coarse = 0.004;            // metres by which meshes are simplified
constexpr float before_background = 0.05f;  // metres nearer than the background: something moved
constexpr float noise_of_square = 0.03f;    // metres per square metre of depth
constexpr double occluded = 0.3;            // cost of a pixel with something before the robot
constexpr double missed = 0.5;  // cost of a pixel with something that moved and is not the robot
constexpr double least_robot = 0.01;      // of the image; a speck, or nothing, explains nothing
constexpr double least_agreeing = 0.002;  // of the image, likewise
constexpr double least_of_scan = 0.0005;  // the same where most of the image is not measured

/// Each block's measurement nearest to its centre, of the first few.
Image<float> made_small(const Image<float>& depth, int block) {
  Image<float> out(depth.width() / block, depth.height() / block);
  for (int v = 0; v < out.height(); ++v)
    for (int u = 0; u < out.width(); ++u)
      for (int i = 0; i < block * block && out(u, v) == 0.0f; ++i) {
        const int at = (i + block / 2 * (block + 1)) % (block * block);  // from the middle on
        out(u, v) = depth(u * block + at % block, v * block + at / block);
      }
  return out;
}

}  // namespace

Agreement::Agreement(const Setup& setup)
    : setup_(setup),
      block_(std::min(std::max(1, setup.camera.width() / small_width), setup.camera.height())) {
  for (const KeptFrame& frame : setup.frames) {
    Small& small = frames_.emplace_back();
    small.depth = made_small(frame.depth, block_);
    small.moved = Image<std::uint8_t>(small.depth.width(), small.depth.height());
  }
  for (std::size_t link = 0; link < setup.robot.links().size(); ++link) {
    std::vector<PreparedMesh>& meshes = meshes_.emplace_back();
    for (const PreparedMesh& mesh : setup.robot.meshes(link))
      meshes.emplace_back(simplified(static_cast<const TriangleMesh&>(mesh), coarse));
  }
}

/// The background is the median depth, of a camera that is fixed.
void Agreement::find_moved(double depth_factor) {
  if (moved_factor_ == depth_factor || setup_.parent != 0) return;
  moved_factor_ = depth_factor;
  const auto factor = static_cast<float>(depth_factor);
  std::vector<float> depths;
  for (std::size_t i = 0; i < frames_.front().depth.size(); ++i) {
    depths.clear();
    for (Small& small : frames_) {
      small.moved.data()[i] = 0;
      if (const float z = small.depth.data()[i]; z > 0.0f) depths.push_back(factor * z);
    }
    if (depths.size() < KeptFrames::least) continue;
    const float middle = detail::median(depths);
    const float limit = middle - before_background - noise_of_square * middle * middle;
    for (Small& small : frames_)
      if (const float z = factor * small.depth.data()[i]; z > 0.0f && z < limit)
        small.moved.data()[i] = 1;
  }
}

Agreement::Counts Agreement::count(const Hypothesis& hypothesis, std::size_t frame,
                                   float tolerance) {
  const Poses& T_root_link = hypothesis.T_root_link[frame];
  const Eigen::Isometry3d T_camera_root =
      (T_root_link[setup_.parent] * hypothesis.T_parent_camera).inverse();
  Poses T_camera_link;
  for (const Eigen::Isometry3d& pose : T_root_link) T_camera_link.push_back(T_camera_root * pose);
  const VirtualDepthView view = renderer_->render(T_camera_link);
  const Intrinsics& view_camera = renderer_->intrinsics();
  const auto factor = static_cast<float>(hypothesis.depth_factor);
  const Small& small = frames_[frame];
  Counts counts;
  for (int v = 0; v < view.depth.height; ++v)
    for (int u = 0; u < view.depth.width; ++u) {
      const float expected = view.depth(u, v);
      float z = factor * small.depth(u, v);
      if (hypothesis.along_ray) z /= static_cast<float>(view_camera.ray(u, v).norm());
      if (!(expected > 0.0f)) {
        if (small.moved(u, v) == 0) continue;
        counts.most += 1.0;
        counts.score -= missed;
        continue;
      }
      counts.most += 1.0;
      if (!(z > 0.0f)) continue;
      const double off = (z - expected) / tolerance;
      if (std::abs(off) < 1.0) {
        counts.agreeing += 1.0 - off * off;
        counts.score += 1.0 - off * off;
      } else if (off > 0.0) {
        counts.beyond += 1.0;
        counts.score -= 1.0;
      } else {
        counts.score -= occluded;
        counts.front += 1.0;
      }
    }
  return counts;
}

double Agreement::score(const Counts& counts, double frames) const {
  const Image<float>& image = frames_.front().depth;
  const double least = least_robot * frames * image.width() * image.height();
  return (counts.score - std::max(0.0, least - counts.most)) / std::max(counts.most, least);
}

std::size_t Agreement::worst() const {
  return static_cast<std::size_t>(
      std::ranges::min_element(given_, {}, [](const Counts& counts) { return counts.score; }) -
      given_.begin());
}

Rating Agreement::rate(const Hypothesis& hypothesis, double tolerance) {
  find_moved(hypothesis.depth_factor);
  const Intrinsics small = hypothesis.camera.binned(block_, block_);
  if (!renderer_ || !(renderer_->intrinsics() == small)) {
    std::vector<Body> bodies;
    for (const auto& meshes : meshes_) bodies.push_back({"", meshes});
    renderer_ = make_depth_renderer(Backend::cpu, small, bodies);
  }
  const bool is_given = given_.empty();
  Counts sum, of_given, all_given;
  double used = 0.0;
  const auto add = [](Counts& to, const Counts& counts) {
    to.score += counts.score;
    to.most += counts.most;
    to.agreeing += counts.agreeing;
    to.beyond += counts.beyond;
    to.front += counts.front;
  };
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    if (!is_given) add(all_given, given_[k]);
    if (hypothesis.T_root_link[k].empty()) continue;
    ++used;
    const Counts counts = count(hypothesis, k, static_cast<float>(tolerance));
    add(sum, counts);
    if (is_given)
      given_.push_back(counts);
    else
      add(of_given, given_[k]);
  }
  if (used == 0.0) return {.score = -1.0};
  const double pixels = used * small.width() * small.height();
  Rating rating{.score = score(sum, used)};
  if (!is_given) rating.more = (sum.agreeing - of_given.agreeing) / used;
  if (!is_given)
    rating.score += score(all_given, static_cast<double>(frames_.size())) - score(of_given, used);
  if (sum.agreeing > (setup_.is_scanner ? least_of_scan : least_agreeing) * pixels)
    rating.fit = sum.agreeing / (sum.agreeing + sum.beyond + occluded * sum.front);
  return rating;
}

}  // namespace penumbra::diagnosis
