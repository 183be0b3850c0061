// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/mesh/primitives.hpp>

#include <io/assembly/attached_input.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/files/printable.hpp>
#include <io/ros/wire_values.hpp>

namespace penumbra::io {
namespace {

using Primitive = SolidPrimitiveMessage;

Eigen::Isometry3d isometry_of(const LoosePose& pose) {
  const Eigen::Vector3d& at = pose.position;
  const Eigen::Vector4d& q = pose.orientation;
  Vector3Wire position;
  to_wire(at, position);
  Eigen::Isometry3d T = isometry_of(position, {q[0], q[1], q[2], q[3]});
  if (!is_rigid(T)) throw InputError("a pose is not a rigid transform");
  return T;
}

TriangleMesh mesh_of(const Primitive& primitive) {
  constexpr double most = 10.0;  // metres: round shapes of more have millions of triangles
  const std::vector<double>& d = primitive.dimensions;
  if (std::any_of(d.begin(), d.end(), [](double size) { return !(size <= most); }))
    throw InputError("a shape is larger than 10 m");
  if (primitive.type == Primitive::box && d.size() == 3) return make_box({d[0], d[1], d[2]});
  if (primitive.type == Primitive::sphere && !d.empty()) return make_sphere(d[0]);
  if (primitive.type == Primitive::cylinder && d.size() >= 2) return make_cylinder(d[1], d[0]);
  throw InputError("only boxes, spheres, cylinders and meshes can be drawn");
}

TriangleMesh mesh_of(const MeshMessage& message) {
  TriangleMesh mesh;
  for (const VertexMessage& v : message.vertices)
    mesh.vertices.push_back(Eigen::Vector3d(v.x, v.y, v.z).cast<float>());
  for (const MeshMessage::Triangle& triangle : message.triangles) {
    if (*std::max_element(triangle.vertices.begin(), triangle.vertices.end()) >=
        mesh.vertices.size())
      throw InputError("a triangle has a vertex that the mesh lacks");
    mesh.triangles.push_back(triangle.vertices);
  }
  return mesh;
}

void append(TriangleMesh& all, const TriangleMesh& part, const Eigen::Isometry3d& T) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  for (const Eigen::Vector3f& vertex : part.vertices) {
    all.vertices.emplace_back((T * vertex.cast<double>()).cast<float>());
    if (!all.vertices.back().allFinite()) throw InputError("a vertex is not finite");
  }
  for (const auto& [a, b, c] : part.triangles)
    all.triangles.push_back({first + a, first + b, first + c});
}

template <typename Shape>
void append(TriangleMesh& all, std::span<const Shape> shapes, std::span<const LoosePose> poses) {
  if (shapes.size() != poses.size()) throw InputError("shapes and poses differ in number");
  for (std::size_t i = 0; i < shapes.size(); ++i)
    append(all, mesh_of(shapes[i]), isometry_of(poses[i]));
}

bool has_shape(const CollisionObjectMessage& object) {
  return !object.primitives.empty() || !object.meshes.empty() || !object.planes.empty();
}

/// All shapes of an object as one mesh in its frame.
TriangleMesh mesh_of(const CollisionObjectMessage& object) {
  if (!object.planes.empty()) throw InputError("planes cannot be drawn");
  TriangleMesh mesh;
  append<Primitive>(mesh, object.primitives, object.primitive_poses);
  append<MeshMessage>(mesh, object.meshes, object.mesh_poses);
  if (mesh.triangles.empty()) throw InputError("its shape has no triangles");
  return mesh;
}

/// Returns the body of a name that is attached at a stamp.
std::optional<AttachedBody> find_attached(const Attachments& to, std::int64_t stamp,
                                          const std::string& name) {
  std::vector<AttachedBody> bodies;
  to.at(stamp, bodies);
  const auto found = std::ranges::find(bodies, name, &AttachedBody::name);
  return found == bodies.end() ? std::nullopt : std::optional(std::move(*found));
}

/// Returns whether a stamp is that of an earlier event: a change of the body has it, or the body is
/// attached after it alone.
bool is_old(std::int64_t stamp, const std::string& name, bool is_removal, const Attachments& to) {
  const bool is_then = find_attached(to, stamp, name).has_value();
  if (is_then != find_attached(to, stamp - 1, name).has_value()) return true;
  return is_removal && !is_then && to.last_change(name).value_or(stamp) > stamp;
}

/// Detaches a body; from `now` on if the stamp is old.
void detach(std::int64_t stamp, std::int64_t now, const std::string& name, Attachments& to) {
  if (is_old(stamp, name, true, to)) stamp = std::max(now, *to.last_change(name));
  to.detach(stamp, name);
}

/// Returns T_link_frame. A frame may be a link of the same robot or the root of all.
Eigen::Isometry3d pose_of_frame(const std::string& frame, const std::string& link,
                                const std::string& prefix, std::int64_t stamp,
                                const PosedRobot* posed) {
  if (prefix + frame == link) return Eigen::Isometry3d::Identity();
  std::optional<Eigen::Isometry3d> found;
  if (posed != nullptr) {
    found = posed->find_pose(link, prefix + frame, stamp);
    if (!found) found = posed->find_pose(link, frame, stamp);
  }
  if (!found)
    throw InputError("its pose is given in '" + printable(frame) + "', whose pose in its link '" +
                     printable(link) + "' is not known");
  return *found;
}

/// Returns the bodies of a robot, or those of one link, that are attached at a stamp.
std::vector<AttachedBody> attached_to(const std::string& prefix, const std::string& link,
                                      std::int64_t stamp, const Attachments& all) {
  std::vector<AttachedBody> bodies;
  all.at(stamp, bodies);
  std::erase_if(bodies, [&](const AttachedBody& body) {
    return !body.link.starts_with(prefix) || !(link.empty() || body.link == prefix + link);
  });
  return bodies;
}

bool is_same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.vertices == b.vertices;
}

}  // namespace

std::shared_ptr<const PreparedMesh> AttachedInput::prepared(TriangleMesh mesh) {
  for (const auto& [source, prepared] : kept_)
    if (is_same(source, mesh)) return prepared;
  auto made = std::make_shared<const PreparedMesh>(mesh);
  if (kept_.size() == max_kept) kept_.erase(kept_.begin());
  return kept_.emplace_back(std::move(mesh), std::move(made)).second;
}

void AttachedInput::follow_world(const CollisionObjectMessage& object, const std::string& prefix) {
  if (object.operation != CollisionObjectMessage::add || !has_shape(object))
    world_.erase(prefix + object.id);
  else if (world_.size() < max_world || world_.contains(prefix + object.id))
    world_[prefix + object.id] = object;
}

/// One that was removed after the message's stamp is attached again from `now` on.
std::string AttachedInput::take(const AttachedObjectMessage& message, std::int64_t now,
                                Attachments& to, const std::string& robot,
                                const PosedRobot* posed) {
  const CollisionObjectMessage& object = message.object;
  const std::string name = (robot.empty() ? "" : robot + "/") + object.id;
  const bool is_add = object.operation == CollisionObjectMessage::add;
  std::string fault;
  if (!is_add || !is_old(object.header.stamp, name, false, to))
    fault = change(message, now, to, robot, posed);
  const auto last = to.last_change(name);
  if (!is_add || !last || find_attached(to, *last, name)) return fault;
  AttachedObjectMessage again = message;
  again.object.header.stamp = std::max(now, *last);
  return change(again, now, to, robot, posed);
}

std::string AttachedInput::change(const AttachedObjectMessage& message, std::int64_t now,
                                  Attachments& to, const std::string& robot,
                                  const PosedRobot* posed) {
  const std::string prefix = robot.empty() ? "" : robot + "/";
  const CollisionObjectMessage& object = message.object;
  const std::int64_t stamp = object.header.stamp > 0 ? object.header.stamp : now;
  if (object.operation == CollisionObjectMessage::remove) {
    if (!object.id.empty()) detach(stamp, now, prefix + object.id, to);
    for (const std::int64_t when : {stamp, std::numeric_limits<std::int64_t>::max()})
      for (const auto& body : attached_to(prefix, message.link_name, when, to))
        if (object.id.empty()) detach(stamp, now, body.name, to);
    return {};
  }
  AttachedBody body{.name = prefix + object.id, .link = prefix + message.link_name, .mesh = {}};
  const bool is_add = object.operation == CollisionObjectMessage::add;
  if (is_add && !has_shape(object)) {
    const auto known = find_attached(to, stamp, body.name);
    if (known && known->link == body.link && known->mesh) return {};
  }
  const auto in_world = has_shape(object) ? world_.end() : world_.find(body.name);
  const bool is_of_world = in_world != world_.end();
  const CollisionObjectMessage& shape = is_of_world ? in_world->second : object;
  try {
    if (!is_add) throw InputError("only adding and removing can be followed");
    if (!has_shape(shape)) throw InputError("its shape is not in the message");
    const std::string& frame = shape.header.frame_id;
    const Eigen::Isometry3d T_link_frame =
        frame.empty() && !is_of_world ? Eigen::Isometry3d::Identity()
                                      : pose_of_frame(frame, body.link, prefix, stamp, posed);
    body.mesh = std::make_shared<const PreparedMesh>(TriangleMesh());  // in case it is not drawn
    body.T_link_body = T_link_frame * isometry_of(shape.pose);
    body.mesh = prepared(mesh_of(shape));
  } catch (const InputError& error) {
    body.reason = error.what();
  }
  const std::string fault =
      body.reason.empty() ? ""
                          : "object '" + printable(object.id) + "' is not drawn: " + body.reason;
  to.attach(stamp, std::move(body));
  return fault;
}

/// A state that is no difference holds all that is attached. MoveIt sends an empty one with changes
/// of the world alone.
std::string AttachedInput::take(const PlanningSceneMessage& message, std::int64_t now,
                                Attachments& to, const std::string& robot,
                                const PosedRobot* posed) {
  const std::string prefix = robot.empty() ? "" : robot + "/";
  const RobotStateMessage& state = message.robot_state;
  const std::int64_t of_state = state.joints.header.stamp;
  const std::int64_t stamp = of_state > 0 ? of_state : now;
  if (!state.is_diff && !(state.joints.names.empty() && state.other_joints.joint_names.empty()))
    for (const auto& body : attached_to(prefix, {}, stamp, to)) to.detach(stamp, body.name);
  std::string fault;
  for (const AttachedObjectMessage& attached : state.attached)
    if (std::string one = change(attached, stamp, to, robot, posed); !one.empty())
      fault = std::move(one);
  for (const CollisionObjectMessage& object : message.world.objects) follow_world(object, prefix);
  return fault;
}

}  // namespace penumbra::io
