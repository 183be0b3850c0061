// SPDX-License-Identifier: Apache-2.0
// ROS 2's graph by itself: names, settings, messages within one process.
#include "../support/errors.hpp"
#include "listening.hpp"
#include "lone_domain.hpp"

#include <io/dds/graph_names.hpp>
#include <io/dds/type_hash.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::test {
namespace {

constexpr const char* image_type = "sensor_msgs/msg/Image";

// The names are those of REP-like conventions of ROS 2's "Topic and Service name mapping to DDS".
TEST(GraphNames, AreThoseOfRos2AndOthersAreRefusedInBothDirections) {
  EXPECT_EQ(io::dds_topic("/camera/depth/image_raw"), "rt/camera/depth/image_raw");
  EXPECT_EQ(io::dds_type("sensor_msgs/msg/Image"), "sensor_msgs::msg::dds_::Image_");
  EXPECT_EQ(io::ros_topic("rt/tf"), "/tf");
  EXPECT_EQ(io::ros_type("tf2_msgs::msg::dds_::TFMessage_"), "tf2_msgs/msg/TFMessage");
  EXPECT_EQ(io::ros_topic("ros_discovery_info"), std::nullopt);
  EXPECT_EQ(io::ros_topic("rq/add_two_intsRequest"), std::nullopt);
  EXPECT_EQ(io::ros_type("sensor_msgs::msg::Image"), std::nullopt);

  for (const char* const name : {"", "/", "a", "a/b", "//a", "/a/", "/a//b", "/1", "/a/2b", "/a b",
                                 "/a\n", "/{ns}/a", "/~/a"}) {
    EXPECT_THROW(static_cast<void>(io::dds_topic(name)), InputError) << name;
    EXPECT_EQ(io::ros_topic("rt" + std::string(name)), std::nullopt) << name;
  }
  for (const char* const type : {"", "Image", "sensor_msgs/Image", "sensor_msgs/msg/", "/msg/Image",
                                 "a/b/C", "a/msg/C/d", "a/msg/C d"})
    EXPECT_THROW(static_cast<void>(io::dds_type(type)), InputError) << type;
  for (const char* const type : {"", "::", "a::msg::dds_::_x", "a::msg::dds_::", "a::msg::dds::C_",
                                 "a::b::dds_::C_", "a::msg::dds_::C"})
    EXPECT_EQ(io::ros_type(type), std::nullopt) << type;
}

TEST(GraphDomain, IsThatOfOptionsEnvironmentOrZero) {
  unsetenv("ROS_DOMAIN_ID");
  EXPECT_EQ(io::graph_domain({}), 0);
  setenv("ROS_DOMAIN_ID", "42", 1);
  EXPECT_EQ(io::graph_domain({}), 42);
  EXPECT_EQ(io::graph_domain({.domain = 7}), 7);
  for (const char* const bad : {"abc", "-1", "233", "1.5", "99999999999"}) {
    setenv("ROS_DOMAIN_ID", bad, 1);
    EXPECT_THROW(static_cast<void>(io::graph_domain({})), InputError) << bad;
  }
  unsetenv("ROS_DOMAIN_ID");
}

TEST(DiscoveryRange, IsThatOfTheEnvironment) {
  unsetenv("ROS_LOCALHOST_ONLY");
  unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
  EXPECT_EQ(io::discovery_range(), "SUBNET");
  setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF", 1);
  EXPECT_EQ(io::discovery_range(), "OFF");
  setenv("ROS_LOCALHOST_ONLY", "1", 1);
  EXPECT_EQ(io::discovery_range(), "LOCALHOST");
  unsetenv("ROS_LOCALHOST_ONLY");
  for (const auto& [name, value] : {std::pair{"ROS_AUTOMATIC_DISCOVERY_RANGE", "NEAR"},
                                    std::pair{"ROS_STATIC_PEERS", "192.0.2.1;<Peers>"}}) {
    unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
    setenv(name, value, 1);
    expect_refused([] { return io::join_graph({.domain = 9}); }, {name});
    unsetenv(name);
  }
}

TEST(Graph, RefusesBadSettingsInOneLineThatNamesThem) {
  const LoneDomain domain;
  for (const char* const bad :
       {"<CycloneDDS><Domain><Foo>1</Foo></Domain></CycloneDDS>", "file:///nonexistent.xml",
        "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"wlan99\"/></Interfaces>"
        "</General></Domain></CycloneDDS>"}) {
    SCOPED_TRACE(bad);
    setenv("CYCLONEDDS_URI", bad, 1);
    expect_refused([&] { return io::join_graph({.domain = domain.id()}); }, {"CYCLONEDDS_URI"});
  }
  unsetenv("CYCLONEDDS_URI");
  EXPECT_EQ(refusal([&] { return io::join_graph({.domain = domain.id()}); }), "");
}

TEST(Graph, CountsWhatNewerMessagesReplaced) {
  const LoneDomain domain;
  const auto graph = io::join_graph({.domain = domain.id()});
  const auto heard = graph->subscribe("/a", image_type, {.reliable = true, .depth = 3});
  const auto said = graph->advertise("/a", image_type, {.reliable = true, .depth = 10});
  for (std::uint32_t i = 0; i < 10; ++i) ASSERT_TRUE(said->write(pattern_message(i, 64)));
  EXPECT_EQ(listen(*graph, *heard, 3), (std::vector<std::int64_t>{7, 8, 9}));
  const auto status = heard->status();
  EXPECT_EQ(status.received, 10U);
  EXPECT_EQ(status.taken, 3U);
  EXPECT_EQ(status.overwritten, 7U);
}

/// Hashes of message types as nodes of ROS 2 Jazzy announce them.
TEST(TypeHash, IsThatOfJazzysOwnNodes) {
  const std::pair<const char*, const char*> announced[] = {
      {"std_msgs/msg/String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
      {"sensor_msgs/msg/Image", "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
      {"sensor_msgs/msg/JointState",
       "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
      {"sensor_msgs/msg/CameraInfo",
       "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"},
      {"tf2_msgs/msg/TFMessage",
       "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
      {"penumbra_msgs/msg/Keypoints",
       "5f8cab968684ffa08b85be83d6fd2819dfb30e4579ca75e5f6e8399a3580f0f0"}};
  for (const auto& [type, hash] : announced)
    EXPECT_EQ(io::type_hash(type, io::definition_of(type)), std::string("RIHS01_") + hash) << type;
  EXPECT_EQ(io::type_hash("a/msg/A", "Unknown field\n"), "");
}

}  // namespace
}  // namespace penumbra::test
