// SPDX-License-Identifier: Apache-2.0
// Watches simulated cameras that stay, that are bumped, that drift, and whose clocks differ, beside
// a swinging arm. Writes the tables of bench/results/watch.txt. usage: watch_study [FRAMES PER
// ROBOT [MOTIONS PER ROBOT]], or bumps [SEQUENCES PER ROBOT [still]]
#include "simulated_cell.hpp"
#include "study_page.hpp"

#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>

#include <penumbra/calibration/calibration.hpp>

namespace penumbra::study {
namespace {

constexpr std::int64_t period = 33'333'333;      // nanoseconds between images
constexpr std::size_t stay = 300, bumped = 300;  // frames before and after a bump
constexpr double bump_position = 0.003, bump_rotation = 0.2 * degree;
constexpr double drift_speed = 0.001 / 60.0;  // metres per second
constexpr std::size_t most_drift = 5400;      // frames: three minutes

bool blames_clocks(const Drift& drift) { return drift.clocks_differ || drift.camera_or_clocks; }

/// A camera with its watch, and where it is from its calibration.
struct Watched {
  explicit Watched(const Camera& of) : camera(of), watch(of) {}

  void restart(const Eigen::Vector3d& direction_, const Eigen::Vector3d& axis_) {
    watch = CalibrationWatch(camera);
    frames = 0;
    told.reset();
    direction = direction_;
    axis = axis_;
  }

  const Camera& camera;
  CalibrationWatch watch;
  std::size_t frames = 0;
  std::optional<std::size_t> told;  // frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX(), axis = Eigen::Vector3d::UnitX();
};

class WatchStudy {
 public:
  WatchStudy(const RobotChoice& choice, std::size_t frames)
      : setup_{.name = "", .speed = 0.3},
        cell_(choice, setup_, 1),
        random_(9, 9),
        pipeline_(cell_.robot(), camera_, {}),
        frames_(frames) {
    cell_.start_swing();
    again(bump_);
    again(drift_);
  }

  std::vector<std::string> run(const std::string& name) {
    for (std::size_t i = 0; i < frames_; ++i) {
      frame_.joints = cell_.joints_at(1e-9 * static_cast<double>(period) * static_cast<double>(i));
      frame_.index = i;
      cell_.draw(frame_);
      follow(still_, Eigen::Isometry3d::Identity());
      false_alarms_ += still_.watch.drift().has_moved || still_.watch.drift().bumped_at;
      follow_bump();
      follow_drift();
      for (const Watched* watched : {&still_, &bump_, &drift_})
        false_clocks_ += blames_clocks(watched->watch.drift());
    }
    return {name,
            std::to_string(frames_),
            std::to_string(false_alarms_),
            std::to_string(false_clocks_),
            std::to_string(told_.size()) + " of " + std::to_string(bumps_),
            number(median(told_), 0) + ", " + number(quantile(told_, 1.0), 0),
            std::to_string(within_) + " of " + std::to_string(off_.size()),
            number(quantile(off_, 1.0), 0),
            std::to_string(drifts_told_.size()) + " of " + std::to_string(drifts_),
            number(median(drifts_told_), 1) + ", " + number(quantile(drifts_told_, 1.0), 1),
            number(1e6 * watch_seconds_ / static_cast<double>(processed_), 0),
            number(1e6 * pipeline_seconds_ / static_cast<double>(processed_), 0)};
  }

 private:
  Eigen::Vector3d any() {
    return Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal()).normalized();
  }
  void again(Watched& watched) { watched.restart(any(), any()); }

  /// The camera has moved by `motion` in its calibrated frame.
  void follow(Watched& watched, const Eigen::Isometry3d& motion) {
    const auto start = std::chrono::steady_clock::now();
    const FrameReport& report =
        pipeline_.process({.index = watched.frames,
                           .stamp = period * static_cast<std::int64_t>(watched.frames),
                           .depth = frame_.depth.view(),
                           .pose = {.positions = frame_.joints,
                                    .T_parent_camera = cell_.truth() * motion.inverse()}});
    const auto judged = std::chrono::steady_clock::now();
    watched.watch.add(report);
    const std::chrono::duration<double> watching = std::chrono::steady_clock::now() - judged,
                                        judging = judged - start;
    watch_seconds_ += watching.count();
    pipeline_seconds_ += judging.count();
    ++processed_;
    ++watched.frames;
    if (watched.watch.drift().has_moved && !watched.told) watched.told = watched.frames;
  }

  void follow_bump() {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (bump_.frames >= stay) {
      motion.translation() = bump_position * bump_.direction;
      motion.linear() = Eigen::AngleAxisd(bump_rotation, bump_.axis).matrix();
    }
    follow(bump_, motion);
    if (bump_.frames < stay + bumped) return;
    ++bumps_;
    if (bump_.told) told_.push_back(static_cast<double>(*bump_.told) - static_cast<double>(stay));
    if (const auto at = bump_.watch.drift().bumped_at) {
      off_.push_back(std::abs(static_cast<double>(*at) - static_cast<double>(stay)));
      within_ += off_.back() <= static_cast<double>(bump_.watch.drift().bumped_within);
    }
    again(bump_);
  }

  void follow_drift() {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    const double seconds = 1e-9 * static_cast<double>(period) * static_cast<double>(drift_.frames);
    motion.translation() = drift_speed * seconds * drift_.direction;
    follow(drift_, motion);
    if (!drift_.told && drift_.frames < most_drift) return;
    ++drifts_;
    if (drift_.told) drifts_told_.push_back(seconds / 60.0);
    again(drift_);
  }

  Setup setup_;
  Cell cell_;
  sim::Random random_;
  Camera camera_{.intrinsics = Cell::intrinsics(), .T_parent_camera = cell_.truth()};
  Pipeline pipeline_;
  std::size_t frames_;
  KeptFrame frame_;
  Watched still_{camera_}, bump_{camera_}, drift_{camera_};
  std::size_t within_ = 0, false_alarms_ = 0, false_clocks_ = 0, bumps_ = 0, drifts_ = 0,
              processed_ = 0;
  std::vector<double> told_, off_, drifts_told_;
  double watch_seconds_ = 0.0, pipeline_seconds_ = 0.0;
};

/// Cameras that stay, whose clocks differ from the joint states' by 10 to 80 ms, beside arms that
/// swing all joints or only one.
class ClockStudy {
 public:
  explicit ClockStudy(const RobotChoice& choice) : choice_(choice) {}

  std::vector<std::string> run(std::size_t motions) {
    for (std::size_t i = 0; i < motions; ++i) follow(i);
    const auto share = [](std::size_t count, std::size_t of) {
      return std::to_string(count) + " of " + std::to_string(of);
    };
    return {choice_.name,
            std::to_string(sequences_),
            std::to_string(moved_),
            share(told_.size(), sequences_),
            std::to_string(either_),
            number(median(told_), 0) + ", " + number(quantile(told_, 1.0), 0),
            number(median(off_), 1) + ", " + number(quantile(off_, 1.0), 1)};
  }

 private:
  static constexpr std::size_t frames = 600;
  static constexpr std::size_t looked_at = 4;  // the watch reads one depth image of so many

  struct Late {
    double seconds;  // from the pose that is said to the image
    CalibrationWatch watch;
    std::optional<std::size_t> told = {};
    bool is_moved = false, is_either = false;
  };

  void follow(std::size_t number) {
    sim::Random random(number, 11);
    const Setup setup{.name = "", .speed = random.uniform(0.1, 1.0)};
    Cell cell(choice_, setup, number);
    cell.start_swing();
    const auto joints_at = [&](double seconds) {
      std::vector<double> joints = cell.joints_at(seconds);
      if (number % 2 == 0) return joints;
      std::vector<double> one = cell.joints_at(0.0);
      const std::size_t moving = number / 2 % choice_.centre.size();
      one[moving] = joints[moving];
      return one;
    };
    Camera camera{Cell::intrinsics(), {}, {}, {}};
    camera.T_parent_camera = cell.truth();
    Pipeline pipeline(cell.robot(), camera, {});
    std::vector<Late> all;
    for (const double sign : {-1.0, 1.0})
      all.push_back({sign * random.uniform(0.01, 0.08), CalibrationWatch(camera)});
    KeptFrame frame;
    for (std::size_t i = 0; i < frames; ++i) {
      const double seconds = 1e-9 * static_cast<double>(period) * static_cast<double>(i);
      frame.joints = joints_at(seconds);
      frame.index = i;
      if (i % looked_at == 0) cell.draw(frame);
      for (Late& late : all) {
        const std::vector<double> joints = joints_at(seconds - late.seconds);
        late.watch.add(
            pipeline.process({.index = i,
                              .stamp = period * static_cast<std::int64_t>(i),
                              .depth = frame.depth.view(),
                              .pose = {.positions = joints, .T_parent_camera = cell.truth()}}));
        const Drift& drift = late.watch.drift();
        late.is_moved |= drift.has_moved || drift.bumped_at;
        late.is_either |= drift.camera_or_clocks;
        if (drift.clocks_differ && !late.told) late.told = i;
      }
    }
    for (const Late& late : all) {
      ++sequences_;
      moved_ += late.is_moved;
      either_ += late.is_either;
      if (!late.told) continue;
      told_.push_back(static_cast<double>(*late.told));
      off_.push_back(1e3 * std::abs(late.watch.drift().time_offset.value - late.seconds));
    }
  }

  const RobotChoice& choice_;
  std::size_t sequences_ = 0, moved_ = 0, either_ = 0;
  std::vector<double> told_, off_;  // frames, milliseconds
};

/// Bumps of several sizes soon after the start, in whole images and in small ones, beside arms that
/// swing all joints or only two.
class BumpStudy {
 public:
  struct Case {
    double position, rotation;      // metres, rad
    int binned;                     // pixels that become one, in each direction
    std::vector<double> told = {};  // frames after the bump
    std::size_t false_alarms = 0, runs = 0;
  };

  explicit BumpStudy(const RobotChoice& choice) : choice_(choice) {}

  void run(std::size_t sequences, std::vector<Case>& cases) {
    for (std::size_t i = 0; i < sequences; ++i) follow(i, cases);
  }

 private:
  static constexpr std::size_t looked_at = 4;  // the watch reads one depth image of so many
  static constexpr std::size_t after = 300;    // frames

  struct Bumped {
    Camera camera;
    Pipeline pipeline;
    CalibrationWatch watch;
    FrameReport report;
    bool is_told = false;
  };

  void follow(std::size_t number, std::vector<Case>& cases) {
    sim::Random random(number, 13);
    const Setup setup{.name = "", .speed = random.uniform(0.1, 0.6)};
    Cell cell(choice_, setup, number);
    cell.start_swing();
    const auto before = static_cast<std::size_t>(random.uniform(60.0, 300.0));
    const auto any = [&] {
      return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    };
    const Eigen::Vector3d direction = any(), axis = any();
    std::vector<std::unique_ptr<Bumped>> all;
    for (const Case& one : cases) {
      const Intrinsics whole = Cell::intrinsics();
      const auto by = static_cast<double>(one.binned);
      Camera camera{{whole.width() / one.binned, whole.height() / one.binned, whole.fx() / by,
                     whole.fy() / by, whole.cx() / by, whole.cy() / by},
                    {},
                    {},
                    {}};
      camera.T_parent_camera = cell.truth();
      all.push_back(std::make_unique<Bumped>(
          Bumped{camera, Pipeline(cell.robot(), camera, {}), CalibrationWatch(camera), {}}));
    }
    std::vector<Eigen::Isometry3d> links(cell.robot().links().size());
    KeptFrame frame;
    for (std::size_t i = 0; i < before + after; ++i) {
      frame.joints = cell.joints_at(1e-9 * static_cast<double>(period) * static_cast<double>(i));
      if (number % 2 != 0) {
        const std::vector<double> still = cell.joints_at(0.0);
        for (std::size_t j = 2; j < frame.joints.size(); ++j) frame.joints[j] = still[j];
      }
      frame.index = i;
      cell.robot().forward_kinematics(frame.joints, links);
      if (i % looked_at == 0) cell.draw(frame);
      for (std::size_t k = 0; k < cases.size(); ++k) {
        Bumped& one = *all[k];
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        if (i >= before) {
          motion.translation() = cases[k].position * direction;
          motion.linear() = Eigen::AngleAxisd(cases[k].rotation, axis).matrix();
        }
        const Eigen::Isometry3d said = cell.truth() * motion.inverse();
        const auto stamp = period * static_cast<std::int64_t>(i);
        Image<float> small;
        if (i % looked_at == 0) {
          small = binned(frame.depth, cases[k].binned);
          one.report =
              one.pipeline.process({.index = i,
                                    .stamp = stamp,
                                    .depth = std::as_const(small).view(),
                                    .pose = {.positions = frame.joints, .T_parent_camera = said}});
        }
        one.report.index = i;
        one.report.stamp = stamp;
        one.report.T_root_link = links;  // of a fixed camera
        one.report.T_root_camera = said;
        one.watch.add(one.report);
        const Drift& drift = one.watch.drift();
        const bool is_told = drift.has_moved || drift.bumped_at;
        if (i < before || cases[k].position == 0.0)
          cases[k].false_alarms += is_told;
        else if (is_told && !one.is_told)
          cases[k].told.push_back(static_cast<double>(i - before + 1));
        one.is_told |= is_told && i >= before;
      }
    }
    for (Case& one : cases) ++one.runs;
  }

  static Image<float> binned(const Image<float>& depth, int by) {
    Image<float> small(depth.width() / by, depth.height() / by);
    for (int v = 0; v < small.height(); ++v)
      for (int u = 0; u < small.width(); ++u) small(u, v) = depth(by * u, by * v);
    return small;
  }

  const RobotChoice& choice_;
};

void study_bumps(std::size_t sequences, bool still) {
  std::vector<BumpStudy::Case> cases;
  for (const int binned : {1, 2})
    for (const auto& [position, rotation] :
         {std::pair{0.0, 0.0}, {0.003, 0.2}, {0.013, 1.25}, {0.03, 2.0}})
      if (!still || position == 0.0) cases.push_back({position, rotation * degree, binned});
  for (const RobotChoice& robot : robots()) BumpStudy(robot).run(sequences, cases);
  for (BumpStudy::Case& one : cases)
    std::cout << number(1e3 * one.position, 0) << " mm, " << number(one.rotation / degree, 2)
              << " deg, binned " << one.binned << ": told " << one.told.size() << " of " << one.runs
              << ", median " << number(median(one.told), 0) << ", 90 % "
              << number(quantile(one.told, 0.9), 0) << ", most "
              << number(quantile(one.told, 1.0), 0) << "; false in frames " << one.false_alarms
              << std::endl;
}

void print(const std::vector<std::string>& row) {
  for (const std::string& cell : row) std::cout << cell << "  ";
  std::cout << std::endl;
}

int study_all(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "bumps") {
    study_bumps(argc > 2 ? std::stoull(argv[2]) : 10, argc > 3);
    return 0;
  }
  const std::size_t frames = argc > 1 ? std::stoull(argv[1]) : 20000;
  const std::size_t motions = argc > 2 ? std::stoull(argv[2]) : 25;
  const auto page = std::filesystem::path(PENUMBRA_STUDY_ROOT) / "bench/results/watch.txt";
  std::vector<std::vector<std::string>> clocks{
      {"robot", "sequences", "camera blamed", "clocks named", "either",
       "frames until then, median, most", "ms off, median, most"}};
  for (const RobotChoice& robot : robots()) {
    clocks.push_back(ClockStudy(robot).run(motions));
    print(clocks.back());
  }
  if (argc == 1) update_page(page, "watch_clocks", table(clocks));
  std::vector<std::vector<std::string>> rows{
      {"robot", "frames", "false alarms", "clocks blamed", "bumps detected",
       "frames until then, median, most", "frame named and right", "frames off, most",
       "drifts detected", "minutes, median, most", "watch, us", "pipeline, us"}};
  for (const RobotChoice& robot : robots()) {
    rows.push_back(WatchStudy(robot, frames).run(robot.name));
    print(rows.back());
  }
  if (argc == 1) update_page(page, "watch_study", table(rows));
  return 0;
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  try {
    return penumbra::study::study_all(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
