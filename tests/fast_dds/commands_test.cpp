// SPDX-License-Identifier: Apache-2.0
// Commands on ROS 2's graph: `penumbra play` and `penumbra topics`, and who listens; `penumbra
// live` where the tiny recording is played.
#include "../apps/fixtures.hpp"
#include "../apps/tiny_clouds.hpp"
#include "../support/running_program.hpp"
#include "listening.hpp"
#include "lone_domain.hpp"

#include <future>

#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::byte>;

constexpr std::int64_t first_log = 5'000'000'000;
constexpr std::int64_t period = 20'000'000;  // 50 Hz
constexpr std::size_t padding = 3;           // bytes: DDS sends multiples of four
constexpr const char* joint_type = "sensor_msgs/msg/JointState";

io::JointStateMessage joints(int i) {
  return {.header = {first_log + period * i - 3'000'000, ""},
          .names = {"a", "b"},
          .positions = {0.5 * i, -1.0}};
}

/// A domain of its own, on which programs run that this test hears.
class LiveGraph : public FolderTest {
 protected:
  [[nodiscard]] Words on_domain(const std::string& command, const Words& options = {}) const {
    return Words{command, "--domain", std::to_string(domain_.id())} + options;
  }
  /// Plays a bag again and again, with the stamps of now.
  [[nodiscard]] std::unique_ptr<RunningProgram> play_in_loop(const TinyBag& bag) const {
    bag.write_mcap(path("bag.mcap"));
    return std::make_unique<RunningProgram>(
        on_domain("play", {"--loop", "--restamp", path("bag.mcap")}), path("play.log"));
  }
  [[nodiscard]] std::unique_ptr<RunningProgram> live(const Words& options) const {
    return std::make_unique<RunningProgram>(on_domain("live", options), path("live.log"));
  }
  [[nodiscard]] std::unique_ptr<io::Subscription> hear(const std::string& topic,
                                                       const std::string& type) const {
    return graph_->subscribe(topic, type, {.reliable = true, .depth = 100});
  }
  /// Waits for messages of a topic until `is_enough(message)`; false: in vain.
  template <typename M, typename IsEnough>
  [[nodiscard]] bool hears(io::Subscription& heard, IsEnough is_enough) const {
    const io::Decoder<M> decoder;
    io::SerializedMessage sample;
    return eventually(*graph_, [&] {
      bool is_so = false;
      for (M message; !is_so && heard.take(sample);)
        is_so = !decoder.decode(sample.data, message) && is_enough(message);
      return is_so;
    });
  }

  LoneDomain domain_;
  std::unique_ptr<io::Participant> graph_ = io::join_graph({.domain = domain_.id()});
};

class Commands : public LiveGraph {
 protected:
  Commands() {
    bag_.add("/robot_description", first_log - 1, io::StringMessage{"<robot/>"});
    for (int i = 0; i < 25; ++i) bag_.add("/joint_states", first_log + period * i, joints(i));
    bag_.write_mcap(file());
  }
  [[nodiscard]] fs::path file() const { return path("bag.mcap"); }

  Outcome play(const Words& options) const {
    return penumbra(on_domain("play", Words{file()} + options));
  }

  /// Messages of a topic until the player is done.
  std::vector<Bytes> hear_joints(const Words& options, const std::string& topic = "/joint_states") {
    const auto heard = hear(topic, joint_type);
    auto player = std::async(std::launch::async, [&] { return play(options); });
    std::vector<Bytes> messages;
    io::SerializedMessage sample;
    bool done = false;
    do {
      done = player.wait_for(0s) == std::future_status::ready;
      graph_->wait(20ms);
      while (heard->take(sample)) messages.emplace_back(sample.data.begin(), sample.data.end());
    } while (!done);
    out_ = succeed(player.get()).out;
    return messages;
  }
  [[nodiscard]] std::vector<Bytes> recorded(const std::string& topic, std::size_t from = 0) const {
    std::vector<Bytes> messages;
    for (const TinyBag::Message& message : bag_.messages)
      if (message.topic == topic) messages.push_back(message.data);
    messages.erase(messages.begin(), messages.begin() + static_cast<std::ptrdiff_t>(from));
    return messages;
  }
  TinyBag bag_;
  std::string out_;
};

TEST_F(Commands, PlayPublishesTheBagByteForByteAndSaysSo) {
  EXPECT_EQ(hear_joints({}), recorded("/joint_states"));
  expect_has(out_, {"/joint_states", "reliable, latched", "26 messages published"});
}

TEST_F(Commands, PlayLoopsUntilCtrlCAndLatecomersHaveLatchedTopics) {
  const auto joints = hear("/joint_states", joint_type);
  const auto player = play_in_loop(bag_);
  io::SerializedMessage sample;
  ASSERT_TRUE(eventually(*graph_, [&] { return joints->take(sample); }));
  const auto late = graph_->subscribe("/robot_description", "std_msgs/msg/String",
                                      {.reliable = true, .latched = true, .depth = 1});
  ASSERT_TRUE(eventually(*graph_, [&] { return late->take(sample); }));
  const Bytes wanted = recorded("/robot_description").front();
  ASSERT_LE(wanted.size(), sample.data.size());
  EXPECT_LE(sample.data.size(), wanted.size() + padding);
  EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), sample.data.begin()));
  std::size_t messages = 1;
  EXPECT_TRUE(eventually(*graph_, [&] {
    while (joints->take(sample)) ++messages;
    return messages > recorded("/joint_states").size();
  }));
  EXPECT_EQ(player->end(SIGINT), 0);
}

/// It is never faster. That it is not slower is in the stamps of PlayRestampsToNow.
TEST_F(Commands, PlayKeepsThePaceOfTheRecording) {
  constexpr double length = 0.48;  // s
  for (const double rate : {0.5, 4.0}) {
    const auto heard = hear("/joint_states", joint_type);
    RunningProgram player(on_domain("play", {file(), "--rate", std::to_string(rate)}),
                          path("play.log"));
    std::vector<std::int64_t> times;
    io::SerializedMessage sample;
    ASSERT_TRUE(eventually(*graph_, [&] {
      while (heard->take(sample)) times.push_back(sample.source_time);
      return times.size() >= 25;
    }));
    EXPECT_GT(static_cast<double>(times.back() - times.front()) * 1e-9, 0.9 * length / rate);
  }
}

TEST_F(Commands, PlayRestampsToNow) {
  const std::int64_t before = system_now();
  const auto messages = hear_joints({"--restamp", "--rate", "2"});
  ASSERT_EQ(messages.size(), 25U);
  const std::int64_t first = decoded<io::JointStateMessage>(messages.front()).header.stamp;
  EXPECT_GT(first, before);
  EXPECT_LT(first, system_now());
  for (int i = 0; i < 25; ++i) {
    const auto message = decoded<io::JointStateMessage>(messages[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(static_cast<double>(message.header.stamp - first), period / 2.0 * i, 1.0);
    EXPECT_EQ(message.positions, joints(i).positions);
  }
}

TEST_F(Commands, PlayStartsLaterButLatchedTopicsAreThere) {
  // 0.2 s after the first message, the description's, 1 ns before the joint states'.
  EXPECT_EQ(hear_joints({"--start", "0.2"}), recorded("/joint_states", 10));
  expect_has(out_, {"16 messages published"});
}

TEST_F(Commands, PlayRenamesAndChoosesTopics) {
  EXPECT_EQ(hear_joints({"--topics", "/joint_states", "--remap", "/joint_states:=/arm/joints"},
                        "/arm/joints"),
            recorded("/joint_states"));
  expect_lacks(out_, {"/robot_description"});
}

TEST_F(Commands, PlayLatchesWhatWasLatched) {
  bag_.add("/map", first_log, io::StringMessage{"x"});
  bag_.add("/words", first_log, io::StringMessage{"x"});
  bag_.qos = {{"/map", "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"},
              {"/words", "- durability: transient_local\n"},
              {"/joint_states", "- {"},
              {"/robot_description", "- durability: volatile\n"}};
  const auto line_of = [](const std::string& text, const std::string& topic) {
    const std::size_t begin = text.find(topic + " ");
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  for (const bool by_sqlite : {false, true}) {
    const fs::path bag = path(by_sqlite ? "qos.db3" : "qos.mcap");
    by_sqlite ? bag_.write_sqlite(bag) : bag_.write_mcap(bag);
    const Words words = on_domain("play", {bag, "--delay", "0", "--rate", "1000"});
    const Outcome outcome = succeed(penumbra(words));
    for (const char* topic : {"/map", "/words"})
      EXPECT_TRUE(line_of(outcome.out, topic).ends_with("reliable, latched")) << outcome.out;
    for (const char* topic : {"/joint_states", "/robot_description"})
      EXPECT_TRUE(line_of(outcome.out, topic).ends_with(" reliable")) << outcome.out;
    expect_has(outcome.err, {"/joint_states: the bag's QoS cannot be read"});
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    const Outcome chosen = penumbra(words + Words{"--latched", "/words"});
    EXPECT_TRUE(line_of(chosen.out, "/map").ends_with(" reliable")) << chosen.out;
    EXPECT_TRUE(line_of(chosen.out, "/words").ends_with("latched")) << chosen.out;
  }
}

TEST_F(Commands, PlayTellsWhatItLeavesOutAndWhatIsDamaged) {
  bag_.add("no_slash", first_log, io::StringMessage{"x"});
  bag_.write_mcap(file());
  expect_has(succeed(play({"--delay", "0"})).err, {"no_slash is not played"});
  EXPECT_EQ(play({"--topics", "no_slash"}).status, 2);
  fs::resize_file(file(), 2000);
  expect_refused(play({}), {"there is nothing to play", "byte "});
}

TEST_F(Commands, BadInputIsStatus2AndOneLine) {
  TinyBag().write_mcap(path("empty.mcap"));
  const std::string bag = file();
  const std::vector<Words> cases = {{"play"},
                                    {"play", path("none.mcap")},
                                    {"play", path("empty.mcap")},
                                    {"play", bag, "--rate", "0"},
                                    {"play", bag, "--rate", "-1"},
                                    {"play", bag, "--rate", "nan"},
                                    {"play", bag, "--start", "-1"},
                                    {"play", bag, "--topics", "/nope"},
                                    {"play", bag, "--latched", "/nope"},
                                    {"play", bag, "--remap", "/joint_states"},
                                    {"play", bag, "--remap", "/joint_states:=x y"},
                                    {"play", bag, "--remap", "/nope:=/x"},
                                    {"play", bag, "--domain", "233"},
                                    {"topics", "--domain", "-1"},
                                    {"topics", "--domain", "x"},
                                    {"topics", "--wait", "forever"}};
  for (const Words& line : cases) expect_refused(penumbra(line), {});
  expect_failed(penumbra({"topics"}, {"CYCLONEDDS_URI=nonsense"}), {"CYCLONEDDS_URI"});
  EXPECT_EQ(penumbra({"topics"}, {"ROS_DOMAIN_ID=x"}).status, 2);
}

TEST_F(Commands, TopicsListsBothSides) {
  const auto said = graph_->advertise("/a", joint_type, {.reliable = true, .latched = true});
  const auto heard = graph_->subscribe("/b", joint_type, {});
  Json json;
  Words words;
  for (int wait = 1; json["topics"].size() < 2 && wait <= 64; wait *= 2) {
    words = on_domain("topics", {"--wait", std::to_string(wait)});
    json = Json::parse(penumbra(words + Words{"--json"}).out);
  }
  ASSERT_EQ(json["topics"].size(), 2U);
  ASSERT_EQ(json["topics"][0]["publishers"].size(), 1U);
  expect_values(json, {{"/domain", domain_.id()},
                       {"/topics/0/name", "/a"},
                       {"/topics/0/type", joint_type},
                       {"/topics/0/publishers/0/latched", true},
                       {"/topics/1/subscribers/0/reliable", false}});
  std::string table;
  for (int i = 0; i < 6 && table.find("reliable, latched") == std::string::npos; ++i)
    table = succeed(penumbra(words)).out;
  expect_has(table, {"reliable, latched"});
}

class LiveTest : public LiveGraph {
 protected:
  LiveTest() {
    write_tiny_recording(path());
    bag_ = tiny_bag(path());
  }

  TinyBag bag_;
};

TEST_F(LiveTest, CloudsAndScansComeWithoutTheRobot) {
  add_clouds(bag_);
  const auto points = hear("/penumbra/points", "sensor_msgs/msg/PointCloud2");
  const auto labelled = hear("/penumbra/points/labelled", "sensor_msgs/msg/PointCloud2");
  const auto scans = hear("/penumbra/scan", "sensor_msgs/msg/LaserScan");
  const auto livox = hear("/penumbra/livox/lidar", "livox_ros_driver2/msg/CustomMsg");
  const auto program = live({"--robot", path("tiny.urdf"), "--cloud", "/points", "--cloud",
                             "/scan removed_ranges=inf sensor=hokuyo", "--cloud", "/livox/lidar",
                             "--summary", path("summary.json")});
  const auto player = play_in_loop(bag_);
  const auto thrice = [](const auto& is_right) {
    return [is_right, count = 0](const auto& message) mutable {
      count += is_right(message) ? 1 : 0;
      return count > 2;
    };
  };
  EXPECT_TRUE(hears<io::PointCloud2Message>(*points, thrice([](const auto& m) {
    return numbers_of(m) == std::vector{1, 2};
  })));
  EXPECT_TRUE(hears<io::PointCloud2Message>(*labelled, thrice([](const auto& m) {
    return numbers_of(m).size() == 4 && m.fields.back().name == "link";
  })));
  EXPECT_TRUE(hears<io::LaserScanMessage>(*scans, thrice([](const auto& m) {
    return m.ranges.at(0) == 3.0F && std::isinf(m.ranges.at(1)) && m.ranges.at(2) == 3.0F;
  })));
  EXPECT_TRUE(hears<io::LivoxMessage>(*livox, thrice([](const auto& m) {
    return m.points.size() == 1 && m.points[0].y == 2.0F;
  }))) << read_file(path("live.log"));
  EXPECT_EQ(program->end(), 0);
  const Json summary = read_json(path("summary.json"));
  ASSERT_EQ(summary["clouds"].size(), 3U);
  EXPECT_EQ(summary["clouds"][0]["topic"], "/points");
  EXPECT_GT(summary["clouds"][0]["points"]["occluded"], 2);
  EXPECT_GT(summary["clouds"][1]["judged"], 2);
  EXPECT_TRUE(summary["cameras"].empty());
}

/// The board moves on the motion that MoveIt shows, towards a knob that it hides until its near
/// face has passed.
TEST_F(LiveTest, APlanIsForecast) {
  io::DisplayTrajectoryMessage plan{.model_id = "tiny", .parts = {{}}};
  plan.parts[0].joints = {
      .joint_names = {"slide"},
      .points = {{.positions = {0.0}},
                 {.positions = {tiny_speed * 6}, .time_from_start = {.sec = 6}}}};
  bag_.add("/display_planned_path", tiny_stamp(0) - 1'000'000, plan);
  for (int frame = 0; frame < 3; ++frame)
    bag_.add("/knob", tiny_stamp(frame),
             io::PoseStampedMessage{{tiny_stamp(frame), "optical"},
                                    Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.5))});
  const auto heard = hear("/penumbra/targets", "penumbra_msgs/msg/Targets");
  const auto program = live({"--depth-topic", "/camera/depth/image_rect_raw", "--robot",
                             path("tiny.urdf"), "--target-topic", "/knob"});
  const auto player = play_in_loop(bag_);
  EXPECT_TRUE(hears<io::TargetsMessage>(*heard, [](const auto& message) {
    if (message.targets.empty() || message.targets[0].forecast_seconds <= 0) return false;
    EXPECT_EQ(message.targets[0].hidden_in, 0.0);
    EXPECT_EQ(message.targets[0].hidden_by, "board");
    EXPECT_NEAR(message.targets[0].forecast_seconds, 2.0, 1e-9);
    return true;
  })) << read_file(path("live.log"));
  EXPECT_EQ(program->end(), 0);
}

TEST_F(LiveTest, RemapsItsDiagnostics) {
  const auto heard = hear("/cell/health", "diagnostic_msgs/msg/DiagnosticArray");
  const auto program = live({"--depth-topic", "/depth", "--remap", "/diagnostics:=/cell/health"});
  EXPECT_TRUE(hears<io::DiagnosticArrayMessage>(
      *heard, [](const auto& message) { return !message.status.empty(); }));
  const auto topics = graph_->graph();
  EXPECT_TRUE(std::none_of(topics.begin(), topics.end(),
                           [](const auto& topic) { return topic.name == "/diagnostics"; }));
  EXPECT_EQ(program->end(), 0);
}

}  // namespace
}  // namespace penumbra::test
