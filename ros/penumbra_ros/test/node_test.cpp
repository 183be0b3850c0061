// SPDX-License-Identifier: Apache-2.0
// The node between a player of the shipped recording and subscribers.
#include "node_fixture.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <mutex>

#include <class_loader/class_loader.hpp>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <gtest/gtest.h>
#include <lifecycle_msgs/msg/state.hpp>
#include <rclcpp_components/node_factory.hpp>

#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra_ros::test {
namespace {

TEST_F(NodeTest, LabelsAreThoseOfTheLibrary) {
  start();
  penumbra::Pipeline pipeline(player_->robot, player_->recording.camera.camera,
                              player_->recording.pipeline_config());
  for (std::size_t i = 0; i < player_->reader.size(); ++i) {
    const auto labels = labels_of(i);
    ASSERT_TRUE(labels) << i;
    ASSERT_EQ(labels->encoding, "8UC1");
    const penumbra::Frame frame = player_->reader.read(i, false);
    const auto expected = pipeline.process(frame).labels;
    ASSERT_EQ(labels->data.size(), std::size_t(expected.width) * expected.height);
    EXPECT_TRUE(std::equal(labels->data.begin(), labels->data.end(), expected.data)) << i;
  }
}

TEST_F(NodeTest, CameraInfoAndMarkersComeWithTheLabels) {
  sensor_msgs::msg::CameraInfo::ConstSharedPtr info;
  visualization_msgs::msg::MarkerArray::ConstSharedPtr markers;
  auto listener = std::make_shared<rclcpp::Node>("listener");
  const auto infos = listener->create_subscription<sensor_msgs::msg::CameraInfo>(
      "/penumbra/camera_info", 10,
      [&](sensor_msgs::msg::CameraInfo::ConstSharedPtr m) { info = m; });
  const auto shown = listener->create_subscription<visualization_msgs::msg::MarkerArray>(
      "/penumbra/markers", 10,
      [&](visualization_msgs::msg::MarkerArray::ConstSharedPtr m) { markers = m; });
  executor_->add_node(listener);
  start();
  const auto labels = labels_of(1);
  ASSERT_TRUE(labels);
  ASSERT_TRUE(spin_until(
      [&] { return info && markers && stamp_of(info->header) == stamp_of(labels->header); }));
  EXPECT_EQ(info->header.frame_id, labels->header.frame_id);
  EXPECT_EQ(info->width, labels->width);
  EXPECT_GT(markers->markers.size(), 1U);
}

TEST_F(NodeTest, RuleAndResultsChangeWhileItRuns) {
  start();
  const auto before = labels_of(3);
  ASSERT_TRUE(before);
  EXPECT_TRUE(node_->set_parameter({"tolerance", std::vector<double>{0.2, 0, 0}}).successful);
  const auto after = labels_of(3);
  ASSERT_TRUE(after);
  EXPECT_NE(before->data, after->data);
  EXPECT_FALSE(node_->set_parameter({"tolerance", std::vector<double>{0.2}}).successful);
  EXPECT_FALSE(node_->set_parameter({"front_min_width", 1000}).successful);
  EXPECT_FALSE(node_->set_parameter({"sensor", "eye"}).successful);
  EXPECT_FALSE(node_->set_parameter({"geometry", "visual"}).successful) << "it is configured";
  EXPECT_FALSE(node_
                   ->set_parameters_atomically({{"tolerance", std::vector<double>{0.01, 0, 0}},
                                                {"publish", std::vector<std::string>{"label"}}})
                   .successful);
  EXPECT_TRUE(node_->set_parameter({"publish", std::vector<std::string>{"labels"}}).successful);
  const auto same = labels_of(3);
  ASSERT_TRUE(same);
  EXPECT_EQ(after->data, same->data) << "the tolerance was refused, too";
  EXPECT_TRUE(node_->set_parameter({"publish", std::vector<std::string>{"mask"}}).successful);
  EXPECT_FALSE(labels_of(4, 5s));
}

TEST_F(NodeTest, ForgetsWhatItSaw) {
  start();
  const auto reset =
      call<std_srvs::srv::Trigger>("reset", std::make_shared<std_srvs::srv::Trigger::Request>());
  ASSERT_TRUE(reset);
  EXPECT_TRUE(reset->success);
  EXPECT_TRUE(labels_of(1)) << "robot and camera are still known";
}

TEST_F(NodeTest, CalibratesWhileItRunsAndAppliesWhenAsked) {
  using penumbra_msgs::srv::Calibrate;
  using std_srvs::srv::Trigger;
  start();
  const auto apply = [&] {
    return call<Trigger>("apply_calibration", std::make_shared<Trigger::Request>());
  };
  const auto ask = [&](bool search, bool again) {
    auto request = std::make_shared<Calibrate::Request>();
    request->search = search;
    request->again = again;
    return call<Calibrate>("calibrate", request);
  };
  const auto early = apply();
  ASSERT_TRUE(early);
  EXPECT_FALSE(early->success);
  EXPECT_NE(early->message.find("no calibration was begun"), std::string::npos) << early->message;

  const auto begun = ask(false, false);
  ASSERT_TRUE(begun);
  EXPECT_TRUE(begun->success) << begun->message;
  EXPECT_FALSE(begun->found);
  const auto other = ask(true, false);
  ASSERT_TRUE(other);
  EXPECT_FALSE(other->success) << "it runs already, with a first guess";
  ASSERT_TRUE(labels_of(1));
  ASSERT_TRUE(labels_of(1));
  const auto resting = ask(false, false);
  ASSERT_TRUE(resting);
  EXPECT_TRUE(resting->success);
  EXPECT_GE(resting->poses, 1U);
  EXPECT_LE(resting->poses, 2U) << "one of start() may come late";
  EXPECT_NE(resting->message.find("move the robot"), std::string::npos) << resting->message;

  for (std::size_t i = 0; i < player_->reader.size(); ++i) ASSERT_TRUE(labels_of(i)) << i;
  Calibrate::Response::SharedPtr found;
  ASSERT_TRUE(spin_until([&] {
    found = ask(false, false);
    return !found || found->found;
  })) << found->message;
  ASSERT_TRUE(found);
  // bench/results/calibration.txt: 95 % of poses by three frames end within 6.5 mm.
  constexpr double near_truth = 0.01;  // metres
  EXPECT_EQ(found->transform.header.frame_id, player_->recording.camera.camera.parent);
  EXPECT_EQ(found->transform.child_frame_id, Player::frame_id);
  const auto& at = found->transform.transform.translation;
  const Eigen::Vector3d truth = player_->recording.camera.camera.T_parent_camera->translation();
  EXPECT_LT((Eigen::Vector3d(at.x, at.y, at.z) - truth).norm(), near_truth) << found->message;
  EXPECT_GT(found->position_error, 0.0);
  EXPECT_NE(found->command.find("static_transform_publisher"), std::string::npos);

  const auto applied = apply();
  ASSERT_TRUE(applied);
  EXPECT_TRUE(applied->success) << applied->message;
  EXPECT_TRUE(labels_of(2)) << "judged with the found pose";
  const auto again = apply();
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->success) << again->message;
}

TEST_F(NodeTest, HasALifecycle) {
  using lifecycle_msgs::msg::State;
  start();
  EXPECT_EQ(node_->get_current_state().id(), State::PRIMARY_STATE_ACTIVE);
  node_->deactivate();
  EXPECT_FALSE(labels_of(2, 5s));
  node_->cleanup();
  EXPECT_TRUE(spin_until([&] { return labels_->get_publisher_count() == 0; }));
  EXPECT_TRUE(node_->set_parameter({"publish", std::vector<std::string>{"labels"}}).successful);
  node_->configure();
  EXPECT_FALSE(labels_of(2, 5s));
  EXPECT_EQ(node_->activate().id(), State::PRIMARY_STATE_ACTIVE);
  EXPECT_TRUE(spin_until([&] { return player_->is_heard(); }));
  EXPECT_TRUE(labels_of(3));
  EXPECT_EQ(node_->shutdown().id(), State::PRIMARY_STATE_FINALIZED);

  const PenumbraNode waiting(options({{"autostart", false}}));
  EXPECT_EQ(waiting.get_current_state().id(), State::PRIMARY_STATE_UNCONFIGURED);
}

TEST_F(NodeTest, ReadsItsParametersWhenItIsConfigured) {
  using lifecycle_msgs::msg::State;
  start();
  EXPECT_FALSE(node_->set_parameter({"depth_topic", "/other"}).successful);
  node_->deactivate();
  EXPECT_FALSE(node_->set_parameter({"depth_topic", "/other"}).successful);
  node_->cleanup();
  EXPECT_TRUE(node_->set_parameter({"depth_topic", "/other"}).successful);
  EXPECT_TRUE(node_->set_parameter({"poses", "none"}).successful);
  EXPECT_EQ(node_->configure().id(), State::PRIMARY_STATE_UNCONFIGURED) << "there is no such value";
  EXPECT_TRUE(node_->set_parameter({"poses", "joints"}).successful);
  EXPECT_EQ(node_->configure().id(), State::PRIMARY_STATE_INACTIVE);
  EXPECT_EQ(node_->activate().id(), State::PRIMARY_STATE_ACTIVE);
  EXPECT_TRUE(spin_until([&] { return player_->node->count_subscribers("/other") == 1; }));
}

TEST_F(NodeTest, HoldsAJointOfNoTopicAndReadsOtherNamesAndUnits) {
  start();
  const auto usual = labels_of(0);
  ASSERT_TRUE(usual);
  const auto labels_with = [&](const rclcpp::Parameter& parameter) {
    node_->deactivate();
    node_->cleanup();
    EXPECT_TRUE(node_->set_parameter(parameter).successful) << parameter;
    node_->configure();
    node_->activate();
    EXPECT_TRUE(spin_until([&] { return player_->is_heard(); }));
    const auto labels = labels_of(0);
    return labels ? labels->data : Image::_data_type();
  };
  player_->unheard = "gripper_left";
  player_->before_names = "left/";
  const auto without = labels_with({"joint_names", "left/*=*"});
  ASSERT_EQ(without.size(), usual->data.size());
  EXPECT_NE(without, usual->data) << "the fingers are not known";
  EXPECT_EQ(labels_with({"joints", std::vector<std::string>{"gripper_left=0.01"}}), usual->data);
  const auto twice_as_far = labels_with({"depth_scale", 0.002});
  ASSERT_EQ(twice_as_far.size(), usual->data.size());
  EXPECT_NE(twice_as_far, usual->data);
}

TEST_F(NodeTest, ReadsAXacroFileWithArguments) {
  const std::string file = testing::TempDir() + "penumbra_hand.urdf.xacro";
  std::ofstream(file) << R"(<robot name="hand" xmlns:xacro="http://www.ros.org/wiki/xacro">
    <xacro:arg name="side" default="right"/>
    <link name="$(arg side)_hand">
      <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
    </link>
  </robot>)";
  rclcpp_lifecycle::LifecycleNode node(
      "penumbra", options({{"robot", file}, {"arguments", std::vector<std::string>{"side=left"}}}));
  const Settings settings = read_settings(node);
  ASSERT_TRUE(settings.live.robot.given);
  EXPECT_TRUE(settings.live.robot.given->find_link("left_hand"));
}

/// Moves the arm's first joint to an angle in two seconds.
trajectory_msgs::msg::JointTrajectory turn(double angle) {
  trajectory_msgs::msg::JointTrajectory motion;
  motion.joint_names = {"shoulder_pan"};
  motion.points.resize(1);
  motion.points[0].positions = {angle};
  motion.points[0].time_from_start.sec = 2;
  return motion;
}

TEST_F(NodeTest, LooksAheadAtMotions) {
  using LookAhead = penumbra_msgs::srv::LookAhead;
  start({{"target_topics", std::vector<std::string>{"/boxes"}}});
  ASSERT_TRUE(labels_of(0));
  const auto ask = [&](const std::vector<trajectory_msgs::msg::JointTrajectory>& motions) {
    auto request = std::make_shared<LookAhead::Request>();
    request->trajectories = motions;
    return call<LookAhead>("look_ahead", request);
  };
  // The can has no expected depth: behind the arm it is unknown, away from it visible.
  LookAhead::Response::SharedPtr found;
  ASSERT_TRUE(spin_until([&] {  // the first detections may be lost
    found = labels_of(0) ? ask({turn(0.3), turn(-3.2)}) : nullptr;
    return found && !found->forecasts.empty() && !found->forecasts[0].targets.empty();
  }));
  ASSERT_TRUE(found->success) << found->message;
  EXPECT_EQ(found->message.find("trajectories[1]: "), 0U) << "it goes beyond the joint's limit";
  ASSERT_EQ(found->forecasts.size(), 2U);
  EXPECT_EQ(found->order, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_GT(found->forecasts[1].seen, found->forecasts[0].seen);
  EXPECT_FALSE(found->forecasts[0].reason.empty());
  for (const auto& forecast : found->forecasts) {
    ASSERT_EQ(forecast.targets.size(), 1U);
    EXPECT_EQ(forecast.targets[0].name, "/boxes/can");
    ASSERT_FALSE(forecast.targets[0].intervals.empty());
    EXPECT_NEAR(forecast.targets[0].intervals.back().end, 2.0, 1e-6);
  }

  auto unknown = turn(0.0);
  unknown.joint_names = {"no_joint"};
  for (const auto& [motions, word] :
       {std::pair{std::vector{turn(0.3), unknown}, "trajectories[1]"},
        std::pair{std::vector<trajectory_msgs::msg::JointTrajectory>(), "no trajectories"}}) {
    const auto refused = ask(motions);
    ASSERT_TRUE(refused);
    EXPECT_FALSE(refused->success);
    EXPECT_TRUE(refused->forecasts.empty());
    EXPECT_NE(refused->message.find(word), std::string::npos) << refused->message;
  }
  EXPECT_TRUE(labels_of(1)) << "images are judged as before";
}

TEST_F(NodeTest, ForecastsAPlanThatIsPublished) {
  start({{"target_topics", std::vector<std::string>{"/boxes"}},
         {"plan_topics", std::vector<std::string>{"/plan"}}});
  const auto plan =
      player_->node->create_publisher<trajectory_msgs::msg::JointTrajectory>("/plan", 10);
  std::map<std::string, penumbra_msgs::msg::Target> heard;
  const auto targets = player_->node->create_subscription<penumbra_msgs::msg::Targets>(
      "/penumbra/targets", 10, [&](penumbra_msgs::msg::Targets::ConstSharedPtr message) {
        for (const auto& target : message->targets) heard[target.name] = target;
      });
  ASSERT_TRUE(spin_until(
      [&] { return plan->get_subscription_count() > 0 && targets->get_publisher_count() > 0; }));
  const auto& can = heard["/boxes/can"];
  EXPECT_TRUE(spin_until([&] { return labels_of(0) && can.verdict != can.UNKNOWN; }));
  EXPECT_EQ(can.forecast_seconds, 0) << "there is no plan";
  plan->publish(turn(0.3));
  ASSERT_TRUE(spin_until([&] { return labels_of(0) && can.forecast_seconds > 0; }));
  EXPECT_NEAR(can.forecast_seconds, 2.0, 0.1);
  // The can has no expected depth: what the arm passes is unknown, with the reason.
  EXPECT_TRUE(std::isnan(can.hidden_in));
  EXPECT_NE(can.forecast_reason, "");
}

TEST_F(NodeTest, HandledTargetsAreDetectionsAndFrames) {
  std::string detected, frame;
  auto listener = std::make_shared<rclcpp::Node>("listener");
  const auto detections = listener->create_subscription<vision_msgs::msg::Detection3DArray>(
      "/penumbra/detections", 10, [&](vision_msgs::msg::Detection3DArray::ConstSharedPtr array) {
        if (!array->detections.empty()) detected = array->detections.front().id;
      });
  const auto transforms = listener->create_subscription<tf2_msgs::msg::TFMessage>(
      "/tf", 100, [&](tf2_msgs::msg::TFMessage::ConstSharedPtr message) {
        for (const auto& transform : message->transforms) frame = transform.child_frame_id;
      });
  executor_->add_node(listener);
  start({{"target_topics", std::vector<std::string>{"/boxes"}},
         {"handling", "hold"},
         {"target_frames", true}});
  EXPECT_TRUE(spin_until([&] {
    static_cast<void>(labels_of(0));
    return !detected.empty() && !frame.empty();
  }));
  EXPECT_EQ(detected, "/boxes/can");
  EXPECT_EQ(frame, "boxes/can");
}

/// Keeps where the pixels of the judged images lie.
class AddressWatcher final : public penumbra::io::FrameWatcher, public penumbra::io::ResultSink {
 public:
  [[nodiscard]] bool wants_color() const override { return false; }
  void take(const penumbra::io::AssembledFrame& job, const penumbra::FrameReport& /*report*/,
            const penumbra::Drift& /*drift*/) override {
    address = job.image.image->data.data();
  }
  [[nodiscard]] bool wants(penumbra::io::Result /*result*/) const override { return false; }
  void write(penumbra::io::Result /*result*/, std::int64_t /*stamp*/,
             std::span<const std::byte> /*payload*/) override {}

  std::atomic<const void*> address = nullptr;
};

TEST_F(NodeTest, DepthOfTheSameProcessIsNotCopied) {
  Player player(example, true);
  const auto node = std::make_shared<rclcpp_lifecycle::LifecycleNode>("penumbra", options());
  const Settings settings = read_settings(*node);
  AddressWatcher watcher;
  penumbra::io::LiveRunner runner(settings.live, settings.pipeline, {&watcher});
  runner.watch(0, watcher);
  Inputs inputs(*node, runner);
  inputs.follow(false, true);
  runner.start();
  executor_->add_node(node->get_node_base_interface());
  executor_->add_node(player.node);
  ASSERT_TRUE(spin_until([&] { return player.is_heard(); }));
  std::int64_t later = 0;
  const void* published = nullptr;
  EXPECT_TRUE(spin_until([&] {
    published = player.play(0, later += 1'000'000'000);
    return spin_until([&] { return watcher.address != nullptr; }, 1s);
  }));
  EXPECT_EQ(watcher.address.load(), published);
  runner.stop();
}

TEST_F(NodeTest, ImagesAreReliableWhereAllPublishersAre) {
  auto drivers = std::make_shared<rclcpp::Node>("drivers");
  node_ = std::make_shared<PenumbraNode>(options());
  executor_->add_node(drivers);
  executor_->add_node(node_->get_node_base_interface());
  const auto asks_for = [&](rclcpp::ReliabilityPolicy policy) {
    return spin_until([&] {
      const auto asking = drivers->get_subscriptions_info_by_topic("/depth/image");
      return asking.size() == 1 && asking[0].qos_profile().reliability() == policy;
    });
  };
  const auto reliable = drivers->create_publisher<Image>("/depth/image", 10);
  EXPECT_TRUE(asks_for(rclcpp::ReliabilityPolicy::Reliable));
  const auto best_effort =
      drivers->create_publisher<Image>("/depth/image", rclcpp::SensorDataQoS());
  EXPECT_TRUE(asks_for(rclcpp::ReliabilityPolicy::BestEffort));
}

TEST_F(NodeTest, DiagnosticsSayWhatIsMissing) {
  std::string message;
  auto listener = std::make_shared<rclcpp::Node>("listener");
  const auto subscription = listener->create_subscription<diagnostic_msgs::msg::DiagnosticArray>(
      "/diagnostics", 10, [&](diagnostic_msgs::msg::DiagnosticArray::ConstSharedPtr array) {
        for (const auto& status : array->status)
          if (status.name == "penumbra: camera") message = status.message;
      });
  node_ = std::make_shared<PenumbraNode>(options());
  executor_->add_node(listener);
  executor_->add_node(node_->get_node_base_interface());
  EXPECT_TRUE(spin_until([&] { return message.find("no depth images") == 0; })) << message;
}

TEST_F(NodeTest, WithoutDepthTheModelAloneIsJudged) {
  // The depth images stand for colour images here: nothing is read from them.
  start({{"has_depth", false}, {"color_topic", "depth/image"}});
  const auto labels = labels_of(1);
  ASSERT_TRUE(labels);
  std::size_t unknown = 0;
  for (const std::uint8_t label : labels->data) {
    ASSERT_TRUE(label == 0 || label == 3) << int(label);
    unknown += label == 3;
  }
  EXPECT_GT(unknown, 10000U);
}

/// Two cameras and a cloud, all of the player's depth images.
TEST_F(NodeTest, ServesSeveralCamerasAndClouds) {
  const Parameters several{{"cameras.left.depth_topic", "depth/image"},
                           {"cameras.right.depth_topic", "depth/image"},
                           {"clouds", std::vector<std::string>{"points tolerance=0.03,0,0"}}};
  player_ = std::make_unique<Player>(example, true);
  node_ = std::make_shared<PenumbraNode>(options(several));
  executor_->add_node(player_->node);
  executor_->add_node(node_->get_node_base_interface());
  std::map<std::string, Image::ConstSharedPtr> labels;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> heard;
  for (const std::string camera : {"left", "right"})
    heard.push_back(player_->node->create_subscription<Image>(
        "/penumbra/" + camera + "/labels", 10,
        [&labels, camera](Image::ConstSharedPtr image) { labels[camera] = image; }));
  sensor_msgs::msg::PointCloud2::ConstSharedPtr cloud;
  heard.push_back(player_->node->create_subscription<sensor_msgs::msg::PointCloud2>(
      "/penumbra/points/labelled", 10,
      [&](sensor_msgs::msg::PointCloud2::ConstSharedPtr message) { cloud = message; }));
  std::vector<std::string> names;
  heard.push_back(player_->node->create_subscription<diagnostic_msgs::msg::DiagnosticArray>(
      "/diagnostics", 10, [&](diagnostic_msgs::msg::DiagnosticArray::ConstSharedPtr array) {
        names.clear();
        for (const auto& status : array->status) names.push_back(status.name);
      }));
  ASSERT_TRUE(spin_until([&] {
    later_ += 1'000'000'000;
    player_->play(1, later_);
    return spin_until(
        [&] {
          return labels.size() == 2 && cloud &&
                 stamp_of(labels["left"]->header) == stamp_of(labels["right"]->header) &&
                 stamp_of(labels["left"]->header) == stamp_of(cloud->header);
        },
        1s);
  }));
  EXPECT_EQ(labels["left"]->data, labels["right"]->data);
  ASSERT_EQ(cloud->fields.back().name, "link");
  const std::uint32_t label_at = cloud->fields[cloud->fields.size() - 2].offset;
  std::size_t robot = 0, other = 0;
  for (std::size_t i = 0; i < labels["left"]->data.size(); ++i) {
    const auto is_robot = [](std::uint8_t label) { return label == 2 || label == 4; };
    const bool in_image = is_robot(labels["left"]->data[i]);
    const bool in_cloud = is_robot(cloud->data[i * cloud->point_step + label_at]);
    robot += in_image || in_cloud;
    other += in_image != in_cloud;
  }
  // Images clean up small regions and have a tolerance of their own.
  std::printf("%zu of %zu robot pixels differ\n", other, robot);
  EXPECT_GT(robot, 10000U);
  EXPECT_LT(other, robot / 20);
  EXPECT_TRUE(spin_until([&] { return names.size() == 4; }));
  EXPECT_EQ(names, (std::vector<std::string>{"penumbra: robot", "penumbra: camera left",
                                             "penumbra: camera right", "penumbra: cloud /points"}));
}

TEST_F(NodeTest, IsAComponent) {
  class_loader::ClassLoader loader("libpenumbra_component.so");
  const auto factory = loader.createInstance<rclcpp_components::NodeFactory>(
      "rclcpp_components::NodeFactoryTemplate<penumbra_ros::PenumbraNode>");
  EXPECT_NO_THROW(factory->create_node_instance(options()));
}

TEST(Node, RefusesWhatItDoesNotUnderstandInOneLine) {
  for (const std::string arguments :
       {"--fast", "--ros-args -p geometry:=both", "--ros-args -p robot:=/none.urdf",
        "--ros-args -p margins:=\"['gripper']\"", "--ros-args -p has_depth:=false",
        "--ros-args -p arguments:=\"['ur_type']\"",
        "--ros-args -p joints:=\"['gripper_left=wide']\"",
        "--ros-args -p joints:=\"['elbow=0', 'elbow=1']\"", "--ros-args -p joint_names:=left/",
        "--ros-args -p robot_namespaces:=\"['left']\" -p joints:=\"['elbow=0']\"",
        "--ros-args -p depth_scale:=-0.001", "--ros-args -p front_min_width:=-5",
        "--ros-args -p clouds:=\"['/points sensor=eyes']\"",
        "--ros-args -p cameras.left.color_topic:=/image"}) {
    const std::string command = PENUMBRA_NODE " " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    EXPECT_EQ(WEXITSTATUS(pclose(pipe)), 2) << arguments;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  }
}

}  // namespace
}  // namespace penumbra_ros::test
