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

namespace penumbra::sim {

/// A stereo camera's depth as it is measured. All zero: the true depth, rounded to millimetres.
struct DepthNoise {
  /// sigma = quadratic * z^2, metres per square metre. Half of its variance is shared by patches of
  /// about a matching window, 8 pixels. A stereo camera's error in disparity is the same at every
  /// depth, so that its error in depth is error / (fx * baseline) * z^2.
  double quadratic = 0.0;
  /// Pixels: depth is a multiple of it in disparity; 0: not quantised. D400 cameras resolve 1/32
  /// pixel (Intel, "Subpixel linearity improvement for Intel RealSense depth camera D400 series").
  double disparity_step = 0.0;
  double baseline = 0.055;  ///< metres; with fx it turns disparity into depth
  double edge_holes = 0.0;  ///< share of the pixels at depth edges without measurement
  /// Share of them with a depth between the two sides, evenly spread in disparity ("points between
  /// two planes", librealsense issue 4346).
  double edge_mixed = 0.0;
  double edge_width = 2.0;  ///< pixels from an edge, at most 20
  double holes = 0.0;       ///< share of all pixels in round patches without measurement

  /// Like an Intel RealSense D415's. Baseline and disparity step are Intel's; `quadratic` stands
  /// for 0.08 pixels of error in disparity; the shares of edges and holes are assumed, fitted to no
  /// recording.
  [[nodiscard]] static DepthNoise d415();
};

/// What differs between runs of one scene.
struct SimulationOptions {
  std::uint64_t seed = 0;
  DepthNoise depth = DepthNoise::d415();
  double joint_sigma = 0.0;    ///< radians: of the reported joint positions
  double joint_latency = 0.0;  ///< seconds by which reported joints are older than they say
  double belt_jitter = 0.0;    ///< standard deviation of the belt's speed, relative; conveyor
  bool color = true;           ///< false: SimFrame::color stays as it is, which saves a third
  bool second_camera = false;  ///< a depth camera on the other side too
  double duration = 0.0;       ///< seconds; 0: the scene's own
  double frame_rate = 30.0;
};

/// What an object is, as targets can say it.
enum class Solid { other, box, ball };
struct ObjectSolid {
  Solid kind = Solid::other;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< metres: a box's edges, a ball's diameter in
                                                   ///< each; about the object's origin
};

/// A thing with a pose that targets are made of: the textured object, the wrist, a person's body.
struct ObjectTruth {
  std::string name;
  std::int32_t id = 0;  ///< in `ids`
  Eigen::Isometry3d T_base_object = Eigen::Isometry3d::Identity();
  std::size_t pixels_alone = 0;  ///< that it would cover were nothing before it; inside the image
  std::size_t pixels_seen = 0;   ///< that it covers
  std::size_t pixels_behind_robot = 0;  ///< of those alone, where a robot link is before it; of
                                        ///< what is not seen, the rest is behind other objects
  Image<std::uint8_t> alone;            ///< 1 where it would be seen were nothing before it, else 0
  Image<float> alone_depth;             ///< metres, there; else 0
  ObjectSolid solid;                    ///< known in the scene `random` only
};

/// One frame as the simulator knows it. Depth is along the optical axis.
struct SimFrame {
  std::int64_t stamp = 0;  ///< nanoseconds
  Image<io::Rgb8> color;
  Image<std::uint16_t> depth;     ///< millimetres as measured, 0 = nothing
  Image<float> true_depth;        ///< metres
  Image<std::int32_t> ids;        ///< what is seen: 0 nothing, 1 + link index of the robot's links
                                  ///< (order of Robot::links()), first_object_id + i of objects
  Image<std::int32_t> robot_ids;  ///< as ids, were nothing there but the robot
  Image<float> robot_depth;       ///< metres, likewise; 0 where no robot is
  Image<std::uint16_t> second_depth;  ///< of the second camera; empty without it
  std::vector<double> true_joints;    ///< order of Robot::variables()
  std::vector<double> joints;         ///< as reported: noisy and late as the options say
  std::vector<ObjectTruth> objects;
};

inline constexpr std::int32_t first_object_id = 10000;

/// A scene that moves, placed and drawn by MuJoCo: nothing of Penumbra's renderer and kinematics
/// has a part in it. The same scene, options and seed give the same frames. Several may be used
/// side by side, each by one thread at a time. The arm's geometry is its URDF's visual geometry;
/// the shipped arm's collision geometry is the same.
class Simulation {
 public:
  /// Names of the scenes: conveyor, handover, random (targets before, behind and beside the arm).
  [[nodiscard]] static const std::vector<std::string>& scenes();

  /// Throws InputError for a scene that is not known, options that make no sense, or a machine
  /// without OpenGL, and says what to install.
  Simulation(const std::string& scene, const SimulationOptions& options);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// The next frame; false where the scene has ended. `frame`'s images are reused.
  bool next(SimFrame& frame);

  /// Leaves out frames without drawing them; those that follow are as if they had been drawn.
  void skip(std::size_t frames);
  [[nodiscard]] std::size_t frames() const;  ///< that the scene has

  [[nodiscard]] const std::filesystem::path& urdf() const;  ///< of the robot in the scene
  [[nodiscard]] const Robot& robot() const;    ///< as Penumbra reads it, visual geometry
  [[nodiscard]] const Camera& camera() const;  ///< colour and depth, aligned
  [[nodiscard]] const Eigen::Isometry3d& T_base_camera() const;
  [[nodiscard]] const Camera& second_camera() const;
  [[nodiscard]] const Eigen::Isometry3d& T_base_second_camera() const;

  /// The image on the textured object's front and its size, metres: what a pose estimator knows.
  [[nodiscard]] const Image<io::Rgb8>& model_image() const;
  [[nodiscard]] Eigen::Vector3d object_size() const;  ///< a box about the object's origin; the
                                                      ///< image is on its +z face, u along +x
  [[nodiscard]] Eigen::Vector3d conveyor_direction() const;  ///< unit, base frame
  [[nodiscard]] double duration() const;                     ///< seconds
  [[nodiscard]] bool is_whole() const;  ///< the scene comes to its own end in that time
  [[nodiscard]] std::optional<std::int64_t> grasp_stamp() const;  ///< of the conveyor scene

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::sim
