// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>

#include <io/files/calibration_report.hpp>
#include <io/files/json-inl.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/files/picture.hpp>

namespace penumbra::io {
namespace {

constexpr Rgb8 before_color{230, 30, 30};
constexpr Rgb8 found_color{0, 220, 80};

Json estimate_json(const Estimate& estimate) {
  return {{"value", estimate.value}, {"sigma", estimate.sigma}};
}

Json rows_of(const auto& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::string calibration_json(const Calibration& found, const Robot& robot,
                             const std::string& camera_parent) {
  Json frames = Json::array(), links = Json::object(), joints = Json::object();
  for (const FrameFit& frame : found.frames)
    frames.push_back({{"index", frame.index},
                      {"used", frame.used},
                      {"agreeing", frame.agreeing},
                      {"residual_m", frame.residual},
                      {"outline_px", frame.outline}});
  for (std::size_t link = 0; link < found.link_residuals.size(); ++link)
    if (std::isfinite(found.link_residuals[link]))
      links[robot.links()[link]] = found.link_residuals[link];
  for (std::size_t j = 0; j < found.joint_offsets.size(); ++j)
    joints[robot.variables()[j]] = estimate_json(found.joint_offsets[j]);
  Json json = {{"good", found.is_good()},
               {"faults", found.faults},
               {"notes", found.notes},
               {"advice", found.advice},
               {"camera_parent", camera_parent.empty() ? robot.links().front() : camera_parent},
               {"T_parent_camera", rows_of(found.T_parent_camera.matrix())},
               {"covariance", rows_of(found.covariance)},
               {"position_error_95_m", found.position_error()},
               {"rotation_error_95_rad", found.rotation_error()},
               {"depth_offset_m", estimate_json(found.depth_offset)},
               {"depth_scale", estimate_json(found.depth_scale)},
               {"outline_px", estimate_json(found.outline)},
               {"frames", std::move(frames)},
               {"link_residuals_m", std::move(links)}};
  if (!joints.empty()) json["joint_offsets"] = std::move(joints);
  if (found.time_offset) json["time_offset_s"] = estimate_json(*found.time_offset);
  if (found.shift_right)
    json["masks"] = {{"overlap", found.mask_overlap},
                     {"depth_shift_right_px", estimate_json(*found.shift_right)},
                     {"depth_shift_down_px", estimate_json(*found.shift_down)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

Image<Rgb8> draw_calibration(const CalibrationFrame& frame, const Intrinsics& camera,
                             const Robot& robot, const std::string& camera_parent,
                             const std::optional<Eigen::Isometry3d>& before,
                             const Calibration& found) {
  Image<Rgb8> image;
  FrameReport report;
  report.index = frame.index;
  draw_overlay(report, {frame.depth.view(), {}}, image);
  const auto renderer = make_depth_renderer(Backend::cpu, camera, bodies_of(robot));
  const std::size_t parent = camera_parent.empty() ? 0 : *robot.find_link(camera_parent);
  const auto draw = [&](const Eigen::Isometry3d& T_parent_camera, Rgb8 color) {
    std::vector<Eigen::Isometry3d> poses = frame.T_root_link;
    const Eigen::Isometry3d T_camera_root = (poses[parent] * T_parent_camera).inverse();
    for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
    draw_outline(renderer->render(poses).depth, color, image);
  };
  if (before) {
    draw(*before, before_color);
    draw_legend("before", before_color, 0, 2, image);
  }
  draw(found.T_parent_camera, found_color);
  draw_legend("calibrated", found_color, 1, 2, image);
  return image;
}

}  // namespace penumbra::io
