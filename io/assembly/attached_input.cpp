// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <span>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/mesh/primitives.hpp>

#include <io/assembly/attached_input.hpp>
#include <io/files/printable.hpp>
#include <io/ros/wire_values-inl.hpp>

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

/// All shapes of an object as one mesh in its frame.
TriangleMesh mesh_of(const AttachedObjectMessage& message) {
  const CollisionObjectMessage& object = message.object;
  const std::string& frame = object.header.frame_id;
  if (object.operation != CollisionObjectMessage::add)
    throw InputError("only adding and removing can be followed");
  if (!frame.empty() && frame != message.link_name)
    throw InputError("its pose is given in '" + printable(frame) + "', not in its link '" +
                     printable(message.link_name) + "'");
  if (!object.planes.empty()) throw InputError("planes cannot be drawn");
  TriangleMesh mesh;
  append<Primitive>(mesh, object.primitives, object.primitive_poses);
  append<MeshMessage>(mesh, object.meshes, object.mesh_poses);
  if (mesh.triangles.empty()) throw InputError("its shape is not in the message");
  return mesh;
}

/// Detaches all bodies of a robot, or those of one link.
void detach_all(const std::string& prefix, const std::string& link, std::int64_t stamp,
                Attachments& to) {
  std::vector<AttachedBody> bodies;
  to.at(stamp, bodies);
  for (const AttachedBody& body : bodies)
    if (body.link.starts_with(prefix) && (link.empty() || body.link == prefix + link))
      to.detach(stamp, body.name);
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

std::string AttachedInput::take(const AttachedObjectMessage& message, std::int64_t now,
                                Attachments& to, const std::string& robot) {
  const std::string prefix = robot.empty() ? "" : robot + "/";
  const CollisionObjectMessage& object = message.object;
  const std::int64_t stamp = object.header.stamp > 0 ? object.header.stamp : now;
  if (object.operation == CollisionObjectMessage::remove) {
    if (object.id.empty())
      detach_all(prefix, message.link_name, stamp, to);
    else
      to.detach(stamp, prefix + object.id);
    return {};
  }
  AttachedBody body{.name = prefix + object.id, .link = prefix + message.link_name, .mesh = {}};
  std::string fault;
  try {
    body.mesh = prepared(mesh_of(message));
    body.T_link_body = isometry_of(object.pose);
  } catch (const InputError& error) {
    body.mesh.reset();
    fault = "object '" + printable(object.id) + "' is not drawn: " + error.what();
  }
  to.attach(stamp, std::move(body));
  return fault;
}

/// A state that is no difference holds all that is attached. MoveIt sends an empty one with changes
/// of the world alone.
std::string AttachedInput::take(const PlanningSceneMessage& message, std::int64_t now,
                                Attachments& to, const std::string& robot) {
  const RobotStateMessage& state = message.robot_state;
  const std::int64_t of_state = state.joints.header.stamp;
  const std::int64_t stamp = of_state > 0 ? of_state : now;
  if (!state.is_diff && !(state.joints.names.empty() && state.other_joints.joint_names.empty()))
    detach_all(robot.empty() ? "" : robot + "/", {}, stamp, to);
  std::string fault;
  for (const AttachedObjectMessage& attached : state.attached)
    if (std::string one = take(attached, stamp, to, robot); !one.empty()) fault = std::move(one);
  return fault;
}

}  // namespace penumbra::io
