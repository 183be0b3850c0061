// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

#include <sim/random.hpp>
#include <sim/stage.hpp>

namespace penumbra::study {

/// One capture of a stereo camera, in the left camera's pixels, beside the truth.
struct StereoImages {
  Image<std::uint8_t> left, right;  ///< grey
  Image<std::uint16_t> measured;    ///< millimetres, 0 = no measurement
  Image<float> depth;               ///< true, metres; 0 = nothing
  Image<std::int32_t> ids;          ///< as sim::SimFrame::ids
};

/// An active stereo camera: two rendered images, lit by a random pattern that is projected from the
/// left camera and falls off with distance, with noise, matched by OpenCV's semi-global block
/// matching. Nothing in it knows where the robot is.
class StereoCamera {
 public:
  static constexpr double baseline = 0.05;  ///< metres; the right camera is at +x

  /// `intrinsics`: of both cameras, fx = fy.
  StereoCamera(const Intrinsics& intrinsics, std::uint64_t seed);
  ~StereoCamera();
  StereoCamera(const StereoCamera&) = delete;
  StereoCamera& operator=(const StereoCamera&) = delete;

  /// Draws and matches what is placed on the stage. `images` are reused.
  void capture(sim::Stage& stage, const Eigen::Isometry3d& T_base_left, StereoImages& images);

 private:
  struct Matcher;
  void light(const Image<Rgb8>& color, const Image<float>& depth, double from_left,
             Image<std::uint8_t>& grey);

  Intrinsics intrinsics_;
  sim::Random random_;
  Image<float> pattern_;  // 0 to 1, as the left camera sees it
  Image<float> noise_;    // of spread 1; read from a random place on
  Image<Rgb8> color_;
  Image<float> right_depth_;
  std::unique_ptr<Matcher> matcher_;
};

}  // namespace penumbra::study
