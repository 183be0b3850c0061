// SPDX-License-Identifier: Apache-2.0
// `penumbra view live` beside `penumbra live`: each packet is the truth of its image's stamp.
#include "../fast_dds/lone_domain.hpp"
#include "../io/live_scene.hpp"
#include "../support/temporary_folder.hpp"
#include "viewer_process.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <io/dds/participant.hpp>

extern char** environ;  // NOLINT(readability-redundant-declaration)

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr auto patience = 30s;

/// A command of penumbra's that runs as long as this lives.
class Running {
 public:
  explicit Running(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), PENUMBRA_PROGRAM);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, PENUMBRA_PROGRAM, nullptr, nullptr, words.data(), environ), 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }

 private:
  pid_t pid_ = -1;
};

/// The scene's robot and camera on the graph, as long as this lives: joint states at 100 Hz, images
/// at 20 Hz or as often as wanted, by the system's clock.
class ScenePublisher {
 public:
  /// @param interval from one image to the next, in 10 ms
  explicit ScenePublisher(int domain, int interval = 5)
      : graph_(io::join_graph({.domain = domain})),
        interval_(interval),
        thread_([this] { run(); }) {}
  ~ScenePublisher() {
    ends_ = true;
    thread_.join();
  }
  ScenePublisher(const ScenePublisher&) = delete;
  ScenePublisher& operator=(const ScenePublisher&) = delete;

 private:
  using Bytes = std::vector<std::byte>;

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
    const auto write = [](const auto& publication, const Bytes& bytes) {
      static_cast<void>(publication->write(bytes));
    };
    write(urdf, encoded(io::StringMessage{live_urdf}));
    write(mount, encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
    for (int tick = 0; !ends_; ++tick, std::this_thread::sleep_for(10ms)) {
      const std::int64_t now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                   std::chrono::system_clock::now().time_since_epoch())
                                   .count();
      write(joints, live_joints(now));
      if (tick % interval_ != 0) continue;
      write(info, encoded(live_info(now)));
      write(depth, live_depth(now));
    }
  }

  std::unique_ptr<io::Participant> graph_;
  const int interval_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

class ViewLive : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> on_domain(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", std::to_string(domain_.id())});
    return arguments;
  }
  static void open(WebClient& browser, const std::string& with) {
    ASSERT_EQ(browser.upgrade("/api/live").status, 101);
    browser.send_text(R"({"type": "want", "with": )" + with + R"(, "step": 4})");
  }
  /// The next packet; fails the test where none comes in time.
  static Packet next(WebClient& browser) {
    browser.send_text(R"({"type": "ready"})");
    for (const auto end = Clock::now() + patience; Clock::now() < end;)
      if (const auto message = browser.message(); message && message->opcode == 2)
        return Packet(message->payload);
    return Packet("");
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
  std::string known;
  for (int v = 0; v < wanted.labels.height; ++v)
    known.append(reinterpret_cast<const char*>(wanted.labels.row(v)),
                 static_cast<std::size_t>(wanted.labels.width));
  EXPECT_EQ(labels, known) << stamp;
  EXPECT_EQ(frame["pixels"]["robot"], *wanted.pixels.robot);
  EXPECT_EQ(frame["pixels"]["beyond"], wanted.pixels.beyond);
  // The board turns about the optical axis, 1 m before the camera.
  const json& board = packet.json["link_poses"][1];
  const double half = spin_at(stamp) / 2;
  EXPECT_NEAR(board[2], 1.0, 1e-9);
  EXPECT_NEAR(std::abs(board[5].get<double>()), std::abs(std::sin(half)), 1e-3);
  EXPECT_NEAR(std::abs(board[6].get<double>()), std::abs(std::cos(half)), 1e-3);
  return 1;
}

TEST_F(ViewLive, PacketsAreTheTruthOfTheirStamps) {
  const ScenePublisher scene(domain_.id());
  const ViewerProcess viewer(on_domain({"live"}));
  const Running live(on_domain({"live"}));
  WebClient browser = viewer.client();
  open(browser, R"(["labels", "depth", "vdi", "cloud"])");
  LiveTruth truth;
  std::size_t known = 0;
  for (int i = 0; i < 40; ++i) {
    const Packet packet = next(browser);
    ASSERT_TRUE(packet.parts.contains("labels"));
    known += expect_truth(packet, truth);
    const json& state = packet.json["live"];
    EXPECT_GT(state["age_ms"], 0.0);
    EXPECT_LT(state["age_ms"], 5000.0);
    float z = 0;
    std::memcpy(&z, packet.parts.at("depth").data(), sizeof z);
    EXPECT_FLOAT_EQ(z, 3.0F);  // the wall
  }
  EXPECT_GT(known, 20U);

  const json session = viewer.get_json("/api/session");
  EXPECT_EQ(session["mode"], "live");
  EXPECT_EQ(session["links"], json({"base", "board"}));
  EXPECT_EQ(session["camera"]["width"], 64);
  const json scene_json = viewer.get_json("/api/scene");
  EXPECT_EQ(scene_json["version"], session["scene_version"]);
  EXPECT_EQ(scene_json["links"][1]["meshes"].size(), 1U);
}

// It is sent the newest when it is ready, and told how many it missed: those that another browser
// was sent meanwhile.
TEST_F(ViewLive, ASlowBrowserMissesFramesAndLagsNot) {
  const ScenePublisher scene(domain_.id());
  const ViewerProcess viewer(on_domain({"live"}));
  const Running live(on_domain({"live"}));
  WebClient slow = viewer.client();
  open(slow, R"(["labels"])");
  WebClient fast = viewer.client();
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

// Slower than the window that rates are counted in: the last interval tells.
TEST_F(ViewLive, ASlowCameraHasARate) {
  constexpr double seconds = 2.5;
  const ScenePublisher scene(domain_.id(), 250);
  const ViewerProcess viewer(on_domain({"live"}));
  const Running live(on_domain({"live"}));
  WebClient browser = viewer.client();
  open(browser, R"(["labels"])");
  EXPECT_EQ(next(browser).json["live"]["rate_hz"], 0.0);  // one frame has none
  const double rate = next(browser).json["live"]["rate_hz"];
  EXPECT_LT(rate, 1 / (0.9 * seconds));
  EXPECT_GT(rate, 1 / (2 * seconds));  // the publisher sleeps longer where others work
}

// Which process serves is told everywhere: the next one on this port counts its scenes anew.
TEST_F(ViewLive, ASceneIsAskedForByServerAndVersion) {
  const ScenePublisher scene(domain_.id());
  const ViewerProcess viewer(on_domain({"live"}));
  const Running live(on_domain({"live"}));
  WebClient browser = viewer.client();
  open(browser, R"(["labels"])");
  const Packet packet = next(browser);
  const std::string server = packet.json["server"];
  const int version = packet.json["scene_version"];
  EXPECT_EQ(viewer.get_json("/api/session")["server"], server);
  const std::string query = "?server=" + server + "&version=" + std::to_string(version);
  EXPECT_EQ(viewer.get_json("/api/scene" + query)["server"], server);
  EXPECT_EQ(viewer.client().get("/api/scene.bin" + query).status, 200);
  for (const std::string& other :
       {"?version=" + std::to_string(version + 1), "?server=x" + server}) {
    EXPECT_EQ(viewer.client().get("/api/scene" + other).status, 409) << other;
    EXPECT_EQ(viewer.client().get("/api/scene.bin" + other).status, 409) << other;
  }
}

// The viewer reads the robot itself: what it cannot draw is told even where penumbra live can.
TEST_F(ViewLive, LinksWithoutTheirGeometryAreTold) {
  std::string urdf = live_urdf;
  urdf.insert(urdf.rfind("</robot>"), R"(
  <link name="cover"><collision><geometry><mesh filename="gone.stl"/></geometry></collision></link>
  <joint name="fixed" type="fixed"><parent link="base"/><child link="cover"/></joint>
)");
  const TemporaryFolder folder;
  const ScenePublisher scene(domain_.id());
  const ViewerProcess viewer(
      on_domain({"live", "--robot", folder.write("robot.urdf", urdf), "--allow-missing-meshes"}));
  std::string missing;
  for (const auto end = Clock::now() + patience;
       missing.find("link cover") == std::string::npos && Clock::now() < end;
       std::this_thread::sleep_for(100ms))
    missing = viewer.get_json("/api/session")["missing"].dump();
  EXPECT_NE(missing.find("link cover is drawn without its geometry"), std::string::npos) << missing;
  EXPECT_NE(missing.find("gone.stl"), std::string::npos) << missing;
}

// By two programs that judge by different rules: labels of one must not come with targets of the
// other. Which one it is can be seen of neither, so that there are two is told.
TEST_F(ViewLive, TwoThatPublishAreToldApartAndTold) {
  const ScenePublisher scene(domain_.id());
  const ViewerProcess viewer(on_domain({"live"}));
  const Running live(on_domain({"live"})), rival(on_domain({"live"}));
  WebClient browser = viewer.client();
  open(browser, R"(["labels"])");
  std::string told;
  for (const auto end = Clock::now() + patience;
       told.find("2 programs publish /penumbra/labels") == std::string::npos && Clock::now() < end;)
    told = next(browser).json["live"]["diagnostics"].dump();
  EXPECT_NE(told.find("2 programs publish /penumbra/labels"), std::string::npos) << told;
  EXPECT_NE(told.find("error"), std::string::npos) << told;
}

// A page whose frames stop asks the session why.
TEST_F(ViewLive, ACameraThatEndsIsToldBySession) {
  auto scene = std::make_unique<ScenePublisher>(domain_.id());
  const ViewerProcess viewer(on_domain({"live"}));
  const Running live(on_domain({"live"}));
  WebClient browser = viewer.client();
  open(browser, R"(["labels"])");
  static_cast<void>(next(browser));
  scene.reset();
  std::string missing;
  for (const auto end = Clock::now() + patience;
       missing.find("depth: nobody publishes") == std::string::npos && Clock::now() < end;
       std::this_thread::sleep_for(100ms))
    missing = viewer.get_json("/api/session")["missing"].dump();
  EXPECT_NE(missing.find("depth: nobody publishes /camera/depth/image_rect_raw"), std::string::npos)
      << missing;
  EXPECT_TRUE(viewer.get_json("/api/session")["diagnostics"].is_array());
}

TEST_F(ViewLive, WithoutPenumbraLiveItIsSaidWhatIsMissing) {
  const ScenePublisher scene(domain_.id());
  const ViewerProcess viewer(on_domain({"live"}));
  WebClient browser = viewer.client();
  open(browser, R"(["labels"])");
  browser.send_text(R"({"type": "ready"})");
  std::string missing;
  for (const auto end = Clock::now() + patience;
       missing.find("penumbra live") == std::string::npos && Clock::now() < end;
       std::this_thread::sleep_for(100ms))
    missing = viewer.get_json("/api/session")["missing"].dump();
  EXPECT_NE(missing.find("nobody publishes /penumbra/labels"), std::string::npos) << missing;
}

TEST_F(ViewLive, BadWantsCloseTheConnection) {
  const ViewerProcess viewer(on_domain({"live"}));
  for (const char* const text :
       {"", "ready", "{}", R"({"type": "x"})", R"({"type": "want"})",
        R"({"type": "want", "with": "labels"})", R"({"type": "want", "with": ["secrets"]})",
        R"({"type": "want", "with": [1]})", R"({"type": "want", "with": [], "step": 0})",
        R"({"type": "want", "with": [], "step": -4})",
        R"({"type": "want", "with": [], "step": "4"})", "[[[[[[[[[["}) {
    WebClient browser = viewer.client();
    ASSERT_EQ(browser.upgrade("/api/live").status, 101);
    browser.send_text(text);
    const auto message = browser.message();
    ASSERT_TRUE(message) << text;
    EXPECT_EQ(message->opcode, 8) << text;
  }
  ViewerProcess other(on_domain({"live"}));
  EXPECT_EQ(other.end(), 0);
}

}  // namespace
}  // namespace penumbra::test
