// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/occlusion/target.hpp>

#include <sim/experiments/sensed.hpp>
#include <sim/simulation.hpp>

namespace penumbra::sim {

/// An object as a detector finds it.
struct Detection {
  Extent extent = Extent::amodal;
  Image<std::uint8_t> mask;  ///< of the camera's size; 0 where the object is not
  PixelBox box;              ///< about the mask
};

/// Where an object is in the image. Any detector's masks can be put in place of the simulated ones.
class Detector {
 public:
  virtual ~Detector() = default;
  /// Nothing where it finds no object.
  virtual std::optional<Detection> detect(const SimFrame& frame) = 0;
};

/// What the simulated detectors get wrong.
struct DetectorNoise {
  double shift = 2.0;      ///< pixels: sigma of the whole mask's place
  double corner = 1.5;     ///< pixels: sigma of each corner (amodal)
  double edge = 0.15;      ///< share of the mask's border that is worn away, in patches (modal)
  double least_area = 40;  ///< pixels: less is not found (modal)
};

/// Answers the object's full projected outline, whatever is before it.
class AmodalDetector : public Detector {
 public:
  AmodalDetector(const Cell& cell, std::uint64_t seed, const DetectorNoise& noise = {})
      : cell_(cell), noise_(noise), random_(seed) {}
  std::optional<Detection> detect(const SimFrame& frame) override;

 private:
  Cell cell_;
  DetectorNoise noise_;
  std::mt19937_64 random_;
};

/// Answers those pixels where the object is seen.
class ModalDetector : public Detector {
 public:
  explicit ModalDetector(std::uint64_t seed, const DetectorNoise& noise = {})
      : noise_(noise), random_(seed) {}
  std::optional<Detection> detect(const SimFrame& frame) override;

 private:
  DetectorNoise noise_;
  std::mt19937_64 random_;
};

/// A person's wrist in the image, as a pose network answers it: also while it is hidden.
struct Keypoint {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double score = 0;
};

class KeypointDetector {
 public:
  virtual ~KeypointDetector() = default;
  virtual std::optional<Keypoint> detect(const SimFrame& frame) = 0;
};

/// The true place with noise; nothing where it lies outside of the image.
class NoisyKeypoints : public KeypointDetector {
 public:
  NoisyKeypoints(const Cell& cell, std::uint64_t seed, double sigma)
      : cell_(cell), random_(seed), noise_(0.0, sigma) {}
  std::optional<Keypoint> detect(const SimFrame& frame) override;

 private:
  Cell cell_;
  std::mt19937_64 random_;
  std::normal_distribution<double> noise_;
};

/// The object's eight corners in the image.
[[nodiscard]] std::array<Eigen::Vector2d, 8> project_box(const Camera& camera,
                                                         const Eigen::Isometry3d& T_camera_object,
                                                         const Eigen::Vector3d& size);

/// The object of a scene that perception looks for; throws std::logic_error where it is not.
[[nodiscard]] const ObjectTruth& object_named(const SimFrame& frame, std::string_view name);

}  // namespace penumbra::sim
