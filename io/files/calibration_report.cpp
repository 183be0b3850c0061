// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/version.hpp>

#include <io/files/calibration_report.hpp>
#include <io/files/json.hpp>

namespace penumbra::io {
namespace {

Json estimate_json(const std::optional<Estimate>& estimate) {
  if (!estimate) return nullptr;
  return {{"value", estimate->value}, {"sigma", estimate->sigma}};
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

std::string calibration_json(const std::string& input, const Calibration& found, const Robot& robot,
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
  Json json = {{"penumbra", PENUMBRA_VERSION},
               {"input", input},
               {"good", found.is_good()},
               {"faults", found.faults},
               {"notes", found.notes},
               {"advice", found.advice},
               {"camera_parent", camera_parent.empty() ? robot.links().front() : camera_parent},
               {"T_parent_camera", rows_of(found.T_parent_camera.matrix())},
               {"pose", pose_json(found.T_parent_camera)},
               {"covariance", rows_of(found.covariance)},
               {"position_error_95_m", found.position_error()},
               {"rotation_error_95_rad", found.rotation_error()},
               {"depth_offset_m", estimate_json(found.depth_offset)},
               {"depth_scale", estimate_json(found.depth_scale)},
               {"outline_px", estimate_json(found.outline)},
               {"frames", std::move(frames)},
               {"link_residuals_m", std::move(links)}};
  if (found.focal_x)
    json["focal"] = {{"fx_relative", estimate_json(found.focal_x)},
                     {"fy_relative", estimate_json(found.focal_y)}};
  if (!joints.empty()) json["joint_offsets"] = std::move(joints);
  if (found.time_offset) json["time_offset_s"] = estimate_json(found.time_offset);
  if (found.mask_overlap > 0.0)
    json["masks"] = {{"overlap", found.mask_overlap},
                     {"depth_shift_right_px", estimate_json(found.shift_right)},
                     {"depth_shift_down_px", estimate_json(found.shift_down)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace penumbra::io
