// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// Which backend is used, and why.
struct RendererChoice {
  Backend backend = Backend::cpu;
  std::string reason;  ///< one sentence, with the figures where there are any; empty: not measured
  std::vector<std::string> warnings;  ///< why OpenGL could not be used, where the user may mend it
};

/// A choice and the renderer that it fell on.
struct ChosenRenderer {
  RendererChoice choice;
  std::unique_ptr<DepthRenderer> renderer;
  std::unique_ptr<DepthRenderer> spare = nullptr;  ///< of the same bodies and image; may be none

  /// DepthRenderer::render. Should the renderer's device fail, the spare one takes its place for
  /// this frame and all later ones, and `choice` its backend and a warning; without one DeviceError
  /// comes through.
  [[nodiscard]] VirtualDepthView render(std::span<const Eigen::Isometry3d> T_camera_body);
};

/// Makes the faster one of the cpu and the gl backend. Both draw the bodies side by side before the
/// camera for some tens of milliseconds; less wall time per frame wins, if the images agree. OpenGL
/// that draws in software is only measured where options.gl_device names it. OpenGL that is missing
/// or faulty is no error: the cpu backend is taken, with a warning. Throws InputError for a
/// gl_device that EGL does not list, and what make_depth_renderer refuses of the cpu backend. Where
/// gl is chosen, the cpu backend is its spare.
[[nodiscard]] ChosenRenderer make_fastest_renderer(const Intrinsics& intrinsics,
                                                   std::span<const Body> bodies,
                                                   const RendererOptions& options = {});

/// The choice of make_fastest_renderer alone.
[[nodiscard]] RendererChoice choose_backend(const Intrinsics& intrinsics,
                                            std::span<const Body> bodies,
                                            const RendererOptions& options = {});

}  // namespace penumbra
