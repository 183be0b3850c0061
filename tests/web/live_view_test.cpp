// SPDX-License-Identifier: Apache-2.0
// The page of `penumbra live --port`: each packet is the truth of its image's stamp.
#include "../apps/program.hpp"
#include "../fast_dds/lone_domain.hpp"
#include "../fast_dds/pattern.hpp"
#include "../io/live_scene.hpp"
#include "viewer_process.hpp"

#include <atomic>

#include <io/dds/participant.hpp>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

/// The scene's robot and camera on the graph, as long as this lives: joint states at 100 Hz, images
/// at 20 Hz, by the system's clock.
class ScenePublisher {
 public:
  explicit ScenePublisher(int domain)
      : graph_(io::join_graph({.domain = domain})), thread_([this] { run(); }) {}
  ~ScenePublisher() {
    ends_ = true;
    thread_.join();
  }
  ScenePublisher(const ScenePublisher&) = delete;
  ScenePublisher& operator=(const ScenePublisher&) = delete;

 private:
  void run() {
    const io::TopicQos latched{.reliable = true, .latched = true, .depth = 1};
    const io::TopicQos plain{.reliable = true, .depth = 10};
    const auto urdf = graph_->advertise("/robot_description", "std_msgs/msg/String", latched);
    const auto mount = graph_->advertise("/tf_static", "tf2_msgs/msg/TFMessage", latched);
    const auto joints = graph_->advertise("/joint_states", "sensor_msgs/msg/JointState", plain);
    const auto info =
        graph_->advertise("/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo", plain);
    const auto depth =
        graph_->advertise("/camera/depth/image_rect_raw", "sensor_msgs/msg/Image", plain);
    const auto write = [](const auto& publication, const std::vector<std::byte>& bytes) {
      return publication->write(bytes);
    };
    write(urdf, encoded(io::StringMessage{live_urdf}));
    write(mount, encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
    for (int tick = 0; !ends_; ++tick, std::this_thread::sleep_for(10ms)) {
      const std::int64_t now = system_now();
      write(joints, live_joints(now));
      if (tick % 5 != 0) continue;
      write(info, encoded(live_info(now)));
      write(depth, live_depth(now));
    }
  }

  std::unique_ptr<io::Participant> graph_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

class ViewLive : public testing::Test {
 protected:
  /// `penumbra live` with a page.
  [[nodiscard]] ViewerProcess start() const {
    return ViewerProcess({"--domain", std::to_string(domain_.id())}, "live");
  }
  static void open(WebClient& browser, const std::string& with) {
    ASSERT_EQ(browser.upgrade("/api/live").status, 101);
    browser.send_text(R"({"type": "want", "with": )" + with + R"(, "step": 4})");
  }
  /// The next packet; fails the test where none comes in time.
  static Packet next(WebClient& browser) {
    browser.send_text(R"({"type": "ready"})");
    std::string bytes;
    eventually([&] {
      const auto message = browser.message();
      if (message && message->opcode == 2) bytes = message->payload;
      return !bytes.empty();
    });
    return Packet(bytes);
  }

  LoneDomain domain_;
};

/// How many packets' labels are the truth; the rest knows no pose, and is unknown throughout.
std::size_t expect_truth(const Packet& packet, LiveTruth& truth) {
  const json& frame = packet.json["frame"];
  const std::int64_t stamp = frame["stamp_ns"];
  const std::string& labels = packet.parts.at("labels");
  if (packet.json["camera_pose"].is_null()) {
    EXPECT_NE(frame["status"], "ok");
    EXPECT_EQ(labels, std::string(labels.size(), '\x03'));
    return 0;
  }
  const FrameReport& wanted = truth.judge(stamp);
  EXPECT_EQ(labels, bytes_of(wanted.labels)) << stamp;
  // The board turns about the optical axis, 1 m before the camera.
  const json& board = packet.json["link_poses"][1];
  const double half = spin_at(stamp) / 2;
  EXPECT_NEAR(board[2], 1.0, 1e-9);
  EXPECT_NEAR(std::abs(board[5].get<double>()), std::abs(std::sin(half)), 1e-3);
  EXPECT_NEAR(std::abs(board[6].get<double>()), std::abs(std::cos(half)), 1e-3);
  return 1;
}

TEST_F(ViewLive, PacketsAreTheTruthOfTheirStamps) {
  const std::int64_t begin = system_now();
  const ScenePublisher scene(domain_.id());
  const ViewerProcess live = start();
  WebClient browser = live.client();
  open(browser, R"(["labels", "vdi", "cloud"])");
  LiveTruth truth;
  std::size_t known = 0;
  for (int i = 0; i < 40; ++i) {
    const Packet packet = next(browser);
    ASSERT_TRUE(packet.parts.contains("labels"));
    known += expect_truth(packet, truth);
    const double age_ms = packet.json["live"]["age_ms"];
    EXPECT_GT(age_ms, 0.0);
    EXPECT_LT(age_ms, 1e-6 * static_cast<double>(system_now() - begin));
  }
  EXPECT_GT(known, 20U);

  const json session = live.get_json("/api/session");
  EXPECT_EQ(session["mode"], "live");
  const json scene_json = live.get_json("/api/scene");
  EXPECT_EQ(scene_json["version"], session["scene_version"]);
  EXPECT_EQ(scene_json["links"][1]["meshes"].size(), 1U);
}

// It is sent the newest when it is ready, and told how many it missed: those that another browser
// was sent meanwhile.
TEST_F(ViewLive, ASlowBrowserMissesFramesAndLagsNot) {
  const ScenePublisher scene(domain_.id());
  const ViewerProcess live = start();
  WebClient slow = live.client();
  open(slow, R"(["labels"])");
  WebClient fast = live.client();
  open(fast, R"(["labels"])");
  const auto index_of = [](const Packet& packet) {
    return packet.json["frame"]["index"].get<std::int64_t>();
  };
  const std::int64_t before = index_of(next(slow));
  std::int64_t newest = 0;
  while (newest < before + 10 && !HasFailure()) newest = index_of(next(fast));
  const Packet after = next(slow);
  EXPECT_GE(index_of(after), newest);
  EXPECT_EQ(after.json["live"]["dropped"], index_of(after) - before - 1);
}

TEST_F(ViewLive, EachCameraHasAPage) {
  const Outcome live =
      penumbra({"live", "--camera", "left=/left/depth", "--camera", "right=/right/depth", "--port",
                "0", "--duration", "0.5", "--domain", std::to_string(domain_.id())});
  EXPECT_EQ(live.status, 2) << live.err;  // nothing was judged
  const std::size_t first = live.out.find("page: http://127.0.0.1:");
  const std::size_t second = live.out.find("page: http://127.0.0.1:", first + 1);
  ASSERT_NE(second, std::string::npos) << live.out;
  const auto line_at = [&](std::size_t at) {
    return live.out.substr(at, live.out.find('\n', at) - at);
  };
  EXPECT_NE(line_at(first), line_at(second));
}

TEST_F(ViewLive, BadWantsCloseTheConnection) {
  ViewerProcess live = start();
  for (const char* const text :
       {"", "ready", "{}", R"({"type": "x"})", R"({"type": "want"})",
        R"({"type": "want", "with": "labels"})", R"({"type": "want", "with": ["secrets"]})",
        R"({"type": "want", "with": [1]})", R"({"type": "want", "with": [], "step": 0})",
        R"({"type": "want", "with": [], "step": -4})",
        R"({"type": "want", "with": [], "step": "4"})", "[[[[[[[[[["}) {
    WebClient browser = live.client();
    ASSERT_EQ(browser.upgrade("/api/live").status, 101);
    browser.send_text(text);
    const auto message = browser.message();
    ASSERT_TRUE(message) << text;
    EXPECT_EQ(message->opcode, 8) << text;
  }
  EXPECT_EQ(live.end(), 0);
}

}  // namespace
}  // namespace penumbra::test
