// SPDX-License-Identifier: Apache-2.0
// Bags of results, read back and held against what `run` writes into a folder.
#include "fixtures.hpp"
#include "reference_bag.hpp"

#include <cstring>

namespace penumbra::test {
namespace {

class OutputBagTest : public BagTest {
 protected:
  Outcome run(const std::string& output, const Words& options = {}) {
    return penumbra(Words{"run", tiny_mcap(), "-o", path(output)} + options);
  }

  template <typename M, typename F>
  void for_each(const std::string& topic, const F& call) {
    const auto count = for_each_message<M>(
        path("results.mcap"), topic, [&](const M& message, std::int64_t log_time, std::size_t i) {
          EXPECT_EQ(message.header.stamp, tiny_stamp(static_cast<int>(i)));
          EXPECT_EQ(message.header.frame_id, "optical");
          EXPECT_EQ(log_time, message.header.stamp);
          call(message, i);
        });
    EXPECT_EQ(count, 3U) << topic;
  }
  void expect_nothing_trusted() {
    for_each<io::ImageMessage>("/penumbra/mask", [&](const auto& image, std::size_t) {
      for (const std::byte pixel : image.data) ASSERT_EQ(pixel, std::byte{255});
    });
  }

  template <typename T>
  [[nodiscard]] Image<T> written(const std::string& kind, std::size_t number) const {
    const char* const ending = std::is_same_v<T, float> ? ".npy" : ".png";
    return read_image<T>(out(kind) / numbered(number, ending));
  }

  template <typename T>
  static void expect_image(const io::ImageMessage& message, const char* encoding,
                           const Image<T>& wanted) {
    EXPECT_EQ(message.encoding, encoding);
    ASSERT_EQ(message.data.size(), wanted.size() * sizeof(T));
    EXPECT_EQ(std::memcmp(message.data.data(), wanted.data(), message.data.size()), 0) << encoding;
  }
};

TEST_F(OutputBagTest, TheReferenceLibraryReadsTheSame) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  succeed(run("out", {"--save", "labels,vdi,overlay,robot_mask"}));
  succeed(run("results.mcap"));
  std::map<std::string, std::size_t> numbers;
  for (const Json& told : decoded_messages(path("results.mcap"))) {
    const std::string topic = told["topic"];
    const std::size_t number = numbers[topic]++;
    const Json& message = told["message"];
    const std::int64_t stamp = tiny_stamp(static_cast<int>(number));
    expect_values(told, {{"/message/header/stamp/sec", stamp / 1'000'000'000},
                         {"/message/header/stamp/nanosec", stamp % 1'000'000'000},
                         {"/message/header/frame_id", "optical"},
                         {"/logTime", std::to_string(stamp)}});
    const auto expect_image_of = [&](const char* encoding, const auto& image) {
      expect_values(message, {{"/encoding", encoding},
                              {"/width", image.width()},
                              {"/height", image.height()},
                              {"/data", array_of(image)}});
    };
    if (topic == "/penumbra/labels") {
      expect_image_of("8UC1", written<std::uint8_t>("labels", number));
    } else if (topic == "/penumbra/robot_mask") {
      expect_image_of("mono8", written<std::uint8_t>("robot_mask", number));
    } else if (topic == "/penumbra/vdi") {
      expect_image_of("32FC1", written<float>("vdi", number));
    } else if (topic == "/penumbra/overlay/compressed") {
      EXPECT_EQ(message["data"], array_of(read_file(out("overlay") / numbered(number))));
    } else if (topic == "/penumbra/points") {
      EXPECT_EQ(told["type"], "sensor_msgs/msg/PointCloud2");
      EXPECT_EQ(message["fields"][2]["name"], "z");
      EXPECT_EQ(message["row_step"], message["width"].get<int>() * 12);
    } else if (topic == "/penumbra/targets") {
      expect_values(message, {{"/status", "ok"}, {"/root_frame", "base"}});
    }
  }
  EXPECT_EQ(numbers.size(), 8U);
  for (const auto& [topic, count] : numbers) EXPECT_EQ(count, 3U) << topic;
}

TEST_F(OutputBagTest, TrustsClearAndFrontAlone) {
  succeed(run("out", {"--save", "labels"}));
  succeed(run("results.mcap"));
  for_each<io::ImageMessage>("/penumbra/mask", [&](const auto& image, std::size_t i) {
    Image<std::uint8_t> wanted = written<std::uint8_t>("labels", i);
    for (std::size_t p = 0; p < wanted.size(); ++p)
      wanted.data()[p] = wanted.data()[p] <= 1 ? 0 : 255;
    expect_image(image, "mono8", wanted);
  });
  std::vector<std::size_t> measured;
  for_each<io::ImageMessage>("/penumbra/filtered_depth", [&](const auto& image, std::size_t i) {
    auto wanted = read_image<std::uint16_t>(path("depth_" + std::to_string(i) + ".png"));
    const Image<std::uint8_t> labels = written<std::uint8_t>("labels", i);
    measured.push_back(0);
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      if (labels.data()[p] > 1) wanted.data()[p] = 0;
      if (wanted.data()[p] > 0) ++measured.back();
    }
    expect_image(image, "16UC1", wanted);
  });
  for_each<io::PointCloud2Message>("/penumbra/points", [&](const auto& cloud, std::size_t i) {
    EXPECT_EQ(cloud.width, measured.at(i));
    ASSERT_EQ(cloud.data.size(), 12 * measured.at(i));
    float first[3];
    std::memcpy(first, cloud.data.data(), sizeof first);
    // Pixel (0, 0) sees the wall: ((0 - cx) / fx, (0 - cy) / fy, 1) times 3 m.
    constexpr float rounding = 1e-6F;
    EXPECT_NEAR(first[0], -31.3F / 60 * 3, rounding);
    EXPECT_NEAR(first[1], -23.7F / 60 * 3, rounding);
    EXPECT_NEAR(first[2], 3, rounding);
  });
}

TEST_F(OutputBagTest, FramesWithoutPoseHaveNoVirtualDepth) {
  bag_.remove("/joint_states");
  bag_.add("/joint_states", tiny_stamp(0), io::JointStateMessage{.header = {1, ""}});
  const Outcome outcome = run("results.mcap");
  EXPECT_EQ(outcome.status, 2) << "no frame is usable";
  EXPECT_FALSE(topic_counts(path("results.mcap")).contains("/penumbra/vdi"));
  expect_nothing_trusted();
  for_each<io::TargetsMessage>("/penumbra/targets", [](const auto& targets, std::size_t) {
    EXPECT_EQ(targets.status, "missing_joints");
  });
}

TEST_F(OutputBagTest, WithoutALinkNothingIsTrusted) {
  const std::string hand = fixed_link("hand", "base", R"(<collision><geometry>
      <mesh filename="file:///nowhere.stl"/></geometry></collision>)");
  bag_.edit<io::StringMessage>(
      [&](auto& text) { text.data.insert(text.data.rfind("</robot>"), hand); });
  expect_has(succeed(run("results.mcap", {"--allow-missing-meshes"})).err, {"trusts nothing"});
  expect_nothing_trusted();
  for_each<io::PointCloud2Message>(
      "/penumbra/points", [](const auto& cloud, std::size_t) { EXPECT_EQ(cloud.width, 0U); });
}

TEST_F(OutputBagTest, RefusesWhatABagCannotHold) {
  for (const Words& options : {Words{"--save", "labels"}, {"--image", "rectified"}, {"--force"}}) {
    expect_refused(run("results.mcap", options), {options[0]});
    EXPECT_FALSE(fs::exists(path("results.mcap")));
  }
  EXPECT_EQ(run("tiny.mcap").status, 2) << "its own input";
  EXPECT_TRUE(fs::exists(path("tiny.mcap")));
}

TEST_F(OutputBagTest, OnlyABagOfResultsIsReplaced) {
  succeed(run("results.mcap"));
  const fs::path keep = path("keep.mcap");
  const auto expect_kept = [&](const std::string& input) {
    const std::string before = read_file(keep);
    expect_refused(penumbra({"run", path(input), "-o", keep}), {"keep.mcap: is "});
    EXPECT_TRUE(read_file(keep) == before);
  };
  bag_.write_mcap(keep);
  expect_kept("tiny.mcap");
  expect_kept("nowhere.mcap");
  expect_kept("results.mcap");  // input and output swapped
  write_file(keep, "another program's");
  expect_kept("tiny.mcap");
  bag_.rename("/joint_states", "/penumbra/joint_states");
  bag_.write_mcap(keep);
  expect_kept("tiny.mcap");

  write_file(keep, "");
  succeed(penumbra({"run", path("tiny.mcap"), "-o", keep}));
  EXPECT_GT(fs::file_size(keep), 0U);
}

/// Frames of a folder without stamps have no place in time, unless it is said how fast they came.
TEST_F(OutputBagTest, FramesWithoutStampsNeedARate) {
  const fs::path results = path("results.mcap");
  const auto to_bag = [&](const Words& options) {
    return penumbra(Words{"run", path(), "-o", results} + options);
  };
  expect_failed(to_bag({}), {"--fps"});
  EXPECT_FALSE(fs::exists(results));
  EXPECT_EQ(to_bag({"--fps", "0"}).status, 2);
  succeed(to_bag({"--fps", "4"}));
  std::vector<std::int64_t> stamps;
  for_each_message<io::ImageMessage>(
      results, "/penumbra/labels",
      [&](const auto&, std::int64_t log_time, std::size_t) { stamps.push_back(log_time); });
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{0, 250'000'000, 500'000'000}));
  EXPECT_EQ(run("other.mcap", {"--fps", "4"}).status, 2) << "a bag has stamps";
}

}  // namespace
}  // namespace penumbra::test
