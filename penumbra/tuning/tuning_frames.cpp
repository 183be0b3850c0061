// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/tuning/tuning_frames.hpp>

namespace penumbra {
namespace {

constexpr double still_camera = 0.002;  // metres

template <typename T>
Image<T> copy_of(ImageView<const T> view) {
  Image<T> out(view.width, view.height);
  for (int v = 0; v < view.height; ++v) std::copy_n(view.row(v), view.width, &out(0, v));
  return out;
}

}  // namespace

void TuningFrames::add(const FrameReport& report) {
  ++seen_;
  const bool is_good =
      (report.status == FrameStatus::ok || report.status == FrameStatus::missing_link) &&
      !report.nothing_measured;
  if (!is_good) {
    if (fault_.empty()) fault_ = report.message;
    return;
  }
  ++good_;
  if (!T_root_camera_) T_root_camera_ = report.T_root_camera;
  if (pose_difference(*T_root_camera_, *report.T_root_camera) > still_camera)
    throw InputError("frame " + std::to_string(report.index) +
                     ": the camera moves relative to the robot's root; tune needs a camera that "
                     "does not move relative to it");
  TuningFrame frame;
  frame.index = report.index;
  const Eigen::Isometry3d T_camera_root = report.T_root_camera->inverse();
  for (const Eigen::Isometry3d& T_root_link : report.T_root_link)
    frame.T_camera_link.push_back(T_camera_root * T_root_link);
  if (!differs(frame, frames_)) return;
  frame.depth = metres_of(report.depth, {range_.near, std::min(range_.far, 1e3)});
  frame.virtual_depth = copy_of(report.virtual_depth.depth);
  frame.links = copy_of(report.virtual_depth.links);
  frames_.push_back(std::move(frame));
  while (frames_.size() > most) thin();
}

bool TuningFrames::holds(std::size_t index) const {
  return std::any_of(frames_.begin(), frames_.end(),
                     [index](const TuningFrame& frame) { return frame.index == index; });
}

void TuningFrames::check() const {
  if (frames_.size() >= least) return;
  const std::string counts =
      std::to_string(seen_) + " frames, " + std::to_string(good_) + " of them usable";
  if (good_ == 0)
    throw InputError("no frame can be used" + (fault_.empty() ? "" : "; the first: " + fault_));
  throw InputError("the arm does not move enough (" + counts + ", " +
                   std::to_string(frames_.size()) +
                   " with another pose of the robot); tune needs " + std::to_string(least) +
                   " poses or more: record the arm while it moves through free space");
}

bool TuningFrames::differs(const TuningFrame& frame, std::span<const TuningFrame> from) const {
  return std::all_of(from.begin(), from.end(), [&](const TuningFrame& other) {
    return pose_difference(frame.T_camera_link, other.T_camera_link) >= motion_;
  });
}

/// Doubles the motion required between kept frames.
void TuningFrames::thin() {
  motion_ *= 2.0;
  std::vector<TuningFrame> kept;
  for (TuningFrame& frame : frames_)
    if (differs(frame, kept)) kept.push_back(std::move(frame));
  frames_ = std::move(kept);
}

}  // namespace penumbra
