// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/triangle_mesh.hpp>
#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/camera/intrinsics.hpp>

namespace penumbra {

/// A rigid thing to draw. The spans need only live while a renderer is made.
struct Body {
  std::string_view name;
  std::span<const TriangleMesh> meshes;  ///< in the body's frame; may be empty
};

enum class Backend { cpu, reference };

[[nodiscard]] std::string_view to_string(Backend backend);

struct RendererOptions {
  static constexpr int max_threads = 512;

  int threads = 1;  ///< of the cpu backend; results do not depend on it
  std::string isa;  ///< cpu backend: a SIMD target by name ("AVX2"); empty: the best there is
};

struct RendererInfo {
  Backend backend = Backend::cpu;
  std::string isa;  ///< Highway's name of the SIMD target; "scalar" for the reference
  int threads = 1;
};

/// Renders bodies to metric z-depth at pixel centres, with which body is seen at each pixel. Clips
/// at near_plane and has no far cut. One instance serves one thread at a time.
class DepthRenderer {
 public:
  static constexpr double near_plane = 0.01;  ///< metres
  /// The cpu backend keeps the body's index in the low bits of the depth: with n bodies depths are
  /// rounded to 2^-(24 - bits of n) of themselves, 1 micrometre at 1 m for 12 bodies, 61 for 1023.
  static constexpr std::size_t max_bodies = 1023;

  virtual ~DepthRenderer() = default;

  /// Draws the bodies at their poses, finite and rigid, one per body in the order of construction.
  /// The view's link image holds body index + 1. It is valid until the next call.
  [[nodiscard]] VirtualDepthView render(std::span<const Eigen::Isometry3d> T_camera_body);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }
  [[nodiscard]] std::size_t body_count() const { return body_count_; }
  [[nodiscard]] std::size_t triangle_count() const { return triangle_count_; }
  [[nodiscard]] const RendererInfo& info() const { return info_; }

 protected:
  DepthRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies, RendererInfo info);
  virtual VirtualDepthView do_render(std::span<const Eigen::Isometry3d> T_camera_body) = 0;

 private:
  Intrinsics intrinsics_;
  std::size_t body_count_;
  std::size_t triangle_count_ = 0;
  RendererInfo info_;
};

/// Makes a renderer. Throws InputError for more than max_bodies, threads that are not within
/// 1..max_threads or more than the machine gives, or an isa that is none of simd_target_names().
[[nodiscard]] std::unique_ptr<DepthRenderer> make_depth_renderer(
    Backend backend, const Intrinsics& intrinsics, std::span<const Body> bodies,
    const RendererOptions& options = {});

/// Finds a body whose closed mesh holds the camera's centre. The answer of a body whose pose
/// relative to the camera has not changed is remembered.
class CameraInsideCheck {
 public:
  explicit CameraInsideCheck(std::span<const Body> bodies);
  ~CameraInsideCheck();

  /// Index of the first body that holds the camera, if any.
  [[nodiscard]] std::optional<std::size_t> find(std::span<const Eigen::Isometry3d> T_camera_body);

 private:
  struct Solid;
  std::vector<Solid> solids_;
};

}  // namespace penumbra
