// SPDX-License-Identifier: Apache-2.0
// Messages there and back, by definitions of any order, and payloads that are none.
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

TEST(RosMessages, AreTheSameThereAndBackInBothByteOrders) {
  test::for_each_sample([](const auto& message) {
    using M = std::decay_t<decltype(message)>;
    const auto little = encoded(message);
    const auto big = encoded(message, std::endian::big);
    EXPECT_EQ(little.size(), big.size());
    EXPECT_EQ(little[1], std::byte{1});
    EXPECT_EQ(big[1], std::byte{0});
    EXPECT_NE(little, big);
    // A rotation may differ in its last bit once.
    const auto again = encoded(decoded<M>(little));
    EXPECT_EQ(encoded(decoded<M>(again)), again) << message_type<M>();
    EXPECT_EQ(encoded(decoded<M>(big)), again) << message_type<M>();
    EXPECT_EQ(again.size(), little.size());
  });
}

TEST(RosMessages, EveryFieldArrives) {
  const auto joints = decoded<JointStateMessage>(encoded(sample<JointStateMessage>()));
  EXPECT_EQ(joints.header.stamp, test::sample_header().stamp);
  EXPECT_EQ(joints.header.frame_id, "camera/optical");
  EXPECT_EQ(joints.names, (std::vector<std::string>{"elbow", "", "shoulder_pan"}));
  EXPECT_EQ(joints.positions, (std::vector<double>{0.5, -1.25, 3}));
  EXPECT_TRUE(joints.velocities.empty());
  EXPECT_EQ(joints.efforts, (std::vector<double>{7, 8}));

  const auto tf = decoded<TfMessage>(encoded(sample<TfMessage>()));
  ASSERT_EQ(tf.transforms.size(), 2U);
  EXPECT_EQ(tf.transforms[1].header.stamp, -1);
  EXPECT_EQ(tf.transforms[0].child_frame_id, "tool");
  EXPECT_TRUE(tf.transforms[0].T_parent_child.isApprox(test::sample_pose(), turn_rounding));

  const auto info = decoded<CameraInfoMessage>(encoded(sample<CameraInfoMessage>()));
  EXPECT_EQ(info.p, sample<CameraInfoMessage>().p);
  EXPECT_EQ(info.roi.width, 4U);
  EXPECT_TRUE(info.roi.do_rectify);
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

// A definition of other order, with more fields of every kind than are known.
TEST(RosMessages, FieldsAreFoundByName) {
  const Decoder<StringMessage> decoder("std_msgs/msg/String",
                                       "bool[2] flags\n"
                                       "Empty nothing\n"
                                       "Pair[] pairs\n"
                                       "string<=8[<=2] words\n"
                                       "string data\n"
                                       "int64[] numbers\n"
                                       "Pair[2] two\n"
                                       "===\nMSG: std_msgs/Empty\n"
                                       "===\nMSG: std_msgs/Pair\nint16 a\nfloat64 b\n");
  std::vector<std::byte> payload;
  CdrWriter writer(payload);
  writer.write_bool(true);
  writer.write_bool(false);
  writer.write(std::uint8_t{0});
  writer.write_count(2);
  for (int i = 0; i < 2; ++i) {
    writer.write(std::int16_t{3});
    writer.write(0.5);
  }
  writer.write_count(1);
  writer.write_string("word");
  writer.write_string("found");
  writer.write_count(0);
  for (int i = 0; i < 2; ++i) {
    writer.write(std::int16_t{3});
    writer.write(0.5);
  }
  StringMessage message;
  const auto fault = decoder.decode(payload, message);
  EXPECT_FALSE(fault) << *fault;
  EXPECT_EQ(message.data, "found");
}

TEST(RosMessages, DefinitionsThatDoNotFitAreRefusedByName) {
  const auto fault = [](const std::string& text) {
    return refusal([&] { Decoder<JointStateMessage>("sensor_msgs/msg/JointState", text); });
  };
  const std::string header = "===\nMSG: std_msgs/Header\ntime stamp\nstring frame_id\n";
  EXPECT_HAS(fault("std_msgs/Header header\nstring[] name\nfloat32[] position\n"
                   "float64[3] velocity\n" +
                   header),
             "'sensor_msgs/JointState': has position as float32[]");
  EXPECT_HAS(fault("std_msgs/Header header\nstring[] name\nfloat64[] position\n"
                   "float64[] velocity\nfloat64[] effort\n"
                   "===\nMSG: std_msgs/Header\nuint32 stamp\n"),
             "header.stamp");
  EXPECT_HAS(fault("wstring[] name\n"), "wstring");
  EXPECT_HAS(refusal([] { Decoder<ImageMessage>("sensor_msgs/msg/PointCloud2", ""); }),
             "sensor_msgs/Image");
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
  for (const std::endian order : {std::endian::little, std::endian::big})
    test::for_each_sample([&](const auto& message) {
      using M = std::decay_t<decltype(message)>;
      check(encoded(message, order), Decoder<M>(), M());
    });
  check(test::detection_2d_payload(), Decoder<Detection2DArrayMessage>(),
        Detection2DArrayMessage());
  check(test::detection_3d_payload(), Decoder<Detection3DArrayMessage>(),
        Detection3DArrayMessage());
}

TEST(RosMessages, FaultsNameFieldAndByte) {
  StringMessage text;
  const auto whole = encoded(sample<StringMessage>());
  const auto fault = [&](const auto& change) {
    auto payload = whole;
    change(payload);
    return Decoder<StringMessage>().decode(payload, text).value_or("");
  };
  for (const int kind : {2, 3, 6, 7, 8, 9, 10, 11, 200})  // encapsulations
    EXPECT_HAS(fault([&](auto& bytes) { bytes[1] = static_cast<std::byte>(kind); }), "CDR_LE");
  for (const std::size_t padding : {1, 2, 3})
    EXPECT_EQ(fault([&](auto& bytes) { bytes.resize(bytes.size() + padding); }), "");
  EXPECT_HAS(fault([](auto& bytes) { bytes.resize(bytes.size() + 4); }), "4 bytes");
  EXPECT_HAS(fault([](auto& bytes) { bytes.back() = std::byte{'x'}; }), "data");
  EXPECT_HAS(fault([](auto& bytes) { bytes.resize(3); }), "3 bytes");
  TfMessage tf;
  auto payload = encoded(sample<TfMessage>());
  payload[8 + 4 + 3] = std::byte{0xff};  // nanoseconds
  EXPECT_HAS(*Decoder<TfMessage>().decode(payload, tf), "transforms.header.stamp, byte 16");
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
