// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <io/files/picture.hpp>
#include <io/files/target_overlay.hpp>
#include <io/web/moment_painter.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_moments = 6;
constexpr Rgb8 grey{90, 90, 90}, robot_color{230, 159, 0};

Rgb8 mixed(Rgb8 a, Rgb8 b) {
  const auto half = [](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>((x + y) / 2);
  };
  return {half(a.r, b.r), half(a.g, b.g), half(a.b, b.b)};
}

std::string seconds(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

Verdict verdict_at(const CameraForecast& forecast, double time) {
  for (const VerdictInterval& each : forecast.intervals)
    if (time < each.end) return each.verdict;
  return forecast.intervals.back().verdict;
}

}  // namespace

MomentPainter::MomentPainter(const Robot& robot, const ForecastCamera& camera,
                             ImageView<const Rgb8> color, std::span<const ForecastTarget> targets,
                             const RobotPose& start)
    : robot_(robot),
      targets_(targets),
      parent_(find_camera_parent(robot, camera.camera.parent)),
      T_parent_camera_(camera.camera.pose()),
      camera_(camera.camera) {
  if (!camera_.distortion.is_none()) {
    rectification_.emplace(camera_);
    camera_.intrinsics = rectification_->pinhole();
    camera_.distortion = {};
  }
  background_ = Image<Rgb8>(camera_.intrinsics.width(), camera_.intrinsics.height());
  std::fill_n(background_.data(), background_.size(), grey);
  Image<Rgb8> straight;
  const ImageView<const Rgb8> seen =
      color.empty() ? color
                    : rectified(rectification_ ? &*rectification_ : nullptr, color, straight);
  if (seen.width == background_.width() && seen.height == background_.height())
    for (int v = 0; v < seen.height; ++v)
      std::copy_n(seen.row(v), seen.width, background_.view().row(v));
  std::vector<Body> bodies = bodies_of(robot);
  for (const AttachedBody& body : start.attached)
    if (body.mesh != nullptr && !body.mesh->triangles.empty() && robot.find_link(body.link)) {
      attached_.push_back(body);
      bodies.push_back({body.name, {body.mesh.get(), 1}});
    }
  renderer_ = make_depth_renderer(Backend::cpu, camera_.intrinsics, bodies);
  std::vector<Eigen::Isometry3d> T_root_link(robot.links().size());
  robot.forward_kinematics(start.positions, T_root_link);
  T_root_camera_ = T_root_link[parent_] * T_parent_camera_;
}

void MomentPainter::add_pictures(const Trajectory& trajectory,
                                 std::span<const TargetForecast> forecasts, std::size_t motion,
                                 std::vector<PagePicture>& page) {
  std::vector<std::pair<double, std::string>> moments;
  for (const TargetForecast& forecast : forecasts)
    for (const VerdictInterval& each : forecast.cameras.front().intervals)
      if (each.verdict == Verdict::hidden)
        moments.emplace_back(0.5 * (each.begin + each.end),
                             forecast.name + " is hidden" +
                                 (each.by.empty() ? "" : " by " + each.by) + " from " +
                                 seconds(each.begin) + " to " + seconds(each.end) + " s");
  std::ranges::sort(moments);
  if (moments.size() > most_moments) moments.resize(most_moments);
  moments.emplace_back(trajectory.duration(),
                       "the end, at " + seconds(trajectory.duration()) + " s");
  std::vector<double> positions(robot_.variables().size());
  for (const auto& [time, caption] : moments) {
    trajectory.at(time, positions);
    page.push_back({motion, picture_uri(draw(positions, forecasts, time).view()), caption});
  }
}

Image<Rgb8> MomentPainter::draw(std::span<const double> positions,
                                std::span<const TargetForecast> forecasts, double time) {
  std::vector<Eigen::Isometry3d> T_root_link(robot_.links().size()), T_camera_link;
  robot_.forward_kinematics(positions, T_root_link);
  const Eigen::Isometry3d T_root_camera = T_root_link[parent_] * T_parent_camera_;
  for (const Eigen::Isometry3d& T : T_root_link)
    T_camera_link.push_back(T_root_camera.inverse() * T);
  for (const AttachedBody& body : attached_)
    T_camera_link.push_back(T_camera_link[*robot_.find_link(body.link)] * body.T_link_body);
  const VirtualDepthView drawn = renderer_->render(T_camera_link);
  const bool stays = T_root_camera.isApprox(T_root_camera_);
  Image<Rgb8> image = background_;
  if (!stays) std::fill_n(image.data(), image.size(), grey);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u)
      if (drawn.depth(u, v) > 0.0F) image(u, v) = mixed(image(u, v), robot_color);
  draw_outline(drawn.depth, robot_color, image);
  std::vector<Target> targets;
  std::vector<TargetReport> reports;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    // Pixels, and places in the camera's frame, are of the start and of the recorded image.
    const auto place = placement_of(targets_[i].target.shape);
    const bool is_of_camera = !place || place->frame.kind == ReferenceFrame::Kind::camera;
    if (is_of_camera && (!stays || (!place && rectification_))) continue;
    targets.push_back(targets_[i].target);
    TargetReport& report = reports.emplace_back();
    report.name = targets.back().name;
    report.verdict = verdict_at(forecasts[i].cameras.front(), time);
  }
  FrameReport report;
  report.T_root_camera = T_root_camera;
  report.T_root_link = T_root_link;
  report.targets = reports;
  TargetOverlay().draw(targets, report, robot_, camera_, image);
  return image;
}

}  // namespace penumbra::io
