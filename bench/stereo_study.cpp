// SPDX-License-Identifier: Apache-2.0
// Measures against the simulator's truth what a stereo camera carries past the robot's outline, how
// much of it the fringe finds and what it takes of real things. Writes a table into docs/cloud.md.
// With --sequences, prints the same of a moving arm, from single images and with a memory of the
// scene, in which things stay, and in which half of them go and others come.
#include "../tests/support/cloud_measure.hpp"
#include "stereo_camera.hpp"
#include "study_page.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <thread>

#include <penumbra/labels/scene_memory.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <sim/arm.hpp>
#include <sim/scene.hpp>
#include <sim/temporary_folder.hpp>

namespace penumbra::study {
namespace {

using sim::ScenePart;
using test::label_at;

constexpr std::uint64_t first_seed = 20230206;
constexpr std::size_t frames_per_cell = 20;
constexpr int threads = 2;
constexpr std::array<int, 4> reaches = {0, 20, 40, 60};
constexpr double wrong = 0.03;        // metres: a depth farther from the truth than this
constexpr double right = 0.02;        // metres: a depth nearer to the truth than this
constexpr double robots_depth = 3.0;  // of e(z): how near to the robot's depth carried ones are

constexpr double frame_rate = 30.0;  // turns a frame's number into the scene's time
constexpr double nearby = 64.0;      // pixels from the robot: no farther point was carried

constexpr std::size_t frames_of_sequence = 60;
constexpr double away = 10.0;   // metres: out of view
constexpr double close = 20.0;  // pixels from the outline

/// The simulated arm among eight things before, behind and beside it, seen by a stereo camera. The
/// seed chooses the camera's place and the things; every frame is a new arm pose with the things in
/// new places.
class StereoCell {
 public:
  [[nodiscard]] static Intrinsics intrinsics() { return {848, 480, 600.0, 600.0, 423.5, 239.5}; }

  explicit StereoCell(std::uint64_t seed)
      : arm_(PENUMBRA_STUDY_ARM, visual_geometry(), folder_.path()),
        scene_(sim::make_random_targets(
            arm_, {.seed = seed, .belt_jitter = 0.0, .frame_rate = frame_rate, .duration = 0.0},
            intrinsics(), false)),
        stage_(arm_, scene_->description(), folder_.path(), intrinsics()),
        renderer_(make_depth_renderer(Backend::cpu, intrinsics(), bodies_of(arm_.robot()))),
        camera_(intrinsics(), seed),
        poses_(arm_.robot().links().size()) {}

  /// Captures frame `index` into `images`. Returns the robot alone, as rendered.
  VirtualDepthView capture(std::size_t index, StereoImages& images) {
    const double time = static_cast<double>(index) / frame_rate;
    return capture(scene_->joints(time), scene_->pose(time).parts, images);
  }

  /// Captures what one of the frames of a sequence shows: the arm comes to the first frame's pose
  /// among the first frame's things, and leaves. If `changes`, half of the things go half-way, and
  /// the others come.
  VirtualDepthView capture_moving(std::size_t frame, bool changes, StereoImages& images) {
    const double s = 2.0 * static_cast<double>(frame) / frames_of_sequence;  // 1: half-way
    const double to = s < 1.0 ? s * s * (3.0 - 2.0 * s) : (s - 1.0) * (s - 1.0) * (5.0 - 2.0 * s);
    const std::vector<double> from = scene_->joints((s < 1.0 ? 1.0 : 0.0) / frame_rate);
    std::vector<double> joints = scene_->joints((s < 1.0 ? 0.0 : 2.0) / frame_rate);
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints[i] = from[i] + to * (joints[i] - from[i]);
    std::vector<Eigen::Isometry3d> parts = scene_->pose(0.0).parts;
    const std::vector<ScenePart>& all = scene_->description().parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const int object = all[i].object;
      const bool goes = object >= 0 && object % 2 == 0, comes = object >= 0 && object % 2 == 1;
      if (changes && ((goes && s >= 1.0) || (comes && s < 1.0))) parts[i].translation().z() -= away;
    }
    return capture(joints, parts, images);
  }

  /// Captures an arm among parts.
  VirtualDepthView capture(const std::vector<double>& joints,
                           const std::vector<Eigen::Isometry3d>& parts, StereoImages& images) {
    stage_.place(joints, parts);
    const Eigen::Isometry3d& T_base_camera = scene_->description().T_base_camera;
    camera_.capture(stage_, T_base_camera, images);
    arm_.robot().forward_kinematics(joints, poses_);
    for (Eigen::Isometry3d& pose : poses_) pose = T_base_camera.inverse() * pose;
    return renderer_->render(poses_);
  }

 private:
  static RobotOptions visual_geometry() {
    RobotOptions options;
    options.geometry = Geometry::visual;
    options.geometry_fallback = true;
    return options;
  }

  sim::TemporaryFolder folder_;
  sim::Arm arm_;
  std::unique_ptr<sim::Scene> scene_;
  sim::Stage stage_;
  std::unique_ptr<DepthRenderer> renderer_;
  StereoCamera camera_;
  std::vector<Eigen::Isometry3d> poses_;  // T_camera_link
};

enum class Point { robot, carried, thing, room, other };

/// Whether something else than the robot, less than `distance` pixels away, has the measured depth:
/// then the point was carried from there.
bool is_others(const StereoImages& images, int u, int v, double distance) {
  const float measured = 0.001F * static_cast<float>(images.measured(u, v));
  const int reach = static_cast<int>(distance);
  for (int y = std::max(0, v - reach); y <= std::min(images.ids.height() - 1, v + reach); ++y)
    for (int x = std::max(0, u - reach); x <= std::min(images.ids.width() - 1, u + reach); ++x) {
      const bool is_robot = images.ids(x, y) > 0 && images.ids(x, y) < sim::first_object_id;
      if (!is_robot && std::hypot(x - u, y - v) < distance &&
          std::abs(images.depth(x, y) - measured) < static_cast<float>(wrong))
        return true;
    }
  return false;
}

/// What a measured point really is.
Point point_of(const StereoImages& images, const VirtualDepthView& rendered,
               const tuning::NearestPixels& nearest, int u, int v) {
  const std::int32_t id = images.ids(u, v);
  const bool is_object = id >= sim::first_object_id;
  if (id != 0 && !is_object) return Point::robot;
  const double measured = 0.001 * static_cast<double>(images.measured(u, v));
  const double off = std::abs(measured - static_cast<double>(images.depth(u, v)));
  const double distance = nearest.distance(u, v);
  if (off > wrong && distance <= nearby) {
    const auto at = nearest.at(u, v);
    const auto robot = static_cast<double>(rendered.depth(at.u, at.v));
    if (std::abs(measured - robot) < robots_depth * LabelRule{}.tolerance.at(robot) &&
        !is_others(images, u, v, distance))
      return Point::carried;
  }
  if (off >= right) return Point::other;
  return is_object ? Point::thing : Point::room;
}

/// Counts of points in a cloud without the robot, by what they are, and of those that each reach
/// labels fringe. `on_robot`: measured on the robot itself.
struct Tally {
  std::size_t frames = 0, on_robot = 0;
  std::array<std::size_t, 5> points{};  // by Point
  std::array<std::array<std::size_t, 5>, reaches.size()> fringe{};

  void add(const Tally& other) {
    frames += other.frames;
    on_robot += other.on_robot;
    for (std::size_t kind = 0; kind < points.size(); ++kind) {
      points[kind] += other.points[kind];
      for (std::size_t i = 0; i < reaches.size(); ++i) fringe[i][kind] += other.fringe[i][kind];
    }
  }
};

std::vector<Classifier> classifiers() {
  std::vector<Classifier> all;
  for (const int reach : reaches) {
    LabelRule rule;
    rule.fringe_reach = reach;
    all.emplace_back(StereoCell::intrinsics().width(), StereoCell::intrinsics().height(), rule);
  }
  return all;
}

/// Points that a cloud without the robot holds are the clear and front ones.
void tally(const StereoImages& images, const VirtualDepthView& robot,
           std::vector<Classifier>& classifiers, Tally& sum) {
  const tuning::NearestPixels nearest = test::nearest_robot(robot.depth);
  std::array<LabelView, reaches.size()> labels;
  for (std::size_t i = 0; i < reaches.size(); ++i)
    labels[i] = classifiers[i].classify(robot, images.measured.view());
  ++sum.frames;
  for (int v = 0; v < images.measured.height(); ++v)
    for (int u = 0; u < images.measured.width(); ++u) {
      if (images.measured(u, v) == 0) continue;
      const Point point = point_of(images, robot, nearest, u, v);
      sum.on_robot += point == Point::robot;
      const int pixel = v * images.measured.width() + u;
      if (!is_trusted(label_at(labels[0], pixel))) continue;
      const auto kind = static_cast<std::size_t>(point);
      ++sum.points[kind];
      for (std::size_t i = 0; i < reaches.size(); ++i)
        sum.fringe[i][kind] += label_at(labels[i], pixel) == Label::fringe;
    }
}

Tally study(std::size_t frames) {
  Tally all;
  std::mutex mutex;
  std::atomic<std::size_t> next_cell = 0;
  const auto work = [&] {
    std::vector<Classifier> rules = classifiers();
    StereoImages images;
    for (;;) {
      const std::size_t cell = next_cell++;
      if (cell * frames_per_cell >= frames) return;
      StereoCell place(first_seed + cell);
      Tally sum;
      for (std::size_t i = 0; i < std::min(frames_per_cell, frames - cell * frames_per_cell); ++i) {
        const VirtualDepthView robot = place.capture(i, images);
        tally(images, robot, rules, sum);
      }
      const std::lock_guard lock(mutex);
      all.add(sum);
      std::cerr << all.frames << " frames\n";
    }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return all;
}

/// Points of moving sequences, by what they are, and of those the ones that a cloud without the
/// robot holds, without and with a memory.
struct Moving {
  std::size_t on_robot = 0;
  std::array<std::size_t, 6> points{};  // by Point; the last: of things next to the outline
  std::array<std::array<std::size_t, 6>, 2> kept{};
  std::size_t confirmed = 0, off = 0;  // by the memory; of these, of nothing there
  std::size_t sequences_off = 0;       // with such points

  void add(const Moving& other) {
    on_robot += other.on_robot;
    confirmed += other.confirmed;
    off += other.off;
    sequences_off += other.off > 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] += other.points[i];
      for (std::size_t k = 0; k < kept.size(); ++k) kept[k][i] += other.kept[k][i];
    }
  }
};

Moving tally_sequence(std::size_t cell, bool changes) {
  StereoCell place(first_seed + cell);
  const Intrinsics camera = StereoCell::intrinsics();
  const LabelRule rule;
  Classifier alone(camera.width(), camera.height(), rule),
      with(camera.width(), camera.height(), rule);
  SceneMemory memory(camera.width(), camera.height(), rule);
  StereoImages images;
  Moving sum;
  for (std::size_t frame = 0; frame < frames_of_sequence; ++frame) {
    const VirtualDepthView robot = place.capture_moving(frame, changes, images);
    const DepthView measured = std::as_const(images.measured).view();
    memory.update(Eigen::Isometry3d::Identity(),
                  static_cast<std::int64_t>(1e9 * static_cast<double>(frame) / frame_rate), robot,
                  measured);
    const std::array<LabelView, 2> labels = {alone.classify(robot, measured),
                                             with.classify(robot, measured, memory.depth())};
    const tuning::NearestPixels nearest = test::nearest_robot(robot.depth);
    for (int v = 0; v < images.measured.height(); ++v)
      for (int u = 0; u < images.measured.width(); ++u) {
        if (images.measured(u, v) == 0 || nearest.distance(u, v) > nearby) continue;
        const Point point = point_of(images, robot, nearest, u, v);
        sum.on_robot += point == Point::robot;
        const int pixel = v * images.measured.width() + u;
        const auto count = [&](std::size_t kind) {
          ++sum.points[kind];
          for (std::size_t k = 0; k < 2; ++k)
            sum.kept[k][kind] += is_trusted(label_at(labels[k], pixel));
        };
        count(static_cast<std::size_t>(point));
        const bool is_confirmed = label_at(labels[0], pixel) == Label::fringe &&
                                  label_at(labels[1], pixel) == Label::clear;
        const double depth = 0.001 * static_cast<double>(images.measured(u, v));
        const double off = std::abs(depth - static_cast<double>(images.depth(u, v)));
        sum.confirmed += is_confirmed;
        sum.off += is_confirmed && off > wrong && !is_others(images, u, v, close);
        if (point == Point::thing && nearest.distance(u, v) <= close) count(5);
      }
  }
  return sum;
}

int study_moving(std::size_t sequences) {
  for (const bool changes : {false, true}) {
    Moving all;
    std::mutex mutex;
    std::atomic<std::size_t> next = 0;
    std::vector<std::thread> workers;
    for (int i = 0; i < threads; ++i)
      workers.emplace_back([&] {
        for (std::size_t cell = next++; cell < sequences; cell = next++) {
          const Moving sum = tally_sequence(cell, changes);
          const std::lock_guard lock(mutex);
          all.add(sum);
        }
      });
    for (std::thread& worker : workers) worker.join();
    std::cout << (changes ? "changing" : "static") << ", on robot " << all.on_robot << '\n';
    std::cout << "  confirmed by the memory: " << all.confirmed
              << ", of these of nothing there: " << all.off << ", in " << all.sequences_off
              << " of " << sequences << " sequences\n";
    const char* const names[] = {"robot", "carried", "thing", "room", "other", "thing next to it"};
    for (std::size_t i = 0; i < 6; ++i)
      std::cout << "  " << names[i] << ": " << all.points[i] << ", kept alone " << all.kept[0][i]
                << " (" << test::percent(all.kept[0][i], all.points[i]) << " %), with memory "
                << all.kept[1][i] << " (" << test::percent(all.kept[1][i], all.points[i])
                << " %)\n";
  }
  return 0;
}

std::string report(const Tally& sum) {
  std::vector<std::vector<std::string>> rows = {{"fringe_reach, px", "points of the robot left, %",
                                                 "points of things removed, %",
                                                 "points of the room removed, %"}};
  const auto of = [](const auto& counts, Point point) {
    return counts[static_cast<std::size_t>(point)];
  };
  const std::size_t carried = of(sum.points, Point::carried);
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    const auto& fringe = sum.fringe[i];
    const auto removed = [&](Point point, int digits) {
      return number(test::percent(of(fringe, point), of(sum.points, point)), digits);
    };
    rows.push_back(
        {std::to_string(reaches[i]),
         number(test::percent(carried - of(fringe, Point::carried), sum.on_robot + carried), 2),
         removed(Point::thing, 2), removed(Point::room, 3)});
  }
  return '\n' + table(rows) + '\n';
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  using namespace penumbra::study;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 2 && arguments[0] == "--sequences")
      return study_moving(std::stoul(arguments[1]));
    const bool has_count = arguments.size() == 3 && arguments[1] == "--frames";
    if (arguments.size() != 1 && !has_count) {
      std::cerr
          << "usage: stereo_study REPOSITORY [--frames N]\n       stereo_study --sequences N\n";
      return 2;
    }
    const Tally sum = study(has_count ? std::stoul(arguments[2]) : 1000);
    const std::string text = report(sum);
    std::cout << text;
    if (!has_count)
      update_page(std::filesystem::path(arguments[0]) / "docs/cloud.md", "stereo_study", text);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}
