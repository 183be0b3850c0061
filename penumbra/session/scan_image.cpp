// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/stamps.hpp>
#include <penumbra/poses/reach.hpp>
#include <penumbra/session/scan_image-inl.hpp>
#include <penumbra/session/session.hpp>

namespace penumbra {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double widest = 50.0 * degree;    // half of the image
constexpr double margin = 5.0 * degree;     // next to the robot, whose pose may be wrong
constexpr int finest = 480, coarsest = 96;  // pixels
/// Of the robot's pixels, if that is coarser. Finer images place points better; what rates setups
/// takes the measurement of nine pixels of the finest.
constexpr double filled = 0.1;
/// Parts before and after one that are drawn with it: links move by up to 2 cm from where they are
/// in it. Without them too few points are left of a fast motion, with more it is blurred.
constexpr std::int64_t nearby = 2;
constexpr std::size_t fewest = 50;  // points in the robot's direction; less tells nothing

bool is_on_robot(std::uint8_t label) {
  const auto of = static_cast<Label>(label);
  return of == Label::front || of == Label::occluded || of == Label::beyond;
}

}  // namespace

ScanImage::ScanImage(const Robot& robot, const CloudConfig& config)
    : robot_(robot),
      parent_(find_camera_parent(robot, config.sensor_parent)),
      poses_(robot_, config.sensor_parent, config.T_parent_sensor, missing_links_of(robot), false) {
}

std::shared_ptr<ScanImage> make_scan_image(const Robot& robot, const CloudConfig& config) {
  return std::make_shared<ScanImage>(robot, config);
}

bool ScanImage::take(const FrameReport& of, const Frame& frame) {
  if (of.status != FrameStatus::ok || !frame.scan->origin || !place(of, frame)) return false;
  scan_ = *frame.scan;
  is_drawn_ = false;
  report_.pixels = of.pixels;
  report_.labels = of.labels;
  if (!renderer_) {
    look(of);
    set_width(finest);
    draw();
    if (const double share = measured_share(); share < filled) {
      set_width(std::max(coarsest, static_cast<int>(finest * std::sqrt(share / filled))));
      fill();
    }
  }
  report_.T_root_camera = placed_->T_root_camera * T_camera_sensor().inverse();
  report_.T_root_link = placed_->T_root_link;
  return true;
}

void ScanImage::draw() {
  if (!is_drawn_) fill();
  is_drawn_ = true;
}

/// Finds the part of the scan that shows most of the robot, and the robot's pose then.
bool ScanImage::place(const FrameReport& of, const Frame& frame) {
  const std::span<const std::int32_t> times = frame.scan->times;
  std::int64_t first = 0, length = 0;
  if (!times.empty()) first = std::ranges::min(times), length = std::ranges::max(times) - first;
  const auto count = static_cast<std::int64_t>(of.parts);  // as ScanLabeller divides the scan
  std::vector<std::size_t> on_robot(of.parts, 0);
  for (std::size_t i = 0; i < frame.scan->points.count; ++i)
    if (is_on_robot(of.labels.data[i]))
      ++on_robot[length == 0 ? 0
                             : static_cast<std::size_t>(
                                   std::min(count - 1, (times[i] - first) * count / length))];
  const std::int64_t part = std::ranges::max_element(on_robot) - on_robot.begin();
  std::size_t points = 0;
  for (std::int64_t i = 0; i < count; ++i)
    if (std::abs(i - part) <= nearby) points += on_robot[static_cast<std::size_t>(i)];
  if (points < fewest) return false;
  begin_ = first + (part - nearby) * length / count;
  end_ = first + (part + nearby + 1) * length / count;
  const std::int64_t stamp =
      stamp_after(frame.stamp.value_or(0), first + (2 * part + 1) * length / (2 * count));
  if (frame.pose_at)
    frame.pose_at(stamp, pose_);
  else
    pose_ = frame.pose;
  placed_ = &poses_.place(pose_, stamp, FrameStatus::ok, "");
  report_.index = of.index;
  report_.stamp = frame.stamp ? std::optional(stamp) : std::nullopt;
  return placed_->status == FrameStatus::ok;
}

/// Looks at all that the robot can reach; from within that, at what the scan meets of the robot.
void ScanImage::look(const FrameReport& of) {
  const Ball reach = transformed(placed_->T_camera_link[0], reach_of_links(robot_)[0]);
  Eigen::Vector3d ahead = reach.centre - *scan_.origin;
  if (ahead.norm() > reach.radius) {
    half_angle_ = std::min(widest, std::asin(reach.radius / ahead.norm()) + margin);
  } else {
    half_angle_ = widest;
    ahead.setZero();
    for (std::size_t i = 0; i < scan_.points.count; ++i)
      if (is_on_robot(of.labels.data[i]))
        ahead += (scan_.points[i].cast<double>() - *scan_.origin).normalized();
  }
  ahead.normalize();
  constexpr double steep = 0.99;
  const Eigen::Vector3d up =
      std::abs(ahead.z()) < steep ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d right = ahead.cross(up).normalized();
  R_camera_sensor_ << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
}

void ScanImage::set_width(int width) {
  const double focal = 0.5 * width / std::tan(half_angle_), middle = 0.5 * (width - 1);
  camera_.intrinsics = Intrinsics(width, width, focal, focal, middle, middle);
  renderer_ = make_depth_renderer(Backend::cpu, camera_.intrinsics, bodies_of(robot_));
}

/// Returns in how many of the robot's pixels there are points.
double ScanImage::measured_share() const {
  double robot = 1.0, measured = 0.0;
  for (int v = 0; v < depth_.height(); ++v)
    for (int u = 0; u < depth_.width(); ++u)
      if (report_.virtual_depth.depth(u, v) > 0.0F) robot += 1.0, measured += depth_(u, v) > 0.0F;
  return measured / robot;
}

Eigen::Isometry3d ScanImage::T_camera_sensor() const {
  return Eigen::Isometry3d(R_camera_sensor_) * Eigen::Translation3d(-*scan_.origin);
}

void ScanImage::fill() {
  const int width = camera_.intrinsics.width();
  const Eigen::Isometry3f T = T_camera_sensor().cast<float>();
  const auto focal = static_cast<float>(camera_.intrinsics.fx());
  const float middle = 0.5F * static_cast<float>(width);
  depth_.fit(width, width);
  std::fill_n(depth_.data(), depth_.size(), 0.0F);
  for (std::size_t i = 0; i < scan_.points.count; ++i) {
    if (!scan_.times.empty() && (scan_.times[i] < begin_ || scan_.times[i] > end_)) continue;
    const Eigen::Vector3f p = T * scan_.points[i];
    const float x = focal * p.x() / p.z() + middle, y = focal * p.y() / p.z() + middle;
    if (!(p.z() > 0.0F && std::min(x, y) >= 0.0F && std::max(x, y) < static_cast<float>(width)))
      continue;
    float& depth = depth_(static_cast<int>(x), static_cast<int>(y));
    if (depth == 0.0F || p.z() < depth) depth = p.z();
  }
  T_camera_link_.clear();
  for (const Eigen::Isometry3d& pose : placed_->T_camera_link)
    T_camera_link_.push_back(T_camera_sensor() * pose);
  report_.virtual_depth = renderer_->render(T_camera_link_);
  report_.depth = std::as_const(depth_).view();
}

}  // namespace penumbra
