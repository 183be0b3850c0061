// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/labelled_frame-inl.hpp>
#include <penumbra/pipeline/object_renderers-inl.hpp>

namespace penumbra {

/// Draws attached bodies into the robot's virtual depth image.
class AttachedBodies {
 public:
  AttachedBodies(const Intrinsics& intrinsics, const PipelineConfig& config)
      : renderers_(intrinsics, config, nullptr) {}

  /// Returns the robot together with the bodies; the nearest surface wins. Valid until the next
  /// call. The first call with a mesh makes its renderer.
  VirtualDepthView add_to(const VirtualDepthView& robot, std::span<const PlacedBody> bodies);

 private:
  ObjectRenderers renderers_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
  TileMask touched_;
};

}  // namespace penumbra
