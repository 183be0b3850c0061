// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/urdf-inl.hpp>
#include <penumbra/robot/urdf_node-inl.hpp>

namespace penumbra::detail {
namespace {

Eigen::Quaterniond read_rotation(const UrdfNode& node) {
  if (node.has("quat_xyzw")) {
    if (node.has("rpy")) node.fail("has both rpy and quat_xyzw; one is expected");
    Eigen::Vector4d xyzw;
    node.numbers("quat_xyzw", {xyzw.data(), 4});
    constexpr double rounding = 1e-3;
    if (std::abs(xyzw.norm() - 1.0) > rounding)
      node.fail("quat_xyzw=" + in_quotes(node.text("quat_xyzw")) + " is not of length 1");
    return Eigen::Quaterniond(xyzw.normalized());
  }
  const Eigen::Vector3d rpy = node.has("rpy") ? node.vector("rpy") : Eigen::Vector3d::Zero();
  constexpr double turn = 6.3;  // rad, a whole one as people round it
  if (rpy.cwiseAbs().maxCoeff() > turn)
    node.warn("rpy", "rpy=" + in_quotes(node.text("rpy")) +
                         " is more than a turn: is it in degrees? give radians");
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}

Eigen::Isometry3d read_origin(const UrdfNode& parent) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const auto node = parent.child("origin");
  if (!node) return pose;
  node->expect({"xyz rpy quat_xyzw"});
  const Eigen::Vector3d xyz = node->has("xyz") ? node->vector("xyz") : Eigen::Vector3d::Zero();
  if (xyz.cwiseAbs().maxCoeff() > farthest_origin)
    node->fail("xyz=" + in_quotes(node->text("xyz")) + " lies beyond 1e6 m; metres are expected");
  if (xyz.cwiseAbs().maxCoeff() > likely_millimetres)
    node->warn("xyz", "xyz=" + in_quotes(node->text("xyz")) + " lies " +
                          printed(std::round(xyz.norm())) +
                          " m away: is it in millimetres? give metres");
  pose.linear() = read_rotation(*node).toRotationMatrix();
  pose.translation() = xyz;
  return pose;
}

UrdfBox read_box(const UrdfNode& node) {
  node.expect({"size"});
  const Eigen::Vector3d size = node.vector("size");
  if (size.minCoeff() <= 0.0 || size.maxCoeff() > largest_size)
    node.fail("size=" + in_quotes(node.text("size")) + " must be above 0 and at most " +
              printed(largest_size) + " m in every direction");
  return {size};
}

UrdfMesh read_mesh(const UrdfNode& node) {
  node.expect({"filename scale"});
  UrdfMesh mesh;
  mesh.filename = node.text("filename");
  if (node.has("scale")) mesh.scale = node.vector("scale");
  if ((mesh.scale.array() == 0.0).any())
    node.fail("scale=" + in_quotes(node.text("scale")) + " flattens the mesh; no factor may be 0");
  return mesh;
}

// A cylinder or capsule: its length is that of the cylindrical part.
template <typename Shape>
Shape read_round(const UrdfNode& node) {
  node.expect({"radius length"});
  return {node.positive("radius", largest_radius), node.positive("length", largest_size)};
}

void read_shape(const UrdfNode& geometry, UrdfElement& element) {
  geometry.expect({"", "name", "box cylinder sphere capsule mesh"});
  std::optional<UrdfNode> shape;
  for (const char* kind : {"box", "cylinder", "sphere", "capsule", "mesh"}) {
    const auto node = geometry.child(kind);
    if (node && shape) node->fail("a second shape; one element for each shape is expected");
    if (node) shape = node;
  }
  if (!shape) geometry.fail("contains no shape; expected box, cylinder, sphere, capsule or mesh");
  if (shape->name() == "box") element.shape = read_box(*shape);
  if (shape->name() == "cylinder") element.shape = read_round<UrdfCylinder>(*shape);
  if (shape->name() == "capsule") element.shape = read_round<UrdfCapsule>(*shape);
  if (shape->name() == "mesh") element.shape = read_mesh(*shape);
  if (shape->name() == "sphere") {
    shape->expect({"radius"});
    element.shape = UrdfSphere{shape->positive("radius", largest_radius)};
  }
}

UrdfElement read_element(const UrdfNode& node, const std::string& place) {
  UrdfElement element;
  element.place = place;
  try {
    node.expect({"", "name group concave", "origin geometry",
                 "material texture verbose contact_coefficients"});
    element.origin = read_origin(node);
    read_shape(node.required_child("geometry"), element);
  } catch (const InputError& error) {
    element.fault = error.what();
  }
  return element;
}

UrdfLink read_link(const UrdfNode& unnamed) {
  const std::string& name = unnamed.identifier();
  const UrdfNode node = unnamed.named("link " + in_quotes(name));
  node.expect({"name", "type concave", "visual collision",
               "inertial contact sensor gazebo verbose self_collision_checking"});
  UrdfLink link{name, node.place(), {}, {}};
  for (const UrdfNode& child : node.children()) {
    if (child.name() == "visual") link.visuals.push_back(read_element(child, link.place));
    if (child.name() == "collision") link.collisions.push_back(read_element(child, link.place));
  }
  return link;
}

JointType read_type(const UrdfNode& node) {
  const std::string& type = node.text("type");
  for (const JointType known : {JointType::revolute, JointType::continuous, JointType::prismatic,
                                JointType::fixed, JointType::planar, JointType::floating})
    if (to_string(known) == type) return known;
  node.fail("unknown type " + in_quotes(type) +
            "; expected revolute, continuous, prismatic, fixed, planar or floating");
}

std::string read_reference(const UrdfNode& joint, std::string_view key) {
  const UrdfNode node = joint.required_child(key);
  node.expect({"link"});
  return node.text("link");
}

Eigen::Vector3d read_axis(const UrdfNode& joint, JointType type) {
  const auto node = joint.child("axis");
  if (!node) {
    // URDF's default is x, but most readers use z for planar joints.
    if (type == JointType::planar)
      joint.fail("a planar joint needs its plane's normal: <axis xyz=\"0 0 1\"/> for x and y");
    return Eigen::Vector3d::UnitX();
  }
  node->expect({"xyz"});
  const Eigen::Vector3d axis = node->vector("xyz");
  // Exporters write a zero axis for joints without one.
  if (type == JointType::fixed || type == JointType::floating) return Eigen::Vector3d::UnitX();
  const double length = axis.stableNorm();
  constexpr double shortest_axis = 1e-9;
  if (length < shortest_axis)
    node->fail("xyz=" + in_quotes(node->text("xyz")) + " has no direction; for instance \"0 0 1\"");
  return (axis / length).normalized();
}

void read_limits(const UrdfNode& joint, Joint& out) {
  const auto node = joint.child("limit");
  if (!node) return;
  node->expect({"lower upper velocity", "effort acceleration deceleration jerk"});
  const double lower = node->number_or("lower", 0.0);
  const double upper = node->number_or("upper", 0.0);
  const double velocity = node->number_or("velocity", 0.0);
  if (velocity > 0.0) out.velocity = velocity;
  if (out.type != JointType::revolute && out.type != JointType::prismatic) return;
  if (lower > upper) node->fail("lower is above upper");
  out.lower = lower;
  out.upper = upper;
}

std::optional<UrdfMimic> read_mimic(const UrdfNode& joint) {
  const auto node = joint.child("mimic");
  if (!node) return std::nullopt;
  node->expect({"joint multiplier offset"});
  const UrdfMimic mimic{node->text("joint"), node->number_or("multiplier", 1.0),
                        node->number_or("offset", 0.0)};
  if (std::abs(mimic.multiplier) > largest_mimic || std::abs(mimic.offset) > largest_mimic)
    node->fail("multiplier and offset must lie within +-1e9");
  return mimic;
}

UrdfJoint read_joint(const UrdfNode& unnamed) {
  const std::string& name = unnamed.identifier();
  const UrdfNode node = unnamed.named("joint " + in_quotes(name));
  node.expect({"name type", "", "parent child origin axis limit mimic",
               "dynamics safety_controller calibration gazebo joint_properties verbose"});
  UrdfJoint joint{name, node.place(), {}, {}, {}, {}};
  joint.joint.type = read_type(node);
  joint.parent = read_reference(node, "parent");
  joint.child = read_reference(node, "child");
  joint.joint.origin = read_origin(node);
  joint.joint.axis = read_axis(node, joint.joint.type);
  read_limits(node, joint.joint);
  joint.mimic = read_mimic(node);
  return joint;
}

}  // namespace

Urdf read_urdf(const XmlElement& root) {
  UrdfWarnings warnings;
  const UrdfNode node(root, warnings, "");
  if (root.name != "robot")
    node.fail("the file's root is <" + root.name + ">; a URDF's is <robot>, an MJCF's <mujoco>");
  node.expect({"name version", "", "link joint",
               "material transmission gazebo ros2_control sensor mujoco"});
  if (node.has("version") && !node.text("version").starts_with("1"))
    node.fail("version=" + in_quotes(node.text("version")) + " is unknown; expected 1.0");
  Urdf urdf{*root.file, node.identifier(), {}, {}, {}};
  for (const UrdfNode& child : node.children()) {
    if (child.name() == "link") urdf.links.push_back(read_link(child));
    if (child.name() == "joint") urdf.joints.push_back(read_joint(child));
  }
  for (auto& [kind, line] : warnings) urdf.warnings.push_back(std::move(line));
  return urdf;
}

}  // namespace penumbra::detail
