// SPDX-License-Identifier: Apache-2.0
// Messages there and back, definitions that are refused, and damaged payloads.
#include "files.hpp"
#include "ros_samples.hpp"

#include <penumbra/base/version.hpp>

#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

using test::decoded;
using test::encoded;
using test::refusal;
using test::sample;

constexpr double turn_rounding = 1e-15;  // a rotation to a quaternion and back

TEST(RosMessages, Detections) {
  const auto flat = decoded<Detection2DArrayMessage>(test::detection_2d_payload());
  ASSERT_EQ(flat.detections.size(), 1U);
  EXPECT_EQ(flat.detections[0].results[1].hypothesis.class_id, "person");
  EXPECT_EQ(flat.detections[0].bbox.centre.position, Eigen::Vector2d(320.5, 240.25));
  EXPECT_EQ(flat.detections[0].bbox.size_y, 32);
  EXPECT_EQ(flat.detections[0].id, "track/7");

  const auto solid = decoded<Detection3DArrayMessage>(test::detection_3d_payload());
  ASSERT_EQ(solid.detections.size(), 1U);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(2 * std::atan2(0.6, 0.8), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_TRUE(solid.detections[0].bbox.centre.linear().isApprox(turned, turn_rounding));
  EXPECT_EQ(solid.detections[0].bbox.size, Eigen::Vector3d(0.1, 0.2, 0.3));
}

/// A definition with one piece of it replaced.
template <typename M>
void expect_definition_refused(const std::string& from, const std::string& to,
                               const std::string& named) {
  const std::string type = message_type<M>();
  const std::string text = test::replaced(std::string(definition_of(type)), from, to);
  EXPECT_HAS(refusal([&] { Decoder<M>(type, text); }), named);
}

TEST(RosMessages, DefinitionsOfOtherFieldsAreRefusedByName) {
  using Joints = JointStateMessage;
  expect_definition_refused<Joints>(
      "float64[] velocity", "float64[3] velocity",
      "sensor_msgs/JointState has 'float64[3] velocity' in place of 'float64[] velocity'");
  expect_definition_refused<Joints>("float64[] velocity\n", "", "in place of 'float64[] velocity'");
  expect_definition_refused<Joints>("float64[] effort", "float64[] effort\nwstring more",
                                    "'wstring more'");
  expect_definition_refused<Joints>("MSG: std_msgs/Header", "MSG: std_msgs/Other",
                                    "lacks std_msgs/Header");
  expect_definition_refused<Joints>("int32 sec", "int64 sec",
                                    "builtin_interfaces/Time has 'int64 sec'");
  EXPECT_HAS(refusal([] { Decoder<Joints>(message_type<Joints>(), ""); }), "ROS 2 Humble");
  EXPECT_HAS(refusal([] { Decoder<ImageMessage>("sensor_msgs/msg/PointCloud2", ""); }),
             "cannot be read as sensor_msgs/Image");
}

// vision_msgs 2 (Foxy), 3 (Galactic) and 4 (Humble to Jazzy): of the older ones only Galactic's
// boxes in space are laid out as today's.
TEST(RosMessages, OlderDetectionsAreRefusedUnlessTheirFieldsAreEqual) {
  expect_definition_refused<Detection2DArrayMessage>(
      "vision_msgs/Pose2D center", "geometry_msgs/Pose2D center",
      "vision_msgs/BoundingBox2D has 'geometry_msgs/Pose2D center'");
  expect_definition_refused<Detection3DArrayMessage>(
      "ObjectHypothesis hypothesis\n", "string id\nfloat64 score\n",
      "vision_msgs/ObjectHypothesisWithPose has 'string id'");
}

TEST(RosMessages, EveryTruncationIsAFault) {
  const auto check = [](std::span<const std::byte> whole, const auto& decoder, auto message) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const test::ExactCopy cut(whole.first(size));
      const auto fault = decoder.decode(cut.bytes(), message);
      EXPECT_TRUE(fault) << size;
      EXPECT_EQ(fault.value_or("").find('\n'), std::string::npos);
    }
  };
  // What is whole is read as it was written. A rotation may differ in its last bit once.
  test::for_each_sample([&](const auto& message) {
    using M = std::decay_t<decltype(message)>;
    check(encoded(message), Decoder<M>(), M());
    const auto again = encoded(decoded<M>(encoded(message)));
    EXPECT_EQ(encoded(decoded<M>(again)), again) << message_type<M>();
  });
  check(test::detection_2d_payload(), Decoder<Detection2DArrayMessage>(),
        Detection2DArrayMessage());
  check(test::detection_3d_payload(), Decoder<Detection3DArrayMessage>(),
        Detection3DArrayMessage());
}

TEST(RosMessages, FaultsNameFieldAndByte) {
  auto payload = encoded(sample<TfMessage>());
  payload[4] = std::byte{3};  // transforms
  TfMessage tf;
  EXPECT_HAS(*Decoder<TfMessage>().decode(payload, tf), "tf2_msgs/TFMessage: transforms");
  payload = encoded(sample<TfMessage>());
  payload[8 + 4 + 3] = std::byte{0xff};  // nanoseconds
  EXPECT_EQ(*Decoder<TfMessage>().decode(payload, tf),
            "tf2_msgs/TFMessage: transforms.header.stamp, byte 16: its nanoseconds exceed a "
            "second");
  payload.resize(3);
  EXPECT_HAS(*Decoder<TfMessage>().decode(payload, tf), "3 bytes are no CDR payload");
}

TEST(RosMessages, WhatIsLeftOverOrNotLittleEndianIsAFault) {
  auto payload = encoded(sample<StringMessage>());
  StringMessage message;
  for (const int kind : {0, 2, 3, 6, 11, 200}) {
    auto other = payload;
    other[1] = static_cast<std::byte>(kind);
    EXPECT_HAS(*Decoder<StringMessage>().decode(other, message), "its encapsulation is ");
  }
  const Decoder<StringMessage> decoder;
  for (int padding = 1; padding <= 3; ++padding) {
    payload.push_back(std::byte{0});
    EXPECT_FALSE(decoder.decode(payload, message));
  }
  payload.push_back(std::byte{0});
  EXPECT_HAS(*decoder.decode(payload, message), "4 bytes are left over");
}

TEST(RosMessages, ARotationThatIsNoneIsNaN) {
  PoseStampedMessage pose{{0, "base"}, test::sample_pose()};
  const auto whole = encoded(pose);
  const std::size_t w = whole.size() - sizeof(double);
  for (const double value : {0.0, 0.5, 2.0, std::nan("")}) {
    auto payload = whole;
    std::memcpy(payload.data() + w, &value, sizeof(value));
    const auto read = decoded<PoseStampedMessage>(payload);
    EXPECT_TRUE(read.pose.linear().array().isNaN().all()) << value;
    EXPECT_EQ(read.pose.translation(), pose.pose.translation());
  }
}

TEST(RosMessages, StampsThatRosCannotHoldAreRefused) {
  const auto encode_at = [](std::int64_t stamp) {
    return encoded(PoseStampedMessage{{stamp, ""}});
  };
  for (const std::int64_t stamp : {2'147'483'648'000'000'000, -2'147'483'648'000'000'001})
    EXPECT_HAS(refusal([&] { encode_at(stamp); }), "32 bits for seconds");
}

// What colcon builds: the same files, of this version.
TEST(RosDefinition, OurPackageListsItsMessages) {
  const std::filesystem::path folder = PENUMBRA_SOURCE_DIR "/ros/penumbra_msgs";
  EXPECT_HAS(test::read_bytes(folder / "package.xml"), "<version>" PENUMBRA_VERSION "</version>");
  const std::string listed = test::read_bytes(folder / "CMakeLists.txt");
  std::size_t messages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "msg")) {
    EXPECT_HAS(listed, "  msg/" + entry.path().filename().string() + "\n");
    EXPECT_FALSE(definition_of("penumbra_msgs/" + entry.path().stem().string()).empty());
    ++messages;
  }
  EXPECT_EQ(messages, 11U);
}

}  // namespace
}  // namespace penumbra::io
