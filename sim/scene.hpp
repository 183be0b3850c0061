// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

#include <io/files/png.hpp>
#include <sim/arm.hpp>
#include <sim/numbers.hpp>
#include <sim/simulation.hpp>

namespace penumbra::sim {

/// A rigid part of a scene other than the arm. Its pose is set in every frame.
struct ScenePart {
  int object = -1;    ///< the index of its object; -1: background
  std::string geoms;  ///< MJCF elements, in the part's frame
};

/// An image that replaces a texture of the scene's MJCF.
struct SceneTexture {
  std::string name;
  Image<Rgb8> image;  ///< row 0 is at texture coordinate 0
};

/// The parts of a scene and its camera.
struct SceneDescription {
  std::string assets;  ///< MJCF elements of <asset>
  std::vector<SceneTexture> textures;
  std::vector<ScenePart> parts;
  std::vector<std::string> objects;  ///< names
  std::vector<ObjectSolid> solids;   ///< solids of the objects, or empty
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_base_second_camera = Eigen::Isometry3d::Identity();
  double duration = 0.0;                                  ///< seconds; the scene's own duration
  bool moves = true;                                      ///< false: the frames are unrelated
  std::optional<double> grasp;                            ///< seconds; conveyor
  Image<Rgb8> model_image;                                ///< conveyor
  Eigen::Vector3d object_size = Eigen::Vector3d::Zero();  ///< conveyor, metres
  Eigen::Vector3d conveyor_direction = Eigen::Vector3d::UnitX();  ///< conveyor, base frame
};

/// The poses of all parts at one time, in the base frame.
struct ScenePose {
  std::vector<Eigen::Isometry3d> parts;
  std::vector<Eigen::Isometry3d> objects;
};

/// A scene with a moving arm and moving objects. The seed determines everything.
class Scene {
 public:
  virtual ~Scene() = default;
  [[nodiscard]] const SceneDescription& description() const { return description_; }

  /// Returns the positions of the arm's variables `time` seconds after the start. Any time is
  /// valid.
  [[nodiscard]] virtual std::vector<double> joints(double time) const = 0;

  /// Returns the poses of everything else.
  [[nodiscard]] virtual ScenePose pose(double time) = 0;

 protected:
  SceneDescription description_;
};

/// The options of a scene.
struct SceneOptions {
  std::uint64_t seed = 0;
  double belt_jitter = 0.0;  ///< standard deviation of the belt's speed, relative
  double frame_rate = 30.0;
  double duration = 0.0;  ///< seconds; 0: the scene's own duration
};

/// Makes a scene. `arm` must outlive it; `intrinsics` are those of the scene's camera.
[[nodiscard]] std::unique_ptr<Scene> make_conveyor(Arm& arm, const SceneOptions& options);
[[nodiscard]] std::unique_ptr<Scene> make_handover(Arm& arm, const SceneOptions& options);
[[nodiscard]] std::unique_ptr<Scene> make_random_targets(Arm& arm, const SceneOptions& options,
                                                         const Intrinsics& intrinsics,
                                                         bool carries);

/// Returns the pose of an upright camera at `eye` that looks at `target`.
[[nodiscard]] Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// The link that scenes move; its z axis points ahead, between the fingers.
inline constexpr const char* tool_link = "tool0";

/// Returns a tool pose that points `ahead`. Its y axis is as near to `sideways` as possible.
[[nodiscard]] Eigen::Isometry3d tool_pose(const Eigen::Vector3d& position,
                                          const Eigen::Vector3d& ahead,
                                          const Eigen::Vector3d& sideways);

[[nodiscard]] inline Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace penumbra::sim
