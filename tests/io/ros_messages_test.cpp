// SPDX-License-Identifier: Apache-2.0
// Messages there and back, definitions that are refused, and damaged payloads.
#include "../support/allocations.hpp"
#include "files.hpp"
#include "ros_samples.hpp"

#include <gtest/gtest.h>

#include <io/ros/cdr_writer.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

using test::encoded;
using test::refusal;
using test::sample;

constexpr double turn_rounding = 1e-15;  // a rotation to a quaternion and back

template <typename M>
M decoded(std::span<const std::byte> payload) {
  M message;
  const auto fault = Decoder<M>().decode(payload, message);
  EXPECT_FALSE(fault) << *fault;
  return message;
}

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

TEST(RosMessages, DefinitionsOfOtherFieldsAreRefusedByName) {
  const auto fault = [](const std::string& text) {
    return refusal([&] { Decoder<JointStateMessage>("sensor_msgs/msg/JointState", text); });
  };
  const std::string begin = "std_msgs/Header header\nstring[] name\nfloat64[] position\n";
  const std::string rest = "float64[] velocity\nfloat64[] effort\n";
  const std::string header = "===\nMSG: std_msgs/Header\ntime stamp\nstring frame_id\n";
  EXPECT_HAS(fault(begin + "float64[3] velocity\n" + header),
             "sensor_msgs/JointState has 'float64[3] velocity' in place of 'float64[] velocity'");
  EXPECT_HAS(fault(begin + header), "in place of 'float64[] velocity'");
  EXPECT_HAS(fault(begin + rest + "wstring more\n" + header), "'wstring more'");
  EXPECT_HAS(fault(begin + rest), "lacks std_msgs/Header");
  EXPECT_HAS(fault(begin + rest + "===\nMSG: std_msgs/Header\nuint32 stamp\nstring frame_id\n"),
             "std_msgs/Header has 'uint32 stamp'");
  EXPECT_HAS(fault(begin + rest + header + "===\nMSG: builtin_interfaces/Time\nint64 sec\n"),
             "builtin_interfaces/Time has 'int64 sec'");
  EXPECT_HAS(fault(""), "ROS 2 Humble");
  EXPECT_HAS(refusal([] { Decoder<ImageMessage>("sensor_msgs/msg/PointCloud2", ""); }),
             "cannot be read as sensor_msgs/Image");
}

// vision_msgs 2 (Foxy), 3 (Galactic) and 4 (Humble to Jazzy): of the older ones only Galactic's
// boxes in space are laid out as today's.
TEST(RosMessages, OlderDetectionsAreRefusedUnlessTheirFieldsAreEqual) {
  const auto changed = [](std::string_view type, const std::string& from, const std::string& to) {
    return test::replaced(std::string(definition_of(type)), from, to);
  };
  const std::string flat = "vision_msgs/msg/Detection2DArray";
  const std::string solid = "vision_msgs/msg/Detection3DArray";
  const std::string galactic =
      changed(flat, "vision_msgs/Pose2D center", "geometry_msgs/Pose2D center");
  EXPECT_HAS(refusal([&] { Decoder<Detection2DArrayMessage>(flat, galactic); }),
             "vision_msgs/BoundingBox2D has 'geometry_msgs/Pose2D center'");
  const std::string foxy =
      changed(solid, "ObjectHypothesis hypothesis\n", "string id\nfloat64 score\n");
  EXPECT_HAS(refusal([&] { Decoder<Detection3DArrayMessage>(solid, foxy); }),
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

// Counts that no payload of that size can hold, at every place where there is a count.
TEST(RosMessages, AbsurdCountsAllocateNothing) {
  const test::MemoryShortage shortage(100'000, 1'000'000);
  test::for_each_sample([](const auto& message) {
    using M = std::decay_t<decltype(message)>;
    const auto whole = encoded(message);
    M out;
    const Decoder<M> decoder;
    for (std::size_t at = 4; at + 4 <= whole.size(); at += 4) {
      auto payload = whole;
      for (const int high : {0xff, 0x7f, 0x10}) {
        payload[at + 3] = static_cast<std::byte>(high);
        static_cast<void>(decoder.decode(payload, out));
      }
    }
  });
  EXPECT_EQ(shortage.asked(), 0U);
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
  std::vector<std::byte> payload;
  PoseStampedMessage pose;
  for (const std::int64_t stamp :
       {std::int64_t{2'147'483'647'999'999'999}, std::int64_t{-2'147'483'648'000'000'000},
        std::int64_t{-1}, std::int64_t{0}, std::int64_t{-1'000'000'000}}) {
    pose.header.stamp = stamp;
    encode(pose, payload);
    EXPECT_EQ(decoded<PoseStampedMessage>(payload).header.stamp, stamp);
  }
  for (const std::int64_t stamp :
       {std::int64_t{2'147'483'648'000'000'000}, std::int64_t{-2'147'483'648'000'000'001}}) {
    pose.header.stamp = stamp;
    EXPECT_HAS(refusal([&] { encode(pose, payload); }), "32 bits for seconds");
  }
}

TEST(RosMessages, ReadingAgainAllocatesNothing) {
  const Decoder<JointStateMessage> decoder;
  const auto payload = encoded(sample<JointStateMessage>());
  JointStateMessage message;
  EXPECT_FALSE(decoder.decode(payload, message));
  std::vector<std::byte> out;
  encode(message, out);
  const std::size_t before = test::allocations();
  EXPECT_FALSE(decoder.decode(payload, message));
  encode(message, out);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace penumbra::io
