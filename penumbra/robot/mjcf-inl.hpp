// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/robot/urdf-inl.hpp>
#include <penumbra/robot/urdf_node-inl.hpp>

namespace penumbra::detail {

/// Reads an MJCF, MuJoCo's XML (https://mujoco.readthedocs.io/en/stable/XMLreference.html), as the
/// links and joints of a URDF. Relative paths start at `folder`, as in MuJoCo.
///
/// - The root link is "world". A link's frame is its body's frame, and a joint's value is MuJoCo's
///   qpos: 0 is not the pose of the file for a joint with `ref`. A free joint (or mocap body)
///   floats in the world: at 0 its body is at the world's origin, not at the body's pos.
/// - Body number N of the file has the name bodyN if it has none. A joint without a name is called
///   BODY_joint, the second one of a body BODY_joint2. A body with several joints, or with a joint
///   away from its origin, has links BODY/JOINT between them, without geometry, and the joint
///   BODY_fixed if the last of them is not the body.
/// - A ball joint is a floating joint; its x, y and z must be 0.
/// - Equality constraints of two joints mimic if they are linear. All others are not enforced.
/// - A geom is collision geometry if its contype or conaffinity is not 0, and visual geometry if
/// its
///   group is at most 2 (MuJoCo's viewer shows those) and its rgba is not transparent. It can be
///   both. Geoms of the world itself are the robot's surroundings and are left out.
///
/// Throws InputError as read_urdf() does; faults of geoms are stored in the element instead.
[[nodiscard]] Urdf read_mjcf(XmlElement root, const std::filesystem::path& folder);

/// What <compiler> says.
struct MjcfCompiler {
  bool degrees = true;
  bool autolimits = true;
  bool strippath = false;
  std::string eulerseq = "xyz";
  std::filesystem::path meshes;  // folder

  [[nodiscard]] double angle_unit() const { return degrees ? std::numbers::pi / 180.0 : 1.0; }
};

/// The attributes that elements take from classes of <default>.
class MjcfDefaults {
 public:
  /// Reads a <default> of the file. All of these are of the class "main".
  void read(const UrdfNode& section);

  /// Returns the class of an element's children: its own childclass, or the parent's.
  [[nodiscard]] std::string childclass(const UrdfNode& node, const std::string& parent) const;

  /// Returns an element with the attributes that it lacks from its class, or from `childclass`.
  /// `kind`: the element's name in <default>.
  [[nodiscard]] XmlElement complete(const UrdfNode& node, const std::string& childclass,
                                    const std::string& kind) const;

 private:
  using Elements = std::map<std::string, XmlElement>;  // by kind
  void read(const UrdfNode& section, const std::string& name, Elements elements);

  std::map<std::string, Elements> classes_{{"main", {}}};
  std::set<std::string> other_names_of_main_;
};

inline constexpr ElementRule mjcf_geom_rule = {
    "name class type contype conaffinity group size fromto pos quat axisangle xyaxes zaxis euler "
    "mesh hfield rgba",
    "condim priority material friction mass density shellinertia solmix solref solimp margin gap "
    "surfacevel adhesion fitscale fluidshape fluidcoef user",
    "", "plugin"};
inline constexpr ElementRule mjcf_joint_rule = {
    "name class type pos axis range limited ref",
    "group springdamper actuatorfrclimited solreflimit solimplimit solreffriction solimpfriction "
    "stiffness actuatorfrcrange actuatorgravcomp margin springref armature damping frictionloss "
    "user"};
inline constexpr ElementRule mjcf_mesh_rule = {
    "name class file refpos refquat scale vertex builtin",
    "content_type normal texcoord face smoothnormal maxhullvert inertia params material exclusive",
    "", "plugin"};

/// Returns the value of an attribute that is "true" or "false".
[[nodiscard]] bool mjcf_flag(const UrdfNode& node, std::string_view key, bool absent);

/// Returns the numbers of an attribute.
[[nodiscard]] std::vector<double> mjcf_numbers(const UrdfNode& node, std::string_view key);

[[nodiscard]] Eigen::Vector3d mjcf_vector(const UrdfNode& node, std::string_view key,
                                          const Eigen::Vector3d& absent);

/// Returns a rotation from w, x, y, z of any length but 0.
[[nodiscard]] Eigen::Quaterniond mjcf_quaternion(const UrdfNode& node, std::string_view key);

/// Returns the smallest rotation from z to a direction; half a turn about x for -z.
[[nodiscard]] Eigen::Quaterniond mjcf_rotation_to(const UrdfNode& node,
                                                  const Eigen::Vector3d& direction);

/// Returns an element's pos and orientation.
[[nodiscard]] Eigen::Isometry3d mjcf_pose(const UrdfNode& node, const MjcfCompiler& compiler);

/// A mesh of <asset>.
struct MjcfMesh {
  UrdfMesh mesh;
  std::string fault;  // why it cannot be drawn; empty if it can
};

/// A file while it is read.
struct MjcfModel {
  MjcfCompiler compiler;
  MjcfDefaults defaults;
  std::map<std::string, MjcfMesh> meshes;
  Urdf urdf;
  std::map<std::string, double> refs;  // of each hinge and slide joint
  std::size_t bodies = 0;
  std::size_t surroundings = 0;    // geoms of the world
  std::size_t hidden = 0;          // geoms that are neither collision nor visual geometry
  std::vector<std::string> balls;  // names of ball joints
};

/// Reads the content of <worldbody>.
void read_mjcf_world(const UrdfNode& worldbody, MjcfModel& model);

/// Returns what a hinge or slide joint does at a value.
[[nodiscard]] Eigen::Isometry3d mjcf_motion(const Joint& joint, double value);

}  // namespace penumbra::detail
