// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/render/renderer_race-inl.hpp>

namespace penumbra {
namespace {

constexpr int warm_up_frames = 3;  // caches, clocks, a driver's last compilation
constexpr int least_frames = 3;
constexpr int most_frames = 40;
constexpr double enough_ms = 15.0;  // of measuring one backend

/// The bodies side by side on a grid that fills the view, turning from frame to frame.
class Parade {
 public:
  Parade(const Intrinsics& intrinsics, std::span<const Body> bodies);

  [[nodiscard]] std::span<const Eigen::Isometry3d> poses(int frame);

 private:
  static constexpr double nearest = 1.2;  // metres from the camera to a body
  static constexpr double turn = 0.05;    // radians per frame

  std::vector<Eigen::Vector3d> centres_;  // of the bodies, in their own frames
  std::vector<Eigen::Vector3d> places_;   // of the centres, in the optical frame
  std::vector<Eigen::Isometry3d> poses_;
};

Eigen::AlignedBox3d bounds_of(const Body& body) {
  Eigen::AlignedBox3d bounds;
  for (const TriangleMesh& mesh : body.meshes)
    for (const Eigen::Vector3f& vertex : mesh.vertices) bounds.extend(vertex.cast<double>());
  return bounds;
}

Parade::Parade(const Intrinsics& intrinsics, std::span<const Body> bodies)
    : centres_(bodies.size(), Eigen::Vector3d::Zero()),
      places_(bodies.size(), Eigen::Vector3d(0, 0, nearest)),
      poses_(bodies.size()) {
  const auto drawn = static_cast<double>(std::count_if(
      bodies.begin(), bodies.end(), [](const Body& body) { return !bounds_of(body).isEmpty(); }));
  const double width = intrinsics.width(), height = intrinsics.height();
  const double columns = std::max(1.0, std::ceil(std::sqrt(drawn * width / height)));
  const double rows = std::max(1.0, std::ceil(drawn / columns));
  double cell = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Eigen::AlignedBox3d bounds = bounds_of(bodies[i]);
    if (bounds.isEmpty()) continue;
    const double row = std::floor(cell / columns), column = cell - row * columns;
    centres_[i] = bounds.center();
    places_[i] = intrinsics.ray((column + 0.5) / columns * width, (row + 0.5) / rows * height) *
                 (nearest + 0.5 * bounds.diagonal().norm());
    ++cell;
  }
}

std::span<const Eigen::Isometry3d> Parade::poses(int frame) {
  const Eigen::AngleAxisd turned(turn * frame, Eigen::Vector3d(1, 2, 2) / 3.0);
  for (std::size_t i = 0; i < poses_.size(); ++i)
    poses_[i] = Eigen::Translation3d(places_[i]) * turned * Eigen::Translation3d(-centres_[i]);
  return poses_;
}

/// Medians of one frame, milliseconds.
struct FrameCost {
  double wall = 0;
  double thread_cpu = 0;  // CPU time of the calling thread
};

double thread_cpu_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double>& samples) {
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::nth_element(samples.begin(), middle, samples.end());
  return *middle;
}

FrameCost measure(DepthRenderer& renderer, Parade& parade) {
  using Clock = std::chrono::steady_clock;
  using Milliseconds = std::chrono::duration<double, std::milli>;
  for (int i = 0; i < warm_up_frames; ++i) static_cast<void>(renderer.render(parade.poses(i)));
  std::vector<double> wall, cpu;
  const Clock::time_point begin = Clock::now();
  for (int i = 0; i < most_frames; ++i) {
    const auto poses = parade.poses(i);
    const double cpu_start = thread_cpu_ms();
    const Clock::time_point start = Clock::now();
    static_cast<void>(renderer.render(poses));
    const Clock::time_point end = Clock::now();
    cpu.push_back(thread_cpu_ms() - cpu_start);
    wall.push_back(Milliseconds(end - start).count());
    if (i + 1 >= least_frames && Milliseconds(end - begin).count() > enough_ms) break;
  }
  return {median(wall), median(cpu)};
}

/// How far two images of the same scene are from each other.
struct Difference {
  std::size_t robot = 0;  // pixels that the robot covers in either
  std::size_t pixels = 0;

  /// Rounding moves an edge across a few pixels' centres; a fault of a driver shows in many.
  [[nodiscard]] bool is_fault() const { return pixels > 16 + robot / 100; }
};

Difference difference(const VirtualDepthView& a, const VirtualDepthView& b) {
  constexpr float most = 1e-3F;  // of the depth
  Difference difference;
  for (int v = 0; v < a.depth.height; ++v) {
    for (int u = 0; u < a.depth.width; ++u) {
      const float za = a.depth(u, v), zb = b.depth(u, v);
      if (za == 0 && zb == 0) continue;
      ++difference.robot;
      const bool same = std::abs(za - zb) <= most * za && a.links(u, v) == b.links(u, v);
      if (!same) ++difference.pixels;
    }
  }
  return difference;
}

std::string text_of(double ms) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), ms, std::chars_format::fixed, 3);
  return std::string(buffer, end.ptr) + " ms";
}

std::string text_of(const FrameCost& cost, const std::string& renderer) {
  return text_of(cost.wall) + " (CPU time of the calling thread " + text_of(cost.thread_cpu) +
         ") with " + renderer;
}

}  // namespace

RendererChoice race(DepthRenderer& cpu, DepthRenderer& gl, std::span<const Body> bodies) {
  Parade parade(cpu.intrinsics(), bodies);
  const std::string device = "gl on " + gl.info().device;
  const FrameCost of_gl = measure(gl, parade);
  const FrameCost of_cpu = measure(cpu, parade);
  const auto poses = parade.poses(most_frames);
  const Difference apart = difference(cpu.render(poses), gl.render(poses));
  if (apart.is_fault())
    throw std::runtime_error(device + " draws " + std::to_string(apart.pixels) + " of " +
                             std::to_string(apart.robot) +
                             " pixels otherwise than the cpu renderer; update its driver");
  return {of_gl.wall < of_cpu.wall ? Backend::gl : Backend::cpu,
          "a frame took " + text_of(of_gl, device) + ", and " +
              text_of(of_cpu, "cpu on " + cpu.info().isa),
          {}};
}

}  // namespace penumbra
