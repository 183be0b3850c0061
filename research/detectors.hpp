// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/targets/target_judge.hpp>

#include <research/cell.hpp>
#include <sim/simulation.hpp>

namespace penumbra::research {

/// An object as a detector finds it.
struct Detection {
  Extent extent = Extent::amodal;
  Image<std::uint8_t> mask;  ///< of the camera's size; 0 outside of the object
  PixelBox box;              ///< around the mask
};

/// Finds the parcel's full projected outline, whatever is in front of it. With noise.
class AmodalDetector {
 public:
  AmodalDetector(const Cell& cell, std::uint64_t seed) : cell_(cell), random_(seed) {}
  std::optional<Detection> detect(const sim::SimFrame& frame);

 private:
  const Cell& cell_;
  std::mt19937_64 random_;
};

/// Finds the pixels where the parcel is visible. With noise.
class ModalDetector {
 public:
  explicit ModalDetector(std::uint64_t seed) : random_(seed) {}
  std::optional<Detection> detect(const sim::SimFrame& frame);

 private:
  std::mt19937_64 random_;
};

/// Finds a person's wrist in the image, as a pose network does: also while it is hidden. With
/// noise.
class KeypointDetector {
 public:
  KeypointDetector(const Cell& cell, std::uint64_t seed, double sigma)
      : cell_(cell), random_(seed), noise_(0.0, sigma) {}
  /// Returns the wrist's pixel; nothing if it is outside of the image.
  std::optional<Eigen::Vector2d> detect(const sim::SimFrame& frame);

 private:
  const Cell& cell_;
  std::mt19937_64 random_;
  std::normal_distribution<double> noise_;
};

/// Returns the object's eight corners in the image.
[[nodiscard]] std::array<Eigen::Vector2d, 8> project_box(const Camera& camera,
                                                         const Eigen::Isometry3d& T_camera_object,
                                                         const Eigen::Vector3d& size);

/// Returns an object of the scene. Throws std::logic_error if there is none of this name.
[[nodiscard]] const sim::ObjectTruth& object_named(const sim::SimFrame& frame,
                                                   std::string_view name);

}  // namespace penumbra::research
