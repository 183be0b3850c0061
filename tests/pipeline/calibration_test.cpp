// SPDX-License-Identifier: Apache-2.0
// Calibration on rendered images without noise: what is said of wrong inputs.
#include "../support/test.hpp"

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/calibration/problem.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::test {
namespace {

using calibration::Model;
using calibration::State;

constexpr float wall = 3.0F;                                                 // metres
const std::vector<double> turns{-0.9, 0.5, 0.8, -0.6, 1.2, 0.4, -1.5, 0.7};  // of the joints

Robot load_arm(const std::vector<std::string>& only_links = {}) {
  return Robot::load(
      PENUMBRA_SOURCE_DIR "/examples/arm_over_table/arm_description/arm.urdf",
      {.geometry = Geometry::visual, .geometry_fallback = true, .only_links = only_links});
}

bool says(const Calibration& found, const std::string& word) {
  return std::ranges::any_of(found.notes,
                             [&](const auto& note) { return bool(holds(note, word)); });
}

/// Moves pixels as a lens does, by its first radial coefficient.
Image<float> seen_by_lens(const Image<float>& image, const Intrinsics& k, double k1) {
  Image<float> raw(image.width(), image.height());
  for (const auto [u, v] : each_pixel(image)) {
    const Vector2d seen = k.ray(u, v).head<2>();
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
    state.joint_offsets.resize(robot.variables().size());
    state.T_parent_camera = looking_at({1.4, 0.5, 0.9}, {0, 0, 0.4});
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
    const auto renderer = make_depth_renderer(Backend::cpu, camera, bodies_of(robot));
    const VirtualDepthView seen = renderer->render(Model(robot, 0).T_camera_link(frame, truth));
    frame.depth = Image<float>(848, 480);
    for (const auto [u, v] : each_pixel(camera))
      frame.depth(u, v) = seen.depth(u, v) > 0.0F ? seen.depth(u, v) : wall;
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
  State state{.T_parent_camera = Isometry3d::Identity(), .joint_offsets = {}};
  KeptFrame frame;
};

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

Frame frame_at(std::int64_t stamp, const std::vector<double>& joints, const DepthView& depth) {
  return {.stamp = stamp, .depth = depth, .pose = {.positions = joints}};
}

class KeptFramesTest : public testing::Test {
 protected:
  void choose(KeptFrames::Choice choice) {
    const Camera camera{Intrinsics(8, 6, 8, 8, 4, 3), {}, {}, {}};
    frames.emplace(robot, camera, KeptFrames::Options{.choice = choice});
  }
  void pass(const Frame& frame) {
    if (auto kept = frames->pass(frame)) frames->add(*std::move(kept));
  }

  Robot robot = load_arm();
  const Image<float> depth{8, 6};
  std::vector<double> joints = robot.rest_positions();
  std::optional<KeptFrames> frames;
};

TEST_F(KeptFramesTest, PosesWithoutImagesTellTheTimeOfImagesThatAreSecondsApart) {
  choose(KeptFrames::Choice::moving);
  for (int i = 0; i <= 130; ++i) {  // 6.5 s, images each 2 s
    joints[1] = 0.015 * i;          // rad: the tip moves by 0.2 m/s
    pass(frame_at(i * 50 * ms, joints, i % 40 == 39 ? DepthView(depth.view()) : DepthView()));
  }
  ASSERT_EQ(frames->chosen().size(), 3U);
  for (const KeptFrame& frame : frames->chosen()) EXPECT_GE(frame.nearby.size(), 5U);
  EXPECT_EQ(frames->seen(), 131U);
}

TEST_F(KeptFramesTest, PosesBetweenImagesOfABagAreLookedUp) {
  using Choice = KeptFrames::Choice;
  const auto joints_at = [&](std::int64_t stamp) {  // moves in the middle of each two seconds
    const double cycles = static_cast<double>(stamp) / (2000.0 * ms), whole = std::floor(cycles);
    joints[1] = 0.2 * (whole + std::clamp(2.0 * (cycles - whole) - 0.5, 0.0, 1.0));
    return joints;
  };
  const auto at = [&](std::int64_t stamp) {
    Frame frame = frame_at(stamp, joints_at(stamp), depth.view());
    frame.pose_at = [&](std::int64_t other, RobotPose& pose) { pose.positions = joints_at(other); };
    return frame;
  };
  for (const Choice choice : {Choice::rest_first, Choice::moving}) {
    choose(choice);
    const std::int64_t first = choice == Choice::moving ? 1000 * ms : 2000 * ms;
    for (int i = 0; i < 3; ++i) pass(at(first + i * 2000 * ms));
    frames->follow(at(first + 4300 * ms));
    ASSERT_EQ(frames->chosen().size(), 3U);
    for (const KeptFrame& frame : frames->chosen()) {
      EXPECT_EQ(frame.is_resting, choice == Choice::rest_first);
      EXPECT_TRUE(frame.tells_time());
    }
  }
}

TEST_F(KeptFramesTest, FramesAtRestAreTakenBeforeOthers) {
  choose(KeptFrames::Choice::rest_first);
  for (int i = 0; i < 40; ++i) {
    if (i % 10 >= 3) joints[1] += 0.05;  // rests for three frames of ten
    pass(frame_at(i * 100 * ms, joints, depth.view()));
  }
  ASSERT_EQ(frames->chosen().size(), 4U);
  for (const KeptFrame& frame : frames->chosen()) EXPECT_LT(frame.index % 10, 3U);
  EXPECT_TRUE(frames->notes().empty());
}

}  // namespace
}  // namespace penumbra::test
