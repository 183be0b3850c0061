// SPDX-License-Identifier: Apache-2.0
// A camera that is calibrated while live judges its images: an arm of boxes before a wall, with the
// messages of ROS 2's topics.
#include "../support/test.hpp"
#include "live_run.hpp"

namespace penumbra::test {
namespace {

constexpr const char* arm_urdf = R"(<robot name="arm">
  <link name="base"/>
  <link name="upper"><collision><origin xyz="0 0 0.2"/>
    <geometry><box size="0.12 0.08 0.4"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0 0 0.18"/>
    <geometry><box size="0.07 0.1 0.36"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0.03 0 0.08"/>
    <geometry><box size="0.16 0.05 0.1"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="upper"/>
    <axis xyz="1 0 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 0.4"/><axis xyz="0 1 0"/></joint>
  <joint name="wrist" type="continuous"><parent link="lower"/><child link="hand"/>
    <origin xyz="0 0 0.36"/><axis xyz="1 0 0"/></joint>
</robot>
)";

constexpr LiveLens lens{.focal = 260, .width = 320, .height = 240, .cx = 159.3, .cy = 119.7};
// Exact depth in whole millimetres and ten poses: measured 0.6 mm and 0.05 degrees.
constexpr double near_truth = 0.003, near_turn = 0.004;  // metres, rad

class LiveCalibration : public testing::Test {
 protected:
  LiveCalibration() {
    truth_.linear() << 0, 0.242536, 0.970143, -1, 0, 0, 0, -0.970143, 0.242536;  // looks at the arm
    truth_.translation() = Vector3d(-1.2, 0.05, 0.1);
  }
  ~LiveCalibration() override {
    if (!run_) return;
    run_->stop();
    EXPECT_FALSE(run_->fault());
  }

  void start(const io::MountOptions& mount = {}) {
    io::LiveOptions options;
    options.robot.given = robot_;
    options.cameras = {{.depth_topic = "/depth", .info_topic = "/info", .mount = mount}};
    run_ =
        std::make_unique<LiveRun>(options, PipelineConfig{}, std::vector<io::ResultSink*>{&sink_});
    run_->start();
    run_->say("/info", encoded(live_info(0, lens)));
  }
  /// TF has the camera's driver's frame so far from where it is.
  void say_mount(const Isometry3d& off) {
    const Isometry3d T_link_optical(Eigen::Translation3d(0.01, 0.02, 0));
    run_->say("/tf_static",
              encoded(io::TfMessage{
                  {{{0, "base"}, "camera_link", truth_ * off * T_link_optical.inverse()},
                   {{0, "camera_link"}, "optical", T_link_optical}}}));
  }

  /// Shows the i-th pose twice, as an arm that stands still, and waits until it is judged.
  void play(int i, bool with_joints = true, bool with_depth = true) {
    const Image<std::uint8_t> other(8, 8);
    std::vector<double> joints{0.5 * std::sin(1.7 * i), 0.8 * std::cos(1.1 * i),
                               0.9 * std::sin(0.6 * i)};
    std::vector<Isometry3d> poses(robot_.links().size());
    robot_.forward_kinematics(joints, poses);
    for (Isometry3d& pose : poses) pose = truth_.inverse() * pose;
    const ImageView<const float> z = renderer_->render(poses).depth;
    Image<std::uint16_t> depth(lens.width, lens.height);
    for (const auto [u, v] : each_pixel(0, 0, lens.width, lens.height))
      depth(u, v) = z(u, v) > 0.0F ? std::uint16_t(std::lround(1e3F * z(u, v))) : 3000;
    for (int again = 0; again < 2; ++again) {
      stamp_ += again == 0 ? seconds : image_period;
      for (const int by : {-10, 10})
        if (with_joints)
          run_->say("/joint_states",
                    encoded(io::JointStateMessage{.header = {stamp_ + by * milliseconds, ""},
                                                  .names = {"turn", "elbow", "wrist"},
                                                  .positions = joints}));
      if (with_depth)
        run_->say("/depth", encoded(io::image_message(io::MessageHeader{stamp_, "optical"}, "16UC1",
                                                      std::as_const(depth).view())));
      else
        run_->say("/depth", encoded(io::image_message(io::MessageHeader{stamp_, "optical"}, "mono8",
                                                      other.view())));
      ++sent_;
      ASSERT_TRUE(wait_until([&] {
        return run_->with_inbox(
            [&](const io::LiveInbox& inbox) { return LiveRun::done(inbox.camera(0)) == sent_; });
      }));
    }
  }
  void play_ten() {
    for (int i = 0; i < 10; ++i) play(i);
  }

  RunningCalibration& calibration() { return run_->calibration(0); }
  CalibrationProgress now() { return run_->calibration_progress(0); }
  /// Waits for a good result of so many poses.
  CalibrationProgress wait_for(std::size_t poses) {
    CalibrationProgress of;
    EXPECT_TRUE(wait_until([&] {
      of = now();
      const bool is_done = of.is_ready() && of.found->frames.size() >= poses;
      if (!is_done) play(9);  // a camera goes on while the robot rests
      return is_done;
    })) << of.message;
    return of;
  }
  void expect_truth(const CalibrationProgress& of) {
    ASSERT_TRUE(of.is_ready()) << of.message;
    const Isometry3d error = truth_.inverse() * of.found->T_parent_camera;
    EXPECT_LT(error.translation().norm(), near_truth) << of.message;
    EXPECT_LT(std::abs(AngleAxisd(error.linear()).angle()), near_turn) << of.message;
  }

  const Robot robot_ = Robot::parse(arm_urdf, "/");
  const Camera camera_ = lens.camera();
  const std::unique_ptr<DepthRenderer> renderer_ =
      make_depth_renderer(Backend::cpu, camera_.intrinsics, bodies_of(robot_));
  Isometry3d truth_ = Isometry3d::Identity();
  SharedResults sink_;  // wants nothing
  std::unique_ptr<LiveRun> run_;
  std::int64_t stamp_ = test::start;
  std::size_t sent_ = 0;
};

Isometry3d off() {
  Isometry3d pose(Eigen::Translation3d(0.03, -0.02, 0.025));
  pose.linear() = AngleAxisd(0.05, Vector3d(1, 2, -1).normalized()).matrix();
  return pose;
}

TEST_F(LiveCalibration, StartsFromTfAndIsAppliedWhenAsked) {
  start();
  say_mount(off());
  EXPECT_TRUE(holds(run_->apply_calibration(0), "no calibration was begun"));
  calibration().begin(false);
  EXPECT_TRUE(holds(run_->apply_calibration(0), "no pose to apply"));
  play_ten();
  const CalibrationProgress of = wait_for(10);
  expect_truth(of);
  EXPECT_TRUE(holds(of.message, "beyond that")) << of.message;
  EXPECT_EQ(of.poses, 10U);

  // TF gets the pose of the driver's topmost frame.
  const auto transform = run_->calibrated_transform(0);
  ASSERT_TRUE(transform);
  EXPECT_EQ(transform->header.frame_id, "base");
  EXPECT_EQ(transform->child_frame_id, "camera_link");
  const Isometry3d T_base_optical =
      transform->T_parent_child * Isometry3d(Eigen::Translation3d(0.01, 0.02, 0));
  EXPECT_TRUE(T_base_optical.isApprox(of.found->T_parent_camera, 1e-9));

  const auto mount = [&] {
    return run_->with_inbox(
        [](const io::LiveInbox& inbox) { return inbox.camera(0).setup()->mount; });
  };
  EXPECT_EQ(mount().source, "tf") << "nothing changes by itself";
  EXPECT_EQ(run_->apply_calibration(0), "");
  EXPECT_TRUE(mount().T_parent_camera.isApprox(of.found->T_parent_camera));
  play(3);
  EXPECT_FALSE(now().found);
  EXPECT_TRUE(holds(now().message, "in use"));
}

TEST_F(LiveCalibration, SaysWhatIsMissing) {
  start();
  say_mount(off());
  EXPECT_EQ(now().message, "");
  calibration().begin(false);
  EXPECT_TRUE(holds(now().message, "no frame was judged"));
  play(0, false);
  EXPECT_TRUE(holds(now().message, {"no frame can be used", "turn"})) << now().message;
  play(0, true, false);
  EXPECT_TRUE(holds(now().message, {"no frame can be used", "encoding"})) << now().message;
  for (int again = 0; again < 4; ++again) play(0);
  EXPECT_EQ(now().poses, 1U);
  EXPECT_TRUE(holds(now().message, {"move the robot", "1 pose so far of at least 5"}))
      << now().message;
  EXPECT_TRUE(now().is_running);
}

TEST_F(LiveCalibration, SaysIfTheOptionsPoseAndTfsDisagree) {
  start({.parent = "base", .pose = truth_, .pose_source = "--pose pose.csv"});
  say_mount(off());
  calibration().begin(false);
  play_ten();
  const CalibrationProgress of = wait_for(10);
  expect_truth(of);
  EXPECT_TRUE(holds(of.message, {"within that", "TF's pose is", "beyond that"})) << of.message;
}

TEST_F(LiveCalibration, ACameraThatTfMovesOnItsLinkEndsIt) {
  start();
  say_mount(off());
  calibration().begin(false);
  play(0);
  say_mount(Isometry3d::Identity());
  play(1);
  EXPECT_FALSE(now().is_running);
  EXPECT_TRUE(holds(now().message, "moves relative to base")) << now().message;
  calibration().begin(false);
  play_ten();
  expect_truth(wait_for(10));
}

}  // namespace
}  // namespace penumbra::test
