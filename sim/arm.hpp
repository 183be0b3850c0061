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

/// The robot as MuJoCo reads it from its URDF. Penumbra's own reader only tells the order of links
/// and variables and which joints mimic which; its poses have no part in this.
class Arm {
 public:
  /// Name of the MJCF file that `folder` then holds.
  static constexpr const char* mjcf_file = "arm.xml";

  /// Writes into `folder` the arm as MJCF, made by MuJoCo from the URDF with all links kept apart,
  /// and its meshes. STL and OBJ files are MuJoCo's to read; others are turned into STL by
  /// load_mesh, as MuJoCo reads none of them. Throws InputError naming what cannot be read.
  Arm(const std::filesystem::path& urdf, const RobotOptions& options,
      const std::filesystem::path& folder);
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  [[nodiscard]] const Robot& robot() const { return robot_; }

  /// A joint and its value, rad or m: what MuJoCo calls qpos.
  struct Position {
    std::string joint;
    double value = 0.0;
  };

  /// Values of every moving joint, mimicking ones included. `positions` in the order of
  /// Robot::variables().
  [[nodiscard]] std::vector<Position> joint_positions(std::span<const double> positions) const;

  /// Centres of the arm's drawn parts in the root link's frame, metres; the root link's own are
  /// left out.
  [[nodiscard]] std::vector<Eigen::Vector3d> part_centres(std::span<const double> positions);

  /// A box that holds one drawn part.
  struct PartBox {
    Eigen::Isometry3d T_root_box = Eigen::Isometry3d::Identity();  ///< of its centre
    Eigen::Vector3d half = Eigen::Vector3d::Zero();                ///< half edges, metres

    /// Of a point in the root link's frame, metres; 0 inside.
    [[nodiscard]] double distance(const Eigen::Vector3d& point) const;
  };

  /// Boxes about all drawn parts, the root link's too.
  [[nodiscard]] std::vector<PartBox> part_boxes(std::span<const double> positions);

  /// Pose of link `link` in the root link's frame.
  [[nodiscard]] Eigen::Isometry3d link_pose(std::span<const double> positions,
                                            const std::string& link);

  /// Positions near `start`, within the joints' limits, that bring link `link` to a pose in the
  /// root link's frame, or as near as can be found.
  [[nodiscard]] std::vector<double> reach(const Eigen::Isometry3d& T_root_link,
                                          const std::string& link, std::vector<double> start);

 private:
  struct Model;
  void set(std::span<const double> positions);

  Robot robot_;
  std::unique_ptr<Model> model_;
};

}  // namespace penumbra::sim
