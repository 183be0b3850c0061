// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/robot/urdf-inl.hpp>
#include <penumbra/robot/urdf_node-inl.hpp>

namespace penumbra::detail {
namespace {

using Names = std::string_view[];

// The elements and attributes that are read, and those known to change nothing that is drawn:
// dynamics, colours, controllers, simulators. http://wiki.ros.org/urdf/XML
constexpr Names kName = {"name"};
constexpr Names kRobotAttributes = {"name", "version"};
constexpr Names kRobotChildren = {"link", "joint"};
constexpr Names kRobotIgnored = {"material",     "transmission", "gazebo",
                                 "ros2_control", "sensor",       "mujoco"};
constexpr Names kLinkChildren = {"visual", "collision"};
constexpr Names kLinkIgnoredAttributes = {"type", "concave"};
constexpr Names kLinkIgnored = {"inertial", "contact", "sensor",
                                "gazebo",   "verbose", "self_collision_checking"};
constexpr Names kElementIgnoredAttributes = {"name", "group", "concave"};
constexpr Names kElementChildren = {"origin", "geometry"};
constexpr Names kElementIgnored = {"material", "texture", "verbose", "contact_coefficients"};
constexpr Names kShapes = {"box", "cylinder", "sphere", "capsule", "mesh"};
constexpr Names kOriginAttributes = {"xyz", "rpy", "quat_xyzw"};
constexpr Names kBoxAttributes = {"size"};
constexpr Names kRoundAttributes = {"radius", "length"};
constexpr Names kSphereAttributes = {"radius"};
constexpr Names kMeshAttributes = {"filename", "scale"};
constexpr Names kJointAttributes = {"name", "type"};
constexpr Names kJointChildren = {"parent", "child", "origin", "axis", "limit", "mimic"};
constexpr Names kJointIgnored = {"dynamics", "safety_controller", "calibration",
                                 "gazebo",   "joint_properties",  "verbose"};
constexpr Names kLinkReference = {"link"};
constexpr Names kAxisAttributes = {"xyz"};
constexpr Names kLimitAttributes = {"lower", "upper", "velocity"};
constexpr Names kLimitIgnored = {"effort", "acceleration", "deceleration", "jerk"};
constexpr Names kMimicAttributes = {"joint", "multiplier", "offset"};

constexpr ElementRule kRobotRule{kRobotAttributes, {}, kRobotChildren, kRobotIgnored};
constexpr ElementRule kLinkRule{kName, kLinkIgnoredAttributes, kLinkChildren, kLinkIgnored};
constexpr ElementRule kElementRule{
    {}, kElementIgnoredAttributes, kElementChildren, kElementIgnored};
constexpr ElementRule kGeometryRule{{}, kName, kShapes, {}};
constexpr ElementRule kJointRule{kJointAttributes, {}, kJointChildren, kJointIgnored};
constexpr ElementRule kLimitRule{kLimitAttributes, kLimitIgnored, {}, {}};

// Nothing on a robot is larger or farther; what is was written in another unit. The radius also
// bounds the triangles of a sphere.
constexpr double kLargestSize = 1000.0;
constexpr double kLargestRadius = 50.0;
constexpr double kFarthestOrigin = 1e6;
constexpr double kShortestAxis = 1e-9;
constexpr double kUnitQuaternion = 1e-3;

constexpr JointType kJointTypes[] = {JointType::revolute,  JointType::continuous,
                                     JointType::prismatic, JointType::fixed,
                                     JointType::planar,    JointType::floating};

ElementRule leaf(std::span<const std::string_view> attributes) { return {attributes, {}, {}, {}}; }

Eigen::Quaterniond read_rotation(const UrdfNode& node) {
  if (node.has("quat_xyzw")) {
    if (node.has("rpy")) node.fail("has both rpy and quat_xyzw; one is expected");
    Eigen::Vector4d xyzw;
    node.numbers("quat_xyzw", {xyzw.data(), 4});
    if (std::abs(xyzw.norm() - 1.0) > kUnitQuaternion)
      node.fail("quat_xyzw=" + in_quotes(node.text("quat_xyzw")) + " is not of length 1");
    return Eigen::Quaterniond(xyzw.normalized());
  }
  const Eigen::Vector3d rpy = node.has("rpy") ? node.vector("rpy") : Eigen::Vector3d::Zero();
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}

Eigen::Isometry3d read_origin(const UrdfNode& parent) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const auto node = parent.child("origin");
  if (!node) return pose;
  node->expect(leaf(kOriginAttributes));
  const Eigen::Vector3d xyz = node->has("xyz") ? node->vector("xyz") : Eigen::Vector3d::Zero();
  if (xyz.cwiseAbs().maxCoeff() > kFarthestOrigin)
    node->fail("xyz=" + in_quotes(node->text("xyz")) + " lies beyond 1e6 m; metres are expected");
  pose.linear() = read_rotation(*node).toRotationMatrix();
  pose.translation() = xyz;
  return pose;
}

UrdfBox read_box(const UrdfNode& node) {
  node.expect(leaf(kBoxAttributes));
  const Eigen::Vector3d size = node.vector("size");
  if (size.minCoeff() <= 0.0 || size.maxCoeff() > kLargestSize)
    node.fail("size=" + in_quotes(node.text("size")) + " must be above 0 and at most " +
              printed(kLargestSize) + " m in every direction");
  return {size};
}

UrdfMesh read_mesh(const UrdfNode& node) {
  node.expect(leaf(kMeshAttributes));
  UrdfMesh mesh{node.text("filename")};
  if (node.has("scale")) mesh.scale = node.vector("scale");
  if ((mesh.scale.array() == 0.0).any())
    node.fail("scale=" + in_quotes(node.text("scale")) + " flattens the mesh; no factor may be 0");
  return mesh;
}

// A cylinder or capsule: its length is that of the cylindrical part.
template <typename Shape>
Shape read_round(const UrdfNode& node) {
  node.expect(leaf(kRoundAttributes));
  return {node.positive("radius", kLargestRadius), node.positive("length", kLargestSize)};
}

void read_shape(const UrdfNode& geometry, UrdfElement& element) {
  geometry.expect(kGeometryRule);
  std::optional<UrdfNode> shape;
  for (const std::string_view kind : kShapes) {
    const auto node = geometry.child(kind);
    if (node && shape) node->fail("a second shape; one element for each shape is expected");
    if (node) shape = node;
  }
  if (!shape) geometry.fail("holds no shape; expected box, cylinder, sphere, capsule or mesh");
  if (shape->name() == "box") element.shape = read_box(*shape);
  if (shape->name() == "cylinder") element.shape = read_round<UrdfCylinder>(*shape);
  if (shape->name() == "capsule") element.shape = read_round<UrdfCapsule>(*shape);
  if (shape->name() == "mesh") element.shape = read_mesh(*shape);
  if (shape->name() == "sphere") {
    shape->expect(leaf(kSphereAttributes));
    element.shape = UrdfSphere{shape->positive("radius", kLargestRadius)};
  }
}

UrdfElement read_element(const UrdfNode& node) {
  UrdfElement element;
  element.line = node.line();
  try {
    node.expect(kElementRule);
    element.origin = read_origin(node);
    read_shape(node.required_child("geometry"), element);
  } catch (const InputError& error) {
    element.fault = error.what();
  }
  return element;
}

UrdfLink read_link(const UrdfNode& unnamed) {
  const std::string& name = unnamed.identifier("name");
  const UrdfNode node = unnamed.named("link " + in_quotes(name));
  node.expect(kLinkRule);
  UrdfLink link{name, node.line(), {}, {}};
  for (const UrdfNode& child : node.children()) {
    if (child.name() == "visual") link.visuals.push_back(read_element(child));
    if (child.name() == "collision") link.collisions.push_back(read_element(child));
  }
  return link;
}

JointType read_type(const UrdfNode& node) {
  const std::string& type = node.text("type");
  for (const JointType known : kJointTypes)
    if (to_string(known) == type) return known;
  node.fail("unknown type " + in_quotes(type) +
            "; expected revolute, continuous, prismatic, fixed, planar or floating");
}

std::string read_reference(const UrdfNode& joint, std::string_view key) {
  const UrdfNode node = joint.required_child(key);
  node.expect(leaf(kLinkReference));
  return node.text("link");
}

Eigen::Vector3d read_axis(const UrdfNode& joint, JointType type) {
  const auto node = joint.child("axis");
  if (!node) {
    // The URDF default would be x, most readers of planar joints take z.
    if (type == JointType::planar)
      joint.fail("a planar joint needs its plane's normal: <axis xyz=\"0 0 1\"/> for x and y");
    return Eigen::Vector3d::UnitX();
  }
  node->expect(leaf(kAxisAttributes));
  const Eigen::Vector3d axis = node->vector("xyz");
  // Exporters write a zero axis for joints that have none.
  if (type == JointType::fixed || type == JointType::floating) return Eigen::Vector3d::UnitX();
  const double length = axis.stableNorm();
  if (length < kShortestAxis)
    node->fail("xyz=" + in_quotes(node->text("xyz")) + " has no direction; for instance \"0 0 1\"");
  return (axis / length).normalized();
}

void read_limits(const UrdfNode& joint, UrdfJoint& out) {
  const auto node = joint.child("limit");
  if (!node) return;
  node->expect(kLimitRule);
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
  node->expect(leaf(kMimicAttributes));
  const UrdfMimic mimic{node->text("joint"), node->number_or("multiplier", 1.0),
                        node->number_or("offset", 0.0)};
  if (std::abs(mimic.multiplier) > kLargestMimic || std::abs(mimic.offset) > kLargestMimic)
    node->fail("multiplier and offset must lie within +-1e9");
  return mimic;
}

UrdfJoint read_joint(const UrdfNode& unnamed) {
  const std::string& name = unnamed.identifier("name");
  const UrdfNode node = unnamed.named("joint " + in_quotes(name));
  node.expect(kJointRule);
  UrdfJoint joint;
  joint.name = name;
  joint.line = node.line();
  joint.type = read_type(node);
  joint.parent = read_reference(node, "parent");
  joint.child = read_reference(node, "child");
  joint.origin = read_origin(node);
  joint.axis = read_axis(node, joint.type);
  read_limits(node, joint);
  joint.mimic = read_mimic(node);
  return joint;
}

// Elements that are ignored are searched too: a file that holds a macro anywhere is not expanded.
// An xmlns:xacro alone is no sign of one: expanded files often keep it.
void refuse_xacro(const XmlElement& xml, UrdfFile& file) {
  if (xml.name.starts_with("xacro:"))
    UrdfNode(xml, file, "")
        .fail(
            "this is a xacro file, not a URDF; expand it first: xacro FILE.urdf.xacro > FILE.urdf");
  for (const XmlElement& child : xml.children) refuse_xacro(child, file);
}

}  // namespace

Urdf read_urdf(std::string_view xml, const std::string& file) {
  const XmlElement root = read_xml(xml, file);
  require_utf8(root, file);
  UrdfFile source{file, {}};
  const UrdfNode node(root, source, "");
  if (root.name != "robot")
    node.fail("the file's root is <" + root.name + ">; a URDF's is <robot>");
  refuse_xacro(root, source);
  node.expect(kRobotRule);
  if (node.has("version") && !node.text("version").starts_with("1"))
    node.fail("version=" + in_quotes(node.text("version")) + " is unknown; expected 1.0");
  Urdf urdf{file, node.identifier("name"), {}, {}, {}};
  for (const UrdfNode& child : node.children()) {
    if (child.name() == "link") urdf.links.push_back(read_link(child));
    if (child.name() == "joint") urdf.joints.push_back(read_joint(child));
  }
  for (auto& [kind, line] : source.warnings) urdf.warnings.push_back(std::move(line));
  return urdf;
}

}  // namespace penumbra::detail
