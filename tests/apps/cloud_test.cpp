// SPDX-License-Identifier: Apache-2.0
// `penumbra cloud`: the tiny robot's board before a wall, in bags and folders of clouds.
#include "fixtures.hpp"
#include "tiny_clouds.hpp"

#include <io/cloud/cloud_file.hpp>

namespace penumbra::test {
namespace {

class CloudBag : public BagTest {
 protected:
  CloudBag() { add_clouds(bag_); }

  Outcome cloud(const Words& options = {}) const {
    return penumbra(Words{"cloud", tiny_mcap(), "-o", clean} + options);
  }

  /// Calls `call` with each of the three messages of a topic.
  template <typename M, typename F>
  void for_each(const std::string& topic, const F& call) const {
    const auto found = for_each_message<M>(
        clean, topic, [&](const M& message, std::int64_t log_time, std::size_t number) {
          EXPECT_EQ(message.header.stamp, tiny_stamp(static_cast<int>(number)) + one_ms);
          EXPECT_EQ(log_time, message.header.stamp + 10 * one_ms);
          call(message);
        });
    EXPECT_EQ(found, 3U) << topic;
  }

  const fs::path clean = path("clean.mcap");
};

TEST_F(CloudBag, LosesTheRobot) {
  bag_.copy("/points", "/penumbra/points");  // of an earlier `penumbra live`
  const Outcome run = succeed(cloud());
  expect_has(run.out, {"/points", "/scan", "/livox/lidar", "frame 'laser' on link 'base'"});
  expect_has(run.err, {"no times"});
  for_each<io::PointCloud2Message>("/penumbra/points", [](const auto& message) {
    EXPECT_EQ(numbers_of(message), (std::vector{1, 2}));
    EXPECT_EQ(message.header.frame_id, "optical");
  });
  for_each<io::LaserScanMessage>("/penumbra/scan", [](const auto& scan) {
    EXPECT_EQ(scan.ranges[0], 3.0F);
    EXPECT_TRUE(std::isnan(scan.ranges[1]));
    EXPECT_EQ(scan.ranges[2], 3.0F);
  });
  for_each<io::LivoxMessage>("/penumbra/livox/lidar", [](const auto& message) {
    ASSERT_EQ(message.points.size(), 1U);
    EXPECT_EQ(message.points[0].y, 2.0F);
  });
}

TEST_F(CloudBag, KeepsAllPointsWithLabelsIfAsked) {
  succeed(cloud({"--label", "--topic", "/points"}));
  for_each<io::PointCloud2Message>("/penumbra/points", [](const auto& message) {
    EXPECT_EQ(numbers_of(message), (std::vector{0, 1, 2, 3}));
    using enum Label;
    const std::vector expected{occluded, front, clear, unknown};
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(message.data[i * message.point_step + 16], static_cast<std::byte>(expected[i]));
  });
  EXPECT_FALSE(topic_counts(clean).contains("/penumbra/scan"));
  succeed(cloud({"--removed-ranges", "inf"}));
  for_each<io::LaserScanMessage>("/penumbra/scan",
                                 [](const auto& scan) { EXPECT_TRUE(std::isinf(scan.ranges[1])); });
}

TEST_F(CloudBag, JudgesTargetsOnTheCloudsOfTheirStamp) {
  for (int i = 0; i < 3; ++i) {
    io::PoseStampedMessage knob{.header = {tiny_stamp(i) + one_ms, "optical"}};
    knob.pose.translation() = Eigen::Vector3d(0, 0, 1.5);
    bag_.add("/knob", tiny_stamp(i) + 50 * one_ms, knob);  // late, as detectors are
  }
  succeed(cloud({"--topic", "/points", "--target-topic", "/knob"}));
  const auto judged = for_each_message<io::TargetsMessage>(
      clean, "/penumbra/points/targets", [](const auto& all, std::int64_t, std::size_t number) {
        EXPECT_EQ(all.header.stamp, tiny_stamp(static_cast<int>(number)) + one_ms);
        ASSERT_EQ(all.targets.size(), 1U);
        EXPECT_EQ(all.targets[0].verdict, io::TargetMessage::unknown);
        expect_has(all.targets[0].reason, {"rays"});  // two are too few for a verdict
      });
  EXPECT_EQ(judged, 3U);
  bag_.add("/boxes", tiny_stamp(0), io::KeypointsMessage{});
  expect_refused(cloud({"--target-topic", "/boxes"}), {"Keypoints", "Detection3DArray"});
}

TEST_F(CloudBag, WithoutPosesTrustsNothing) {
  std::erase_if(bag_.messages, [](const TinyBag::Message& message) {
    return message.topic == "/joint_states" && message.log_time > tiny_stamp(1) - 300 * one_ms;
  });
  expect_has(succeed(cloud({"--topic", "/points"})).err,
             {"/points: stale_joints in 2 of 3 frames", "slide"});
  std::vector<std::size_t> sizes;
  for_each<io::PointCloud2Message>("/penumbra/points",
                                   [&](const auto& message) { sizes.push_back(message.width); });
  EXPECT_EQ(sizes, (std::vector<std::size_t>{2, 0, 0}));
  bag_.remove("/joint_states");
  expect_refused(cloud({"--poses", "joints"}), {"has no joint states"});
}

TEST_F(CloudBag, ACloudWithoutAStampIsNotTrusted) {
  bag_.edit<io::PointCloud2Message>([](auto& message) { message.header.stamp = 0; });
  expect_failed(cloud({"--topic", "/points"}), {"stamp is 0"});
  for_each_message<io::PointCloud2Message>(
      clean, "/penumbra/points",
      [](const auto& message, std::int64_t, std::size_t) { EXPECT_EQ(message.width, 0U); });
}

TEST_F(CloudBag, SaysWhatIsWrong) {
  const fs::path bag = tiny_mcap();
  expect_all_refused(
      [&](const Words& options) {
        return penumbra(Words{"cloud", bag} + options);
      },
      {{{}, "--output is required"},
       {{"--tune", "-o", clean}, "--output"},
       {{"--tune", "--port", "0"}, "--port"},
       {{"-o", clean, "--address", "0.0.0.0"}, "--port, too"},
       {{"-o", clean, "--topic", "/pionts"}, "/points"},
       {{"-o", clean, "--topic", "/joint_states"}, "JointState"},
       {{"-o", clean, "--sensor", "eyes"}, "lidar_2cm"},
       {{"-o", clean, "--beam", "1"}, "0.01"},
       {{"-o", clean, "--pose", path("camera_pose.csv"), "--parent", "base"}, "3 topics of clouds"},
       {{"-o", clean, "--ignore-links", "lidar_*"}, "lidar_*"},
       {{"-o", out()}, "*.mcap"},
       {{"-o", bag}, "is the input"}});
  expect_failed(penumbra({"cloud", bag, "--tune", "--topic", "/points"}),
                {"/points: only 1 points are on the robot"});
  EXPECT_FALSE(fs::exists(clean));
  expect_failed(cloud({"--topic", "/points", "--ignore-links", "board"}), {"no link is rendered"});
  bag_.edit<io::PointCloud2Message>([](auto& message) { message.width = 1'000'000; });
  expect_failed(cloud({"--topic", "/points"}), {"do not fit"});
}

TEST_F(CloudBag, AFrameThatTfLacksIsRefused) {
  bag_.edit<io::PointCloud2Message>([](auto& message) { message.header.frame_id = "lidar"; });
  expect_refused(cloud({"--topic", "/points"}), {"where the sensor is", "'lidar'", "--topic"});
  bag_.add("/tf_static", tiny_stamp(0),
           io::TfMessage{{{{0, "lidar"}, "base", Eigen::Isometry3d::Identity()}}});
  expect_refused(cloud({"--topic", "/points"}), {"above the robot", "--sensor-frame", "--merged"});
  succeed(cloud({"--topic", "/points", "--sensor-frame", "optical"}));
  succeed(cloud({"--topic", "/points", "--merged"}));
}

class CloudFolder : public TinyTest {
 protected:
  CloudFolder() {
    fs::create_directories(path("scans"));
    for (int i = 0; i < 3; ++i)
      io::write_cloud(path("scans/" + std::to_string(i) + ".pcd"), FourPoints(i).message);
    write("clouds.yaml", clouds_yaml() + "targets: knob.yaml\n");
    write("knob.yaml", "targets: [{name: knob, point: [0, 0, 1.5]}]\n");
  }
  Outcome cloud(const Words& options = {}) const {
    return penumbra(Words{"cloud", path("clouds.yaml"), "-o", out()} + options);
  }
};

TEST_F(CloudFolder, LosesTheRobot) {
  succeed(cloud());
  for (const char* file : {"clouds/0.pcd", "clouds/1.pcd", "clouds/2.pcd"})
    EXPECT_EQ(numbers_of(io::read_cloud(out(file)).cloud), (std::vector{1, 2}));
  const Json json = report();
  EXPECT_EQ(json["frames"].size(), 3U);
  expect_values(json, {{"/frames/0/targets/0/name", "knob"},
                       {"/frames/0/targets/0/verdict", "unknown"},  // of one ray
                       {"/frames/0/points/occluded", 1},
                       {"/frames/0/status", "ok"},
                       {"/input", path("clouds.yaml").string()},
                       {"/settings/beam", 0.003},
                       {"/summary/frames", 3},
                       {"/summary/points/occluded", 3}});
  succeed(cloud({"--label", "--frames", "1:2"}));  // replaces former results
  expect_refused(penumbra({"cloud", path("clouds.yaml"), "-o", path(), "--force"}), {"own folder"});
  EXPECT_FALSE(fs::exists(out("clouds/0.pcd")));
  EXPECT_EQ(io::read_cloud(out("clouds/1.pcd")).cloud.fields.back().name, "link");

  // Merged clouds have no rays.
  succeed(cloud({"--label"}));
  EXPECT_EQ(report()["frames"][0]["points"]["front"], 1);
  succeed(cloud({"--label", "--merged"}));
  EXPECT_EQ(report()["frames"][0]["points"]["front"], 0);
}

TEST_F(CloudFolder, NamesBodiesAndTargetsInMillimetres) {
  write("knob.yaml",
        "targets: [{name: knob, point: [300, 0, 1500]}, {name: lid, point: [300, 0, 1500]}]\n");
  succeed(cloud());
  const Json json = report();
  for (const Json& target : json["frames"][0]["targets"])
    expect_has(target["reason"].dump(), {"it is 1530 m away"});
  edit("clouds.yaml",
       "frames:", "attached: [{name: part, link: board, box: [90, 50, 9]}]\nframes:");
  cloud();
  expect_has(notes(), {"'part' reaches 51.7 m"});
}

TEST_F(CloudFolder, TheRobotMustBeInSomeCloud) {
  succeed(cloud());
  EXPECT_EQ(report()["summary"]["shows_robot"], true);
  write("camera_pose.csv", "1,0,0,0\n0,1,0,0\n0,0,1,-2000\n0,0,0,1\n");  // millimetres
  expect_failed(cloud(), {"no point is on the robot"});
  EXPECT_EQ(report()["summary"]["shows_robot"], false);
  succeed(cloud({"--force"}));
}

TEST_F(CloudFolder, HandlingNeedsStampsAndWarningsAreThoseOfImages) {
  const std::string knob = "targets: [{name: knob, point: [0, 0, 1.5], handling: {point: {}}}]\n";
  write("knob.yaml", knob);
  expect_has(succeed(cloud()).err, {"handling", "3 frames without a stamp"});
  write("joint_states.csv",
        "frame,stamp,slide\n0,1000000000,0\n1,2000000000,0.05\n2,3000000000,0.1\n");
  expect_lacks(succeed(cloud()).err, {"handling"});
  EXPECT_FALSE(report()["frames"][0]["targets"][0]["handled"].is_null());

  write("joint_states.csv", "frame,stamp,slide\n0,3000000000,0\n1,2000000000,5\n2,4000000000,0\n");
  expect_has(succeed(cloud()).err, {"joint 'slide' beyond its limits in 1 frame",
                                    "stamp not after the frame's before, first in frame 1"});
}

TEST_F(CloudFolder, CloudsOfOthersStay) {
  succeed(cloud());
  expect_refused(cloud({"--frames", "7:9"}), {"--frames"});
  EXPECT_TRUE(fs::exists(out("report.json"))) << "until the input is known";
  write_file(out("clouds/scan_0.pcd"), "the user's own");
  expect_refused(cloud(), {"clouds/scan_0.pcd", "--force"});
  EXPECT_TRUE(fs::exists(out("clouds/0.pcd")));
  succeed(cloud({"--force"}));
  EXPECT_EQ(read_file(out("clouds/scan_0.pcd")), "the user's own");
}

TEST_F(CloudFolder, EachCloudHasAFileOfItsOwn) {
  for (int i = 0; i < 3; ++i) {
    const fs::path folder = path("scan_" + std::to_string(i));
    fs::create_directory(folder);
    fs::rename(path("scans/" + std::to_string(i) + ".pcd"), folder / "points.pcd");
  }
  edit("clouds.yaml", "scans/%d.pcd", "scan_%d/points.pcd");
  expect_refused(cloud(), {"points.pcd", "the file's name"});
}

TEST_F(CloudFolder, BadFilesAreSaid) {
  write("scans/0.pcd", "");
  fs::remove(path("scans/1.pcd"));
  expect_has(succeed(cloud()).err, {"bad_depth in 2 of 3 frames", "0.pcd"});
  EXPECT_FALSE(fs::exists(out("clouds/0.pcd")));
  edit("clouds.yaml", "%d.pcd", "%d.xyz");
  expect_refused(cloud(), {".xyz", ".pcd, .ply, .npy or .bin"});
  edit("clouds.yaml", "parent: base, pose: camera_pose.csv, ", "");
  expect_refused(cloud(), {"clouds.yaml", "where the sensor is"});
}

}  // namespace
}  // namespace penumbra::test
