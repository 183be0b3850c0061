// SPDX-License-Identifier: Apache-2.0
// Foxglove's messages in protobuf, read as those of ROS 2.
#include "../support/allocations.hpp"
#include "../support/run_length.hpp"
#include "foxglove_encoder.hpp"
#include "ros_samples.hpp"

#include <cmath>

#include <io/ros/foxglove_messages.hpp>

namespace penumbra::io {
namespace {

using namespace std::string_literals;
namespace fox = test::foxglove;

std::span<const std::byte> bytes_of_text(const std::string& text) {
  return std::as_bytes(std::span(text));
}

template <typename M>
const Decoder<M>& decoder_of(const std::string& schema) {
  static const std::string set = fox::descriptors();
  static std::map<std::string, Decoder<M>> decoders;
  return decoders.try_emplace(schema, schema, set).first->second;
}

/// `payload` must outlive the message.
template <typename M>
M read(const std::string& schema, const std::string& payload) {
  M message;
  const auto fault = decoder_of<M>(schema).decode(bytes_of_text(payload), message);
  EXPECT_FALSE(fault) << *fault;
  return message;
}

template <typename M>
std::string fault_of(const std::string& schema, const std::string& payload) {
  M message;
  return decoder_of<M>(schema).decode(bytes_of_text(payload), message).value_or("");
}

constexpr auto image_schema = "foxglove.RawImage", joints_schema = "foxglove.JointStates",
               camera_schema = "foxglove.CameraCalibration",
               transforms_schema = "foxglove.FrameTransforms";

/// Calls `call(schema, sample, payload)` with a message of each schema. What protobuf does not say
/// is as ROS's drivers leave it.
template <typename F>
void for_each_foxglove(const F& call) {
  CameraInfoMessage camera = test::sample_camera();
  camera.binning_x = camera.binning_y = 0;
  camera.roi = {};
  const auto one = [&](const char* schema, const auto& sample) {
    call(schema, sample, fox::encode(sample));
  };
  const MessageHeader header = test::sample_header();
  one(image_schema, ImageMessage{header, 1, 5, "mono16", {}, 5, test::sample_bytes});
  one("foxglove.CompressedImage", CompressedImageMessage{header, "png", test::sample_bytes});
  one("foxglove.CompressedVideo", CompressedVideoMessage{header, test::sample_bytes, "h264"});
  one(camera_schema, camera);
  one(joints_schema, JointStateMessage{{header.stamp, ""}, {"elbow", "wrist"}, {0.5, -1.25}});
  const TfMessage tf{{{header, "tool", test::sample_pose()}, {{7, "a"}, "b", test::sample_pose()}}};
  one(transforms_schema, tf);
  call("foxglove.FrameTransform", TfMessage{{tf.transforms[0]}}, fox::encode(tf.transforms[0]));
}

TEST(Foxglove, MessagesAreThoseOfRos) {
  for_each_foxglove([](const std::string& schema, const auto& sample, const std::string& payload) {
    using M = std::decay_t<decltype(sample)>;
    EXPECT_EQ(ros_type_of(schema), message_type<M>());
    if constexpr (std::is_same_v<M, TfMessage>) {  // a rotation is rounded as a quaternion
      const M found = read<M>(schema, payload);
      ASSERT_EQ(found.transforms.size(), sample.transforms.size());
      for (std::size_t i = 0; i < found.transforms.size(); ++i) {
        const auto &is = found.transforms[i], &wanted = sample.transforms[i];
        EXPECT_EQ(is.header.stamp, wanted.header.stamp);
        EXPECT_EQ(is.header.frame_id, wanted.header.frame_id);
        EXPECT_EQ(is.child_frame_id, wanted.child_frame_id);
        EXPECT_TRUE(is.T_parent_child.isApprox(wanted.T_parent_child, 1e-12));
      }
    } else {
      EXPECT_EQ(test::encoded(read<M>(schema, payload)), test::encoded(sample)) << schema;
    }
  });
}

TEST(Foxglove, BytesAreThoseOfTheSpecification) {
  // Written by hand: time {5 s, 300 ns}, 2 x 1 of 16UC1 in steps of 4 bytes, frame "cam".
  const std::string payload = "\x0a\x05\x08\x05\x10\xac\x02"s + "\x15\x02\x00\x00\x00"s +
                              "\x1d\x01\x00\x00\x00"s + "\x22\x05" + "16UC1" +
                              "\x2d\x04\x00\x00\x00"s + "\x32\x04\x01\x02\x03\x04" + "\x3a\x03" +
                              "cam";
  const auto image = read<ImageMessage>(image_schema, payload);
  EXPECT_EQ(image.header.stamp, 5'000'000'300);
  EXPECT_EQ(image.header.frame_id, "cam");
  EXPECT_EQ(image.encoding, "16UC1");
  EXPECT_EQ((std::array{image.width, image.height, image.step}), (std::array{2U, 1U, 4U}));
  EXPECT_EQ(fox::bytes_in(image.data), "\x01\x02\x03\x04");
  EXPECT_EQ(reinterpret_cast<const char*>(image.data.data()), payload.data() + 31) << "no copy";
}

TEST(Foxglove, ReadsAllThatProtobufAllows) {
  const JointStateMessage state{{5, ""}, {"a"}, {0.5}};
  // Fields of later versions, and in any order.
  const std::string unknown = fox::integer(99, ~0ULL) + fox::fixed(98, 1) + fox::real(97, 2) +
                              fox::counted(100, "id") + fox::counted(1'000'000, "");
  const std::string joint = fox::counted(2, unknown + fox::real(2, 0.5) + fox::counted(1, "a"));
  for (const std::string& payload :
       {unknown + fox::encode(state), joint + fox::counted(1, fox::time(5)),
        fox::encode(state) + unknown,
        // Parts of a message in two pieces are merged, and the last number counts.
        fox::counted(1, fox::integer(1, 9) + fox::integer(2, 5)) +
            fox::counted(1, fox::integer(1, 0)) + joint})
    EXPECT_EQ(test::encoded(read<JointStateMessage>(joints_schema, payload)), test::encoded(state));

  // Numbers one by one, as protobuf's version 2 writes them.
  std::string camera = fox::counted(1, fox::time(5)) + fox::counted(4, "kannala_brandt");
  for (int i = 0; i < 9; ++i) camera += fox::real(6, i);
  const auto info = read<CameraInfoMessage>(camera_schema, camera);
  EXPECT_EQ(info.k, (std::array<double, 9>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(info.r, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1})) << "of one camera";
  EXPECT_EQ(info.distortion_model, "equidistant") << "ROS's name";
}

TEST(Foxglove, WhatIsNotWrittenIsZeroOrUnknown) {
  const std::string names = fox::counted(2, "base") + fox::counted(3, "tool");
  // Half a turn around x: w is 0, and not written.
  const auto turned =
      read<TfMessage>("foxglove.FrameTransform", names + fox::counted(5, fox::real(1, 1.0)));
  const Eigen::Vector3d half_turn(1, -1, -1);
  EXPECT_TRUE(turned.transforms.at(0).T_parent_child.matrix().diagonal().head<3>().isApprox(
      half_turn, 1e-12));
  EXPECT_EQ(turned.transforms[0].header.stamp, 0);
  const auto without = read<TfMessage>("foxglove.FrameTransform", names);
  EXPECT_TRUE(std::isnan(without.transforms.at(0).T_parent_child(0, 0)))
      << "no rotation is no pose";

  const std::string joints = fox::counted(1, fox::time(5)) + fox::counted(2, fox::counted(1, "a")) +
                             fox::counted(2, fox::counted(1, "b") + fox::real(2, 0.0)) +
                             fox::counted(2, fox::counted(1, "c") + fox::real(2, NAN));
  EXPECT_EQ(read<JointStateMessage>(joints_schema, joints).names, std::vector{"b"s});
}

TEST(Foxglove, FaultsNameSchemaAndField) {
  const auto joints_fault = [](const std::string& payload) {
    return fault_of<JointStateMessage>(joints_schema, payload);
  };
  const std::string time = fox::counted(1, fox::time(5));
  EXPECT_EQ(joints_fault(fox::counted(2, fox::counted(1, "a"))),
            "foxglove.JointStates: timestamp: is missing");
  EXPECT_HAS(joints_fault(fox::counted(1, fox::integer(2, 1'000'000'000))), "1000000000 ns");
  EXPECT_HAS(joints_fault(fox::counted(1, fox::integer(1, 9'300'000'000))), "2262");
  EXPECT_HAS(joints_fault(time + fox::counted(2, fox::integer(2, 5))),
             "joints: position: is of wire type 0");
  EXPECT_HAS(joints_fault(time + fox::counted(2, "")), "joints: name: is missing");
  EXPECT_HAS(joints_fault(time + "\x13"), "wire type 3");
  EXPECT_HAS(joints_fault(time + "\x02"), "number 0");
  EXPECT_HAS(joints_fault(time + "\x08" + std::string(10, '\xff')), "10 bytes");
  const std::array<double, 4> four = {1, 2, 3, 4};
  EXPECT_HAS(fault_of<CameraInfoMessage>(camera_schema, time + fox::packed(6, four)),
             "K: has 4 values; expected 9");
  EXPECT_HAS(fault_of<CameraInfoMessage>(camera_schema, time + fox::counted(6, "123")), "3 bytes");
  EXPECT_HAS(fault_of<TfMessage>("foxglove.FrameTransform", fox::counted(2, "base")),
             "child_frame_id");
  std::string many;
  for (int i = 0; i < 70'000; ++i) many += fox::counted(1, fox::counted(3, "a"));
  EXPECT_HAS(fault_of<TfMessage>(transforms_schema, many), "65536");
}

TEST(Foxglove, SchemasWithOtherFieldsAreRefused) {
  const auto refusal_of = [](const std::string& from, const std::string& to,
                             const std::string& type = image_schema) {
    return test::refusal([&] {
      Decoder<ImageMessage>(type, fox::descriptors(test::replaced(fox::all_schemas, from, to)));
    });
  };
  EXPECT_EQ(refusal_of("5 effort 1 1\n", "5 effort 1 1\n6 torque 1 1\n"), "") << "a later version";
  EXPECT_HAS(refusal_of("7 frame_id 1 9", "8 frame_id 1 9"), "field 7 of RawImage is missing");
  EXPECT_HAS(refusal_of("2 width 1 7\n3 height 1 7\n4 enc", "3 width 1 7\n2 height 1 7\n4 enc"),
             "field 2 of RawImage is 'height'; expected width");
  EXPECT_HAS(refusal_of("2 width 1 7\n3 height 1 7\n4 enc", "2 width 1 13\n3 height 1 7\n4 enc"),
             "width, is of another type");
  EXPECT_HAS(refusal_of("6 data 1 12", "6 data 3 12"), "data, is of another type");
  EXPECT_HAS(refusal_of("1 seconds 1 3", "1 secs 1 3"), "field 1 of Timestamp is 'secs'");
  EXPECT_HAS(refusal_of("foxglove RawImage", "foxglove Picture"), "lacks foxglove.RawImage");
  EXPECT_HAS(test::refusal([] { Decoder<ImageMessage>(image_schema, ""); }), "lacks");
  EXPECT_HAS(test::refusal([] { Decoder<ImageMessage>(image_schema, "uint8 data\n"); }), "byte");
  EXPECT_HAS(refusal_of("1 x", "1 x", joints_schema), "cannot be read as sensor_msgs/Image");
}

std::string damaged(std::string bytes, std::mt19937_64& random) {
  if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
  for (std::size_t n = 1 + random() % 6; n > 0 && !bytes.empty(); --n)
    bytes[random() % bytes.size()] = static_cast<char>(random());
  return bytes;
}

TEST(Foxglove, DamageIsAFaultOrAnotherValue) {
  std::mt19937_64 random = test::seeded_random(17);
  const test::MemoryShortage shortage(std::size_t{64} << 20, 0);
  const int rounds = test::is_full_run() ? 40'000 : test::samples(1500);
  for_each_foxglove([&](const std::string& schema, const auto& sample, const std::string& whole) {
    using M = std::decay_t<decltype(sample)>;
    M out;
    const auto decode = [&](const std::string& bytes) {
      const test::ExactCopy copy(bytes_of_text(bytes));
      const auto fault = decoder_of<M>(schema).decode(copy.bytes(), out);
      ASSERT_EQ(fault.value_or("").find('\n'), std::string::npos) << *fault;
    };
    for (std::size_t size = 0; size < whole.size(); ++size) decode(whole.substr(0, size));
    for (int i = 0; i < rounds; ++i) decode(damaged(whole, random));
  });
  const std::string schemas = fox::descriptors();
  for (int i = 0; i < rounds; ++i)
    test::refusal([&] { Decoder<TfMessage>(transforms_schema, damaged(schemas, random)); });
  EXPECT_EQ(shortage.asked(), 0U);
}

}  // namespace
}  // namespace penumbra::io
