// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>

#include <io/files/overlay_painter.hpp>
#include <io/files/picture.hpp>
#include <io/web/calibration_page.hpp>
#include <io/web/html-inl.hpp>
#include <io/web/key_frames.hpp>

namespace penumbra::io {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;
constexpr float full_color = 0.02F;  // metres of distance that have the full colour
constexpr float farthest = 0.1F;     // metres: what is farther off is not the robot
constexpr Rgb8 outline_color{0, 220, 80}, mask_color{160, 160, 160};
constexpr std::size_t most_pictures = 10;

std::string plus_minus(const Estimate& estimate, double scale, int digits) {
  return number(scale * estimate.value, digits) + " ± " +
         number(2.0 * scale * estimate.sigma, digits);
}

/// Blue where the measured point is before the robot's surface, red where it is behind.
Rgb8 distance_color(float metres) {
  const auto pale = static_cast<std::uint8_t>(
      std::lround(255.0F * (1.0F - std::min(1.0F, std::abs(metres) / full_color))));
  return metres < 0.0F ? Rgb8{pale, pale, 255} : Rgb8{255, pale, pale};
}

class Pictures {
 public:
  explicit Pictures(const CalibrationOf& of)
      : of_(of),
        parent_(of.options.camera_parent.empty()
                    ? 0
                    : of.robot.find_link(of.options.camera_parent).value()),
        renderer_(make_depth_renderer(Backend::cpu, of.camera, bodies_of(of.robot))) {}

  /// Returns an <img> of the frame's depth with the robot at this camera pose.
  std::string draw(const CalibrationFrame& frame, const Calibration& found,
                   const Eigen::Isometry3d& T_parent_camera) {
    FrameReport report;
    report.index = frame.index;
    const bool has_depth = !frame.depth.empty();
    if (has_depth)
      draw_overlay(report, {frame.depth.view(), {}}, image_);
    else
      image_ = Image<Rgb8>(frame.mask.width(), frame.mask.height());
    std::vector<Eigen::Isometry3d> poses = frame.T_root_link;
    const Eigen::Isometry3d T_camera_root = (poses[parent_] * T_parent_camera).inverse();
    for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
    const ImageView<const float> robot = renderer_->render(poses).depth;
    for (int v = 0; v < robot.height; ++v)
      for (int u = 0; u < robot.width; ++u) {
        if (!has_depth) {
          if (frame.mask(u, v) != 0) image_(u, v) = mask_color;
          continue;
        }
        const float distance = (frame.depth(u, v) - static_cast<float>(found.depth_offset->value)) /
                                   (1.0F + static_cast<float>(found.depth_scale->value)) -
                               robot(u, v);
        if (robot(u, v) > 0.0F && frame.depth(u, v) > 0.0F && std::abs(distance) < farthest)
          image_(u, v) = distance_color(distance);
      }
    draw_outline(robot, outline_color, image_);
    return "<img src=\"" + picture_uri(std::as_const(image_).view()) + "\">";
  }

 private:
  const CalibrationOf& of_;
  std::size_t parent_;
  std::unique_ptr<DepthRenderer> renderer_;
  Image<Rgb8> image_;
};

std::string result(const CalibrationOf& of, const Calibration& found) {
  std::string html;
  for (const std::string& fault : found.faults)
    html += "<p class=\"bad\">Not calibrated: " + escaped(fault) + "</p>\n";
  for (const std::string& note : found.notes) html += "<p>" + escaped(note) + "</p>\n";
  html += "<p>" + escaped(found.advice) + "</p>\n";
  const Eigen::Vector3d at = found.T_parent_camera.translation();
  const Eigen::Quaterniond q(found.T_parent_camera.linear());
  Rows rows = {
      {"estimate", "value"},
      {"camera's position in " +
           (of.options.camera_parent.empty() ? of.robot.links().front() : of.options.camera_parent),
       number(at.x(), 5) + ", " + number(at.y(), 5) + ", " + number(at.z(), 5) + " m"},
      {"quaternion xyzw", number(q.x(), 6) + ", " + number(q.y(), 6) + ", " + number(q.z(), 6) +
                              ", " + number(q.w(), 6)},
      {"95 % region", number(1e3 * found.position_error(), 1) + " mm, " +
                          number(degrees * found.rotation_error(), 2) + "°"},
      {"outline is larger by", plus_minus(found.outline, 1.0, 1) + " px"}};
  if (found.depth_offset) {
    rows.push_back({"depth offset", plus_minus(*found.depth_offset, 1e3, 1) + " mm"});
    rows.push_back({"depth scale", plus_minus(*found.depth_scale, 100.0, 2) + " %"});
  } else {
    rows.push_back({"overlap with the masks", number(100.0 * found.mask_overlap, 1) + " %"});
  }
  if (found.shift_right)
    rows.push_back({"depth image right of, below the colour image",
                    plus_minus(*found.shift_right, 1.0, 1) + ", " +
                        plus_minus(*found.shift_down, 1.0, 1) + " px"});
  if (found.focal_x)
    rows.push_back({"focal lengths", "fx " + plus_minus(*found.focal_x, 100.0, 2) + " %, fy " +
                                         plus_minus(*found.focal_y, 100.0, 2) + " % longer"});
  if (found.time_offset)
    rows.push_back({"time offset", plus_minus(*found.time_offset, 1e3, 1) + " ms"});
  for (std::size_t j = 0; j < found.joint_offsets.size(); ++j)
    rows.push_back({"offset of " + of.robot.variables()[j],
                    plus_minus(found.joint_offsets[j], degrees, 2) + "°"});
  return html + table(rows);
}

std::string residuals(const CalibrationOf& of, const Calibration& found) {
  const bool has_depth = found.depth_offset.has_value();
  Rows frames = {{"frame", has_depth ? "robot's pixels at its depth" : "overlap with the mask",
                  "from its surface", has_depth ? "depth's edge" : "mask's edge"}};
  for (const FrameFit& frame : found.frames)
    frames.push_back({std::to_string(frame.index) + (frame.used ? "" : " (left out)"),
                      number(100.0 * frame.agreeing, 0) + " %",
                      has_depth ? number(1e3 * frame.residual, 1) + " mm" : "-",
                      number(frame.outline, 1) + " px"});
  Rows links = {{"link", "median distance behind its surface"}};
  for (std::size_t link = 0; link < found.link_residuals.size(); ++link)
    if (std::isfinite(found.link_residuals[link]))
      links.push_back(
          {of.robot.links()[link], number(1e3 * found.link_residuals[link], 1) + " mm"});
  return "<h2>By frame</h2>\n" + table(frames) +
         (has_depth ? "<h2>By link</h2>\n" + table(links) : "");
}

}  // namespace

std::string calibration_page(const CalibrationOf& of, const Calibration& found) {
  std::string html =
      page_start("Calibration of " + of.input) + result(of, found) + residuals(of, found);
  html +=
      "<h2>Pictures</h2>\n<p>Left: the first guess, if there was one. Right: the result. The robot "
      "is outlined in green. ";
  html +=
      found.depth_offset
          ? "Its pixels are white where the measured point is on its surface, red where it is "
            "2 cm or more behind, blue where it is before. The depth offset and scale above are "
            "taken off.</p>\n"
          : "The masks are grey.</p>\n";
  Pictures pictures(of);
  for (const CalibrationFrame& frame : of.frames.first(std::min(of.frames.size(), most_pictures))) {
    html += "<figure>";
    html += of.options.initial ? pictures.draw(frame, found, *of.options.initial) : "<span></span>";
    html += pictures.draw(frame, found, found.T_parent_camera) + "<figcaption>frame " +
            std::to_string(frame.index) + "</figcaption></figure>\n";
  }
  return html;
}

}  // namespace penumbra::io
