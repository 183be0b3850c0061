// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/png.hpp>
#include <sim/two_arms.hpp>

namespace penumbra::sim {

/// The noise of a stereo camera's depth. All zero: the true depth, rounded to millimetres.
struct DepthNoise {
  /// sigma = quadratic * z^2, metres per square metre. Patches of 8 pixels, about a matching
  /// window, share half of the variance. A stereo camera has the same disparity error at every
  /// depth, so its depth error is error / (fx * baseline) * z^2.
  double quadratic = 0.0;
  /// The disparity step in pixels; 0: not quantised. D400 cameras resolve 1/32 pixel (Intel,
  /// "Subpixel linearity improvement for Intel RealSense depth camera D400 series").
  double disparity_step = 0.0;
  double baseline = 0.055;  ///< metres; with fx it converts disparity to depth
  double edge_holes = 0.0;  ///< fraction of the pixels at depth edges without measurement
  /// Fraction of these pixels with a depth between the two sides, uniform in disparity ("points
  /// between two planes", librealsense issue 4346).
  double edge_mixed = 0.0;
  double edge_width = 2.0;  ///< width of an edge in pixels, at most 20
  double holes = 0.0;       ///< fraction of all pixels in round patches without measurement

  /// Returns noise like an Intel RealSense D415's. Baseline and disparity step are Intel's;
  /// `quadratic` is for a disparity error of 0.08 pixels; the fractions of edges and holes are
  /// assumptions, not fitted to a recording.
  [[nodiscard]] static DepthNoise d415() {
    DepthNoise noise;
    noise.quadratic = 0.0016;
    noise.disparity_step = 1.0 / 32.0;
    noise.edge_holes = 0.35;
    noise.edge_mixed = 0.25;
    noise.holes = 0.003;
    return noise;
  }
};

/// The options of a simulation.
struct SimulationOptions {
  std::uint64_t seed = 0;
  DepthNoise depth = DepthNoise::d415();
  double joint_sigma = 0.0;    ///< standard deviation of the reported joint positions, radians
  double joint_latency = 0.0;  ///< seconds by which reported joints are older than their stamps
  double belt_jitter = 0.0;    ///< standard deviation of the belt's speed, relative; conveyor only
  bool color = true;           ///< false: not drawn, which saves a third of the time
  /// Which of a scene's three cameras is drawn, 0 to 2. Camera 0 is the scene's own; the others
  /// stand 120 and 240 degrees from it around the base's z axis. The scene moves alike for all.
  int camera = 0;
  bool second_camera = false;  ///< adds a depth camera on the other side
  double duration = 0.0;       ///< seconds; 0: the scene's own duration
  double frame_rate = 30.0;
};

/// The shape of an object, as targets describe it.
enum class Solid { other, box, ball, wedge };
struct ObjectSolid {
  Solid kind = Solid::other;
  /// Metres, centred at the object's origin: the edges of a box, or a ball's diameter three times.
  /// A wedge is the half of that box with x / size.x() + y / size.y() <= 0.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// An object with a pose that targets are made of: the textured object, the wrist, a person's body.
struct ObjectTruth {
  std::string name;
  std::int32_t id = 0;  ///< id in `ids`
  Eigen::Isometry3d T_base_object = Eigen::Isometry3d::Identity();
  std::size_t pixels_alone = 0;  ///< pixels that it covers without occluders, inside the image
  std::size_t pixels_seen = 0;   ///< pixels that it covers
  std::size_t pixels_behind_robot = 0;  ///< of pixels_alone, those behind a robot link; the other
                                        ///< hidden pixels are behind objects
  Image<std::uint8_t> alone;            ///< 1 where it is visible without occluders, else 0
  Image<float> alone_depth;             ///< metres where `alone` is 1, else 0
  ObjectSolid solid;                    ///< known in the scene `random` only
};

/// A simulated frame with its truth. Depth is along the optical axis.
struct SimFrame {
  std::int64_t stamp = 0;  ///< nanoseconds
  Image<Rgb8> color;
  Image<std::uint16_t> depth;  ///< measured millimetres, 0 = no measurement
  Image<float> true_depth;     ///< metres
  Image<std::int32_t> ids;     ///< visible ids: 0 nothing, 1 + link index of robot links (order of
                               ///< Robot::links()), first_object_id + i of objects
  Image<std::int32_t> robot_ids;      ///< like ids, with the robot alone
  Image<float> robot_depth;           ///< metres, with the robot alone; 0 without robot
  Image<std::uint16_t> second_depth;  ///< of the second camera; empty without one
  std::vector<double> true_joints;    ///< order of Robot::variables()
  std::vector<double> joints;  ///< reported positions, with the noise and latency of the options
  std::vector<ObjectTruth> objects;
};

inline constexpr std::int32_t first_object_id = 10000;

/// A moving scene. MuJoCo places and draws it; Penumbra's renderer and kinematics are not used. The
/// same scene, options and seed give the same frames. Several simulations may run in parallel, each
/// in one thread at a time. The arm's geometry is its URDF's visual geometry; the shipped arm's
/// collision geometry is the same.
class Simulation {
 public:
  /// Returns the names of the scenes: conveyor, handover, random (targets in front of, behind and
  /// next to the arm), carry (the same, with an object "held" in the gripper), two_arms (the same,
  /// with two arms that cross).
  [[nodiscard]] static const std::vector<std::string>& scenes();

  /// Throws InputError for an unknown scene, invalid options, or a machine without OpenGL; the
  /// message then says what to install.
  Simulation(const std::string& scene, const SimulationOptions& options);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Draws the next frame. Returns false at the end of the scene. The images of `frame` are reused.
  bool next(SimFrame& frame);

  /// Skips frames without drawing them. Later frames are the same as without skipping.
  void skip(std::size_t frames);
  [[nodiscard]] std::size_t frames() const;  ///< number of frames of the scene

  [[nodiscard]] const std::filesystem::path& urdf() const;  ///< URDF of the robot, or of each arm
  /// The places of several arms; empty for one. Their world is the base frame below.
  [[nodiscard]] const std::vector<ArmPlace>& arms() const;
  /// The robot as Penumbra reads it, visual geometry; of several arms one URDF with a link "world",
  /// whose names are as Robot::join makes them.
  [[nodiscard]] const Robot& robot() const;
  /// Colour and depth, aligned; also the second camera's.
  [[nodiscard]] const Camera& camera() const;
  [[nodiscard]] const Eigen::Isometry3d& T_base_camera() const;
  [[nodiscard]] const Eigen::Isometry3d& T_base_second_camera() const;

  /// Returns the image on the front (+z face, u along +x) of the textured object.
  [[nodiscard]] const Image<Rgb8>& model_image() const;
  /// Returns the size in metres of a box around the object's origin.
  [[nodiscard]] Eigen::Vector3d object_size() const;
  [[nodiscard]] Eigen::Vector3d conveyor_direction() const;  ///< unit, base frame
  [[nodiscard]] double duration() const;                     ///< seconds
  [[nodiscard]] bool is_whole() const;  ///< the duration reaches the scene's own end
  /// Returns the time of the grasp in the scene `conveyor`.
  [[nodiscard]] std::optional<std::int64_t> grasp_stamp() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::sim
