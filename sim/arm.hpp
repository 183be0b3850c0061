// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/robot/robot.hpp>

namespace penumbra::sim {

/// The robot as MuJoCo reads it from its URDF. Penumbra's reader only gives the order of links and
/// variables and the mimic joints; its poses are not used.
class Arm {
 public:
  /// Name of the MJCF file in `folder`.
  static constexpr const char* mjcf_file = "arm.xml";

  /// Writes the arm as MJCF and its meshes into `folder`. MuJoCo converts the URDF and keeps all
  /// links separate. MuJoCo reads STL and OBJ files; load_mesh converts other formats to STL.
  /// Throws InputError that names what cannot be read.
  Arm(const std::filesystem::path& urdf, const RobotOptions& options,
      const std::filesystem::path& folder);
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  [[nodiscard]] const Robot& robot() const { return robot_; }

  /// A joint and its value in rad or m (MuJoCo's qpos).
  struct Position {
    std::string joint;
    double value = 0.0;
  };

  /// Returns the values of all moving joints, including mimic joints. `positions` in the order of
  /// Robot::variables().
  [[nodiscard]] std::vector<Position> joint_positions(std::span<const double> positions) const;

  /// Returns the centres of the arm's drawn parts in the root link's frame, metres, without those
  /// of the root link.
  [[nodiscard]] std::vector<Eigen::Vector3d> part_centres(std::span<const double> positions);

  /// A box that contains a drawn part.
  struct PartBox {
    Eigen::Isometry3d T_root_box = Eigen::Isometry3d::Identity();  ///< pose of its centre
    Eigen::Vector3d half = Eigen::Vector3d::Zero();                ///< half edges, metres

    /// Returns the distance of a point in the root link's frame, metres; 0 inside.
    [[nodiscard]] double distance(const Eigen::Vector3d& point) const;
  };

  /// Returns boxes around all drawn parts, including those of the root link.
  [[nodiscard]] std::vector<PartBox> part_boxes(std::span<const double> positions);

  /// Returns the pose of link `link` in the root link's frame.
  [[nodiscard]] Eigen::Isometry3d link_pose(std::span<const double> positions,
                                            const std::string& link);

  /// Returns positions near `start` and within the joint limits that bring link `link` to a pose in
  /// the root link's frame, or as near as found.
  [[nodiscard]] std::vector<double> reach(const Eigen::Isometry3d& T_root_link,
                                          const std::string& link, std::vector<double> start);

 private:
  struct Model;
  void set(std::span<const double> positions);

  Robot robot_;
  std::unique_ptr<Model> model_;
};

}  // namespace penumbra::sim
