// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "real_frames.hpp"

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/tuning/nearest_pixel-inl.hpp>

namespace penumbra::test {

enum class Outline { plate, disc, hand };

/// An object that faces the camera: a square plate, a disc, or a palm with five fingers.
struct PastedObject {
  Outline outline = Outline::plate;
  double width = 0.05;  ///< metres: side, diameter, or width of the palm
};

/// Pastes objects into a frame's measured depth, with the noise of a stereo sensor, and takes them
/// out again.
class Paster {
 public:
  explicit Paster(std::mt19937_64::result_type seed);

  /// Puts an object over a random pixel of the robot, turned at random, so that its farthest point
  /// is `gap` metres before the nearest virtual depth under it.
  void paste_before(RealFrame& frame, const PastedObject& object, double gap);

  /// Puts an object at a random place beside the arm, turned at random, all of it in the air,
  /// so that its nearest point is `offset` metres behind the virtual depth of the robot's pixel
  /// nearest to it. Its near edge is `gap` metres from that pixel, or up to 1.5 pixels more; a gap
  /// of 0 is the next pixel. `nearest`: of the frame's robot.
  void paste_beside(RealFrame& frame, const tuning::NearestPixels& nearest,
                    const PastedObject& object, double gap, double offset);

  /// Puts the last object into a frame, at the same place.
  void paste_again(RealFrame& frame) { paste(frame); }

  /// Restores the frame.
  void undo(RealFrame& frame);

  /// Pixels (v * width + u) where the last object is measured, two pixels or more inside its
  /// outline: those on the robot, and the others.
  [[nodiscard]] const std::vector<int>& on_robot() const { return on_robot_; }
  [[nodiscard]] const std::vector<int>& beside() const { return beside_; }

  /// Returns whether its depth differs by 5 cm from every depth of the robot, virtual and measured,
  /// within 12 pixels of it. Call it before undo().
  [[nodiscard]] bool has_true_step(const RealFrame& frame) const;

 private:
  /// Where a pixel's ray meets the object's surface.
  struct Hit {
    double depth;   // metres
    double inside;  // metres from the outline, positive inside
  };
  struct Place {
    PastedObject object;
    double u = 0.0, v = 0.0, z = 1.0, turn = 0.0;

    [[nodiscard]] Hit hit(const RealFrame& frame, double du, double dv) const;
    template <typename F>
    void for_each_pixel(const RealFrame& frame, double margin, F&& f) const;
  };
  struct Offset {
    int du, dv;
  };

  [[nodiscard]] double uniform(double low, double high);
  [[nodiscard]] std::vector<Offset> outline(const RealFrame& frame) const;
  bool slide_off(const RealFrame& frame, const tuning::NearestPixels& nearest, double least,
                 double angle);
  bool find_place(const RealFrame& frame, const tuning::NearestPixels& nearest, double gap,
                  double offset);
  void paste(RealFrame& frame);
  void measure(RealFrame& frame, const Hit& hit, int u, int v);
  [[nodiscard]] double noise(double z, int u, int v);

  std::mt19937_64 random_;
  Image<float> patches_;  // of spread 1, repeated over the plane
  int shift_u_ = 0, shift_v_ = 0;
  Place place_;
  double nearest_depth_ = 0.0;  // virtual depth of the robot's pixel nearest to the place
  std::vector<int> on_robot_, beside_;
  std::vector<std::pair<int, std::uint16_t>> before_;
};

}  // namespace penumbra::test
