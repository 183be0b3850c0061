// SPDX-License-Identifier: Apache-2.0
// Robots of primitives in a room, and what lidars measure of them by MuJoCo's rays.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

#include <sim/mujoco_handles.hpp>
#include <sim/random.hpp>

namespace penumbra::test {

/// A primitive in its link's frame: "box" with its edges; "cylinder", "capsule" or "sphere" with
/// radius and, without the capsule's ends, length.
struct LidarShape {
  std::string kind;
  Eigen::Vector3d size;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();  ///< about fixed axes, as in a URDF
};

struct LidarLink {
  std::string name, parent;  ///< of the root: empty
  Eigen::Vector3d at;        ///< in the parent's frame
  Eigen::Vector3d axis;      ///< of its joint; zero: fixed
  double centre = 0.0;       ///< position that the joint moves around, rad
  std::vector<LidarShape> shapes = {};
};

/// Links in the order of a URDF. What is no part of the robot but only of its room: `furniture`.
struct LidarRobot {
  std::string name;
  std::vector<LidarLink> links;
  std::vector<LidarShape> furniture = {};

  [[nodiscard]] std::string urdf() const;
  /// `objects`: geoms that stand around it.
  [[nodiscard]] std::string mjcf(std::span<const LidarShape> objects) const;
};

/// Arms of six axes on a table, their bases 0.9 m apart.
[[nodiscard]] LidarRobot lidar_arms(std::size_t count);
/// 12 joints in its legs, 2 in its head.
[[nodiscard]] LidarRobot lidar_quadruped();

/// A ray in the sensor's frame, and its time from the scan's begin, seconds.
struct LidarRay {
  Eigen::Vector3d direction;
  double time;
};
/// Elevations between -half_height and half_height, radians. A turn about z takes 100 ms.
[[nodiscard]] std::vector<LidarRay> spinning_lidar(int beams, int columns, double half_height);
/// 20,000 points in 100 ms, all around and -7 to 52 degrees high, others in every scan.
[[nodiscard]] std::vector<LidarRay> rosette_lidar(std::size_t scan);
/// 270 degrees around x in steps of 0.25 degrees, in 25 ms.
[[nodiscard]] std::vector<LidarRay> plane_scanner();

struct LidarMount {
  std::string parent;  ///< link
  Eigen::Isometry3d T_parent_sensor;
};

/// Positions in the order of Robot::variables() at a time in seconds.
using JointMotion = std::function<std::vector<double>(double)>;
enum class Wave { sine, triangle };
/// All joints at most 0.5 rad from their centres, and at most 2 rad/s fast. A triangle's speed
/// jumps from 2 to -2 rad/s.
[[nodiscard]] JointMotion lidar_motion(const LidarRobot& robot, const Robot& loaded, Wave wave,
                                       std::uint64_t seed);

/// `veil`: the beam meets the robot and its room; it returns a mixture of both ranges.
/// `other_veil`: one that is before the robot, or farther behind it than CloudRule's default for
/// `mixing`.
enum class LidarTruth : std::uint8_t { dropped, robot, room, veil, other_veil };

struct LidarPoint {
  LidarTruth truth = LidarTruth::dropped;
  std::uint16_t link = 0;   ///< index + 1 in Robot::links() of a robot point
  bool is_before = false;   ///< a room point whose ray meets the robot behind it
  bool is_next_to = false;  ///< a room point in whose beam, as CloudRule has it, robot is
  bool is_close = false;    ///< a room point at most LidarWorld::close from the robot's surface
};

struct LidarScan {
  std::int64_t stamp = 0, middle = 0;  ///< nanoseconds
  std::vector<std::array<float, 3>> points = {};
  std::vector<std::int32_t> times = {};
  std::vector<LidarPoint> truth = {};
};

/// A robot, a lidar and ten boxes and balls in a room.
class LidarWorld {
 public:
  static constexpr double beam = 0.003;    ///< radians, half of the beam's width
  static constexpr double dropped = 0.01;  ///< fraction of the rays
  static constexpr double close = 0.05;    ///< metres
  static constexpr double veil = 0.02;     ///< metres by which ranges of a mixture differ at least

  LidarWorld(const LidarRobot& robot, LidarMount mount, std::uint64_t seed);

  [[nodiscard]] const Robot& robot() const { return robot_; }
  /// Places the objects before and behind the robot, with a gap of 5 to 50 cm at the time `middle`.
  void place_objects(const JointMotion& motion, double begin, double end);
  /// Casts each ray at its own time. `noise`: standard deviation along the ray, metres.
  [[nodiscard]] LidarScan scan(std::span<const LidarRay> rays, const JointMotion& motion,
                               double begin, double noise);

 private:
  struct Hit {
    double range;
    int geom;  // -1: none
  };
  void pose(const std::vector<double>& positions);
  [[nodiscard]] Hit cast(const Eigen::Vector3d& ray, bool robot_only) const;
  [[nodiscard]] bool is_robot(int geom) const { return geom >= 0 && link_of_[at(geom)] != 0; }
  [[nodiscard]] bool may_meet_robot(const Eigen::Vector3d& ray) const;
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;  // to the robot's surface
  [[nodiscard]] LidarPoint meet(const Eigen::Vector3d& ray, double& range);
  [[nodiscard]] static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  LidarMount mount_;
  Robot robot_;
  sim::ModelPtr model_;
  sim::DataPtr data_;
  sim::Random random_;
  std::vector<int> qpos_;               // address of each variable
  std::vector<std::uint16_t> link_of_;  // of each geom: index + 1; 0: the room
  int body_;                            // that carries the sensor
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
};

/// How the points of scans were labelled. Room points are removed if they are neither clear nor
/// front, for the first reason that holds: next to an outline, before the robot, close to it.
struct LidarScore {
  std::size_t robot = 0, room = 0, veil = 0, other_veil = 0;  ///< points, by the truth
  std::size_t left = 0;         ///< robot points that are clear or front
  std::size_t wrong_links = 0;  ///< robot points that are occluded or beyond
  std::size_t veil_left = 0, other_veil_left = 0;
  std::size_t fringe = 0, before = 0, near = 0, removed = 0;  ///< removed room points
  std::size_t false_measurements = 0;  ///< dropped points with a label, others without

  void add(const LidarScan& scan, const FrameReport& report);
};

/// A scan with the times of its points; both must outlive it.
[[nodiscard]] Frame frame_of(const LidarScan& scan, const JointMotion& motion);

/// Labels a scan. `with_times`: otherwise all points are measured at the scan's middle.
const FrameReport& process(Pipeline& pipeline, const LidarScan& scan, const JointMotion& motion,
                           bool with_times);

}  // namespace penumbra::test
