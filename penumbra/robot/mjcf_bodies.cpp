// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/mjcf-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr int deepest_body = 300;  // nested; the readers of bodies call themselves

constexpr ElementRule body_rule = {
    "name childclass pos quat axisangle xyaxes zaxis euler mocap", "gravcomp sleep simple user",
    "body frame joint freejoint geom composite flexcomp attach replicate",
    "inertial site camera light plugin"};

/// A joint, and its place in the body's frame.
struct BodyJoint {
  UrdfJoint urdf;
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  double ref = 0.0;
  bool is_free = false;
};

/// A body inside another one.
struct ChildBody {
  UrdfNode node;
  Eigen::Isometry3d T_parent_frame;
  std::string defaults;  // class
};

/// What a body contains, that of its frames included.
struct BodyContent {
  std::vector<BodyJoint> joints;
  std::vector<ChildBody> bodies;
};

/// Returns the first numbers of `size`, metres.
std::vector<double> sizes_of(const UrdfNode& geom, std::size_t count) {
  if (!geom.has("size")) geom.fail("the attribute 'size' is missing");
  std::vector<double> sizes = mjcf_numbers(geom, "size");
  if (sizes.size() < count || sizes.size() > 3)
    geom.fail("size=" + in_quotes(geom.text("size")) + " has " + std::to_string(sizes.size()) +
              " numbers; expected " + std::to_string(count));
  sizes.resize(count);
  for (const double size : sizes)
    if (size <= 0.0 || size > largest_radius)
      geom.fail("size=" + in_quotes(geom.text("size")) + " must be above 0 and at most " +
                printed(largest_radius) + " m");
  return sizes;
}

/// Returns half of the distance between the ends in `fromto`, and sets the geom's pose by them.
double set_ends(const UrdfNode& geom, Eigen::Isometry3d& T_body_geom) {
  if (geom.has("pos") && !geom.vector("pos").isZero(0.0)) geom.fail("has both pos and fromto");
  Eigen::Matrix<double, 3, 2> ends;
  geom.numbers("fromto", {ends.data(), 6});
  const Eigen::Vector3d along = ends.col(0) - ends.col(1);
  if (ends.cwiseAbs().maxCoeff() > farthest_origin || along.norm() > 2.0 * largest_radius)
    geom.fail("fromto=" + in_quotes(geom.text("fromto")) + " is too long; metres are expected");
  T_body_geom.translation() = ends.rowwise().mean();
  T_body_geom.linear() = mjcf_rotation_to(geom, along).toRotationMatrix();
  return along.norm() / 2.0;
}

/// Sets the shape and pose of a sphere, capsule, cylinder, ellipsoid or box.
void set_primitive(const UrdfNode& geom, const std::string& type, const MjcfCompiler& compiler,
                   UrdfElement& element) {
  const bool is_sphere = type == "sphere";
  const bool is_long = type == "capsule" || type == "cylinder";
  const bool has_ends = geom.has("fromto");
  if (has_ends && is_sphere) geom.fail("fromto is given, but a sphere has no ends");
  std::vector<double> half = sizes_of(geom, is_sphere || has_ends ? 1 : is_long ? 2 : 3);
  if (has_ends) {
    const double half_length = set_ends(geom, element.origin);
    half.resize(is_long ? 1 : 2, half[0]);
    half.push_back(half_length);
  } else {
    element.origin = mjcf_pose(geom, compiler);
  }
  if (is_sphere) element.shape = UrdfSphere{half[0]};
  if (type == "capsule") element.shape = UrdfCapsule{half[0], 2.0 * half[1]};
  if (type == "cylinder") element.shape = UrdfCylinder{half[0], 2.0 * half[1]};
  if (type == "ellipsoid") element.shape = UrdfEllipsoid{{half[0], half[1], half[2]}};
  if (type == "box") element.shape = UrdfBox{{2.0 * half[0], 2.0 * half[1], 2.0 * half[2]}};
}

void set_mesh(const UrdfNode& geom, const MjcfModel& model, UrdfElement& element) {
  const std::string& name = geom.text("mesh");
  const auto mesh = model.meshes.find(name);
  if (mesh == model.meshes.end()) geom.fail("mesh=" + in_quotes(name) + " is no mesh of <asset>");
  if (geom.has("fromto")) geom.fail("a mesh has no fromto");
  if (!mesh->second.fault.empty()) throw InputError(mesh->second.fault);
  element.shape = mesh->second.mesh;
  element.origin = mjcf_pose(geom, model.compiler);
}

void set_shape(const UrdfNode& geom, const MjcfModel& model, UrdfElement& element) {
  static constexpr std::string_view primitives[] = {"sphere", "capsule", "cylinder", "ellipsoid",
                                                    "box"};
  const std::string type = geom.has("type") ? geom.text("type") : "sphere";
  if (type == "mesh") return set_mesh(geom, model, element);
  if (type == "plane" || type == "hfield" || type == "sdf")
    geom.fail("type='" + type + "' is not supported on a body; leave the body out (ignore_links)");
  if (std::ranges::find(primitives, type) == std::end(primitives))
    geom.fail("unknown type " + in_quotes(type) +
              "; expected sphere, capsule, cylinder, ellipsoid, box or mesh");
  if (geom.has("mesh"))
    geom.fail("a " + type +
              " that is fitted to a mesh is not supported; draw visual geometry (--geometry "
              "visual), or write type=\"mesh\"");
  set_primitive(geom, type, model.compiler, element);
}

int integer_of(const UrdfNode& node, std::string_view key, int absent) {
  const double value = node.number_or(key, absent);
  constexpr double largest = 2147483647.0;
  if (value != std::trunc(value) || std::abs(value) > largest)
    node.fail(std::string(key) + "=" + in_quotes(node.text(key)) + " is not an integer");
  return static_cast<int>(value);
}

bool is_transparent(const UrdfNode& geom) {
  if (!geom.has("rgba") || trimmed(*geom.xml().attribute("rgba")).empty()) return false;
  const std::vector<double> rgba = mjcf_numbers(geom, "rgba");
  return rgba.size() == 4 && rgba[3] == 0.0;
}

bool collides(const UrdfNode& geom) {
  return integer_of(geom, "contype", 1) != 0 || integer_of(geom, "conaffinity", 1) != 0;
}

bool is_shown(const UrdfNode& geom) {
  constexpr int last_group_shown = 2;
  return integer_of(geom, "group", 0) <= last_group_shown && !is_transparent(geom);
}

void add_geom(const UrdfNode& node, const Eigen::Isometry3d& T_body_frame,
              const std::string& defaults, UrdfLink& link, MjcfModel& model) {
  UrdfElement element;
  element.place = link.place;
  bool is_collision = true;
  bool is_visual = true;
  try {
    node.expect(mjcf_geom_rule);
    const XmlElement complete = model.defaults.complete(node, defaults, "geom");
    const UrdfNode geom = node.with(complete);
    is_collision = collides(geom);
    is_visual = is_shown(geom);
    set_shape(geom, model, element);
    element.origin = T_body_frame * element.origin;
  } catch (const InputError& error) {
    element.fault = error.what();
  }
  if (!is_collision && !is_visual) ++model.hidden;
  if (is_collision) link.collisions.push_back(element);
  if (is_visual) link.visuals.push_back(std::move(element));
}

/// Adds an element that cannot be drawn.
void add_fault(const UrdfNode& node, UrdfLink& link) {
  UrdfElement element;
  element.place = link.place;
  element.fault = node.place() + ": deformable bodies are not supported";
  link.collisions.push_back(element);
  link.visuals.push_back(std::move(element));
}

void read_range(const UrdfNode& node, const MjcfCompiler& compiler, Joint& joint) {
  if (!node.has("range")) return;
  Eigen::Vector2d range;
  node.numbers("range", {range.data(), 2});
  const bool is_auto = !node.has("limited") || node.text("limited") == "auto";
  const bool is_limited =
      is_auto ? compiler.autolimits && !range.isZero(0.0) : mjcf_flag(node, "limited", false);
  if (!is_limited) return;
  if (range[0] >= range[1]) node.fail("range=" + in_quotes(node.text("range")) + " is empty");
  if (joint.type == JointType::continuous) {
    joint.type = JointType::revolute;
    range *= compiler.angle_unit();
  }
  joint.lower = range[0];
  joint.upper = range[1];
}

/// Sets what hinge and slide joints have.
void read_scalar_joint(const UrdfNode& node, bool is_hinge, const Eigen::Isometry3d& T_body_frame,
                       MjcfModel& model, BodyJoint& out) {
  Joint& joint = out.urdf.joint;
  joint.type = is_hinge ? JointType::continuous : JointType::prismatic;
  const Eigen::Vector3d axis = mjcf_vector(node, "axis", Eigen::Vector3d::UnitZ());
  constexpr double shortest = 1e-9;
  if (axis.stableNorm() < shortest)
    node.fail("axis=" + in_quotes(node.text("axis")) + " has no direction");
  joint.axis = (T_body_frame.linear() * axis.stableNormalized()).normalized();
  out.ref = node.number_or("ref", 0.0) * (is_hinge ? model.compiler.angle_unit() : 1.0);
  if (std::abs(out.ref) > largest_mimic) node.fail("ref lies beyond 1e9");
  model.refs[out.urdf.name] = out.ref;
  read_range(node, model.compiler, joint);
}

BodyJoint read_body_joint(const UrdfNode& unnamed, const std::string& name, const ChildBody& frame,
                          MjcfModel& model) {
  const UrdfNode node = unnamed.named("joint " + in_quotes(name));
  BodyJoint out;
  out.urdf.name = name;
  out.urdf.place = node.place();
  out.urdf.joint.type = JointType::floating;
  if (node.name() == "freejoint") {
    node.expect({"name align", "group"});
    out.is_free = true;
    if (node.has("align") && node.text("align") == "true")
      node.fail("align=\"true\" moves the body's frame; write \"false\"");
    return out;
  }
  node.expect(mjcf_joint_rule);
  const XmlElement complete = model.defaults.complete(node, frame.defaults, "joint");
  const UrdfNode joint = node.with(complete);
  const std::string type = joint.has("type") ? joint.text("type") : "hinge";
  out.is_free = type == "free";
  if (type == "hinge" || type == "slide")
    read_scalar_joint(joint, type == "hinge", frame.T_parent_frame, model, out);
  else if (type == "ball")
    model.balls.push_back(name);
  else if (type != "free")
    joint.fail("unknown type " + in_quotes(type) + "; expected hinge, slide, ball or free");
  // A slide moves alike wherever it is.
  if (type == "hinge" || type == "ball")
    out.anchor = frame.T_parent_frame * mjcf_vector(joint, "pos", Eigen::Vector3d::Zero());
  return out;
}

std::string joint_name(const UrdfNode& node, const std::string& body, std::size_t before) {
  if (node.has("name")) return node.identifier();
  return body + "_joint" + (before == 0 ? "" : std::to_string(before + 1));
}

void connect_fixed(const UrdfLink& body, const std::string& parent, const Eigen::Isometry3d& T,
                   Urdf& urdf) {
  UrdfJoint& joint = urdf.joints.emplace_back();
  joint.name = body.name + "_fixed";
  joint.place = body.place;
  joint.parent = parent;
  joint.child = body.name;
  joint.joint.origin = T;
}

/// Adds the joints between a body and its parent, in order, and links between them.
void connect(const UrdfLink& body, const std::string& parent,
             const Eigen::Isometry3d& T_parent_body, std::vector<BodyJoint> joints, Urdf& urdf) {
  std::string from = parent;
  Eigen::Isometry3d T_from_body = T_parent_body;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    auto& [joint, anchor, ref, is_free] = joints[i];
    const bool is_last = i + 1 == joints.size() && anchor.isZero(0.0);
    joint.parent = from;
    joint.child = is_last ? body.name : body.name + "/" + joint.name;
    if (!is_last) urdf.links.push_back({joint.child, body.place, {}, {}});
    if (!is_free)
      joint.joint.origin =
          T_from_body * Eigen::Translation3d(anchor) * mjcf_motion(joint.joint, -ref);
    T_from_body = Eigen::Translation3d(-anchor);
    from = joint.child;
    urdf.joints.push_back(std::move(joint));
  }
  if (from != body.name) connect_fixed(body, from, T_from_body, urdf);
}

/// Reads what a body or one of its frames contains, in the body's frame.
void read_content(const ChildBody& frame, UrdfLink& link, BodyContent& content, MjcfModel& model,
                  int depth) {
  if (depth > deepest_body)
    frame.node.fail("bodies and frames are nested deeper than " + std::to_string(deepest_body));
  const bool is_world = link.name == "world";
  for (const UrdfNode& child : frame.node.children()) {
    const std::string& name = child.name();
    if (name == "body") content.bodies.push_back({child, frame.T_parent_frame, frame.defaults});
    if (name == "attach" || name == "replicate")
      child.fail("<" + name +
                 "> is not supported; let MuJoCo write the whole model (mj_saveLastXML)");
    if (name == "frame") {
      child.expect(body_rule);
      read_content({child, frame.T_parent_frame * mjcf_pose(child, model.compiler),
                    model.defaults.childclass(child, frame.defaults)},
                   link, content, model, depth + 1);
    }
    if (is_world && (name == "joint" || name == "freejoint"))
      child.fail("the world has no joints; a <body> around it is expected");
    if (name == "joint" || name == "freejoint")
      content.joints.push_back(read_body_joint(
          child, joint_name(child, link.name, content.joints.size()), frame, model));
    const bool is_deformable = name == "composite" || name == "flexcomp";
    if (is_world && (name == "geom" || is_deformable)) ++model.surroundings;
    if (!is_world && name == "geom")
      add_geom(child, frame.T_parent_frame, frame.defaults, link, model);
    if (!is_world && is_deformable) add_fault(child, link);
  }
}

void check_free(const UrdfNode& node, const std::string& parent,
                const std::vector<BodyJoint>& joints) {
  if (!std::ranges::any_of(joints, &BodyJoint::is_free)) return;
  if (parent != "world") node.fail("has a free joint, but only bodies in <worldbody> can be free");
  if (joints.size() > 1) node.fail("has a free joint and others; one joint is expected");
}

void read_body(const ChildBody& place, const std::string& parent, MjcfModel& model, int depth) {
  const std::string name =
      place.node.has("name") ? place.node.identifier() : "body" + std::to_string(model.bodies + 1);
  ++model.bodies;
  const UrdfNode node = place.node.named("body " + in_quotes(name));
  node.expect(body_rule);
  UrdfLink link{name, node.place(), {}, {}};
  BodyContent content;
  read_content(
      {node, Eigen::Isometry3d::Identity(), model.defaults.childclass(node, place.defaults)}, link,
      content, model, depth);
  if (mjcf_flag(node, "mocap", false)) {
    if (!content.joints.empty()) node.fail("a mocap body has no joints");
    BodyJoint& moved = content.joints.emplace_back();
    moved.urdf.name = name + "_joint";
    moved.urdf.place = link.place;
    moved.urdf.joint.type = JointType::floating;
    moved.is_free = true;
  }
  check_free(node, parent, content.joints);
  connect(link, parent, place.T_parent_frame * mjcf_pose(node, model.compiler),
          std::move(content.joints), model.urdf);
  model.urdf.links.push_back(std::move(link));
  for (const ChildBody& child : content.bodies) read_body(child, name, model, depth + 1);
}

}  // namespace

Eigen::Isometry3d mjcf_motion(const Joint& joint, double value) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (joint.type == JointType::prismatic)
    motion.translation() = value * joint.axis;
  else if (joint.type != JointType::floating)
    motion.linear() = Eigen::AngleAxisd(value, joint.axis).toRotationMatrix();
  return motion;
}

void read_mjcf_world(const UrdfNode& worldbody, MjcfModel& model) {
  worldbody.expect({"", "", "body frame geom composite flexcomp attach replicate joint freejoint",
                    "site camera light plugin"});
  BodyContent content;
  read_content({worldbody, Eigen::Isometry3d::Identity(), "main"}, model.urdf.links.front(),
               content, model, 0);
  for (const ChildBody& child : content.bodies) read_body(child, "world", model, 0);
}

}  // namespace penumbra::detail
