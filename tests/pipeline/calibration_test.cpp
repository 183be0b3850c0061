// SPDX-License-Identifier: Apache-2.0
// Calibration on rendered images without noise: the residuals' derivatives against the difference
// that a small change of each unknown makes, and what is said of wrong inputs.
#include "../support/temporary_folder.hpp"
#include "../support/test.hpp"

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/calibration/problem.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::test {
namespace {

using calibration::Kind;
using calibration::Model;
using calibration::Observer;
using calibration::Residuals;
using calibration::State;
using calibration::Unknowns;

// Surfaces are curved, and edges are whole or half pixels.
constexpr std::array<double, calibration::kinds> allowed{0.12, 0.25, 0.25};
constexpr float wall = 3.0F;                                                 // metres
constexpr std::size_t elbow = 2;                                             // of the joints
const std::vector<double> turns{-0.9, 0.5, 0.8, -0.6, 1.2, 0.4, -1.5, 0.7};  // of the joints

const std::string arm_file =
    PENUMBRA_SOURCE_DIR "/examples/arm_over_table/arm_description/arm.urdf";

RobotOptions arm_options(const std::vector<std::string>& only_links = {}) {
  return {.geometry = Geometry::visual, .geometry_fallback = true, .only_links = only_links};
}

Robot load_arm(const std::vector<std::string>& only_links = {}) {
  return Robot::load(arm_file, arm_options(only_links));
}

bool says(const Calibration& found, const std::string& word) {
  return std::ranges::any_of(found.notes,
                             [&](const auto& note) { return bool(holds(note, word)); });
}

/// Moves pixels as a lens does, by its first radial coefficient.
template <typename T>
Image<T> seen_by_lens(const Image<T>& image, const Intrinsics& k, double k1) {
  Image<T> raw(image.width(), image.height());
  for (const auto [u, v] : each_pixel(0, 0, image.width(), image.height())) {
    const Vector2d seen(k.ray(u, v).x(), k.ray(u, v).y());
    Vector2d straight = seen;
    for (int i = 0; i < 20; ++i) straight = seen / (1.0 + k1 * straight.squaredNorm());
    const auto x = std::lround(k.cx() + k.fx() * straight.x());
    const auto y = std::lround(k.cy() + k.fy() * straight.y());
    if (x >= 0 && y >= 0 && x < image.width() && y < image.height())
      raw(u, v) = image(int(x), int(y));
  }
  return raw;
}

class RenderedCalibration : public testing::Test {
 protected:
  RenderedCalibration() {
    unknowns.has_shift = true;
    unknowns.focal_count = 2;
    unknowns.variables.resize(robot.variables().size());
    std::iota(unknowns.variables.begin(), unknowns.variables.end(), std::size_t{0});
    unknowns.links = {elbow};
    unknowns.has_time = unknowns.has_lens = true;
    state.joint_offsets.resize(robot.variables().size());
    state.link_lengths.resize(robot.joints().size());
    const Vector3d eye(1.4, 0.5, 0.9), forward = (Vector3d(0, 0, 0.4) - eye).normalized();
    const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
    state.T_parent_camera.linear() << right, forward.cross(right), forward;
    state.T_parent_camera.translation() = eye;
    std::vector<double> joints = robot.rest_positions();
    std::copy_n(std::array{0.3, 0.2, 1.0, 0.3, 0.6}.begin(), 5, joints.begin());
    for (const double seconds : {-0.1, 0.0, 0.1}) {
      KeptFrame& near = frame.nearby.emplace_back();
      near.stamp = static_cast<std::int64_t>(1e9 * seconds);
      near.joints = joints;
      near.T_root_link.resize(robot.links().size());
      for (double& joint : near.joints) joint += 0.5 * seconds;
      robot.forward_kinematics(near.joints, near.T_root_link);
    }
    frame.stamp = 0;
    frame.joints = joints;
    frame.T_root_link = frame.nearby[1].T_root_link;
  }

  /// Draws what a sensor sees at a state.
  void draw(const State& truth) {
    const Intrinsics true_camera(848, 480, camera.fx() * (1.0 + truth.focal.x()),
                                 camera.fy() * (1.0 + truth.focal.y()), camera.cx(), camera.cy());
    const auto renderer = make_depth_renderer(Backend::cpu, true_camera, bodies_of(robot));
    const VirtualDepthView seen = renderer->render(Model(robot, 0).T_camera_link(frame, truth));
    frame.depth = Image<float>(848, 480);
    frame.mask = Image<std::uint8_t>(848, 480);
    for (const auto [u, v] : each_pixel(0, 0, 848, 480)) {
      const float z = seen.depth(u, v);
      frame.mask(u, v) = z > 0.0F;
      frame.depth(u, v) =
          float((z > 0.0F ? z : wall) * (1.0 + truth.depth_scale) + truth.depth_offset);
    }
  }

  /// The sums of a kind's residuals times their prediction, and of the predictions' squares.
  static Vector2d sums(const Residuals& residuals, std::size_t size, int unknown, double change,
                       Kind kind) {
    Vector2d sum = Vector2d::Zero();
    for (std::size_t i = 0; i < residuals.list.size(); ++i) {
      const double value = residuals.list[i].value;
      const double predicted = -change * residuals.rows[i * size + std::size_t(unknown)];
      const double far = kind == Kind::surface ? 0.03 : 12.0;  // another surface or edge
      if (residuals.list[i].kind != kind || std::abs(value - predicted) > far) continue;
      sum += predicted * Vector2d(value, predicted);
    }
    return sum;
  }

  /// Frames after each turn.
  std::vector<KeptFrame> drawn(const State& truth) {
    std::vector<KeptFrame> frames;
    for (const double turn : turns) {
      turn_joints(turn);
      robot.forward_kinematics(frame.joints, frame.T_root_link);
      draw(truth);
      frames.push_back(frame);
      frames.back().index = frames.size() - 1;
      frames.back().mask = {};
    }
    return frames;
  }

  void turn_joints(double turn) {
    for (std::size_t j = 0; j < 4; ++j) frame.joints[j] += (j % 2 == 0 ? 0.3 : -0.3) * turn;
  }

  [[nodiscard]] CalibrationOptions options() const {
    return {.camera_parent = "", .initial = state.T_parent_camera};
  }

  /// How far the camera was found from its place, metres.
  [[nodiscard]] double off(const Isometry3d& T_parent_camera) const {
    return (T_parent_camera.translation() - state.T_parent_camera.translation()).norm();
  }

  Robot robot = load_arm();
  Intrinsics camera{848, 480, 610.0, 600.0, 423.5, 239.5};
  Unknowns unknowns;
  State state{.T_parent_camera = Isometry3d::Identity(), .joint_offsets = {}};
  KeptFrame frame;
};

TEST_F(RenderedCalibration, DerivativesAreThoseOfRenderedImages) {
  const Model model(robot, 0);
  Observer observer(model, camera, unknowns);
  state.focal = Vector2d(0.05, -0.03);  // the derivatives hold away from 0, too
  const Intrinsics focused(848, 480, 1.05 * camera.fx(), 0.97 * camera.fy(), camera.cx(),
                           camera.cy());
  const int focal = unknowns.focal(), joints = unknowns.joints();
  std::map<int, double> changes{{Unknowns::depth_offset, 0.01},
                                {Unknowns::depth_scale, 0.01},
                                {focal, 0.05},
                                {focal + 1, 0.03},
                                {unknowns.time(), 0.02},
                                {unknowns.lens(), 0.3}};
  const std::array of_pose{0.01, 0.01, 0.03, 0.01, 0.01, 0.04};  // turns, then shifts
  for (int i = 0; i < 6; ++i) changes[i] = of_pose[std::size_t(i)];
  for (int i = 0; i < 3; ++i) changes[joints + i] = 0.02;
  changes[unknowns.lengths()] = 0.01;
  const auto size = std::size_t(unknowns.size());
  for (const auto& [unknown, change] : changes) {
    std::array<Vector2d, calibration::kinds> all;
    all.fill(Vector2d::Zero());
    for (const double by : {-change, change}) {
      State truth = state;
      unknowns.step(truth, by * Eigen::VectorXd::Unit(unknowns.size(), unknown));
      draw(truth);
      frame.depth = seen_by_lens(frame.depth, focused, truth.lens);
      frame.mask = seen_by_lens(frame.mask, focused, truth.lens);
      Residuals residuals;
      observer.observe(frame, 0, state, {.depth = 0.1, .pixels = 40.0}, residuals);
      for (std::size_t k = 0; k < calibration::kinds; ++k)
        all[k] += sums(residuals, size, unknown, by, static_cast<Kind>(k));
    }
    for (std::size_t k = 0; k < calibration::kinds; ++k)
      if (all[k][1] > 0.0) {
        EXPECT_NEAR(all[k][0] / all[k][1], 1.0, allowed[k])
            << "unknown " << unknown << ", kind " << k;
      }
  }
}

TEST_F(RenderedCalibration, NothingIsSaidOfRightInputs) {
  const Calibration found = calibrate(drawn(state), camera, robot, options());
  ASSERT_TRUE(found.is_good());
  EXPECT_TRUE(found.notes.empty()) << found.notes.front();
}

/// Its frames repeat one view, whose error nothing shows.
TEST_F(RenderedCalibration, ARobotOfWhichOnlyTheBaseIsSeenIsRefused) {
  robot = load_arm({robot.links()[0]});
  const Calibration found = calibrate(drawn(state), camera, robot, options());
  ASSERT_EQ(found.faults.size(), 1U);
  EXPECT_TRUE(holds(found.faults[0], "one view"));
}

TEST_F(RenderedCalibration, AWrongFocalLengthIsNamedAndFound) {
  const std::vector<KeptFrame> frames = drawn(state);
  const Intrinsics wrong(848, 480, 1.02 * camera.fx(), 1.02 * camera.fy(), camera.cx(),
                         camera.cy());
  CalibrationOptions given = options();
  const Calibration found = calibrate(frames, wrong, robot, given);
  EXPECT_TRUE(says(found, "fx")) << found.notes.size();
  EXPECT_GT(off(found.T_parent_camera), 0.005);
  EXPECT_LT(off(found.T_parent_camera), found.position_error());

  given.focal = true;
  const Calibration freed = calibrate(frames, wrong, robot, given);
  ASSERT_TRUE(freed.is_good());
  EXPECT_FALSE(says(freed, "fx"));
  EXPECT_NEAR(freed.focal_x->value, 1.0 / 1.02 - 1.0, 0.003);
  EXPECT_NEAR(freed.focal_y->value, 1.0 / 1.02 - 1.0, 0.003);
  EXPECT_LT(off(freed.T_parent_camera), 0.004);
}

TEST_F(RenderedCalibration, ALensThatCameraInfoLacksIsNamed) {
  for (const double k1 : {-0.1, 0.1}) {
    std::vector<KeptFrame> frames = drawn(state);
    for (KeptFrame& each : frames) each.depth = seen_by_lens(each.depth, camera, k1);
    const Calibration found = calibrate(frames, camera, robot, options());
    EXPECT_TRUE(says(found, "lens")) << k1;
    EXPECT_LT(off(found.T_parent_camera), found.position_error());
  }
}

TEST_F(RenderedCalibration, AnOffsetOfAJointIsNamed) {
  State truth = state;
  truth.joint_offsets[2] = 0.017;  // a degree
  const Calibration found = calibrate(drawn(truth), camera, robot, options());
  EXPECT_TRUE(says(found, robot.variables()[2]));
}

TEST_F(RenderedCalibration, ALinkOfAnotherLengthIsNamed) {
  const std::string place = R"(<origin xyz="0 0 0.38" rpy="0 0 0"/><parent)";
  std::string longer = read_bytes(arm_file);
  longer.replace(longer.find(place), place.size(),
                 R"(<origin xyz="0 0 0.42" rpy="0 0 0"/><parent)");
  const Robot wrong =
      Robot::parse(longer, std::filesystem::path(arm_file).parent_path(), arm_options());
  std::vector<KeptFrame> frames = drawn(state);
  for (KeptFrame& each : frames) wrong.forward_kinematics(each.joints, each.T_root_link);
  const Calibration found = calibrate(frames, camera, wrong, options());
  EXPECT_TRUE(says(found, "the length of upper_arm to elbow is 4")) << found.notes.size();
  EXPECT_FALSE(says(found, "depth"));
  EXPECT_LT(off(found.T_parent_camera), found.position_error());
}

TEST_F(RenderedCalibration, AWrongUnitOfDepthIsNotALength) {
  State truth = state;
  truth.depth_scale = 0.03;
  const Calibration found = calibrate(drawn(truth), camera, robot, options());
  EXPECT_TRUE(says(found, "depth_scale"));
  EXPECT_FALSE(says(found, "length"));
}

TEST_F(RenderedCalibration, ClocksThatDifferAreNamed) {
  State truth = state;
  truth.time_offset = 0.04;
  const auto moving = [&](const auto& velocity) {
    std::vector<KeptFrame> frames;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      turn_joints(turns[i]);
      for (KeptFrame& near : frame.nearby) {
        near.joints = frame.joints;
        for (std::size_t j = 0; j < 4; ++j)
          near.joints[j] += velocity(i, j) * *near.seconds_after(frame);
        robot.forward_kinematics(near.joints, near.T_root_link);
      }
      frame.T_root_link = frame.nearby[1].T_root_link;
      draw(truth);
      frames.push_back(frame);
      frames.back().mask = {};
    }
    return calibrate(frames, camera, robot, options());
  };
  const Calibration both_ways =
      moving([](std::size_t i, std::size_t j) { return (i + j) % 2 == 0 ? 0.4 : -0.5; });  // rad/s
  EXPECT_TRUE(says(both_ways, "stamps"));
  EXPECT_LT(off(both_ways.T_parent_camera), both_ways.position_error());

  // A turn of the whole arm is to the images a turn of the camera.
  const Calibration one_way = moving([](std::size_t, std::size_t j) { return j == 0 ? 0.3 : 0.0; });
  EXPECT_TRUE(says(one_way, "time"));
  EXPECT_LT(off(one_way.T_parent_camera), 1.2 * one_way.position_error());  // on the border
}

/// A frame at a time (ns); without an image unless there is depth.
Frame frame_at(std::int64_t stamp, std::vector<double> joints, const Image<float>* depth) {
  Frame frame;
  frame.stamp = stamp;
  frame.pose.positions = std::move(joints);
  if (depth != nullptr) frame.depth = depth->view();
  return frame;
}

const Camera tiny_camera{Intrinsics(8, 6, 8, 8, 4, 3), {}, {}, {}};

TEST(KeptFrames, PosesWithoutImagesTellTheTimeOfImagesThatAreSecondsApart) {
  const Robot robot = load_arm();
  const Image<float> depth(8, 6);
  KeptFrames frames(robot, tiny_camera, {.choice = KeptFrames::Choice::moving});
  std::vector<double> joints = robot.rest_positions();
  for (int i = 0; i <= 130; ++i) {  // 6.5 s, images each 2 s
    joints[1] = 0.015 * i;          // rad: the tip moves by 0.2 m/s
    auto kept = frames.pass(frame_at(i * 50 * ms, joints, i % 40 == 39 ? &depth : nullptr));
    if (kept) frames.add(*std::move(kept));
  }
  ASSERT_EQ(frames.chosen().size(), 3U);
  for (const KeptFrame& frame : frames.chosen()) EXPECT_GE(frame.nearby.size(), 5U);
  EXPECT_EQ(frames.seen(), 131U);
}

TEST(KeptFrames, PosesBetweenImagesOfABagAreLookedUp) {
  using Choice = KeptFrames::Choice;
  const Robot robot = load_arm();
  const Image<float> depth(8, 6);
  const auto joints_at = [&](std::int64_t stamp) {  // moves in the middle of each two seconds
    std::vector<double> joints = robot.rest_positions();
    const double cycles = static_cast<double>(stamp) / (2000.0 * ms);
    joints[1] = 0.2 * (std::floor(cycles) +
                       std::clamp(2.0 * (cycles - std::floor(cycles)) - 0.5, 0.0, 1.0));
    return joints;
  };
  for (const Choice choice : {Choice::rest_first, Choice::moving}) {
    KeptFrames frames(robot, tiny_camera, {.choice = choice});
    const auto at = [&](std::int64_t stamp) {
      Frame frame = frame_at(stamp, joints_at(stamp), &depth);
      frame.pose_at = [&](std::int64_t other, RobotPose& pose) {
        pose.positions = joints_at(other);
      };
      return frame;
    };
    const std::int64_t first = choice == Choice::moving ? 1000 * ms : 2000 * ms;
    for (int i = 0; i < 3; ++i)
      if (auto kept = frames.pass(at(first + i * 2000 * ms))) frames.add(*std::move(kept));
    frames.follow(at(first + 4300 * ms));
    ASSERT_EQ(frames.chosen().size(), 3U);
    for (const KeptFrame& frame : frames.chosen()) {
      EXPECT_EQ(frame.is_resting, choice == Choice::rest_first);
      EXPECT_TRUE(frame.tells_time());
    }
  }
}

TEST(KeptFrames, FramesAtRestAreTakenBeforeOthers) {
  const Robot robot = load_arm();
  const Image<float> depth(8, 6);
  KeptFrames frames(robot, tiny_camera, {.choice = KeptFrames::Choice::rest_first});
  std::vector<double> joints = robot.rest_positions();
  for (int i = 0; i < 40; ++i) {
    if (i % 10 >= 3) joints[1] += 0.05;  // rests for three frames of ten
    auto kept = frames.pass(frame_at(i * 100 * ms, joints, &depth));
    if (kept) frames.add(*std::move(kept));
  }
  ASSERT_EQ(frames.chosen().size(), 4U);
  for (const KeptFrame& frame : frames.chosen()) EXPECT_LT(frame.index % 10, 3U);
  EXPECT_TRUE(frames.notes().empty());
}

TEST(KeptFrames, OneAtRestTakesThePlaceOfAMovingOneOfItsPose) {
  const Robot robot = load_arm();
  const Image<float> depth(8, 6);
  KeptFrames frames(robot, tiny_camera, {.choice = KeptFrames::Choice::rest_first});
  std::vector<double> joints = robot.rest_positions();
  for (int i = 0; i < 5; ++i) {
    if (i == 1) joints[1] += 0.2;  // then it rests
    auto kept = frames.pass(frame_at(i * 100 * ms, joints, &depth));
    if (kept) frames.add(*std::move(kept));
  }
  ASSERT_EQ(frames.frames().size(), 2U) << "as many as different poses";
  EXPECT_TRUE(frames.frames().back().is_resting);
}

}  // namespace
}  // namespace penumbra::test
