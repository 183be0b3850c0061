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
#include <penumbra/camera/intrinsics.hpp>

#include <io/files/png.hpp>
#include <sim/arm.hpp>
#include <sim/numbers.hpp>
#include <sim/simulation.hpp>

namespace penumbra::sim {

/// A rigid piece of a scene beside the arm. Its pose is set in every frame.
struct ScenePart {
  int object = -1;    ///< which object of the scene it belongs to; -1: background
  std::string geoms;  ///< MJCF elements, in the part's frame
};

/// An image for a texture of the scene's MJCF; it is put in place of what the MJCF says of it.
struct SceneTexture {
  std::string name;
  Image<io::Rgb8> image;  ///< row 0 is at the texture coordinate 0
};

/// What a scene consists of and from where it is seen.
struct SceneDescription {
  std::string assets;  ///< MJCF elements of <asset>
  std::vector<SceneTexture> textures;
  std::vector<ScenePart> parts;
  std::vector<std::string> objects;  ///< names
  std::vector<ObjectSolid> solids;   ///< of the objects, or empty
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_base_second_camera = Eigen::Isometry3d::Identity();
  double duration = 0.0;        ///< seconds; what the scene takes of its own accord
  bool moves = true;            ///< false: frames have nothing to do with each other
  std::optional<double> grasp;  ///< seconds; conveyor
  Image<io::Rgb8> model_image;  ///< conveyor
  Eigen::Vector3d object_size = Eigen::Vector3d::Zero();          ///< conveyor, metres
  Eigen::Vector3d conveyor_direction = Eigen::Vector3d::UnitX();  ///< conveyor, base frame
};

/// Where everything is at one time, in the base frame.
struct ScenePose {
  std::vector<Eigen::Isometry3d> parts;
  std::vector<Eigen::Isometry3d> objects;
};

/// Things that move beside a moving arm. Everything comes from the seed.
class Scene {
 public:
  virtual ~Scene() = default;
  [[nodiscard]] const SceneDescription& description() const { return description_; }

  /// Positions of the arm's variables, seconds after the start. Any time may be asked for.
  [[nodiscard]] virtual std::vector<double> joints(double time) const = 0;

  /// Poses of everything else.
  [[nodiscard]] virtual ScenePose pose(double time) = 0;

 protected:
  SceneDescription description_;
};

/// How seeded scenes may differ beyond their seed.
struct SceneWishes {
  std::uint64_t seed = 0;
  double belt_jitter = 0.0;  ///< of the belt's speed, relative
  double frame_rate = 30.0;
  double duration = 0.0;  ///< seconds; 0: the scene's own
};

/// `arm` must outlive the scene; `intrinsics` are those of the scene's camera.
[[nodiscard]] std::unique_ptr<Scene> make_conveyor(Arm& arm, const SceneWishes& wishes);
[[nodiscard]] std::unique_ptr<Scene> make_handover(Arm& arm, const SceneWishes& wishes);
[[nodiscard]] std::unique_ptr<Scene> make_random_targets(Arm& arm, const SceneWishes& wishes,
                                                         const Intrinsics& intrinsics);

/// The pose of a camera at `eye` that looks at `target`, its image upright.
[[nodiscard]] Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// The link that scenes steer; its z axis points ahead, between the fingers.
inline constexpr const char* tool_link = "tool0";

/// A tool pose that points `ahead`; its y axis comes as near to `sideways` as that leaves free.
[[nodiscard]] Eigen::Isometry3d tool_pose(const Eigen::Vector3d& position,
                                          const Eigen::Vector3d& ahead,
                                          const Eigen::Vector3d& sideways);

[[nodiscard]] inline Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace penumbra::sim
