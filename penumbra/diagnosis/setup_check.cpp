// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <variant>

#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>

namespace penumbra {
namespace {

constexpr int enough_columns = 640;       // finer images find no more mistakes
constexpr double farthest_nearby = 0.25;  // seconds; poses between frames are interpolated

/// The centres of blocks of pixels as a camera of its own.
Intrinsics thinned(const Intrinsics& camera, int block) {
  const int middle = block / 2;
  return {camera.width() / block, camera.height() / block,        camera.fx() / block,
          camera.fy() / block,    (camera.cx() - middle) / block, (camera.cy() - middle) / block};
}

}  // namespace

SetupCheck::SetupCheck(const Robot& robot, const Camera& camera, std::size_t camera_parent,
                       bool is_scanner)
    : robot_(robot),
      parent_(camera_parent),
      is_scanner_(is_scanner),
      block_(1),
      camera_(camera.intrinsics) {
  if (!camera.distortion.is_none()) lens_.emplace(camera);
  if (lens_) camera_ = lens_->pinhole();
  block_ = std::clamp(camera_.width() / enough_columns, 1, camera_.height());
  camera_ = thinned(camera_, block_);
}

bool SetupCheck::wants(std::span<const Eigen::Isometry3d> T_root_link) const {
  return std::ranges::all_of(frames_, [&](const DiagnosisFrame& frame) {
    return pose_difference(frame.T_root_link, T_root_link) >= motion_;
  });
}

void SetupCheck::add(const FrameReport& report, std::span<const double> joints) {
  const auto is_finite = [](const Eigen::Isometry3d& T) { return T.matrix().allFinite(); };
  if (!has_depth(report.status) || !report.T_root_camera || is_empty(report.depth) ||
      !std::ranges::all_of(report.T_root_link, is_finite))
    return;
  if (joints.size() != robot_.variables().size()) joints = {};
  if (!recent_.empty() && recent_.back().joints.empty() != joints.empty()) return;  // not of a kind
  pixels_ += static_cast<std::size_t>(report.labels.width) *
             static_cast<std::size_t>(report.labels.height);
  measured_ += report.pixels.front + report.pixels.occluded + report.pixels.beyond;
  elsewhere_ += report.pixels.front + report.pixels.beyond;
  recent_.push_back({seen_++,
                     report.stamp,
                     {joints.begin(), joints.end()},
                     {report.T_root_link.begin(), report.T_root_link.end()}});
  if (recent_.size() > reach + 1) recent_.pop_front();
  if (wants(report.T_root_link)) keep(report);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    std::vector<NearbyFrame>& around = frames_[i].around;
    const auto first = static_cast<int>(recent_.front().number) - static_cast<int>(kept_[i].number);
    const int next = around.empty() ? std::max(first, -reach) : around.back().frames + 1;
    for (int by = next; by <= std::min(reach, first + static_cast<int>(recent_.size()) - 1); ++by) {
      const Seen& seen = recent_[static_cast<std::size_t>(by - first)];
      NearbyFrame& near = around.emplace_back();
      near.frames = by;
      if (seen.stamp && kept_[i].stamp)
        near.seconds = 1e-9 * static_cast<double>(*seen.stamp - *kept_[i].stamp);
      near.joints = seen.joints;
      near.T_root_link = seen.T_root_link;
      if (near.seconds && std::abs(*near.seconds) <= farthest_nearby)
        frames_[i].nearby.push_back({*near.seconds, near.T_root_link});
    }
  }
}

void SetupCheck::keep(const FrameReport& report) {
  const Seen& seen = recent_.back();
  if (!T_parent_camera_)
    T_parent_camera_ = seen.T_root_link[parent_].inverse() * *report.T_root_camera;
  DiagnosisFrame& frame = frames_.emplace_back();
  frame.index = report.index;
  frame.joints = seen.joints;
  frame.T_root_link = seen.T_root_link;
  frame.depth = Image<float>(camera_.width(), camera_.height());
  std::visit(
      [&](const auto& depth) {
        for (int v = 0; v < camera_.height(); ++v)
          for (int u = 0; u < camera_.width(); ++u) {
            int x = u * block_ + block_ / 2, y = v * block_ + block_ / 2;
            if (lens_) {
              const std::int32_t raw = lens_->pinhole_to_raw()(x, y);
              if (raw == Rectification::no_pixel) continue;
              x = raw % depth.width, y = raw / depth.width;
            }
            frame.depth(u, v) = metres_of(depth(x, y));
          }
      },
      report.depth);
  kept_.push_back({seen.number, seen.stamp, {}, {}});
  while (frames_.size() > most) thin_out();
}

/// Keeps only frames that are farther from one another.
void SetupCheck::thin_out() {
  motion_ *= 1.5;
  std::vector<DiagnosisFrame> all;
  std::vector<Seen> seen;
  all.swap(frames_);
  seen.swap(kept_);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (wants(all[i].T_root_link)) {
      frames_.push_back(std::move(all[i]));
      kept_.push_back(std::move(seen[i]));
    }
}

Diagnosis SetupCheck::diagnose() const {
  // Of the robot's measured pixels those that are measured elsewhere; its measured pixels of all.
  constexpr double most_elsewhere = 0.05, least_measured = 0.002;
  if (frames_.empty()) return {};
  const auto measured = static_cast<double>(measured_);
  const bool is_suspicious = static_cast<double>(elsewhere_) > most_elsewhere * measured ||
                             measured < least_measured * static_cast<double>(pixels_);
  return penumbra::diagnose(frames_, camera_, robot_, parent_, *T_parent_camera_, is_suspicious,
                            is_scanner_);
}

}  // namespace penumbra
