// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include <Eigen/LU>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/fusion/target_fusion.hpp>

namespace penumbra {
namespace {

constexpr double best_step = 0.05;      // visible fractions that differ by less are equal
constexpr double tolerance_sigmas = 2;  // e(z) in standard deviations of the depth
constexpr double target_speed = 0.5;    // m/s at most: covariances grow by it times a view's age
constexpr double contradiction_bound = 16.27;  // chi-square of 3 degrees of freedom, 99.9 %
constexpr double kept_windows = 10;            // in which a target is in no frame
constexpr double calibration = 0.005;          // metres, of a camera's pose; its standard deviation
// Parts of the target's radius: from its centre to the middle of what is seen in the image, if all
// is seen and for each part of it that is not; the middle of an oblong target's end; and its centre
// behind the surface, evenly between 0 (a plate) and 1.
constexpr double extent_across = 0.05, hidden_across = 1.0, cut_reach = 1.5;
constexpr double behind_surface = 0.5, behind_sigma = 0.5 * std::numbers::inv_sqrt3;

/// Radius of a disc with as many pixels as the target, metres.
double radius_of(const Intrinsics& camera, std::size_t pixels, double z) {
  return z *
         std::sqrt(static_cast<double>(pixels) / (std::numbers::pi * camera.fx() * camera.fy()));
}

/// Whether the image's border may cut a target of that many pixels around a point.
bool may_be_cut(const Intrinsics& camera, std::size_t pixels, const Eigen::Vector3d& at) {
  const double reach = cut_reach * std::sqrt(static_cast<double>(pixels) / std::numbers::pi) + 1;
  const Eigen::Vector2d pixel = camera.project(at);
  return pixel.minCoeff() < reach || pixel.x() > camera.width() - 1 - reach ||
         pixel.y() > camera.height() - 1 - reach;
}

/// Sets what follows from the point, or removes it.
void measure(const ViewCamera& camera, const Eigen::Isometry3d& T_root_camera,
             const Judgement& judgement, CameraView& view) {
  const Eigen::Vector3d at = T_root_camera.inverse() * *view.point;
  if (may_be_cut(camera.intrinsics, judgement.covered, at)) return view.point.reset();
  const double z = at.z();
  const Eigen::Vector3d ray = at.normalized();
  const double radius = radius_of(camera.intrinsics, judgement.covered, z);
  view.distance = at.norm();
  view.angle = std::acos(std::clamp(ray.z(), -1.0, 1.0));
  *view.point += behind_surface * radius * (T_root_camera.linear() * ray);
  const double noise = camera.tolerance.at(z) / tolerance_sigmas * view.distance / z;
  const double pixel = z / std::min(camera.intrinsics.fx(), camera.intrinsics.fy());
  const double part = extent_across + hidden_across * (1.0 - view.visible_fraction);
  const double along = std::hypot(noise, behind_sigma * radius, calibration);
  const double across = std::hypot(pixel, part * radius, calibration);
  const Eigen::Matrix3d on_ray = ray * ray.transpose();
  const Eigen::Matrix3d in_camera =
      along * along * on_ray + across * across * (Eigen::Matrix3d::Identity() - on_ray);
  view.covariance = T_root_camera.linear() * in_camera * T_root_camera.linear().transpose();
}

bool is_seen(const CameraView& view) {
  return view.verdict == Verdict::visible || view.verdict == Verdict::partial;
}

/// Sorts the best view first.
auto rank(const CameraView& view) {
  const double far = std::numeric_limits<double>::infinity();
  return std::tuple(view.verdict != Verdict::visible,
                    -std::floor(view.visible_fraction / best_step + 1e-9),
                    view.point ? view.distance : far, view.point ? view.angle : far);
}

Eigen::Matrix3d moved(const CameraView& view, std::int64_t stamp) {
  const double by = target_speed * 1e-9 * static_cast<double>(stamp - *view.stamp);
  return view.covariance + by * by * Eigen::Matrix3d::Identity();
}

/// Returns the first view of that verdict, or null.
const CameraView* find(const std::vector<CameraView>& views, Verdict verdict) {
  const auto found = std::find_if(views.begin(), views.end(),
                                  [&](const auto& view) { return view.verdict == verdict; });
  return found == views.end() ? nullptr : &*found;
}

/// Sets the point, or the contradiction.
void fuse_points(FusedTarget& target) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < target.views.size(); ++i) {
    const CameraView& view = target.views[i];
    if (!view.point) continue;
    const Eigen::Matrix3d covariance = moved(view, target.stamp);
    for (std::size_t j = 0; j < i; ++j) {
      const CameraView& other = target.views[j];
      if (!other.point) continue;
      const Eigen::Matrix3d both = covariance + moved(other, target.stamp);
      const Eigen::Vector3d apart = *view.point - *other.point;
      const double chi_square = apart.dot(both.inverse() * apart);
      if (chi_square >
          (target.contradiction ? target.contradiction->chi_square : contradiction_bound))
        target.contradiction = {other.camera, view.camera, apart.norm(), chi_square};
    }
    information += covariance.inverse();
    weighted += covariance.inverse() * *view.point;
  }
  if (target.contradiction || information.isZero(0)) return;
  target.covariance = information.inverse();
  target.point = target.covariance * weighted;
}

}  // namespace

TargetFusion::TargetFusion(std::vector<ViewCamera> cameras, const TargetFusionConfig& config)
    : cameras_(std::move(cameras)), config_(config), newest_(cameras_.size()) {
  if (cameras_.empty()) throw InputError("target fusion: no camera is given");
  std::set<std::string_view> names;
  for (const ViewCamera& camera : cameras_) {
    if (camera.name.empty()) throw InputError("target fusion: a camera has no name");
    if (!names.insert(camera.name).second)
      throw InputError("target fusion: two cameras are called '" + camera.name + "'");
  }
  if (!(std::isfinite(config.window) && config.window > 0))
    throw InputError("target fusion: the window is " + std::to_string(config.window) +
                     " s; expected a finite number above 0");
}

CameraFrame views_of(const ViewCamera& camera, const FrameReport& report) {
  if (!report.stamp)
    throw InputError("target fusion: a frame of camera '" + camera.name +
                     "' has no stamp, so that the cameras' frames cannot be matched");
  CameraFrame frame{*report.stamp, {}};
  for (const TargetReport& target : report.targets) {
    CameraView view;
    view.stamp = target.stamp ? target.stamp : report.stamp;
    view.verdict = target.verdict;
    view.reason = target.reason;
    if (target.judgement) {
      view.visible_fraction = target.judgement->clear + target.judgement->front;
      if (report.T_root_camera) view.point = target.point;
    }
    if (view.point) measure(camera, *report.T_root_camera, *target.judgement, view);
    frame.views.emplace(target.name, std::move(view));
  }
  return frame;
}

void TargetFusion::add(std::size_t camera, const CameraFrame& frame) {
  if (camera >= cameras_.size())
    throw InputError("target fusion: there is no camera " + std::to_string(camera) + ", only " +
                     std::to_string(cameras_.size()));
  std::optional<std::int64_t>& newest = newest_[camera];
  if (newest && is_clock_jump(frame.stamp, *newest)) {
    newest_.assign(newest_.size(), std::nullopt);
    targets_.clear();
  }
  newest = std::max(newest.value_or(frame.stamp), frame.stamp);
  const std::int64_t now = **std::max_element(newest_.begin(), newest_.end());
  std::erase_if(targets_, [&](const auto& target) {
    return 1e-9 * static_cast<double>(now - target.second.judged) > kept_windows * config_.window;
  });
  for (const auto& [name, view] : frame.views) {
    Record& record =
        targets_.try_emplace(name, Record{Views(cameras_.size()), frame.stamp}).first->second;
    record.judged = std::max(record.judged, frame.stamp);
    std::optional<CameraView>& stored = record.views[camera];
    if (stored && *stored->stamp > *view.stamp) continue;
    stored = view;
    stored->camera = camera;
  }
}

void TargetFusion::add(std::size_t camera, const FrameReport& report) {
  add(camera, views_of(cameras_[std::min(camera, cameras_.size() - 1)], report));
}

FusedTarget TargetFusion::fuse(const std::string& name, const Views& views) const {
  FusedTarget target;
  target.name = name;
  target.stamp = std::numeric_limits<std::int64_t>::min();
  for (const auto& view : views)
    if (view) target.stamp = std::max(target.stamp, *view->stamp);
  const auto is_fresh = [&](std::int64_t stamp) {
    return 1e-9 * static_cast<double>(target.stamp - stamp) <= config_.window;
  };
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i] && is_fresh(*views[i]->stamp))
      target.views.push_back(*views[i]);
    else if (views[i] || !newest_[i] || !is_fresh(*newest_[i]))
      target.views.push_back({.camera = i,
                              .stamp = {},
                              .reason = "no view of it within the window of time",
                              .point = {}});
  }
  fuse_points(target);
  const CameraView* best = nullptr;
  for (const CameraView& view : target.views)
    if (is_seen(view) && (best == nullptr || rank(view) < rank(*best))) best = &view;
  if (best != nullptr) target.best = best->camera;

  const CameraView* const unknown = find(target.views, Verdict::unknown);
  if (const auto& pair = target.contradiction) {
    char metres[32];
    std::snprintf(metres, sizeof metres, "%.3f", pair->distance);
    target.reason = "cameras '" + cameras_[pair->first].name + "' and '" +
                    cameras_[pair->second].name + "' measure it " + metres + " m apart";
  } else if (find(target.views, Verdict::held) != nullptr) {
    target.verdict = Verdict::held;
  } else if (best != nullptr) {
    target.verdict = best->verdict;
  } else if (unknown != nullptr) {
    target.reason = "camera '" + cameras_[unknown->camera].name + "': " + unknown->reason;
  } else {
    target.verdict =
        find(target.views, Verdict::hidden) != nullptr ? Verdict::hidden : Verdict::out_of_view;
  }
  return target;
}

FusedTarget TargetFusion::fused(std::string_view name) const {
  const auto found = targets_.find(name);
  if (found == targets_.end())
    throw InputError("target fusion: no camera has judged a target '" + std::string(name) + "'");
  return fuse(found->first, found->second.views);
}

std::vector<FusedTarget> TargetFusion::fused() const {
  std::vector<FusedTarget> all;
  for (const auto& [name, record] : targets_) all.push_back(fuse(name, record.views));
  return all;
}

}  // namespace penumbra
