// SPDX-License-Identifier: Apache-2.0
// Calibrates simulated cameras whose pose is known, and counts how far off the results and their
// stated errors are. Without arguments it writes the table of docs/calibration.md.
// usage: calibration_study [PART OF A SETUP'S NAME [RUNS [PART OF A ROBOT'S NAME]]]
//        calibration_study real
#include "simulated_cell.hpp"
#include "study_page.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/calibration/calibration.hpp>

#include <io/run/calibration_input.hpp>
#include <sim/random.hpp>

namespace penumbra::study {
namespace {

struct Outcome {
  bool refused = false;
  double position = 0.0, rotation = 0.0;  ///< metres and rad
  double mahalanobis = 0.0;               ///< squared, of the six
  double seconds = 0.0;
  double late = 0.0, late_sigma = 0.0;  ///< error of the time offset, and what is stated, seconds
};

Outcome calibrated(const RobotChoice& robot, const Setup& setup, std::uint64_t seed) {
  Cell cell(robot, setup, seed);
  const std::vector<CalibrationFrame> frames = cell.frames();
  CalibrationOptions options;
  if (setup.on_hand) options.camera_parent = robot.flange;
  if (!setup.search) options.initial = cell.off();
  options.seed = seed;
  options.time_offset = setup.speed > 0.0;
  const auto start = std::chrono::steady_clock::now();
  const Calibration found = calibrate(frames, Cell::intrinsics(), cell.robot(), options);
  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.refused = !found.is_good();
  if (found.time_offset) {
    outcome.late = found.time_offset->value - setup.late;
    outcome.late_sigma = found.time_offset->sigma;
  }
  const Eigen::Isometry3d error = found.T_parent_camera.inverse() * cell.truth();
  const Eigen::AngleAxisd turn(error.linear());
  Eigen::Matrix<double, 6, 1> twist;
  twist << turn.angle() * turn.axis(), error.translation();
  outcome.position = error.translation().norm();
  outcome.rotation = std::abs(turn.angle());
  outcome.mahalanobis = twist.dot(found.covariance.ldlt().solve(twist));
  return outcome;
}

const std::vector<std::string> heads{
    "robot, camera",   "right",    "refused",       "wrong",           "median, mm",
    "median, degrees", "95 %, mm", "95 %, degrees", "region holds, %", "seconds"};

/// A row of the table. Runs that are refused count in the first columns only.
std::vector<std::string> run(const RobotChoice& robot, const Setup& setup, std::uint64_t seeds) {
  constexpr double right_position = 0.02, right_rotation = 1.0 * degree;  // gross errors
  constexpr double six_freedoms = 12.592;  // 95 % quantile of chi^2 with as many
  std::vector<double> position, rotation, seconds;
  int refused = 0, held = 0, wrong = 0, right = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Outcome outcome = calibrated(robot, setup, seed);
    seconds.push_back(outcome.seconds);
    if (outcome.refused) {
      ++refused;
      continue;
    }
    const bool is_right = outcome.position < right_position && outcome.rotation < right_rotation;
    right += is_right;
    wrong += !is_right;
    held += outcome.mahalanobis < six_freedoms;
    position.push_back(1e3 * outcome.position);
    rotation.push_back(outcome.rotation / degree);
  }
  return {robot.name + ", " + setup.name,
          std::to_string(right),
          std::to_string(refused),
          std::to_string(wrong),
          number(quantile(position, 0.5), 2),
          number(quantile(rotation, 0.5), 3),
          number(quantile(position, 0.95), 2),
          number(quantile(rotation, 0.95), 3),
          number(100.0 * held / std::max<double>(1.0, static_cast<double>(position.size())), 0),
          number(quantile(seconds, 0.5), 1)};
}

const std::vector<std::string> time_heads{"robot, moving",    "right",       "refused",
                                          "median error, ms", "largest, ms", "within 2 sigma, %",
                                          "seconds"};

/// Time offsets from -80 to 80 ms, by the seed.
std::vector<std::string> run_moving(const RobotChoice& robot, double speed, std::uint64_t seeds) {
  std::vector<double> errors, seconds;
  int refused = 0, held = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const double late = -0.08 + 0.16 * static_cast<double>((seed * 7) % 31) / 30.0;
    const Outcome outcome =
        calibrated(robot, {.name = "", .frames = 20, .speed = speed, .late = late}, seed);
    seconds.push_back(outcome.seconds);
    if (outcome.refused) {
      ++refused;
      continue;
    }
    errors.push_back(1e3 * std::abs(outcome.late));
    held += std::abs(outcome.late) < 2.0 * outcome.late_sigma;
  }
  const double count = std::max<double>(1.0, static_cast<double>(errors.size()));
  return {robot.name + ", " + number(speed, 1) + " m/s",
          std::to_string(errors.size()),
          std::to_string(refused),
          number(quantile(errors, 0.5), 2),
          number(quantile(errors, 1.0), 2),
          number(100.0 * held / count, 0),
          number(quantile(seconds, 0.5), 1)};
}

/// The largest and the root mean square distance of poses from their mean.
void print_spread(const std::string& what, const std::vector<Eigen::Isometry3d>& poses) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector4d quaternion = Eigen::Vector4d::Zero();
  for (const Eigen::Isometry3d& pose : poses) {
    mean += pose.translation() / static_cast<double>(poses.size());
    const Eigen::Quaterniond q(pose.linear());
    quaternion +=
        q.coeffs() * (q.coeffs().dot(Eigen::Quaterniond(poses[0].linear()).coeffs()) < 0 ? -1 : 1);
  }
  const Eigen::Matrix3d R = Eigen::Quaterniond(quaternion.normalized()).toRotationMatrix();
  double most = 0.0, turned = 0.0, squares = 0.0, turns = 0.0, apart = 0.0, apart_turned = 0.0;
  for (const Eigen::Isometry3d& pose : poses) {
    const double d = (pose.translation() - mean).norm();
    const double a = Eigen::AngleAxisd(R.transpose() * pose.linear()).angle();
    most = std::max(most, d), turned = std::max(turned, a);
    squares += d * d / static_cast<double>(poses.size());
    turns += a * a / static_cast<double>(poses.size());
    for (const Eigen::Isometry3d& other : poses) {
      apart = std::max(apart, (pose.translation() - other.translation()).norm());
      apart_turned = std::max(
          apart_turned, Eigen::AngleAxisd(other.linear().transpose() * pose.linear()).angle());
    }
  }
  std::cout << what << ": from the mean rms " << 1e3 * std::sqrt(squares) << " mm, "
            << std::sqrt(turns) / degree << " deg, most " << 1e3 * most << " mm, "
            << turned / degree << " deg; apart at most " << 1e3 * apart << " mm, "
            << apart_turned / degree << " deg" << std::endl;
}

void run_real(const std::filesystem::path& recording, bool masks) {
  io::CalibrationInputOptions options;
  options.input.path = recording;
  if (masks) options.masks = "robot_mask_%d.png";
  const io::CalibrationInput input = io::read_calibration_input(
      options, [](const std::string&) {}, [] {});
  sim::Random random(7, 7);
  const auto any = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  };
  const auto found = [&](const std::vector<CalibrationFrame>& frames, bool off) {
    CalibrationOptions wanted{.camera_parent = input.input.config.camera_parent,
                              .initial = input.input.config.T_parent_camera};
    if (off) {
      wanted.initial->translation() += 0.1 * any();
      wanted.initial->linear() =
          wanted.initial->linear() * Eigen::AngleAxisd(10.0 * degree, any()).matrix();
    }
    return calibrate(frames, input.camera, input.input.robot, wanted);
  };
  std::vector<Eigen::Isometry3d> starts, subsets;
  for (int i = 0; i < 20; ++i) {
    const Calibration one = found(input.frames, true);
    if (!one.is_good()) std::cout << "refused: " << one.faults[0] << '\n';
    starts.push_back(one.T_parent_camera);
  }
  print_spread("20 starts", starts);
  const Calibration all = found(input.frames, false);
  std::cout << "stated: " << 1e3 * all.position_error() << " mm, " << all.rotation_error() / degree
            << " deg; overlap with the masks " << all.mask_overlap << std::endl;
  for (std::size_t a = 0; a < input.frames.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::size_t c = 0; c < b; ++c) {
        std::vector<CalibrationFrame> some = input.frames;
        for (const std::size_t left : {a, b, c})
          some.erase(some.begin() + static_cast<std::ptrdiff_t>(left));
        subsets.push_back(found(some, false).T_parent_camera);
      }
  print_spread("without any three frames", subsets);
}

/// What is wrong with a recording of a cell.
struct Faults {
  Eigen::Vector2d focal =
      Eigen::Vector2d::Zero();  ///< fx and fy are too long by this of themselves
  Setup setup;
};

RobotChoice ur5e() {
  const std::filesystem::path folder = data_folder() / "robots/ur5e";
  RobotChoice choice{"UR5e",
                     folder / "ur5e.urdf",
                     robots()[1].options,
                     "tool0",
                     {0.0, -1.2, 1.4, -1.0, -1.2, 0.0}};
  choice.options.packages = {{"ur_description", folder / "ur_description"}};
  return choice;
}

constexpr std::array fault_names{
    "clean", "clean, depth 0.5 % off", "clean, moving", "focal", "fx alone", "joint", "clock",
    "two"};

double either_way(sim::Random& random, double least, double most) {
  return random.uniform(0.0, 1.0) < 0.5 ? -random.uniform(least, most)
                                        : random.uniform(least, most);
}

void add_fault(std::size_t kind, std::size_t joints, sim::Random& random, Faults& faults) {
  if (kind == 3) faults.focal.setConstant(either_way(random, 0.01, 0.05));
  if (kind == 4) faults.focal.x() = either_way(random, 0.01, 0.05);
  if (kind == 5) {
    faults.setup.joint_errors.resize(joints);
    faults.setup.joint_errors[static_cast<std::size_t>(random.uniform(
        0.0, static_cast<double>(joints) - 0.001))] = either_way(random, 0.5, 2.0) * degree;
  }
  if (kind == 6) {
    faults.setup.late = either_way(random, 0.01, 0.08);
    faults.setup.speed = random.uniform(0.2, 0.6);
  }
}

void run_faulty(const RobotChoice& robot, std::size_t kind, std::uint64_t seed) {
  sim::Random random(seed, 1000 + kind);
  Faults faults;
  if (kind == 1) faults.setup.depth_scale = either_way(random, 0.005, 0.005);
  if (kind == 2) faults.setup.speed = random.uniform(0.2, 0.6);
  const std::size_t joints = robot.centre.size();
  if (kind < 7) add_fault(kind, joints, random, faults);
  if (kind == 7) {
    constexpr std::array kinds{3, 4, 5, 6};
    const auto a = static_cast<std::size_t>(random.uniform(0.0, 3.999));
    const std::size_t b = (a + 1 + static_cast<std::size_t>(random.uniform(0.0, 2.999))) % 4;
    add_fault(static_cast<std::size_t>(kinds.at(a)), joints, random, faults);
    add_fault(static_cast<std::size_t>(kinds.at(b)), joints, random, faults);
  }
  Cell cell(robot, faults.setup, seed);
  const Intrinsics truth = Cell::intrinsics();
  const Intrinsics given(truth.width(), truth.height(), truth.fx() * (1.0 + faults.focal.x()),
                         truth.fy() * (1.0 + faults.focal.y()), truth.cx(), truth.cy());
  std::cout << robot.name << ", " << fault_names.at(kind) << ", seed " << seed << ": focal "
            << 100.0 * faults.focal.x() << " " << 100.0 * faults.focal.y() << " %, late "
            << faults.setup.late << " joints";
  for (const double error : faults.setup.joint_errors) std::cout << " " << error;
  std::cout << std::endl;
  const std::vector<CalibrationFrame> frames = cell.frames();
  CalibrationOptions options;
  options.initial = cell.off();
  options.seed = seed;
  const auto start = std::chrono::steady_clock::now();
  const Calibration found = calibrate(frames, given, cell.robot(), options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Eigen::Isometry3d error = found.T_parent_camera.inverse() * cell.truth();
  const Eigen::AngleAxisd turn(error.linear());
  Eigen::Matrix<double, 6, 1> twist;
  twist << turn.angle() * turn.axis(), error.translation();
  std::cout << "  = " << 1e3 * error.translation().norm() << " mm " << turn.angle() / degree
            << " deg, stated " << 1e3 * found.position_error() << " "
            << found.rotation_error() / degree << ", mahalanobis "
            << std::sqrt(twist.dot(found.covariance.ldlt().solve(twist)) / 12.592) << ", "
            << seconds << " s" << std::endl;
  for (const std::string& note : found.notes) std::cout << "  note: " << note << std::endl;
  for (const std::string& fault : found.faults) std::cout << "  fault: " << fault << std::endl;
}

int study_all(int argc, char** argv) {
  const std::filesystem::path data = data_folder();
  const std::vector<Setup> setups = {{.name = "in the cell, 10 frames"},
                                     {.name = "in the cell, 3 frames", .frames = 3},
                                     {.name = "on the hand, 10 frames", .on_hand = true},
                                     {.name = "`--search`, 5 frames", .frames = 5, .search = true},
                                     {.name = "something before the arm", .object = true},
                                     {.name = "20 % without depth", .missing = 0.2},
                                     {.name = "one wrong joint state", .wrong_joints = true}};
  const std::string wanted = argc > 1 ? argv[1] : "";
  if (wanted == "real") {
    run_real(data / "xarm7_realsense", false);
    run_real(data / "xarm7_realsense", true);
    return 0;
  }
  if (wanted == "faults") {
    const std::uint64_t runs = argc > 2 ? std::stoull(argv[2]) : 1;
    const std::size_t only = argc > 3 ? std::stoull(argv[3]) : fault_names.size();
    const std::uint64_t first = argc > 4 ? std::stoull(argv[4]) : 0;
    std::vector<RobotChoice> all = robots();
    all.push_back(ur5e());
    for (std::uint64_t seed = first; seed < first + runs; ++seed)
      for (std::size_t kind = 0; kind < fault_names.size(); ++kind)
        if (only == fault_names.size() || kind == only)
          run_faulty(all[(seed + kind) % 3], kind, seed);
    return 0;
  }
  const std::uint64_t seeds = argc > 2 ? std::stoull(argv[2]) : 30;
  const std::string only = argc > 3 ? argv[3] : "";
  std::vector<std::vector<std::string>> rows{heads}, time_rows{time_heads};
  const auto add = [](auto& to, std::vector<std::string> row) {
    for (const std::string& cell : row) std::cout << cell << "  ";
    std::cout << std::endl;
    to.push_back(std::move(row));
  };
  for (const RobotChoice& robot : robots()) {
    if (robot.name.find(only) == std::string::npos) continue;
    for (const Setup& setup : setups)
      if (setup.name.find(wanted) != std::string::npos) add(rows, run(robot, setup, seeds));
    for (const double speed : {0.2, 0.5, 1.0})
      if (std::string("moving").find(wanted) != std::string::npos)
        add(time_rows, run_moving(robot, speed, seeds));
  }
  if (wanted.empty() && only.empty())
    update_page(std::filesystem::path(PENUMBRA_STUDY_ROOT) / "docs/calibration.md",
                "calibration_study", table(rows) + "\n" + table(time_rows));
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
