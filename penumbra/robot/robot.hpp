// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

enum class Geometry { collision, visual };

/// A part of a link that the URDF lacks: a tool, a cable, a cover.
struct ExtraMesh {
  std::string link;            ///< a name, not a pattern
  std::filesystem::path mesh;  ///< in the link's frame, metres
};

/// Which geometry of a URDF is drawn, and where its files are. Link patterns are globs (*, ?,
/// [a-z]). A plain name overrides patterns. Two patterns with different values for a link are an
/// error, and so is a pattern that matches no link.
struct RobotOptions {
  std::map<std::string, std::filesystem::path> packages = {};  ///< package://NAME -> folder
  std::map<std::string, std::string> arguments = {};           ///< of a xacro file, name -> value
  /// Null: collision, and visual for links that have no other, which a note lists.
  std::optional<Geometry> geometry = {};
  std::map<std::string, Geometry> geometry_of_links = {};  ///< pattern -> overrides `geometry`
  bool geometry_fallback = false;  ///< use the other geometry for links that lack the chosen one,
                                   ///< without a note
  std::vector<std::string> ignore_links = {};  ///< patterns of links that are not drawn
  std::vector<std::string> only_links = {};    ///< if not empty: patterns of the links drawn
  std::map<std::string, double> margins = {};  ///< pattern -> surface offset, metres, -1 to 1
  std::vector<ExtraMesh> extra = {};           ///< drawn even if their links are not

  /// Joint -> position at which it is held, rad or m: it and the joints that mimic it do not move.
  std::map<std::string, double> joints = {};

  /// Continue without meshes that cannot be read and links that lack the chosen geometry: these
  /// links are missing, in the report and in every frame.
  bool allow_missing_meshes = false;
};

/// How a link's geometry was loaded.
struct LinkReport {
  std::string link;
  bool drawn = false;
  bool missing = false;  ///< some of its geometry could not be drawn (allow_missing_meshes)
  std::string fault;     ///< file, line and reason of a mesh that could not be read; else empty
  std::string reason;    ///< why it is not drawn, or which geometry was chosen; one line
  std::vector<std::string> sources;  ///< each element's file or primitive
  std::size_t triangles = 0;
  bool watertight = false;     ///< whether every mesh of the link is, before margins
  double margin = 0.0;         ///< metres
  Eigen::AlignedBox3d bounds;  ///< in the link's frame, metres; empty if not drawn
  double load_ms = 0.0;
};

enum class JointType { revolute, continuous, prismatic, fixed, planar, floating };

/// Returns the type's name in a URDF.
[[nodiscard]] std::string_view to_string(JointType type);

/// A joint. Its frame is the child link's frame at position 0.
struct Joint {
  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0;                                    ///< link index
  std::size_t child = 0;                                     ///< link index
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< T_parent_joint
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< unit, in the joint's frame
  std::optional<double> lower, upper;  ///< limits of revolute and prismatic joints, rad or m
  std::optional<double> velocity;      ///< limit, rad/s or m/s, above 0

  /// Index of the joint's first value in the position vector; not set for a fixed joint. A
  /// mimicking joint's value is multiplier * positions[variable] + offset, with chains resolved.
  std::optional<std::size_t> variable;
  double multiplier = 1.0;
  double offset = 0.0;
  bool mimics = false;
  bool is_held = false;  ///< fixed by RobotOptions::joints, although it moves by the URDF
};

/// Returns the axes of a planar joint, in the joint's frame: x, y and the unit normal of the plane.
/// They are the frame's axes rotated by the smallest rotation from z to the normal. If the normal's
/// z is negative: by half a turn about x and then by the smallest rotation from -z to the normal.
[[nodiscard]] Eigen::Matrix3d plane_axes(const Eigen::Vector3d& normal);

struct PlacedRobot;

/// One of several robots: its links and variables, first <= index < end.
struct RobotPart {
  std::string name;
  std::size_t first_link, end_link;
  std::size_t first_variable, end_variable;
};

/// The links, joints and geometry of a URDF, xacro or MJCF. Immutable: copies are cheap, share
/// their data and may be used by several threads.
class Robot {
 public:
  static constexpr double max_position = 1e9;  ///< rad or m, keeps every pose finite

  /// Reads a URDF, a xacro file or an MJCF (docs/recording.md says how), and its meshes. Throws
  /// InputError that names file, line and element for one that cannot be drawn correctly, for a
  /// mesh that cannot be read, and for links that have only the other kind than the chosen
  /// geometry.
  [[nodiscard]] static Robot load(const std::filesystem::path& urdf,
                                  const RobotOptions& options = {});

  /// Reads such a text. Relative mesh paths start at `folder`.
  [[nodiscard]] static Robot parse(std::string_view xml, const std::filesystem::path& folder,
                                   const RobotOptions& options = {});

  /// Joins several robots to one, so that they hide and are judged together. Its root link is
  /// "world"; link, joint and variable NAME of robot ROBOT is called ROBOT/NAME. Throws InputError
  /// for no robots, a name that is empty, doubled or contains '/', and a pose that is not rigid.
  [[nodiscard]] static Robot join(std::span<const PlacedRobot> robots);
  /// The joined robots; empty for the robot of one URDF.
  [[nodiscard]] std::span<const RobotPart> parts() const;
  /// Returns the part of a link; null for the world and for the robot of one URDF.
  [[nodiscard]] const RobotPart* part_of(std::size_t link) const;

  [[nodiscard]] const std::string& name() const;

  /// The file that load() read; empty for the robots of parse() and join().
  [[nodiscard]] const std::filesystem::path& urdf() const;
  /// As they were given to load() or parse(); the defaults for the robot of join().
  [[nodiscard]] const RobotOptions& options() const;

  /// Link names, parents before children; index 0 is the root.
  [[nodiscard]] std::span<const std::string> links() const;
  [[nodiscard]] std::optional<std::size_t> find_link(std::string_view name) const;

  /// In the order of the links: joints()[i].child == i + 1.
  [[nodiscard]] std::span<const Joint> joints() const;

  /// Names of the independent position values: joint names for one value; NAME/x, NAME/y, NAME/yaw
  /// for planar, NAME/x .. NAME/qw for floating joints. Mimicking joints have none.
  [[nodiscard]] std::span<const std::string> variables() const;
  [[nodiscard]] std::optional<std::size_t> find_variable(std::string_view name) const;

  /// Returns the rest positions of all variables: 0, and the identity quaternion.
  [[nodiscard]] std::vector<double> rest_positions() const;

  /// The meshes of a link in its frame, margins included; empty if it is not drawn.
  [[nodiscard]] std::span<const PreparedMesh> meshes(std::size_t link) const;

  [[nodiscard]] std::span<const LinkReport> report() const;

  /// Remarks, one line each: unknown content of the URDF, where a package was found that was not
  /// given ("package NAME: taken from ..."), links so small that their unit may be wrong, links
  /// that are drawn by visual geometry because they have no other, and links that are missing
  /// because they lack the chosen one.
  [[nodiscard]] std::span<const std::string> notes() const;

  /// Computes the pose T_root_link of every link. `positions` are in the order of variables(), rad
  /// and m, within +-max_position. Planar joints move by x and y in their plane (plane_axes) and
  /// turn by yaw about its normal. Quaternions are normalised. Allocates nothing. Throws
  /// std::invalid_argument for wrong sizes and invalid positions.
  void forward_kinematics(std::span<const double> positions,
                          std::span<Eigen::Isometry3d> T_root_link) const;

 private:
  struct Model;
  static std::unique_ptr<Model> make_model(std::string_view xml, const std::string& file,
                                           const std::filesystem::path& folder,
                                           const RobotOptions& options);
  explicit Robot(std::unique_ptr<Model> model);
  std::shared_ptr<const Model> model_;
};

/// A robot and its place in the world.
struct PlacedRobot {
  std::string name;
  Robot robot;
  Eigen::Isometry3d T_world_root = Eigen::Isometry3d::Identity();
};

/// Returns the link that carries a camera; the root for an empty name. Throws InputError for an
/// unknown name.
[[nodiscard]] std::size_t find_camera_parent(const Robot& robot, const std::string& name);

}  // namespace penumbra
