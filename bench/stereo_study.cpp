// SPDX-License-Identifier: Apache-2.0
// Measures against the simulator's truth what a stereo camera carries past the robot's outline, how
// much of it the fringe finds and what it takes of real things. Writes a table into
// bench/results/points.txt. With --sequences, prints the same of a moving arm, from single images
// and with a memory of the scene: where things stay, where half of them go and others come, where a
// person walks through and where a door opens. With --boxes, prints what is kept of two boxes next
// to the arm's outline, of which one stood there before the arm came.
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
#include <optional>
#include <thread>

#include <penumbra/base/statistics-inl.hpp>
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

/// What happens while the arm moves.
enum class Change { nothing, things, person, door };
constexpr std::array<const char*, 4> change_names = {"static", "things go and come",
                                                     "a person walks through", "a door opens"};

constexpr std::size_t frames_of_sequence = 60;
constexpr double seen_from = 104.0;   // pixels from the arm: the memory sees all there
constexpr double walk = 1.5;          // metres to each side, in a second
constexpr double clear_of_arm = 0.1;  // metres from its middle, of a person and a door
constexpr double away = 10.0;         // metres: out of view
constexpr double close = 20.0;        // pixels from the outline

/// The simulated arm among eight things before, behind and next to it, seen by a stereo camera. The
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
        stage_(arm_, description(), folder_.path(), intrinsics()),
        renderer_(make_depth_renderer(Backend::cpu, intrinsics(), bodies_of(arm_.robot()))),
        camera_(intrinsics(), seed),
        random_(seed, 47),
        poses_(arm_.robot().links().size()) {
    others_.fill(out_of_view());
  }

  /// Captures frame `index` into `images`. Returns the robot alone, as rendered.
  VirtualDepthView capture(std::size_t index, StereoImages& images) {
    const double time = static_cast<double>(index) / frame_rate;
    return capture(scene_->joints(time), scene_->pose(time).parts, images);
  }

  /// Captures what one of the frames of a sequence shows: the arm comes to the first frame's pose
  /// among the first frame's things, and leaves. `arm`: where the arm is in place of that, as s.
  VirtualDepthView capture_moving(std::size_t frame, Change change, StereoImages& images,
                                  std::optional<double> arm = {}) {
    const double s = 2.0 * static_cast<double>(frame) / frames_of_sequence;  // 1: half-way
    std::vector<Eigen::Isometry3d> parts = scene_->pose(0.0).parts;
    const std::vector<ScenePart>& all = scene_->description().parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const int object = all[i].object;
      const bool goes = object >= 0 && object % 2 == 0, comes = object >= 0 && object % 2 == 1;
      if (change == Change::things && ((goes && s >= 1.0) || (comes && s < 1.0)))
        parts[i] = out_of_view();
    }
    if (frame == 0 && !arm) begin();
    if (change == Change::person) others_[0] = at({walk * (s - 1.0), 0.0, depth_});
    if (change == Change::door)
      others_[1] = at({hinge_, 0.0, depth_}) *
                   Eigen::AngleAxisd(0.5 * M_PI * std::clamp(2.0 * s - 1.0, 0.0, 1.0) *
                                         (hinge_ > 0.0 ? 1.0 : -1.0),
                                     Eigen::Vector3d::UnitY()) *
                   Eigen::Translation3d(hinge_ > 0.0 ? -0.4 : 0.4, 0.0, 0.0);
    return capture(joints_at(arm.value_or(s)), parts, images);
  }

  /// A box whose front faces the camera.
  struct Box {
    double u = 0, v = 0, half = 0, z = 0;  // pixels; metres

    [[nodiscard]] bool holds(double x, double y, double margin) const {
      return std::max(std::abs(x - u), std::abs(y - v)) <= half + margin;
    }
  };

  /// Returns a box that is `gap` pixels from the arm's outline half-way, and `offset` metres behind
  /// it. It is far from the arm of the first frame.
  std::optional<Box> box_next_to_arm(double gap, double offset) {
    const VirtualDepthView first = render(joints_at(0.0));
    const tuning::NearestPixels far = test::nearest_robot(first.depth);
    const VirtualDepthView robot = render(joints_at(1.0));
    const tuning::NearestPixels nearest = test::nearest_robot(robot.depth);
    for (int i = 0; i < 20000; ++i) {
      Box box{.u = random_.uniform() * robot.depth.width,
              .v = random_.uniform() * robot.depth.height};
      const auto at = nearest.at(static_cast<int>(box.u), static_cast<int>(box.v));
      box.z = static_cast<double>(robot.depth(at.u, at.v)) + offset;
      box.half = 0.03 * intrinsics().fx() / box.z;
      const bool is_inside = box.u > box.half && box.u < robot.depth.width - 1 - box.half &&
                             box.v > box.half && box.v < robot.depth.height - 1 - box.half;
      if (!is_inside || far.distance(static_cast<int>(box.u), static_cast<int>(box.v)) <
                            seen_from + 1.5 * box.half)
        continue;
      double distance = seen_from;
      for (int v = static_cast<int>(std::ceil(box.v - box.half)); v <= box.v + box.half; ++v)
        for (int u = static_cast<int>(std::ceil(box.u - box.half)); u <= box.u + box.half; ++u)
          distance = std::min(distance, nearest.distance(u, v));
      if (distance >= gap + 1.0 && distance < gap + 2.5 && !is_pushed(box)) return box;
    }
    return std::nullopt;
  }

  /// Returns whether the arm comes to where a box is before it stops next to it.
  bool is_pushed(const Box& box) {
    constexpr double touches = 0.15;  // metres: more than the box and half a link are thick
    for (double s = 0.0; s < 1.0; s += 0.05) {
      const VirtualDepthView robot = render(joints_at(s));
      for (int v = 0; v < robot.depth.height; v += 2)
        for (int u = 0; u < robot.depth.width; u += 2)
          if (robot.depth(u, v) > 0.0F && box.holds(u, v, 0.0) &&
              std::abs(static_cast<double>(robot.depth(u, v)) - box.z) < touches)
            return true;
    }
    return false;
  }

  /// Captures the arm and the boxes `0` and, if `is_late`, `1`.
  VirtualDepthView capture_boxes(double s, const std::array<Box, 2>& boxes, bool is_late,
                                 StereoImages& images) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Eigen::Vector3d ray = intrinsics().ray(boxes[i].u, boxes[i].v);
      others_[2 + i] = i == 0 || is_late ? at(boxes[i].z * ray + Eigen::Vector3d(0.0, 0.0, 0.03))
                                         : out_of_view();
      if (i == 0 || is_late) others_[2 + i].linear() = T_base_camera().linear();
    }
    return capture(joints_at(s), scene_->pose(0.0).parts, images);
  }

  /// Captures an arm among parts.
  VirtualDepthView capture(const std::vector<double>& joints, std::vector<Eigen::Isometry3d> parts,
                           StereoImages& images) {
    parts.insert(parts.end(), others_.begin(), others_.end());
    stage_.place(joints, parts);
    camera_.capture(stage_, T_base_camera(), images);
    return render(joints);
  }

 private:
  /// Half-way (1) the arm is at the first frame's pose.
  [[nodiscard]] std::vector<double> joints_at(double s) const {
    const double to = s < 1.0 ? s * s * (3.0 - 2.0 * s) : (s - 1.0) * (s - 1.0) * (5.0 - 2.0 * s);
    const std::vector<double> from = scene_->joints((s < 1.0 ? 1.0 : 0.0) / frame_rate);
    std::vector<double> joints = scene_->joints((s < 1.0 ? 0.0 : 2.0) / frame_rate);
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints[i] = from[i] + to * (joints[i] - from[i]);
    return joints;
  }

  static RobotOptions visual_geometry() {
    RobotOptions options;
    options.geometry = Geometry::visual;
    options.geometry_fallback = true;
    return options;
  }

  [[nodiscard]] const Eigen::Isometry3d& T_base_camera() const {
    return scene_->description().T_base_camera;
  }
  [[nodiscard]] Eigen::Isometry3d at(const Eigen::Vector3d& in_camera) const {
    return T_base_camera() * Eigen::Translation3d(in_camera);
  }
  static Eigen::Isometry3d out_of_view() {
    return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -away));
  }

  /// The scene's, with a person, a door and two boxes.
  [[nodiscard]] sim::SceneDescription description() const {
    sim::SceneDescription all = scene_->description();
    for (const char* const size :
         {"0.22 0.9 0.06", "0.4 0.9 0.02", "0.03 0.03 0.03", "0.03 0.03 0.03"})
      all.parts.push_back(
          {-1, std::string("<geom type=\"box\" rgba=\"0.5 0.5 0.6 1\" group=\"2\" ") + "size=\"" +
                   size + "\"/>"});
    return all;
  }

  VirtualDepthView render(const std::vector<double>& joints) {
    arm_.robot().forward_kinematics(joints, poses_);
    for (Eigen::Isometry3d& pose : poses_) pose = T_base_camera().inverse() * pose;
    return renderer_->render(poses_);
  }

  /// Chooses where person and door are: next to, before or behind the arm's middle.
  void begin() {
    const VirtualDepthView robot = render(scene_->joints(0.0));
    std::vector<double> depths;
    for (int v = 0; v < robot.depth.height; ++v)
      for (int u = 0; u < robot.depth.width; ++u)
        if (robot.depth(u, v) > 0.0F) depths.push_back(static_cast<double>(robot.depth(u, v)));
    const double middle = depths.empty() ? 1.0 : detail::median(depths);
    const double off = clear_of_arm + 0.4 * random_.uniform();
    depth_ = std::max(middle + (random_.uniform() < 0.3 ? -off : off), 0.4);
    hinge_ = random_.uniform() < 0.5 ? -0.4 : 0.4;
  }

  sim::TemporaryFolder folder_;
  sim::Arm arm_;
  std::unique_ptr<sim::Scene> scene_;
  sim::Stage stage_;
  std::unique_ptr<DepthRenderer> renderer_;
  StereoCamera camera_;
  sim::Random random_;
  std::array<Eigen::Isometry3d, 4> others_;  // in the base frame: person, door and boxes
  double depth_ = 0.0, hinge_ = 0.0;         // theirs, and the door's edge in the camera frame
  std::vector<Eigen::Isometry3d> poses_;     // T_camera_link
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
  std::size_t confirmed = 0;       // by the memory
  std::size_t gone = 0;            // of these, what was there, is gone, and only the arm explains
  std::size_t not_judged = 0;      // may be gone: near the arm in all poses
  std::size_t sequences_gone = 0;  // with such points

  void add(const Moving& other) {
    on_robot += other.on_robot;
    confirmed += other.confirmed;
    gone += other.gone;
    not_judged += other.not_judged;
    sequences_gone += other.gone > 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] += other.points[i];
      for (std::size_t k = 0; k < kept.size(); ++k) kept[k][i] += other.kept[k][i];
    }
  }
};

Moving tally_sequence(std::size_t cell, Change change) {
  StereoCell place(first_seed + cell);
  const Intrinsics camera = StereoCell::intrinsics();
  const LabelRule rule;
  Classifier alone(camera.width(), camera.height(), rule),
      with(camera.width(), camera.height(), rule);
  SceneMemory memory(camera.width(), camera.height(), rule);
  StereoImages images, elsewhere;
  std::vector<StereoImages> before;
  Moving sum;
  for (std::size_t frame = 0; frame < frames_of_sequence; ++frame) {
    const VirtualDepthView robot = place.capture_moving(frame, change, images);
    const DepthView measured = std::as_const(images.measured).view();
    memory.update(Eigen::Isometry3d::Identity(),
                  static_cast<std::int64_t>(1e9 * static_cast<double>(frame) / frame_rate), robot,
                  measured);
    const std::array<LabelView, 2> labels = {alone.classify(robot, measured),
                                             with.classify(robot, measured, memory.depth())};
    const tuning::NearestPixels nearest = test::nearest_robot(robot.depth);
    std::vector<int> gone;  // pixels
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
        if (is_confirmed && off > wrong && !is_others(images, u, v, close))
          if (std::ranges::any_of(before, [&](StereoImages& then) {
                then.measured(u, v) = images.measured(u, v);
                return is_others(then, u, v, close);
              }))
            gone.push_back(pixel);
        if (point == Point::thing && nearest.distance(u, v) <= close) count(5);
      }
    if (frame % 4 == 0) before.push_back(images);
    if (gone.empty()) continue;
    std::vector<bool> is_judged(gone.size()), is_gone(gone.size());
    for (const double arm : {0.0, 1.0, 2.0}) {
      const VirtualDepthView away_from_it = place.capture_moving(frame, change, elsewhere, arm);
      const tuning::NearestPixels there = test::nearest_robot(away_from_it.depth);
      for (std::size_t i = 0; i < gone.size(); ++i) {
        const int u = gone[i] % camera.width(), v = gone[i] / camera.width();
        if (there.distance(u, v) <= nearby) continue;
        is_judged[i] = true;
        if (std::abs(int{images.measured(u, v)} - int{elsewhere.measured(u, v)}) >
            static_cast<int>(1000.0 * wrong))
          is_gone[i] = true;
      }
    }
    sum.gone += static_cast<std::size_t>(std::ranges::count(is_gone, true));
    sum.not_judged += static_cast<std::size_t>(std::ranges::count(is_judged, false));
  }
  return sum;
}

int study_moving(std::size_t sequences) {
  for (const Change change : {Change::person, Change::things, Change::door, Change::nothing}) {
    Moving all;
    std::mutex mutex;
    std::atomic<std::size_t> next = 0;
    std::vector<std::thread> workers;
    for (int i = 0; i < threads; ++i)
      workers.emplace_back([&] {
        for (std::size_t cell = next++; cell < sequences; cell = next++) {
          const Moving sum = tally_sequence(cell, change);
          const std::lock_guard lock(mutex);
          all.add(sum);
        }
      });
    for (std::thread& worker : workers) worker.join();
    std::cout << change_names.at(static_cast<std::size_t>(change)) << ", on robot " << all.on_robot
              << '\n';
    std::cout << "  confirmed by the memory: " << all.confirmed
              << ", of these of what is gone: " << all.gone << ", in " << all.sequences_gone
              << " of " << sequences << " sequences; not judged: " << all.not_judged << '\n';
    const char* const names[] = {"robot", "carried", "thing", "room", "other", "thing next to it"};
    for (std::size_t i = 0; i < 6; ++i)
      std::cout << "  " << names[i] << ": " << all.points[i] << ", kept alone " << all.kept[0][i]
                << " (" << test::percent(all.kept[0][i], all.points[i]) << " %), with memory "
                << all.kept[1][i] << " (" << test::percent(all.kept[1][i], all.points[i]) << " %)"
                << std::endl;
  }
  return 0;
}

constexpr std::array<double, 7> offsets = {-0.10, -0.05, -0.03, 0.0, 0.03, 0.05, 0.10};  // metres
constexpr std::array<double, 4> gaps = {0.0, 5.0, 10.0, 20.0};                           // pixels

/// Pixels of boxes, and those that are kept without and with a memory: of the box that was there,
/// and of a new one.
struct BoxTally {
  std::size_t placements = 0;
  std::array<std::size_t, 2> all{};
  std::array<std::array<std::size_t, 2>, 2> kept{};
};
using BoxTable = std::array<std::array<BoxTally, gaps.size()>, offsets.size()>;

void tally_boxes(std::size_t cell, BoxTable& table) {
  StereoCell place(first_seed + cell / (offsets.size() * gaps.size()));
  const std::size_t i = cell % offsets.size(), j = cell / offsets.size() % gaps.size();
  const auto old_box = place.box_next_to_arm(gaps[j], offsets[i]);
  const auto new_box = place.box_next_to_arm(gaps[j], offsets[i]);
  if (!old_box || !new_box) return;
  const std::array<StereoCell::Box, 2> boxes = {*old_box, *new_box};
  const Intrinsics camera = StereoCell::intrinsics();
  const LabelRule rule;
  Classifier alone(camera.width(), camera.height(), rule),
      with(camera.width(), camera.height(), rule);
  SceneMemory memory(camera.width(), camera.height(), rule);
  StereoImages images;
  BoxTally sum;
  for (int frame = 0; frame <= 31; frame += frame < 27 ? 3 : 1) {  // it stops at frame 30
    const double s = frame / 30.0;
    const VirtualDepthView robot = place.capture_boxes(s, boxes, frame >= 27, images);
    const DepthView measured = std::as_const(images.measured).view();
    memory.update(Eigen::Isometry3d::Identity(), static_cast<std::int64_t>(1e9 * s), robot,
                  measured);
    if (frame < 29) continue;
    const std::array<LabelView, 2> labels = {alone.classify(robot, measured),
                                             with.classify(robot, measured, memory.depth())};
    for (std::size_t b = 0; b < boxes.size(); ++b)
      for (int v = 0; v < camera.height(); ++v)
        for (int u = 0; u < camera.width(); ++u) {
          const double z = static_cast<double>(images.depth(u, v));
          const double off = std::abs(0.001 * images.measured(u, v) - z);
          if (!boxes[b].holds(u, v, -2.0) || std::abs(z - boxes[b].z) > 0.005 || off > right ||
              robot.depth(u, v) > 0.0F)
            continue;
          ++sum.all[b];
          for (std::size_t k = 0; k < 2; ++k)
            sum.kept[b][k] += is_trusted(label_at(labels[k], v * camera.width() + u));
        }
  }
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  BoxTally& into = table[i][j];
  ++into.placements;
  for (std::size_t b = 0; b < 2; ++b) {
    into.all[b] += sum.all[b];
    for (std::size_t k = 0; k < 2; ++k) into.kept[b][k] += sum.kept[b][k];
  }
}

int study_boxes(std::size_t sequences) {
  BoxTable sums{};
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i)
    workers.emplace_back([&] {
      for (std::size_t cell = next++; cell < sequences; cell = next++) tally_boxes(cell, sums);
    });
  for (std::thread& worker : workers) worker.join();
  for (const std::size_t b : {0, 1}) {
    std::vector<std::vector<std::string>> rows = {{"cm behind the outline"}};
    for (const double gap : gaps) rows[0].push_back(number(gap, 0) + " px away");
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      rows.push_back({number(100.0 * offsets[i], 0)});
      for (const BoxTally& of : sums[i])
        rows.back().push_back(of.all[b] == 0
                                  ? "none"
                                  : number(test::percent(of.kept[b][0], of.all[b]), 1) + " / " +
                                        number(test::percent(of.kept[b][1], of.all[b]), 1) +
                                        " of " + std::to_string(of.placements));
    }
    std::cout << (b == 0 ? "seen before\n" : "new\n") << table(rows) << '\n';
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
  const auto count = [&](std::size_t i) { return std::strtoul(arguments[i].c_str(), nullptr, 10); };
  try {
    if (arguments.size() == 2 && arguments[0] == "--sequences" && count(1) > 0)
      return study_moving(count(1));
    if (arguments.size() == 2 && arguments[0] == "--boxes" && count(1) > 0)
      return study_boxes(count(1));
    const bool has_count = arguments.size() == 3 && arguments[1] == "--frames" && count(2) > 0;
    if ((arguments.size() != 1 && !has_count) || arguments[0].starts_with("-")) {
      std::cerr << "usage: stereo_study REPOSITORY [--frames N]\n       stereo_study --sequences "
                   "N\n       stereo_study --boxes N\n";
      return 2;
    }
    const Tally sum = study(has_count ? count(2) : 1000);
    const std::string text = report(sum);
    std::cout << text;
    if (!has_count)
      update_page(std::filesystem::path(arguments[0]) / "bench/results/points.txt", "stereo_study",
                  text);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}
