// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/target_stage-inl.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra {
namespace {

std::shared_ptr<const PreparedMesh> mesh_of(const TargetShape& shape) {
  check_shape(shape);
  if (const auto* mesh = std::get_if<MeshTarget>(&shape)) return mesh->mesh;
  if (const auto* point = std::get_if<PointTarget>(&shape))
    return std::make_shared<PreparedMesh>(make_sphere(point->radius));
  if (const auto* box = std::get_if<BoxTarget>(&shape))
    return std::make_shared<PreparedMesh>(make_box(box->size));
  throw InputError("it is no 3-D shape; give it as a point with a radius, a 3-D box or a mesh");
}

/// Returns T_root_target at the frame's stamp.
Eigen::Isometry3d current_pose(const Target& target, const ShapePlacement& given,
                               const PoseResult& poses, const TargetReport& report,
                               const Robot& robot) {
  if (const PlacedBody* const body = find_body(poses, target.name))
    return poses.T_root_camera * body->T_camera_body;
  const auto& handled = report.handled;
  if (handled && !handled->position) throw InputError("its handled pose is lost");
  const bool needs_given = !handled || (is_rendered(target.shape) && !handled->orientation);
  Eigen::Isometry3d T_root_target = Eigen::Isometry3d::Identity();
  if (needs_given) {
    if (!target.fault.empty()) throw InputError(std::string(target.fault));
    if (target.estimate && std::holds_alternative<std::monostate>(target.estimate->value))
      throw InputError("it was not found in this frame");
    if (target.stamp && target.stamp != poses.stamp)
      throw InputError("its pose has another stamp than the frame");
    T_root_target = pose_of(given.frame, poses, robot) * given.pose;
  }
  if (handled) T_root_target.translation() = *handled->position;
  if (handled && handled->orientation)
    T_root_target.linear() = handled->orientation->toRotationMatrix();
  return T_root_target;
}

AttachedBody attached(const Target& target, std::string_view link, const PoseResult& poses,
                      const TargetReport& report, const Robot& robot) try {
  if (!poses.known()) throw InputError("the robot's pose is not known: " + poses.message);
  std::shared_ptr<const PreparedMesh> mesh = mesh_of(target.shape);
  const Eigen::Isometry3d T_root_link =
      pose_of(ReferenceFrame::of_link(std::string(link)), poses, robot);
  const Eigen::Isometry3d T_root_target =
      current_pose(target, placement_of(target.shape).value(), poses, report, robot);
  return {.name = target.name,
          .link = std::string(link),
          .mesh = std::move(mesh),
          .T_link_body = T_root_link.inverse() * T_root_target};
} catch (const InputError& fault) {
  throw InputError("target '" + target.name + "' is not attached: " + fault.what());
}

}  // namespace

const PlacedBody* find_body(const PoseResult& poses, std::string_view name) {
  for (const PlacedBody& body : poses.attached)
    if (body.name == name) return &body;
  return nullptr;
}

AttachedBody TargetStage::attach(const Target& target, std::string_view link,
                                 const PoseResult* poses) const {
  const auto report = std::ranges::find(reports_, target.name, &TargetReport::name);
  if (poses == nullptr || report == reports_.end())
    throw InputError("target '" + target.name + "' was not in the last frame");
  return attached(target, link, *poses, *report, robot_);
}

}  // namespace penumbra
