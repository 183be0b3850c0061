// SPDX-License-Identifier: Apache-2.0
// Hashes of message types as nodes of ROS 2 Jazzy announce them.
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <io/dds/type_hash.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

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
    EXPECT_EQ(type_hash(type, definition_of(type)), std::string("RIHS01_") + hash) << type;
}

TEST(TypeHash, IsEmptyWithoutAllTypes) {
  EXPECT_EQ(type_hash("a/msg/A", "Unknown field\n"), "");
  EXPECT_EQ(type_hash("a/msg/A", "a/A itself\n").size(), 71U);  // ends
}

}  // namespace
}  // namespace penumbra::io
