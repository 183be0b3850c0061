// SPDX-License-Identifier: Apache-2.0
// `penumbra play` and `penumbra topics`, and who listens.
#include "../apps/program.hpp"
#include "../apps/tiny_bag.hpp"
#include "listening.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"

#include <algorithm>
#include <cstdlib>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

class Commands : public testing::Test {
 protected:
  Commands() {
    bag_.add("/robot_description", first_log - 1, io::StringMessage{"<robot/>"});
    for (int i = 0; i < 25; ++i) bag_.add("/joint_states", first_log + period * i, joints(i));
    bag_.write_mcap(file());
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "bag.mcap"; }

  Outcome play(std::vector<std::string> options) const {
    options.insert(options.begin(), {"play", file(), "--domain", std::to_string(domain_.id())});
    return penumbra(options);
  }
  /// While this runs on, `penumbra play` does.
  std::future<Outcome> playing(const std::vector<std::string>& options) const {
    return std::async(std::launch::async, [this, options] { return play(options); });
  }

  /// Messages of a topic until the player is done.
  std::vector<Bytes> hear(io::Subscription& heard, std::future<Outcome>& player) {
    std::vector<Bytes> messages;
    io::Sample sample;
    bool done = false;
    do {
      done = player.wait_for(0s) == std::future_status::ready;
      graph_->wait(20ms);
      while (heard.take(sample)) messages.emplace_back(sample.data.begin(), sample.data.end());
    } while (!done);
    return messages;
  }
  std::vector<Bytes> hear_joints(const std::vector<std::string>& options,
                                 const std::string& topic = "/joint_states") {
    const auto heard = graph_->subscribe(topic, joint_type, {.reliable = true, .depth = 100});
    auto player = playing(options);
    auto messages = hear(*heard, player);
    const Outcome outcome = player.get();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    out_ = outcome.out;
    return messages;
  }
  [[nodiscard]] std::vector<Bytes> recorded(const std::string& topic, std::size_t from = 0) const {
    std::vector<Bytes> messages;
    for (const TinyBag::Message& message : bag_.messages)
      if (message.topic == topic) messages.push_back(message.data);
    messages.erase(messages.begin(), messages.begin() + static_cast<std::ptrdiff_t>(from));
    return messages;
  }
  static io::JointStateMessage decoded(const Bytes& bytes) {
    io::JointStateMessage message;
    EXPECT_EQ(io::Decoder<io::JointStateMessage>().decode(bytes, message), std::nullopt);
    return message;
  }

  TemporaryFolder folder_;
  LoneDomain domain_;
  TinyBag bag_;
  std::unique_ptr<io::Participant> graph_ = io::join_graph({.domain = domain_.id()});
  std::string out_;
};

TEST_F(Commands, PlayPublishesTheBagByteForByteAndSaysSo) {
  EXPECT_EQ(hear_joints({}), recorded("/joint_states"));
  EXPECT_NE(out_.find("/joint_states"), std::string::npos) << out_;
  EXPECT_NE(out_.find("reliable, latched"), std::string::npos) << out_;
  EXPECT_NE(out_.find("26 messages published"), std::string::npos) << out_;
}

TEST_F(Commands, PlayLoopsUntilCtrlCAndLatecomersHaveLatchedTopics) {
  constexpr int until_ctrl_c = 4;  // s, of which 1 is the delay
  const std::string command = "timeout --preserve-status -s INT " + std::to_string(until_ctrl_c) +
                              " '" PENUMBRA_PROGRAM "' play --loop --domain " +
                              std::to_string(domain_.id()) + " '" + file().string() +
                              "' >/dev/null";
  auto player = std::async(std::launch::async, [&] { return std::system(command.c_str()); });
  const auto joints =
      graph_->subscribe("/joint_states", joint_type, {.reliable = true, .depth = 100});
  io::Sample sample;
  ASSERT_TRUE(eventually(*graph_, [&] { return joints->take(sample); }));
  const auto late = graph_->subscribe("/robot_description", "std_msgs/msg/String",
                                      {.reliable = true, .latched = true, .depth = 1});
  ASSERT_TRUE(eventually(*graph_, [&] { return late->take(sample); }));
  const Bytes wanted = recorded("/robot_description").front();
  ASSERT_LE(wanted.size(), sample.data.size());
  EXPECT_LE(sample.data.size(), wanted.size() + padding);
  EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), sample.data.begin()));
  std::size_t messages = 1;
  while (player.wait_for(0s) != std::future_status::ready) {
    graph_->wait(20ms);
    while (joints->take(sample)) ++messages;
  }
  EXPECT_EQ(player.get(), 0);
  EXPECT_GT(messages, recorded("/joint_states").size());
}

TEST_F(Commands, PlayKeepsThePaceOfTheRecording) {
  constexpr double length = 0.48, slack = 2.0;  // s; of a busy machine
  for (const double rate : {0.5, 4.0}) {
    const auto heard =
        graph_->subscribe("/joint_states", joint_type, {.reliable = true, .depth = 100});
    auto player = playing({"--rate", std::to_string(rate), "--delay", "0.5"});
    std::vector<std::int64_t> times;
    io::Sample sample;
    ASSERT_TRUE(eventually(*graph_, [&] {
      while (heard->take(sample)) times.push_back(sample.source_time);
      return times.size() >= 25;
    }));
    const double took = static_cast<double>(times.back() - times.front()) * 1e-9;
    EXPECT_GT(took, 0.9 * length / rate);
    EXPECT_LT(took, length / rate + slack);
    EXPECT_EQ(player.get().status, 0);
  }
}

TEST_F(Commands, PlayRestampsToNow) {
  const auto messages = hear_joints({"--restamp", "--rate", "2"});
  ASSERT_EQ(messages.size(), 25U);
  const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  const std::int64_t first = decoded(messages.front()).header.stamp;
  EXPECT_LT(now - first, 20'000'000'000);
  EXPECT_GT(now - first, 0);
  for (int i = 0; i < 25; ++i) {
    const auto message = decoded(messages[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(static_cast<double>(message.header.stamp - first), period / 2.0 * i, 1.0);
    EXPECT_EQ(message.positions, joints(i).positions);
  }
}

TEST_F(Commands, PlayStartsLaterButLatchedTopicsAreThere) {
  // 0.2 s after the first message, the description's, 1 ns before the joint states'.
  EXPECT_EQ(hear_joints({"--start", "0.2"}), recorded("/joint_states", 10));
  EXPECT_NE(out_.find("16 messages published"), std::string::npos) << out_;
}

TEST_F(Commands, PlayRenamesAndChoosesTopics) {
  const auto all = recorded("/joint_states");
  EXPECT_EQ(hear_joints({"--topics", "/joint_states", "--remap", "/joint_states:=/arm/joints"},
                        "/arm/joints"),
            all);
  EXPECT_EQ(out_.find("/robot_description"), std::string::npos) << out_;
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
    const auto bag = folder_.path() / (by_sqlite ? "qos.db3" : "qos.mcap");
    by_sqlite ? bag_.write_sqlite(bag) : bag_.write_mcap(bag);
    const std::vector<std::string> words = {
        "play", bag, "--domain", std::to_string(domain_.id()), "--delay", "0", "--rate", "1000"};
    const Outcome outcome = penumbra(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (const char* topic : {"/map", "/words"})
      EXPECT_TRUE(line_of(outcome.out, topic).ends_with("reliable, latched")) << outcome.out;
    for (const char* topic : {"/joint_states", "/robot_description"})
      EXPECT_TRUE(line_of(outcome.out, topic).ends_with(" reliable")) << outcome.out;
    EXPECT_NE(outcome.err.find("/joint_states: the bag's QoS cannot be read"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    auto by_option = words;
    by_option.insert(by_option.end(), {"--latched", "/words"});
    const Outcome chosen = penumbra(by_option);
    EXPECT_TRUE(line_of(chosen.out, "/map").ends_with(" reliable")) << chosen.out;
    EXPECT_TRUE(line_of(chosen.out, "/words").ends_with("latched")) << chosen.out;
  }
}

TEST_F(Commands, PlayTellsWhatItLeavesOut) {
  bag_.add("no_slash", first_log, io::StringMessage{"x"});
  bag_.write_mcap(file());
  const Outcome outcome = play({"--delay", "0"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("no_slash is not played"), std::string::npos) << outcome.err;
  EXPECT_EQ(play({"--topics", "no_slash"}).status, 2);
}

TEST_F(Commands, PlayOfABagCutAtItsBeginningTellsTheDamage) {
  std::filesystem::resize_file(file(), 2000);
  const Outcome outcome = play({});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_NE(outcome.err.find("there is nothing to play"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("byte "), std::string::npos) << outcome.err;
}

TEST_F(Commands, BadInputIsStatus2AndOneLine) {
  TinyBag().write_mcap(folder_.path() / "empty.mcap");
  const std::string bag = file(), empty = folder_.path() / "empty.mcap";
  const std::vector<std::vector<std::string>> cases = {
      {"play"},
      {"play", folder_.path() / "none.mcap"},
      {"play", empty},
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
  for (const auto& arguments : cases) {
    const Outcome outcome = penumbra(arguments);
    const std::string shown = testing::PrintToString(arguments) + ": " + outcome.err;
    EXPECT_EQ(outcome.status, 2) << shown;
    EXPECT_EQ(count_lines(outcome.err), 1U) << shown;
  }
  const Outcome settings = penumbra({"topics"}, {"CYCLONEDDS_URI=nonsense"});
  EXPECT_EQ(settings.status, 2);
  EXPECT_NE(settings.err.find("CYCLONEDDS_URI"), std::string::npos) << settings.err;
  EXPECT_EQ(penumbra({"topics"}, {"ROS_DOMAIN_ID=x"}).status, 2);
}

TEST_F(Commands, TopicsListsBothSides) {
  const auto said = graph_->advertise("/a", joint_type, {.reliable = true, .latched = true});
  const auto heard = graph_->subscribe("/b", joint_type, {});
  const std::vector<std::string> words = {"topics", "--domain", std::to_string(domain_.id()),
                                          "--wait", "1"};
  const Outcome table = penumbra(words);
  EXPECT_EQ(table.status, 0);
  EXPECT_NE(table.out.find("reliable, latched"), std::string::npos) << table.out;
  auto with_json = words;
  with_json.emplace_back("--json");
  const auto json = nlohmann::json::parse(penumbra(with_json).out);
  EXPECT_EQ(json["domain"], domain_.id());
  ASSERT_EQ(json["topics"].size(), 2U);
  EXPECT_EQ(json["topics"][0]["name"], "/a");
  EXPECT_EQ(json["topics"][0]["type"], joint_type);
  ASSERT_EQ(json["topics"][0]["publishers"].size(), 1U);
  EXPECT_EQ(json["topics"][0]["publishers"][0]["latched"], true);
  EXPECT_EQ(json["topics"][1]["subscribers"][0]["reliable"], false);
}

TEST_F(Commands, LiveRemapsItsDiagnostics) {
  const auto heard =
      graph_->subscribe("/cell/health", "diagnostic_msgs/msg/DiagnosticArray", {.reliable = true});
  LiveProgram live({"--domain", std::to_string(domain_.id()), "--depth-topic", "/depth", "--remap",
                    "/diagnostics:=/cell/health"},
                   folder_.path() / "live.log");
  io::Sample sample;
  ASSERT_TRUE(eventually(*graph_, [&] { return heard->take(sample); }));
  io::DiagnosticArrayMessage message;
  ASSERT_FALSE(io::Decoder<io::DiagnosticArrayMessage>().decode(sample.data, message));
  EXPECT_FALSE(message.status.empty());
  const auto topics = graph_->graph();
  EXPECT_TRUE(std::none_of(topics.begin(), topics.end(),
                           [](const auto& topic) { return topic.name == "/diagnostics"; }));
  EXPECT_EQ(live.end(), 0);
}

}  // namespace
}  // namespace penumbra::test
