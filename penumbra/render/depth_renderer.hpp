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

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// The pixels u0 <= u < u1, v0 <= v < v1 of an image.
struct PixelRectangle {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;

  [[nodiscard]] bool empty() const { return u0 >= u1 || v0 >= v1; }
  [[nodiscard]] int width() const { return u1 - u0; }
  [[nodiscard]] int height() const { return v1 - v0; }

  /// The smallest rectangle that holds both.
  [[nodiscard]] PixelRectangle united(const PixelRectangle& other) const;
};

/// The pixels of both; empty where there are none.
[[nodiscard]] PixelRectangle overlap(const PixelRectangle& a, const PixelRectangle& b);

/// Calls f with rectangles that make up what of `old` is not in `kept`.
template <typename F>
void for_each_outside(const PixelRectangle& old, const PixelRectangle& kept, F&& f) {
  const PixelRectangle both = overlap(old, kept);
  const auto call = [&](const PixelRectangle& r) {
    if (!r.empty()) f(r);
  };
  if (both.empty()) return call(old);
  call({old.u0, old.v0, old.u1, both.v0});
  call({old.u0, both.v1, old.u1, old.v1});
  call({old.u0, both.v0, both.u0, both.v1});
  call({both.u1, both.v0, old.u1, both.v1});
}

/// Pixels in which a box's contents before the near plane may be seen: none left out, the whole
/// image where the box reaches through the near plane.
[[nodiscard]] PixelRectangle pixels_of(const Eigen::AlignedBox3d& box,
                                       const Eigen::Isometry3d& T_camera_box,
                                       const Intrinsics& intrinsics);

/// A rigid thing to draw. The spans need only live while a renderer is made.
struct Body {
  std::string_view name;
  std::span<const PreparedMesh> meshes;  ///< in the body's frame; may be empty

  [[nodiscard]] std::size_t triangle_count() const;
};

enum class Backend {
  cpu,        ///< SIMD
  gl,         ///< OpenGL without a display
  reference,  ///< plain scalar code
};

[[nodiscard]] std::string_view to_string(Backend backend);

struct RendererOptions {
  static constexpr int max_threads = 512;

  int threads = 1;    ///< of the cpu backend; results do not depend on it
  std::string isa{};  ///< cpu backend: a SIMD target by name ("AVX2"); empty: the best there is
  /// gl backend: index into gl_devices(); -1: the first usable one, hardware before software.
  int gl_device = -1;
};

struct RendererInfo {
  Backend backend = Backend::cpu;
  std::string isa{};  ///< Highway's name of the SIMD target; "scalar" for the reference; gl: empty
  int threads = 1;
  std::string device{};  ///< gl: OpenGL's own words, "RENDERER, OpenGL VERSION"; others: empty
};

/// Renders bodies to metric z-depth at pixel centres, with which body is seen at each pixel. Clips
/// at near_plane and has no far cut. One instance serves one thread at a time.
class DepthRenderer {
 public:
  static constexpr double near_plane = 0.01;  ///< metres
  /// Of those that have triangles. The cpu backend keeps a body's number in the low bits of the
  /// depth: with n bodies depths are rounded to 2^-(24 - bits of n) of themselves, 1 micrometre at
  /// 1 m for 12 bodies, 61 for 1023. Where there are more, only those that have triangles count.
  static constexpr std::size_t max_drawn_bodies = 1023;
  static constexpr std::size_t max_bodies = 65534;  ///< so that 16 bits hold their index + 1

  virtual ~DepthRenderer() = default;

  /// Draws the bodies at their poses, finite and rigid, one per body in the order of construction:
  /// submit() and collect() in one. The view's link image holds body index + 1. Throws
  /// std::logic_error while earlier frames are pending.
  [[nodiscard]] VirtualDepthView render(std::span<const Eigen::Isometry3d> T_camera_body);
  /// The same where only a window's pixels matter, which saves time: other pixels may lack what is
  /// there.
  [[nodiscard]] VirtualDepthView render(std::span<const Eigen::Isometry3d> T_camera_body,
                                        const PixelRectangle& window);

  /// Begins a frame, for collect() to wait for; the caller may do other things meanwhile. The poses
  /// need only live during the call. Throws std::logic_error if max_pending() frames are pending or
  /// the poses are not as many as the bodies, and DeviceError if the graphics device fails or has
  /// failed: make a new renderer.
  void submit(std::span<const Eigen::Isometry3d> T_camera_body);
  void submit(std::span<const Eigen::Isometry3d> T_camera_body, const PixelRectangle& window);

  /// The oldest pending frame; frames come in the order of submission. The view of the n-th frame
  /// is valid until frame n + max_pending() is submitted or rendered. Throws std::logic_error if no
  /// frame is pending, and DeviceError as submit() does: after one failure of the device no
  /// pending frame is to be trusted, and none comes any more.
  [[nodiscard]] VirtualDepthView collect();

  /// Frames that were submitted and not yet collected.
  [[nodiscard]] int pending() const { return pending_; }
  /// Most frames that may be pending: 1 of the cpu backend and of the reference, 3 of gl.
  [[nodiscard]] int max_pending() const { return max_pending_; }

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }
  [[nodiscard]] std::size_t body_count() const { return body_count_; }
  [[nodiscard]] std::size_t triangle_count() const { return triangle_count_; }
  [[nodiscard]] const RendererInfo& info() const { return info_; }

 protected:
  DepthRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies, RendererInfo info,
                int max_pending = 1);
  virtual void do_submit(std::span<const Eigen::Isometry3d> T_camera_body,
                         const PixelRectangle& window) = 0;
  virtual VirtualDepthView do_collect() = 0;

 private:
  Intrinsics intrinsics_;
  std::size_t body_count_;
  std::size_t triangle_count_ = 0;
  RendererInfo info_;
  int max_pending_;
  int pending_ = 0;
};

/// Makes a renderer. Throws InputError for more than max_bodies or max_drawn_bodies; of the cpu
/// backend, for threads that are not within 1..max_threads or more than the machine gives, or an
/// isa that is none of simd_target_names(); of gl, where this build, the machine or the chosen
/// device cannot draw (what was found and what to install), or an image or mesh is larger than the
/// device takes.
[[nodiscard]] std::unique_ptr<DepthRenderer> make_depth_renderer(
    Backend backend, const Intrinsics& intrinsics, std::span<const Body> bodies,
    const RendererOptions& options = {});

/// Finds a body that encloses the camera's centre: one of its surface patches, or all of its open
/// ones together, take up more than half of what is seen around it. A body is tested once per pose
/// relative to the camera.
class CameraInsideCheck {
 public:
  /// The bodies' meshes must outlive the check.
  explicit CameraInsideCheck(std::span<const Body> bodies);

  /// Returns the index of the first body that encloses the camera, if any. Allocates nothing.
  [[nodiscard]] std::optional<std::size_t> find(std::span<const Eigen::Isometry3d> T_camera_body);

 private:
  struct Solid {
    std::span<const PreparedMesh> meshes;
    Eigen::AlignedBox3d open_bounds;  // of the patches that are not closed
    std::optional<Eigen::Vector3d> last_centre;
    bool last_answer = false;
  };
  std::vector<Solid> solids_;
};

}  // namespace penumbra
