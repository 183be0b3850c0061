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

/// What a link carries that the URDF lacks: a tool, a cable, a cover.
struct ExtraMesh {
  std::string link;            ///< its name; no pattern
  std::filesystem::path mesh;  ///< in the link's frame, metres
};

/// What of a URDF is drawn, and where its files are. Link patterns are globs (*, ?, [a-z]); where
/// several say different things of a link, a plain name goes before patterns, and two patterns are
/// an error, as is a pattern that matches no link.
struct RobotOptions {
  std::map<std::string, std::filesystem::path> packages = {};  ///< package://NAME -> folder
  Geometry geometry = Geometry::collision;
  std::map<std::string, Geometry> geometry_of_links = {};  ///< pattern -> in place of `geometry`
  bool geometry_fallback = false;  ///< take the other geometry for a link that lacks the chosen one
  std::vector<std::string> ignore_links = {};  ///< patterns of links that are not drawn
  std::vector<std::string> only_links = {};    ///< if not empty: patterns of the links drawn
  std::map<std::string, double> margins = {};  ///< pattern -> surface offset, metres, -1 to 1
  std::vector<ExtraMesh> extra = {};  ///< drawn with their links, whatever else is drawn of them

  /// Go on without meshes that cannot be read and without links that have only the other geometry:
  /// their links are missing, in the report and in every frame.
  bool allow_missing_meshes = false;
};

/// What became of a link's geometry.
struct LinkReport {
  std::string link;
  bool drawn = false;
  bool missing = false;  ///< it has geometry that should be drawn and is not (allow_missing_meshes)
  std::string fault;     ///< of a mesh that could not be read: file, line and reason; else empty
  std::string reason;    ///< why it is not drawn, or what was chosen; one line
  std::vector<std::string> sources;  ///< each element's file or primitive
  std::size_t triangles = 0;
  bool watertight = false;     ///< every mesh of the link is, before margins
  double margin = 0.0;         ///< metres
  Eigen::AlignedBox3d bounds;  ///< in the link's frame, metres; empty if not drawn
  double load_ms = 0.0;
};

enum class JointType { revolute, continuous, prismatic, fixed, planar, floating };

/// The type's name in a URDF.
[[nodiscard]] std::string_view to_string(JointType type);

/// A joint of the tree. Its frame is the child link's frame at position 0.
struct Joint {
  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0;                                    ///< link index
  std::size_t child = 0;                                     ///< link index
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< T_parent_joint
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();           ///< unit, in the joint's frame
  std::optional<double> lower, upper;  ///< limits of revolute and prismatic joints, rad or m
  std::optional<double> velocity;      ///< limit, rad/s or m/s, above 0

  /// First of this joint's values in the position vector; not set for a fixed joint. A mimicking
  /// joint's value is multiplier * positions[variable] + offset, chains folded.
  std::optional<std::size_t> variable;
  double multiplier = 1.0;
  double offset = 0.0;
  bool mimics = false;
};

/// The axes of a planar joint, in the joint's frame: x and y in the columns 0 and 1, which span the
/// plane, and the unit normal. They are the frame's own x, y and z turned by the smallest rotation
/// that takes z to the normal; where the normal's z is negative, by half a turn about x and then by
/// the smallest rotation that takes -z to the normal.
[[nodiscard]] Eigen::Matrix3d plane_axes(const Eigen::Vector3d& normal);

/// A URDF's links, joints and geometry, ready to be posed. Immutable, and shared by its
/// copies, which are cheap and may be used by several threads.
class Robot {
 public:
  /// Reads a URDF and its meshes. Throws InputError naming file, line and element for anything that
  /// is neither understood nor known to be irrelevant, for a mesh that cannot be read, and for
  /// links that have geometry, but none of the chosen kind.
  [[nodiscard]] static Robot load(const std::filesystem::path& urdf,
                                  const RobotOptions& options = {});

  /// The same from text; relative mesh paths start at `folder`.
  [[nodiscard]] static Robot parse(std::string_view xml, const std::filesystem::path& folder,
                                   const RobotOptions& options = {});

  Robot(const Robot&);
  Robot(Robot&&) noexcept;
  Robot& operator=(const Robot&);
  Robot& operator=(Robot&&) noexcept;
  ~Robot();

  [[nodiscard]] const std::string& name() const;

  /// Link names in an order in which parents stand before children; index 0 is the root.
  [[nodiscard]] std::span<const std::string> links() const;
  [[nodiscard]] std::optional<std::size_t> find_link(std::string_view name) const;

  /// In the order of the links: joints()[i].child == i + 1.
  [[nodiscard]] std::span<const Joint> joints() const;

  /// Names of the independent position values: joint names for one value; NAME/x, NAME/y, NAME/yaw
  /// for planar, NAME/x .. NAME/qw for floating joints. Mimicking joints have none.
  [[nodiscard]] std::span<const std::string> variables() const;
  [[nodiscard]] std::optional<std::size_t> find_variable(std::string_view name) const;

  /// Positions of every variable at rest: 0, and the unit quaternion.
  [[nodiscard]] std::vector<double> rest_positions() const;

  /// Triangles of link i in its own frame, margins included; empty if it is not drawn.
  [[nodiscard]] std::span<const PreparedMesh> meshes(std::size_t link) const;

  [[nodiscard]] std::span<const LinkReport> report() const;

  /// What a user should know though nothing is wrong, a line each: where a package was found that
  /// was not given ("package NAME: taken from ..."), what is odd about mesh files, which links are
  /// so small that their unit is in doubt, and, where missing meshes are allowed, which have
  /// geometry, but none of the chosen kind, and so are missing.
  [[nodiscard]] std::span<const std::string> notes() const;

  /// Poses T_root_link of every link. `positions` in the order of variables(), rad and m, within
  /// +-1e9; T_root_link one per link. Planar joints move by x and y in their plane (plane_axes) and
  /// turn by yaw about its normal. Quaternions are normalised. Allocates nothing. Throws
  /// std::invalid_argument for anything else, so that no pose is ever made up.
  void forward_kinematics(std::span<const double> positions,
                          std::span<Eigen::Isometry3d> T_root_link) const;

 private:
  struct Model;
  static std::unique_ptr<const Model> make_model(std::string_view xml, const std::string& file,
                                                 const std::filesystem::path& folder,
                                                 const RobotOptions& options);
  explicit Robot(std::unique_ptr<const Model> model);
  std::shared_ptr<const Model> model_;
};

}  // namespace penumbra
