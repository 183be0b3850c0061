// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "measured_paste.hpp"
#include "nearest_robot.hpp"
#include "real_frames.hpp"

#include <vector>

namespace penumbra::test {

enum class Outline { plate, disc, cylinder, hand, rod };

/// An object that faces the camera. The hand is a palm as wide as `width` with five fingers.
struct SideObject {
  Outline outline = Outline::plate;
  double width = 0.10;   ///< metres; a cylinder's and a rod's diameter
  double height = 0.10;  ///< metres

  /// Where the object's surface is, (x, y) metres from its centre: metres behind its nearest point,
  /// and inside of its outline.
  [[nodiscard]] SurfaceHit at(double x, double y) const;
  [[nodiscard]] double radius() const;  ///< metres: of a circle that holds it
  [[nodiscard]] double relief() const;  ///< metres from its nearest to its farthest point
};

/// How far an object's near edge is from the silhouette.
struct Gap {
  double pixels = 0.0;
  double metres = 0.0;  ///< at the object's depth, added
};

/// Pastes objects that face the camera beside the arm.
class SidePaster {
 public:
  static constexpr int air_rows = 420;  ///< the recording has only air around the arm in these

  explicit SidePaster(std::mt19937_64::result_type seed) : paste_({}, seed) {}

  /// Puts an object at a random place beside the arm, turned at random, all of it in the air rows,
  /// so that its nearest point lies `offset` metres behind the virtual depth of the silhouette's
  /// pixel nearest to it. Its near edge is up to 1.5 pixels farther off than `gap`; a gap of 0 is
  /// the next pixel. Tries places until one fits.
  void paste(RealFrame& frame, const NearestRobot& nearest, const SideObject& object,
             const Gap& gap, double offset);

  /// Puts an object's centre on a random pixel of the robot in the air rows, `offset` metres behind
  /// it; the nearer of robot and object is seen.
  void paste_across(RealFrame& frame, const SideObject& object, double offset);

  void undo(RealFrame& frame) { paste_.undo(frame); }

  /// Of the object that was pasted last.
  [[nodiscard]] const MeasuredPaste::Pixels& beside() const { return paste_.beside(); }
  [[nodiscard]] const MeasuredPaste::Pixels& on_robot() const { return paste_.on_robot(); }
  [[nodiscard]] double depth() const { return place_.z; }  ///< metres, of its nearest point
  [[nodiscard]] double clearance() const { return place_.clearance; }  ///< pixels to the silhouette

  /// Whether its depth differs by `step` metres from every depth of the robot, virtual and as
  /// recorded, within `margin` pixels of it. Call it before undo().
  [[nodiscard]] bool has_true_step(const RealFrame& frame, double step, double margin) const;

 private:
  struct Place {
    SideObject object;
    double u = 0.0, v = 0.0, z = 1.0, turn = 0.0;
    double clearance = 0.0;

    [[nodiscard]] SurfaceHit hit(const RealFrame& frame, double du, double dv) const;
    template <typename F>
    void for_each_pixel(const RealFrame& frame, double margin, F&& f) const;
  };
  struct Offset {
    int du, dv;
  };

  [[nodiscard]] std::vector<Offset> outline(const RealFrame& frame) const;
  [[nodiscard]] int random_robot_pixel(const RealFrame& frame);
  bool slide_off(const NearestRobot& nearest, const std::vector<Offset>& pixels, double least,
                 double angle);
  bool find_place(const RealFrame& frame, const NearestRobot& nearest, const Gap& gap,
                  double offset);
  void paste_at_place(RealFrame& frame);

  MeasuredPaste paste_;
  Place place_;
  float nearest_depth_ = 0.0F;  // virtual depth of the silhouette's pixel nearest to the place
};

}  // namespace penumbra::test
