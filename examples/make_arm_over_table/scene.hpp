// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arm.hpp"
#include "shape.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace example {

enum class Kind : std::uint8_t { room, object, robot };
enum class Finish : std::uint8_t { plain, wood, tiles, gloss };

/// Something that light meets. Poses are in the arm's base frame; the table's top is z = 0.
struct Thing {
  Kind kind;
  Vector3d colour;  ///< sRGB, 0..1
  Finish finish;
  Shape shape;
  Isometry3d pose;
  Isometry3d inverse;       ///< of pose
  Eigen::AlignedBox3d box;  ///< in the shape's frame
};

struct Seen {
  const Thing* thing = nullptr;  ///< null: nothing on the ray
  double t = std::numeric_limits<double>::infinity();
  Vector3d normal = Vector3d::Zero();  ///< unit, towards the ray's origin
};

/// One frame's world.
class Scene {
 public:
  static constexpr int frame_count = 12;
  static Arm::Values joints(int frame);

  Scene(const Arm& arm, int frame);

  /// The nearest thing of any kind, or of one, at t > 0 of a ray in the base frame.
  [[nodiscard]] Seen nearest(const Ray& ray) const;
  [[nodiscard]] Seen nearest(const Ray& ray, Kind kind) const;

  /// Whether anything stands between a surface point and where `to_light` ends.
  [[nodiscard]] bool blocked(const Vector3d& point, const Vector3d& to_light) const;

 private:
  void add(Kind kind, const Vector3d& colour, Finish finish, const Shape& shape,
           const Isometry3d& pose);
  void add_room();
  void add_objects();
  void add_hand(int frame);

  std::vector<Thing> things_;
};

/// The depth camera: a pinhole whose principal point is off the centre.
struct View {
  static constexpr int width = 640, height = 480;
  static constexpr double fx = 611.42, fy = 611.17, cx = 326.38, cy = 235.71;
  static constexpr double baseline = 0.055;  ///< metres to the second imager, along +x

  Isometry3d T_base_camera;

  View();
  /// Through image point (u, v); t is the z-depth in metres.
  [[nodiscard]] Ray ray(double u, double v) const;
};

}  // namespace example
