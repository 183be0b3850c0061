// SPDX-License-Identifier: Apache-2.0
// Calibrates simulated cameras whose pose is known, and counts how far off the results and their
// stated errors are. Without arguments it writes the table of docs/calibration.md.
// usage: calibration_study [PART OF A SETUP'S NAME [RUNS [PART OF A ROBOT'S NAME]]]
//        calibration_study real
#include "study_page.hpp"

#include <algorithm>
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
#include <sim/arm.hpp>
#include <sim/depth_sensor.hpp>
#include <sim/random.hpp>
#include <sim/scene.hpp>
#include <sim/stage.hpp>
#include <sim/temporary_folder.hpp>

namespace penumbra::study {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// What is simulated.
struct Setup {
  std::string name;
  bool on_hand = false;  ///< the camera moves with the flange
  std::size_t frames = 10;
  bool search = false;
  bool object = false;        ///< something stands before the arm
  double missing = 0.0;       ///< share of the depth image without measurement
  bool wrong_joints = false;  ///< of one frame
  double speed = 0.0;         ///< of the arm's tip, m/s, root mean square; 0: it stands
  double late = 0.0;          ///< seconds from an image's stamp to when it was taken
};

struct RobotChoice {
  std::string name;
  std::filesystem::path urdf;
  RobotOptions options;
  std::string flange;
  std::vector<double> centre;  ///< joint positions around which poses are drawn, rad
};

class Cell {
 public:
  [[nodiscard]] static Intrinsics intrinsics() { return {848, 480, 610.0, 610.0, 423.5, 239.5}; }

  Cell(const RobotChoice& choice, const Setup& setup, std::uint64_t seed)
      : choice_(choice),
        setup_(setup),
        random_(seed, 77),
        arm_(choice.urdf, choice.options, folder_.path()),
        stage_(arm_, room(), folder_.path(), intrinsics()),
        sensor_(noise(setup), intrinsics().fx(), seed, 3),
        parent_(setup.on_hand ? *robot().find_link(choice.flange) : 0),
        small_renderer_(
            make_depth_renderer(Backend::cpu, intrinsics().binned(8, 8), bodies_of(robot()))) {
    if (setup.on_hand) {
      // On a bracket beside the flange, so that the gripper is in view.
      const Eigen::Vector3d jitter(random_.normal(), random_.normal(), random_.normal());
      T_parent_camera_ = Eigen::Isometry3d::Identity();
      T_parent_camera_.translation() = Eigen::Vector3d(0.0, -0.16, -0.12) + 0.01 * jitter;
      T_parent_camera_.linear() =
          Eigen::AngleAxisd(-0.5 + 0.05 * random_.normal(), Eigen::Vector3d::UnitX()).matrix();
    } else {
      const double around = random_.uniform(-1.2, 1.2), away = random_.uniform(1.1, 1.7);
      const Eigen::Vector3d eye(away * std::cos(around), away * std::sin(around),
                                random_.uniform(0.5, 1.1));
      const Eigen::Vector3d target(random_.uniform(-0.1, 0.2), random_.uniform(-0.1, 0.1),
                                   random_.uniform(0.3, 0.5));
      T_parent_camera_ = sim::look_at(eye, target);
    }
  }

  [[nodiscard]] const Robot& robot() const { return arm_.robot(); }
  [[nodiscard]] const Eigen::Isometry3d& truth() const { return T_parent_camera_; }

  std::vector<CalibrationFrame> frames() {
    std::vector<CalibrationFrame> all;
    if (setup_.speed > 0.0) return moving_frames();
    while (all.size() < setup_.frames) {
      CalibrationFrame frame;
      frame.index = all.size();
      frame.joints = pose();
      draw(frame);
      if (setup_.wrong_joints && frame.index == 4)
        for (double& joint : frame.joints) joint += random_.uniform(0.1, 0.3);
      frame.T_root_link.resize(robot().links().size());
      robot().forward_kinematics(frame.joints, frame.T_root_link);
      all.push_back(std::move(frame));
    }
    return all;
  }

  /// A first guess: 100 mm and 10 degrees off, in any direction.
  [[nodiscard]] Eigen::Isometry3d off() {
    const auto any = [&] {
      return Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal()).normalized();
    };
    Eigen::Isometry3d T = truth();
    T.translation() += 0.1 * any();
    T.linear() = T.linear() * Eigen::AngleAxisd(10.0 * degree, any()).matrix();
    return T;
  }

 private:
  static sim::DepthNoise noise(const Setup& setup) {
    sim::DepthNoise noise = sim::DepthNoise::d415();
    noise.holes = std::max(noise.holes, setup.missing);
    return noise;
  }

  sim::SceneDescription room() const {
    sim::SceneDescription scene;
    scene.parts.push_back({-1, R"(<geom type="box" size="3 3 0.05" pos="0 0 -0.06" group="2"/>)"});
    scene.parts.push_back({-1, R"(<geom type="box" size="0.05 3 2" pos="-1.2 0 1" group="2"/>)"});
    scene.parts.push_back({-1, R"(<geom type="box" size="3 0.05 2" pos="0 -1.6 1" group="2"/>)"});
    scene.parts.push_back(
        {-1, R"(<geom type="box" size="0.15 0.2 0.15" pos="-0.5 0.6 0.1" group="2"/>)"});
    scene.parts.push_back({-1, R"(<geom type="cylinder" size="0.04 0.12" group="2"/>)"});
    return scene;
  }

  /// A pose with all links above the table. A camera on the hand looks at the arm.
  std::vector<double> pose() {
    const double range = setup_.on_hand ? 2.5 : 0.7;
    for (;;) {
      std::vector<double> joints = robot().rest_positions();
      for (std::size_t i = 0; i < choice_.centre.size(); ++i)
        joints[i] = choice_.centre[i] + random_.uniform(-range, range);
      const auto centres = arm_.part_centres(joints);
      if (std::all_of(centres.begin(), centres.end(),
                      [](const Eigen::Vector3d& centre) { return centre.z() > 0.04; }) &&
          (!setup_.on_hand || sees_arm(joints)))
        return joints;
    }
  }

  /// Whether links that do not move with the camera fill a tenth of its image, and none is nearer
  /// than the camera can measure.
  bool sees_arm(const std::vector<double>& joints) {
    std::vector<Eigen::Isometry3d> poses(robot().links().size()), rest = poses;
    robot().forward_kinematics(joints, poses);
    robot().forward_kinematics(robot().rest_positions(), rest);
    const Eigen::Isometry3d T_camera_root = (poses[parent_] * T_parent_camera_).inverse();
    std::vector<bool> moves;
    for (std::size_t i = 0; i < poses.size(); ++i)
      moves.push_back(
          !(rest[parent_].inverse() * rest[i]).isApprox(poses[parent_].inverse() * poses[i], 1e-6));
    for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
    constexpr float nearest = 0.1f;  // metres
    const VirtualDepthView robot_seen = small_renderer_->render(poses);
    const auto& depth = robot_seen.depth;
    const auto& links = robot_seen.links;
    int seen = 0;
    for (int v = 0; v < links.height; ++v)
      for (int u = 0; u < links.width; ++u) {
        if (links(u, v) == 0) continue;
        if (depth(u, v) < nearest) return false;
        seen += moves[links(u, v) - 1U];
      }
    return seen > links.width * links.height / 10;
  }

  /// Every joint swings; poses are known at the times of 30 images per second.
  std::vector<CalibrationFrame> moving_frames() {
    constexpr double amplitude = 0.35, period = 1.0 / 30.0;  // rad, seconds
    constexpr int around = 4;                                // images before and after
    std::vector<double> centre = pose(), phases, rates;
    for (std::size_t i = 0; i < choice_.centre.size(); ++i) {
      phases.push_back(random_.uniform(0.0, 6.28));
      rates.push_back(random_.uniform(0.7, 1.3));
    }
    double pace = 1.0;
    const auto at = [&](double t) {
      std::vector<double> joints = centre;
      for (std::size_t i = 0; i < phases.size(); ++i)
        joints[i] += amplitude * std::sin(pace * rates[i] * t + phases[i]);
      return joints;
    };
    const auto tip = [&](double t) -> Eigen::Vector3d {
      return arm_.link_pose(at(t), choice_.flange).translation();
    };
    double squares = 0.0;
    for (int i = 0; i < 200; ++i)
      squares += ((tip(0.1 * i + 0.01) - tip(0.1 * i)) / 0.01).squaredNorm();
    pace = setup_.speed / std::sqrt(squares / 200.0);
    std::vector<CalibrationFrame> all;
    while (all.size() < setup_.frames) {
      CalibrationFrame frame;
      frame.index = all.size();
      const double stamp = 1.7 / pace * static_cast<double>(all.size());
      frame.joints = at(stamp + setup_.late);
      draw(frame);
      frame.joints = at(stamp);
      frame.T_root_link.resize(robot().links().size());
      for (int k = -around; k <= around; ++k) {
        robot().forward_kinematics(at(stamp + period * k), frame.T_root_link);
        frame.nearby.push_back({period * k, frame.T_root_link});
      }
      frame.T_root_link = frame.nearby[around].T_root_link;
      all.push_back(std::move(frame));
    }
    return all;
  }

  void draw(CalibrationFrame& frame) {
    std::vector<Eigen::Isometry3d> parts(5, Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d T_root_camera =
        setup_.on_hand ? arm_.link_pose(frame.joints, choice_.flange) * T_parent_camera_
                       : T_parent_camera_;
    // The object is somewhere in the cell, or between the camera and the arm.
    parts[4].translation() = Eigen::Vector3d(0.0, 5.0, 0.1);
    if (setup_.object)
      parts[4].translation() = T_root_camera * Eigen::Vector3d(random_.uniform(-0.2, 0.2),
                                                               random_.uniform(-0.1, 0.1), 0.7);
    stage_.place(frame.joints, parts);
    const int width = intrinsics().width(), height = intrinsics().height();
    Image<float> depth(width, height);
    const auto all = [](std::int32_t) { return true; };
    stage_.draw_ids({intrinsics(), T_root_camera}, all, {0, 0, width, height}, nullptr, &depth);
    Image<std::uint16_t> measured;
    sensor_.measure(depth, frame.index, measured);
    frame.depth = Image<float>(measured.width(), measured.height());
    for (std::size_t i = 0; i < measured.size(); ++i)
      frame.depth.data()[i] = metres_of(measured.data()[i]);
  }

  const RobotChoice& choice_;
  const Setup& setup_;
  sim::Random random_;
  sim::TemporaryFolder folder_;
  sim::Arm arm_;
  sim::Stage stage_;
  sim::DepthSensor sensor_;
  std::size_t parent_;
  std::unique_ptr<DepthRenderer> small_renderer_;
  Eigen::Isometry3d T_parent_camera_;
};

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

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
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
  for (int i = 0; i < 20; ++i) {
    std::vector<CalibrationFrame> some = input.frames;
    for (int left = 0; left < 3; ++left)
      some.erase(some.begin() +
                 static_cast<std::ptrdiff_t>(random.uniform(0, static_cast<double>(some.size()))));
    subsets.push_back(found(some, false).T_parent_camera);
  }
  print_spread("without three frames", subsets);
}

int study_all(int argc, char** argv) {
  const std::filesystem::path data =
      std::getenv("PENUMBRA_DATA") != nullptr ? std::getenv("PENUMBRA_DATA") : PENUMBRA_STUDY_DATA;
  const auto visual = [](std::map<std::string, std::filesystem::path> packages) {
    RobotOptions options;
    options.packages = std::move(packages);
    options.geometry = Geometry::visual;
    options.geometry_fallback = true;
    return options;
  };
  const std::vector<RobotChoice> robots = {
      {"shipped arm", PENUMBRA_STUDY_ARM, visual({}), "tool0", {0.0, 0.2, 1.0, 0.3, 0.6, 0.0}},
      {"xArm 7",
       data / "robots/xarm7/xarm7.urdf",
       visual({{"xarm_description", data / "robots/xarm7/xarm_description"}}),
       "link_eef",
       {0.0, -0.3, 0.0, 1.2, 0.0, 1.2, 0.0}}};
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
  const std::uint64_t seeds = argc > 2 ? std::stoull(argv[2]) : 30;
  const std::string only = argc > 3 ? argv[3] : "";
  std::vector<std::vector<std::string>> rows{heads}, time_rows{time_heads};
  const auto add = [](auto& to, std::vector<std::string> row) {
    for (const std::string& cell : row) std::cout << cell << "  ";
    std::cout << std::endl;
    to.push_back(std::move(row));
  };
  for (const RobotChoice& robot : robots) {
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
