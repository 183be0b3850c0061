// SPDX-License-Identifier: Apache-2.0
// Calibrates simulated cameras whose pose is known, and counts how far off the results and their
// stated errors are; or calibrates with wrong inputs, and counts what is said of them. Without
// arguments and with "faults" alone it writes a table of bench/results/calibration.txt.
// usage: calibration_study [PART OF A SETUP'S NAME [RUNS [PART OF A ROBOT'S NAME]]]
//        calibration_study faults [RUNS [PART OF A FAULT'S NAME [FIRST SEED]]]
//        calibration_study masks [RUNS [PART OF A SETUP'S NAME [PART OF A ROBOT'S NAME]]]
//        calibration_study few [RUNS [POSES]]
//        calibration_study images [RUNS [PART OF A SETUP'S NAME [PART OF A ROBOT'S NAME]]]
//        calibration_study real
#include "simulated_cell.hpp"
#include "study_page.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/calibration/calibration.hpp>

#include <io/inputs/calibration_input.hpp>
#include <sim/random.hpp>

namespace penumbra::study {
namespace {

struct Outcome {
  bool refused = false;
  std::string fault = {};                 ///< of a refused one
  double position = 0.0, rotation = 0.0;  ///< metres and rad
  double mahalanobis = 0.0;               ///< squared, of the six
  double region = 0.0;                    ///< half axis of the position's, metres
  double seconds = 0.0;
  double late = 0.0, late_sigma = 0.0;  ///< error of the time offset, and what is stated, seconds
};

Outcome calibrated(const RobotChoice& robot, const Setup& setup, std::uint64_t seed) {
  Cell cell(robot, setup, seed);
  const std::vector<KeptFrame> frames = cell.frames();
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
  if (outcome.refused) outcome.fault = found.faults.front();
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
  outcome.region = found.position_error();
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
      std::cerr << robot.name << ", " << setup.name << ", seed " << seed << ": " << outcome.fault
                << ", off by " << 1e3 * outcome.position << " mm" << std::endl;
      ++refused;
      continue;
    }
    const bool is_right = outcome.position < right_position && outcome.rotation < right_rotation;
    right += is_right;
    wrong += !is_right;
    held += outcome.mahalanobis < six_freedoms;
    if (outcome.mahalanobis >= six_freedoms)
      std::cerr << robot.name << ", " << setup.name << ", seed " << seed << ": off by "
                << 1e3 * outcome.position << " mm, region " << 1e3 * outcome.region
                << " mm, outside " << outcome.mahalanobis / six_freedoms << std::endl;
    position.push_back(1e3 * outcome.position);
    rotation.push_back(outcome.rotation / degree);
  }
  return {robot.name + ", " + setup.name,
          std::to_string(right),
          std::to_string(refused),
          std::to_string(wrong),
          number(median(position), 2),
          number(median(rotation), 3),
          number(quantile(position, 0.95), 2),
          number(quantile(rotation, 0.95), 3),
          number(100.0 * held / std::max<double>(1.0, static_cast<double>(position.size())), 0),
          number(median(seconds), 1)};
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
          number(median(errors), 2),
          number(quantile(errors, 1.0), 2),
          number(100.0 * held / count, 0),
          number(median(seconds), 1)};
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

void run_real(const std::filesystem::path& recording, bool masks, bool depth = true) {
  io::CalibrationInputOptions options;
  options.input.path = recording;
  if (masks) options.masks = "robot_mask_%d.png";
  io::CalibrationInput input = io::read_calibration_input(
      options, [](const std::string&) {}, [] {});
  if (!depth)
    for (KeptFrame& frame : input.frames) frame.depth = {};
  sim::Random random(7, 7);
  const auto any = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  };
  const auto found = [&](const std::vector<KeptFrame>& frames, bool off) {
    CalibrationOptions wanted{.camera_parent = input.input.camera->parent,
                              .initial = input.input.camera->pose()};
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
        std::vector<KeptFrame> some = input.frames;
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
  double link = 0.0;  ///< by this of itself one link of the URDF is too long
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
    "nothing",   "nothing, depth 0.5 % off", "nothing, moving arm", "fx and fy", "fx alone",
    "one joint", "clocks, moving arm",       "two of these",        "one link",  "depth scale"};
constexpr std::size_t right_kinds = 3;  // the first of them have no fault

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
  if (kind == 6) faults.setup.late = either_way(random, 0.01, 0.08);
  if (kind == 2 || kind == 6) faults.setup.speed = random.uniform(0.2, 0.6);
}

Faults faults_of(std::size_t kind, std::size_t joints, std::uint64_t seed) {
  sim::Random random(seed, 1000 + kind);
  Faults faults;
  if (kind == 1) faults.setup.depth_scale = either_way(random, 0.005, 0.005);
  if (kind == 8) faults.link = either_way(random, 0.1, 0.1);
  if (kind == 9) faults.setup.depth_scale = either_way(random, 0.02, 0.05);
  if (kind != 7) {
    add_fault(kind, joints, random, faults);
    return faults;
  }
  const auto first = static_cast<std::size_t>(random.uniform(0.0, 3.999));
  const auto second = (first + 1 + static_cast<std::size_t>(random.uniform(0.0, 2.999))) % 4;
  add_fault(right_kinds + first, joints, random, faults);
  add_fault(right_kinds + second, joints, random, faults);
  return faults;
}

/// The robot with one joint farther from the one before; joints take turns.
Robot with_long_link(const RobotChoice& choice, double by, std::uint64_t seed) {
  std::ifstream file(choice.urdf);
  std::string text(std::istreambuf_iterator<char>(file), {});
  constexpr double least = 0.1;  // metres: a link
  std::vector<std::pair<std::size_t, Eigen::Vector3d>> origins;
  for (std::size_t at = text.find("<joint"); at < text.size(); at = text.find("<joint", at + 1)) {
    const std::size_t xyz = text.find("xyz=\"", text.find("<origin", at));
    Eigen::Vector3d origin;
    if (xyz > text.find("</joint", at)) continue;
    std::istringstream(text.substr(xyz + 5)) >> origin.x() >> origin.y() >> origin.z();
    if (origin.norm() > least) origins.emplace_back(xyz + 5, origin);
  }
  const auto& [at, origin] = origins.at(seed / 3 % origins.size());
  std::ostringstream longer;
  longer << (1.0 + by) * origin.transpose();
  text.replace(at, text.find('"', at) - at, longer.str());
  return Robot::parse(text, choice.urdf.parent_path(), choice.options);
}

bool says(const Calibration& found, const std::string& word) {
  return std::any_of(found.notes.begin(), found.notes.end(), [&](const std::string& note) {
    return note.find("contradict") != std::string::npos && note.find(word) != std::string::npos;
  });
}

/// What was said of some runs with a fault.
struct Said {
  int runs = 0, named = 0, others = 0, refused = 0, wrong = 0, held = 0;
  int mended_refused = 0, mended_wrong = 0;
  std::vector<double> position, mended_position, seconds;  // millimetres
};

constexpr double six_freedoms = 12.592;  // 95 % quantile of chi^2 with as many

void run_faulty(const RobotChoice& robot, std::size_t kind, std::uint64_t seed, Said& said) {
  const Faults faults = faults_of(kind, robot.centre.size(), seed);
  Cell cell(robot, faults.setup, seed);
  const Intrinsics right = Cell::intrinsics();
  const Intrinsics given(right.width(), right.height(), right.fx() * (1.0 + faults.focal.x()),
                         right.fy() * (1.0 + faults.focal.y()), right.cx(), right.cy());
  Eigen::Isometry3d truth = cell.truth();
  const auto& errors = faults.setup.joint_errors;
  if (!errors.empty())  // the first joint turns the whole arm: its zero is a matter of definition
    truth = Eigen::AngleAxisd(errors[0], Eigen::Vector3d::UnitZ()) * truth;
  std::vector<KeptFrame> frames = cell.frames();
  const Robot used = faults.link == 0.0 ? cell.robot() : with_long_link(robot, faults.link, seed);
  for (KeptFrame& frame : frames) used.forward_kinematics(frame.joints, frame.T_root_link);
  CalibrationOptions options{.camera_parent = "", .initial = cell.off(), .seed = seed};
  const auto start = std::chrono::steady_clock::now();
  const Calibration found = calibrate(frames, given, used, options);
  said.seconds.push_back(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());

  const auto twist_to_truth = [&](const Calibration& from) {
    const Eigen::Isometry3d error = from.T_parent_camera.inverse() * truth;
    const Eigen::AngleAxisd turn(error.linear());
    Eigen::Matrix<double, 6, 1> twist;
    twist << turn.angle() * turn.axis(), error.translation();
    return twist;
  };
  const auto outside = [&](const Calibration& from) {  // squared, 1: on the region's border
    const Eigen::Matrix<double, 6, 1> twist = twist_to_truth(from);
    return twist.dot(from.covariance.ldlt().solve(twist)) / six_freedoms;
  };
  constexpr double much = 1.5 * 1.5;
  bool named = faults.setup.late != 0.0 && says(found, "stamps");
  named |= faults.focal.x() != 0.0 && says(found, "fx is");
  named |= faults.link != 0.0 && says(found, "in the URDF");
  named |= std::abs(faults.setup.depth_scale) > 0.01 && says(found, "multiply depth_scale");
  for (std::size_t j = 0; j < errors.size(); ++j)
    named |= errors[j] != 0.0 && says(found, cell.robot().variables()[j] + " ");
  const bool other = !named && says(found, "");
  const bool wrong = found.is_good() && !named && outside(found) > much;
  ++said.runs;
  said.named += named;
  said.others += other;
  said.refused += !found.is_good();
  said.wrong += wrong;
  said.held += outside(found) < 1.0;
  said.position.push_back(1e3 * twist_to_truth(found).tail<3>().norm());
  if (other || wrong || (kind < right_kinds && !found.is_good())) {
    std::cout << fault_names.at(kind) << ", " << robot.name << ", seed " << seed << ": focal "
              << faults.focal.transpose() << ", late " << faults.setup.late << " s, joints";
    for (const double error : errors) std::cout << ' ' << error / degree;
    std::cout << ": off by " << said.position.back() << " mm, outside " << outside(found);
    for (const auto* lines : {&found.notes, &found.faults})
      for (const std::string& line : *lines) std::cout << "\n  " << line;
    std::cout << std::endl;
  }
  if (!named) return;
  options.focal = says(found, "--focal");
  options.joint_offsets = says(found, "--joint-offsets");
  options.time_offset = says(found, "--time-offset");
  const Calibration mended = calibrate(frames, given, used, options);
  said.mended_refused += !mended.is_good();
  if (!mended.is_good()) return;
  said.mended_wrong += outside(mended) > much;
  said.mended_position.push_back(1e3 * twist_to_truth(mended).tail<3>().norm());
}

const std::vector<std::string> fault_heads{"wrong",           "runs",       "named",
                                           "another named",   "refused",    "wrong, not said",
                                           "region holds, %", "off by, mm", "mended: refused",
                                           "outside",         "off by, mm", "seconds"};

std::vector<std::string> row_of(const std::string& name, Said said) {
  return {name,
          std::to_string(said.runs),
          std::to_string(said.named),
          std::to_string(said.others),
          std::to_string(said.refused),
          std::to_string(said.wrong),
          number(100.0 * said.held / std::max(1, said.runs), 0),
          number(median(said.position), 1),
          std::to_string(said.mended_refused),
          std::to_string(said.mended_wrong),
          number(median(said.mended_position), 1),
          number(median(said.seconds), 1)};
}

/// The table of what is said of wrong inputs, by fault; robots take turns.
int study_faults(std::size_t runs, const std::string& wanted, std::uint64_t first) {
  std::vector<RobotChoice> all = robots();
  all.push_back(ur5e());
  std::vector<std::vector<std::string>> rows{fault_heads};
  for (std::size_t kind = 0; kind < fault_names.size(); ++kind) {
    if (std::string(fault_names.at(kind)).find(wanted) == std::string::npos) continue;
    Said said;
    for (std::uint64_t seed = first; seed < first + runs * (kind < right_kinds ? 2 : 1); ++seed)
      run_faulty(all[seed % all.size()], kind, seed, said);
    rows.push_back(row_of(fault_names.at(kind), said));
    for (const std::string& cell : rows.back()) std::cout << "| " << cell << ' ';
    std::cout << '|' << std::endl;
  }
  if (wanted.empty())
    update_page(std::filesystem::path(PENUMBRA_STUDY_ROOT) / "bench/results/calibration.txt",
                "calibration_faults", table(rows));
  return 0;
}

/// Runs setups with each robot, and writes the table if it is whole.
int write_table(const std::string& name, const std::vector<Setup>& setups, std::uint64_t seeds,
                const std::string& wanted, const std::string& only) {
  std::vector<std::vector<std::string>> rows{heads};
  for (const RobotChoice& robot : robots())
    for (const Setup& setup : setups) {
      if (robot.name.find(only) == std::string::npos ||
          setup.name.find(wanted) == std::string::npos)
        continue;
      rows.push_back(run(robot, setup, seeds));
      for (const std::string& cell : rows.back()) std::cout << cell << "  ";
      std::cout << std::endl;
    }
  if (wanted.empty() && only.empty())
    update_page(std::filesystem::path(PENUMBRA_STUDY_ROOT) / "bench/results/calibration.txt", name,
                table(rows));
  return 0;
}

/// The table of calibrations from masks alone.
int study_masks(std::uint64_t seeds, const std::string& wanted, const std::string& only) {
  const auto with = [](std::string name, std::size_t frames, auto change) {
    Setup setup{.name = std::move(name), .frames = frames, .masks = true};
    change(setup);
    return setup;
  };
  const auto exact = [](Setup&) {};
  const std::vector<Setup> setups = {
      with("5 exact masks", 5, exact),
      with("8 exact masks", 8, exact),
      with("12 exact masks", 12, exact),
      with("20 exact masks", 20, exact),
      with("12, on the hand", 12, [](Setup& setup) { setup.on_hand = true; }),
      with("12, `--search`", 12, [](Setup& setup) { setup.search = true; }),
      with("12, 2 px too small", 12, [](Setup& setup) { setup.mask_grown = -2; }),
      with("12, 2 px too large", 12, [](Setup& setup) { setup.mask_grown = 2; }),
      with("12, 5 % of the border wrong", 12, [](Setup& setup) { setup.mask_border = 0.05; }),
      with("12, 10 % of the masks wrong", 12, [](Setup& setup) { setup.wrong_masks = 0.1; }),
      with("12, a tool that the URDF lacks", 12, [](Setup& setup) { setup.tool = true; }),
      with("12, something before the arm", 12, [](Setup& setup) { setup.object = true; })};
  return write_table("calibration_masks", setups, seeds, wanted, only);
}

/// The table of colour images.
int study_images(std::uint64_t seeds, const std::string& wanted, const std::string& only) {
  const auto with = [](const std::string& name, std::size_t frames, const auto& change) {
    Setup setup{.name = name, .frames = frames, .colors = true};
    change(setup);
    return setup;
  };
  const auto nothing = [](Setup&) {};
  const std::vector<Setup> setups = {
      with("6 images", 6, nothing),
      with("12 images", 12, nothing),
      with("20 images", 20, nothing),
      with("12, light that changes by 30 %", 12, [](Setup& setup) { setup.light = 0.3; }),
      with("12, somebody walks through", 12, [](Setup& setup) { setup.person = true; }),
      with("12, a tool that the URDF lacks", 12, [](Setup& setup) { setup.tool = true; }),
      with("12, one wrong joint state", 12, [](Setup& setup) { setup.wrong_joints = true; }),
      with("12, `--search`", 12, [](Setup& setup) { setup.search = true; })};
  return write_table("calibration_images", setups, seeds, wanted, only);
}

/// What happened to runs with few poses.
struct Few {
  int runs = 0, refused = 0, wrong = 0, held = 0;
  std::vector<double> position, region, seconds;  // millimetres, of all
};

const std::vector<std::string> few_heads{"poses",      "joint zeros",     "runs",       "not good",
                                         "wrong",      "region holds, %", "median, mm", "95 %, mm",
                                         "region, mm", "seconds"};

/// Zeros of joints that are off by normal errors of this width, rad.
void run_few(const RobotChoice& robot, std::size_t poses, double width, std::uint64_t seed,
             Few& few) {
  sim::Random random(seed, 4242);
  Setup setup{.name = "", .frames = poses};
  for (std::size_t j = 0; j < robot.centre.size(); ++j)
    setup.joint_errors.push_back(width * random.normal());
  Cell cell(robot, setup, seed);
  const Eigen::Isometry3d truth =  // as in run_faulty()
      Eigen::AngleAxisd(setup.joint_errors[0], Eigen::Vector3d::UnitZ()) * cell.truth();
  const std::vector<KeptFrame> frames = cell.frames();
  const CalibrationOptions options{.camera_parent = "", .initial = cell.off(), .seed = seed};
  const auto start = std::chrono::steady_clock::now();
  const Calibration found = calibrate(frames, Cell::intrinsics(), cell.robot(), options);
  few.seconds.push_back(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  const Eigen::Isometry3d error = found.T_parent_camera.inverse() * truth;
  const Eigen::AngleAxisd turn(error.linear());
  Eigen::Matrix<double, 6, 1> twist;
  twist << turn.angle() * turn.axis(), error.translation();
  const double outside = twist.dot(found.covariance.ldlt().solve(twist)) / six_freedoms;
  constexpr double right_position = 0.02, right_rotation = 1.0 * degree;  // gross errors
  const bool is_right =
      error.translation().norm() < right_position && std::abs(turn.angle()) < right_rotation;
  ++few.runs;
  few.refused += !found.is_good();
  few.wrong += found.is_good() && !is_right;
  few.held += outside < 1.0;
  few.position.push_back(1e3 * error.translation().norm());
  few.region.push_back(1e3 * found.position_error());
  if (outside >= 1.0 || !found.is_good()) {
    std::cout << robot.name << ", " << poses << " poses, width " << width << ", seed " << seed
              << ": off by " << few.position.back() << " mm and " << turn.angle() / degree
              << " degrees, region " << few.region.back() << " mm, outside " << outside;
    for (const auto* lines : {&found.notes, &found.faults})
      for (const std::string& line : *lines) std::cout << "\n  " << line;
    std::cout << std::endl;
  }
}

/// The table of few poses, of the three robots together, with zeros of joints from the prior and
/// from twice its width.
int study_few(std::uint64_t runs, std::size_t only) {
  std::vector<std::vector<std::string>> rows{few_heads};
  for (const std::size_t poses : {3, 4, 5, 6, 8, 10})
    for (const auto& [name, width] :
         {std::pair{"exact", 0.0}, {"0.005 rad", 0.005}, {"0.010 rad", 0.010}}) {
      if (only != 0 && poses != only) continue;
      Few few;
      for (const RobotChoice& robot : robots())
        for (std::uint64_t seed = 1; seed <= runs; ++seed) run_few(robot, poses, width, seed, few);
      rows.push_back({std::to_string(poses), name, std::to_string(few.runs),
                      std::to_string(few.refused), std::to_string(few.wrong),
                      number(100.0 * few.held / few.runs, 0), number(median(few.position), 1),
                      number(quantile(few.position, 0.95), 1), number(median(few.region), 1),
                      number(median(few.seconds), 1)});
      for (const std::string& cell : rows.back()) std::cout << "| " << cell << ' ';
      std::cout << '|' << std::endl;
    }
  if (only == 0)
    update_page(std::filesystem::path(PENUMBRA_STUDY_ROOT) / "bench/results/calibration.txt",
                "calibration_few", table(rows));
  return 0;
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
    run_real(data / "xarm7_realsense", true, false);
    return 0;
  }
  if (wanted == "masks")
    return study_masks(argc > 2 ? std::stoull(argv[2]) : 20, argc > 3 ? argv[3] : "",
                       argc > 4 ? argv[4] : "");
  if (wanted == "images")
    return study_images(argc > 2 ? std::stoull(argv[2]) : 10, argc > 3 ? argv[3] : "",
                        argc > 4 ? argv[4] : "");
  if (wanted == "few")
    return study_few(argc > 2 ? std::stoull(argv[2]) : 10, argc > 3 ? std::stoull(argv[3]) : 0);
  if (wanted == "faults")
    return study_faults(argc > 2 ? std::stoull(argv[2]) : 20, argc > 3 ? argv[3] : "",
                        argc > 4 ? std::stoull(argv[4]) : 1);
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
    update_page(std::filesystem::path(PENUMBRA_STUDY_ROOT) / "bench/results/calibration.txt",
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
