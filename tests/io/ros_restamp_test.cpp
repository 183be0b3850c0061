// SPDX-License-Identifier: Apache-2.0
#include "ros_samples.hpp"

#include <io/ros/restamp.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t shift = 12'345'678'901;  // ns

std::int64_t shifted(std::int64_t stamp) { return stamp + shift; }

template <typename M>
io::Restamper restamper() {
  const std::string type = io::message_type<M>();
  return {type, io::definition_of(type)};
}

/// The same as if the message had been encoded with other stamps.
template <typename M, typename Shift>
void expect_as_encoded(M message, Shift shift_stamps) {
  std::vector<std::byte> payload = encoded(message);
  shift_stamps(message);
  const io::Restamper restamper = test::restamper<M>();
  EXPECT_TRUE(restamper.has_headers());
  EXPECT_EQ(restamper.apply(payload, shifted), std::nullopt);
  EXPECT_TRUE(payload == encoded(message)) << io::message_type<M>();
}

TEST(Restamp, ChangesStampsAndNothingElse) {
  for_each_sample([](const auto& message) {
    if constexpr (requires { message.header; })
      expect_as_encoded(message, [](auto& moved) { moved.header.stamp += shift; });
    else if constexpr (requires { message.transforms; })
      expect_as_encoded(message, [](auto& moved) {
        for (auto& transform : moved.transforms) transform.header.stamp += shift;
      });
  });
}

TEST(Restamp, LeavesNoStampAndTypesWithoutHeadersAlone) {
  auto message = sample<io::JointStateMessage>();
  message.header.stamp = 0;
  const std::vector<std::byte> before = encoded(message);
  std::vector<std::byte> payload = before;
  EXPECT_EQ(restamper<io::JointStateMessage>().apply(payload, shifted), std::nullopt);
  EXPECT_TRUE(payload == before);
  EXPECT_FALSE(restamper<io::StringMessage>().has_headers());
}

TEST(Restamp, CutPayloadsAreFaultsOrWholeInTheirHeaders) {
  const std::vector<std::byte> whole = encoded(sample<io::JointStateMessage>());
  const io::Restamper restamper = test::restamper<io::JointStateMessage>();
  std::size_t faults = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    faults += restamper.apply(cut, shifted) ? 1 : 0;
  }
  EXPECT_GE(faults, 12U);  // encapsulation and stamp
}

TEST(Restamp, FindsHeadersOfDetections) {
  const auto expect_shifted = []<typename M>(M message, std::vector<std::byte> payload) {
    EXPECT_EQ(restamper<M>().apply(payload, shifted), std::nullopt);
    ASSERT_EQ(io::Decoder<M>().decode(payload, message), std::nullopt);
    EXPECT_EQ(message.header.stamp, sample_header().stamp + shift);
    ASSERT_EQ(message.detections.size(), 1U);
    EXPECT_EQ(message.detections[0].header.stamp, sample_header().stamp + shift);
    EXPECT_FALSE(message.detections[0].id.empty());
  };
  expect_shifted(io::Detection2DArrayMessage(), detection_2d_payload());
  expect_shifted(io::Detection3DArrayMessage(), detection_3d_payload());
}

TEST(Restamp, TellsOfHeadersThatItLeaves) {
  const std::string
      header = "std_msgs/Header header\n",
      definition = "===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";
  for (const auto& [text, changes, leaves] :
       {std::tuple(header + "wstring text\n" + definition, true, false),
        {header + "C[] more\n===\nMSG: a/C\n" + header + definition, true, true},
        {"int32 count\n" + header + definition, false, true},
        {"std_msgs/Header[] headers\n" + definition, false, true},
        {header + "===\nMSG: std_msgs/Header\nuint32 seq\n", false, true},
        {"", false, true},
        {"int32 count\n", false, false}}) {
    const io::Restamper restamper("a/msg/B", text);
    EXPECT_EQ(restamper.has_headers(), changes) << text;
    EXPECT_EQ(restamper.leaves_headers(), leaves) << text;
  }
}

}  // namespace
}  // namespace penumbra::test
