// SPDX-License-Identifier: Apache-2.0
// Watches simulated cameras that stay, that are bumped, and that drift, beside a swinging arm.
// Writes the table of docs/calibration.md.
// usage: watch_study [FRAMES PER ROBOT]
#include "simulated_cell.hpp"
#include "study_page.hpp"

#include <chrono>
#include <exception>
#include <iostream>
#include <optional>

#include <penumbra/calibration/watch.hpp>

namespace penumbra::study {
namespace {

constexpr std::int64_t period = 33'333'333;      // nanoseconds between images
constexpr std::size_t stay = 300, bumped = 300;  // frames before and after a bump
constexpr double bump_position = 0.003, bump_rotation = 0.2 * degree;
constexpr double drift_speed = 0.001 / 60.0;  // metres per second
constexpr std::size_t most_drift = 5400;      // frames: three minutes

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
    }
    return {name,
            std::to_string(frames_),
            std::to_string(false_alarms_),
            std::to_string(told_.size()) + " of " + std::to_string(bumps_),
            number(quantile(told_, 0.5), 0) + ", " + number(quantile(told_, 1.0), 0),
            number(quantile(off_, 1.0), 0),
            std::to_string(drifts_told_.size()) + " of " + std::to_string(drifts_),
            number(quantile(drifts_told_, 0.5), 1) + ", " + number(quantile(drifts_told_, 1.0), 1),
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
        pipeline_.process({.stamp = period * static_cast<std::int64_t>(watched.frames),
                           .depth = frame_.depth.view(),
                           .joints = frame_.joints,
                           .T_parent_camera = cell_.truth() * motion.inverse(),
                           .index = watched.frames});
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
      if (std::getenv("DBG")) std::cout << "bump told " << (bump_.told ? *bump_.told : 0) << " at " << *at << " +- " << bump_.watch.drift().bumped_within << " | " << bump_.watch.drift().message() << std::endl;
    } else if (std::getenv("DBG")) std::cout << "bump told " << (bump_.told ? *bump_.told : 0) << " no frame " << bump_.watch.drift().bumped_within << " | " << bump_.watch.drift().message() << std::endl;
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
  Camera camera_{Cell::intrinsics(), {}, {}, {}};
  Pipeline pipeline_;
  std::size_t frames_;
  CalibrationFrame frame_;
  Watched still_{camera_}, bump_{camera_}, drift_{camera_};
  std::size_t within_ = 0, false_alarms_ = 0, bumps_ = 0, drifts_ = 0, processed_ = 0;
  std::vector<double> told_, off_, drifts_told_;
  double watch_seconds_ = 0.0, pipeline_seconds_ = 0.0;
};

/// Sequences of cameras that stay, whose clocks differ from the joint states'.
class ClockStudy {
 public:
  explicit ClockStudy(const RobotChoice& choice) : choice_(choice) {}

  std::vector<std::string> run(std::size_t sequences) {
    for (std::size_t i = 0; i < sequences; ++i) follow(i);
    return {choice_.name,
            std::to_string(sequences)};
  }

 private:
  void follow(std::size_t number) {
    sim::Random random(number, 11);
    const Setup setup{.name = "", .speed = random.uniform(0.1, 1.0)};
    Cell cell(choice_, setup, number);
    cell.start_swing();
    const bool is_slow = std::getenv("ONE") != nullptr;
    const std::size_t only = number % choice_.centre.size();
    const auto joints_at = [&](double t) {
      std::vector<double> joints = cell.joints_at(t);
      if (is_slow) {
        const std::vector<double> at = cell.joints_at(0.0);
        for (std::size_t j = 0; j < joints.size(); ++j) if (j != only) joints[j] = at[j];
      }
      return joints;
    };
    const Camera camera{Cell::intrinsics(), {}, {}, {}};
    Pipeline pipeline(cell.robot(), camera, {});
    std::vector<CalibrationWatch> watches;
    std::vector<double> lates;
    const std::size_t n = 4;
    const double shift = std::getenv("SHIFT") != nullptr ? std::stod(std::getenv("SHIFT")) : 0.0;
    const double scale = std::getenv("LATE") != nullptr ? std::stod(std::getenv("LATE")) : 1.0;
    const std::size_t shift_at = std::getenv("SHIFT_AT") != nullptr ? std::stoul(std::getenv("SHIFT_AT")) : 0;
    std::vector<std::string> said(n);
    std::vector<std::string> first(n);
    for (std::size_t k = 0; k < n; ++k) {
      watches.emplace_back(camera);
      lates.push_back((k % 2 == 0 ? 1.0 : -1.0) * random.uniform(0.010, 0.080) * scale);
    }
    CalibrationFrame frame;
    const std::size_t frames = 600;
    for (std::size_t i = 0; i < frames; ++i) {
      const double seconds = 1e-9 * static_cast<double>(period) * static_cast<double>(i);
      frame.joints = joints_at(seconds);
      frame.index = i;
      if (i % 4 == 0) cell.draw(frame);
      for (std::size_t k = 0; k < n; ++k) {
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        if (i >= shift_at) {
        sim::Random again(number * n + k, 5);
        motion.translation() = shift * Eigen::Vector3d(again.normal(), again.normal(), again.normal()).normalized();
        motion.linear() = Eigen::AngleAxisd(0.67 / 0.01 * degree * shift, Eigen::Vector3d(again.normal(), again.normal(), again.normal()).normalized()).matrix();
        }
        const std::vector<double> joints = joints_at(seconds - lates[k]);
        watches[k].add(pipeline.process({.stamp = period * static_cast<std::int64_t>(i),
                           .depth = frame.depth.view(),
                           .joints = joints,
                           .T_parent_camera = cell.truth() * motion.inverse(),
                           .index = i}));
        const auto m = watches[k].drift().message();
        if (!m.empty() && first[k].empty()) first[k] = std::to_string(i) + " " + m;
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Drift& drift = watches[k].drift();
      std::cout << number << " speed " << setup.speed << " late " << 1e3 * lates[k] << " ms: estimate " << 1e3 * drift.time_offset.value << " +- " << 2e3 * drift.time_offset.sigma
        << " moved " << 1e3 * drift.position() << " +- " << 1e3 * drift.position_error() << " | " << first[k] << " | " << drift.message() << std::endl;
    }
  }

  const RobotChoice& choice_;
};

int study_all(int argc, char** argv) {
  if (argc > 2) {
    for (const RobotChoice& robot : robots()) { std::cout << robot.name << std::endl; ClockStudy(robot).run(std::stoull(argv[1])); }
    return 0;
  }
  const std::size_t frames = argc > 1 ? std::stoull(argv[1]) : 20000;
  std::vector<std::vector<std::string>> rows{{"robot", "frames", "false alarms", "bumps detected",
                                              "frames until then, median, most", "frames off, most",
                                              "drifts detected", "minutes, median, most",
                                              "watch, us", "pipeline, us"}};
  for (const RobotChoice& robot : robots()) {
    rows.push_back(WatchStudy(robot, frames).run(robot.name));
    for (const std::string& cell : rows.back()) std::cout << cell << "  ";
    std::cout << std::endl;
  }
  if (argc == 1)
    update_page(std::filesystem::path(PENUMBRA_STUDY_ROOT) / "docs/calibration.md", "watch_study",
                table(rows));
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
