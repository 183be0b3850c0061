// SPDX-License-Identifier: Apache-2.0
// The page of `penumbra cloud --port`: the tiny robot's board before a wall.
#include "../apps/fixtures.hpp"
#include "../apps/tiny_clouds.hpp"
#include "viewer_process.hpp"

namespace penumbra::test {
namespace {

using nlohmann::json;

using CloudViewTest = BagTest;

TEST_F(CloudViewTest, HasThePointsAndTheirLabels) {
  add_clouds(bag_);
  bag_.write_mcap(path("tiny.mcap"));
  ViewerProcess viewer({path("tiny.mcap"), "--topic", "/points"}, "cloud");
  ASSERT_NE(viewer.port(), 0);
  const json session = viewer.complete_session();
  EXPECT_EQ(session["parts"], json({"cloud"}));
  EXPECT_EQ(session["camera"], nullptr);
  EXPECT_EQ(session["frames"], 3);
  const json report = viewer.get_json("/api/report");
  ASSERT_EQ(report["frames"].size(), 3U);
  const json& points = report["frames"][1]["points"];
  EXPECT_EQ(points["occluded"], 1);
  EXPECT_EQ(points["front"], 1);
  EXPECT_EQ(points["clear"], 1);
  EXPECT_EQ(points["unknown"], 1);
  EXPECT_NE(report["summary"], nullptr);

  const Packet packet = viewer.packet(1, "cloud");
  EXPECT_EQ(packet.json["frame"], report["frames"][1]);
  EXPECT_EQ(packet.json["link_poses"].size(), session["links"].size());
  EXPECT_TRUE(packet.json["camera_pose"].is_array());
  const std::string& cloud = packet.parts.at("cloud");
  ASSERT_EQ(cloud.size(), 3 * 16U) << "what is no measurement is not shown";
  const std::array labels{Label::occluded, Label::front, Label::clear};
  for (std::size_t i = 0; i < labels.size(); ++i)
    EXPECT_EQ(cloud[16 * i + 12], static_cast<char>(labels.at(i)));
  EXPECT_EQ(packet.float_at("cloud", 8), on_board(1));
  EXPECT_EQ(viewer.end(), 0);
}

}  // namespace
}  // namespace penumbra::test
