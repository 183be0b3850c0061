// SPDX-License-Identifier: Apache-2.0
// What a live page is sent: the values that were judged, and no more than it asks for.
#include "../apps/tiny_clouds.hpp"
#include "../io/live_scene.hpp"
#include "packet.hpp"

#include <io/files/report_json.hpp>
#include <io/web/live_view.hpp>

namespace penumbra::test {
namespace {

using nlohmann::json;

constexpr const char* color_topic = "/camera/color/image_raw";

io::LiveOptions with_color() {
  io::LiveOptions options = LiveBench::one_camera();
  options.cameras.front().color_topic = color_topic;
  options.robot.robot.allow_missing_meshes = true;
  return options;
}

/// What a client that is ready is sent; nothing: it waits.
std::optional<Packet> next(io::WebChannel& client) {
  EXPECT_TRUE(client.take(R"({"type": "ready"})"));
  const auto message = client.next();
  if (!message) return std::nullopt;
  std::string bytes;
  for (const io::SharedBytes& part : *message) bytes += *part;
  return Packet(bytes);
}

/// A camera that is judged by hand, and its page. Keeps what was judged.
class LivePage : public testing::Test, public io::FrameWatcher {
 protected:
  void judge(std::int64_t stamp) {
    bench_.tell_joints_around(stamp);
    const Image<Rgb8> red(64, 48, {200, 0, 0});
    bench_.publish(color_topic, encoded(io::image_message(io::MessageHeader{stamp, "optical"},
                                                          "rgb8", red.view())));
    bench_.tell_depth(stamp);
    ASSERT_TRUE(bench_.inbox.next(0, bench_.now, wants_color(), bench_.job));
    const auto outcome = bench_.worker.judge(bench_.job, bench_.results, this);
    bench_.inbox.done(0, outcome, bench_.now, bench_.now);
  }

  [[nodiscard]] bool wants_color() const override { return view_.needs(io::Part::color); }
  void take(const io::AssembledFrame& job, const FrameReport& report, const Drift& drift) override {
    report_ = io::report_frame(report);
    parts_ = {{"labels", bytes_of(report.labels)},
              {"links", bytes_of(report.virtual_depth.links)},
              {"vdi", bytes_of(report.virtual_depth.depth)}};
    static_cast<void>(view_.show(job, report, drift, *job.stamp));
  }

  std::unique_ptr<io::WebChannel> client(const std::string& with) {
    auto channel = view_.open_channel("/api/live");
    EXPECT_TRUE(channel->take(R"({"type": "want", "with": )" + with + "}"));
    return channel;
  }
  [[nodiscard]] json answer(const std::string& path) {
    return json::parse(*view_.answer({path, {}}).body.front());
  }

  LiveBench bench_{with_color()};
  io::LiveView view_{"live"};
  std::string report_;  // of the last frame
  std::map<std::string, std::string> parts_;
};

TEST_F(LivePage, ShowsTheValuesThatWereJudged) {
  const auto browser = client(R"(["color", "labels", "links", "vdi", "depth", "cloud"])");
  bench_.tell_all();
  judge(start);
  const auto packet = next(*browser);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->json["frame"], json::parse(report_));
  EXPECT_EQ(packet->json["frame"]["status"], "ok");
  for (const auto& [name, bytes] : parts_) EXPECT_TRUE(packet->parts.at(name) == bytes) << name;
  EXPECT_FLOAT_EQ(packet->float_at("depth"), 3.0F);               // the wall
  EXPECT_EQ(packet->parts.at("color").substr(0, 2), "\xFF\xD8");  // a JPEG
  ASSERT_GE(packet->parts.at("cloud").size(), 16U);
  EXPECT_NEAR(static_cast<unsigned char>(packet->parts.at("cloud")[13]), 200, 5);  // its red
  EXPECT_EQ(packet->json["link_poses"][1][2], 1.0);
  EXPECT_EQ(packet->json["live"]["dropped"], 0);
  EXPECT_EQ(packet->json["live"]["calibration"], nullptr);  // not known after one frame
  const json session = answer("/api/session");
  EXPECT_EQ(session["parts"],
            json({"color", "labels", "links", "vdi", "depth", "outlines", "cloud"}));
  EXPECT_EQ(session["camera"]["width"], 64);
  EXPECT_EQ(session["links"], json({"base", "board"}));
}

TEST_F(LivePage, AFrameWithoutAPoseHasItsStatusAndItsDepth) {
  const auto browser = client(R"(["labels", "vdi", "depth"])");
  bench_.tell_all();
  bench_.tell_depth(start);
  bench_.now += seconds;  // no joint states came
  ASSERT_TRUE(bench_.inbox.next(0, bench_.now, false, bench_.job));
  static_cast<void>(bench_.worker.judge(bench_.job, bench_.results, this));
  const auto packet = next(*browser);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->json["frame"], json::parse(report_));
  EXPECT_EQ(packet->json["camera_pose"], nullptr);
  EXPECT_EQ(packet->parts.at("labels"), std::string(64 * 48, '\x03'));
  EXPECT_TRUE(packet->parts.contains("depth"));
  EXPECT_FALSE(packet->parts.contains("vdi"));
}

TEST(LiveScans, ShowTheirPointsWhereTheSensorWas) {
  io::LiveOptions options;
  options.clouds = {{.topic = "/points"}};
  LiveBench bench(options);
  io::LiveView view("live", true);
  const auto browser = view.open_channel("/api/live");
  EXPECT_TRUE(browser->take(R"({"type": "want", "with": ["cloud"]})"));
  bench.tell_robot();
  bench.tell_mount();
  bench.tell_joints_around(start);
  FourPoints points(0);
  points.message.header.stamp = start;
  bench.publish("/points", encoded(points.message));
  ASSERT_TRUE(bench.inbox.next(0, bench.now, false, bench.job));
  Pipeline pipeline(bench.job.setup->posed->robot, *bench.job.setup->cloud());
  EXPECT_TRUE(view.show(bench.job, pipeline.process(bench.job), {}, start));
  const auto packet = next(*browser);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->json["frame"]["status"], "ok");
  EXPECT_EQ(packet->json["frame"]["points"]["occluded"], 1);
  EXPECT_EQ(packet->json["link_poses"][1][2], 1.0) << "the board";
  EXPECT_EQ(packet->json["camera_pose"][2], 0.0) << "the sensor is in the base";
  const std::string& shown = packet->parts.at("cloud");
  ASSERT_EQ(shown.size(), 3 * 16U) << "what is no measurement is not shown";
  EXPECT_EQ(shown[12], static_cast<char>(Label::occluded));
  EXPECT_EQ(shown[2 * 16 + 12], static_cast<char>(Label::clear));
  EXPECT_EQ(json::parse(*view.answer({"/api/session", {}}).body.front())["parts"], json({"cloud"}));
}

TEST_F(LivePage, LinksWithoutTheirGeometryAreTold) {
  std::string urdf = live_urdf;
  urdf.insert(urdf.rfind("</robot>"), R"(
  <link name="cover"><collision><geometry><mesh filename="gone.stl"/></geometry></collision></link>
  <joint name="fixed" type="fixed"><parent link="base"/><child link="cover"/></joint>
)");
  bench_.tell_robot(urdf);
  bench_.tell_mount();
  bench_.tell_info(0);
  judge(start);
  const std::string missing = answer("/api/session")["missing"].dump();
  EXPECT_NE(missing.find("cover"), std::string::npos) << missing;
  EXPECT_NE(missing.find("gone.stl"), std::string::npos) << missing;
}

}  // namespace
}  // namespace penumbra::test
