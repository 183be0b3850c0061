// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <nlohmann/json_fwd.hpp>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::bench {

struct GlSettings {
  int rounds = 5;
  std::size_t frames = 40;
  std::uint64_t seed = 7;
  RendererOptions gl;  ///< which device
};

/// The gl backend beside the cpu backend, by scene, image size and number of triangles.
[[nodiscard]] nlohmann::json compare_frames(const GlSettings& settings);

/// Several cameras before one robot, each with its renderer.
[[nodiscard]] nlohmann::json compare_cameras(const GlSettings& settings);

/// Memory and files that many frames, and many renderers made and dropped, leave behind.
[[nodiscard]] nlohmann::json soak(const GlSettings& settings);

}  // namespace penumbra::bench
