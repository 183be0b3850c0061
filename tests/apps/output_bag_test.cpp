// SPDX-License-Identifier: Apache-2.0
// Bags of results, read back and held against what `run` writes into a folder.
#include "../support/node_scripts.hpp"
#include "fixtures.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <span>
#include <sstream>
#include <type_traits>

#include <io/bag/bag_reader.hpp>
#include <io/files/npy.hpp>
#include <io/files/pending_file.hpp>
#include <io/mcap/compression.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::test {
namespace {

class OutputBagTest : public BagTest {
 protected:
  Outcome run(const std::string& output, Words options = {}) {
    bag_.write_mcap(path("tiny.mcap"));
    options.insert(options.begin(), {"run", path("tiny.mcap"), "-o", path(output)});
    return penumbra(options);
  }

  /// Calls `call` with each message of a topic and its number.
  template <typename M, typename F>
  void for_each(const std::string& topic, const F& call) {
    const auto bag = io::open_bag(path("results.mcap"));
    std::size_t number = 0;
    M decoded;
    for (io::BagMessage message; bag->next(message);) {
      const io::BagTopic& from = bag->topics()[message.topic];
      if (from.name != topic) continue;
      const io::Decoder<M> decoder(from.type, from.definition);
      const auto fault = decoder.decode(message.data, decoded);
      ASSERT_FALSE(fault) << *fault;
      EXPECT_EQ(decoded.header.stamp, tiny_stamp(static_cast<int>(number)));
      EXPECT_EQ(decoded.header.frame_id, "optical");
      EXPECT_EQ(message.log_time, decoded.header.stamp);
      call(decoded, number++);
    }
    EXPECT_EQ(number, 3U) << topic;
    EXPECT_TRUE(bag->faults().empty());
  }

  template <typename T>
  [[nodiscard]] Image<T> written(const char* kind, std::size_t number) const {
    const std::string name = std::string(kind) + "/00000" + std::to_string(number);
    Image<T> image;
    if constexpr (std::is_same_v<T, float>)
      io::read_npy(path("out") / (name + ".npy"), image).require();
    else
      io::read_png(path("out") / (name + ".png"), image).require();
    return image;
  }
  [[nodiscard]] Image<std::uint16_t> depth(std::size_t number) const {
    Image<std::uint16_t> image;
    io::read_png(path() / ("depth_" + std::to_string(number) + ".png"), image).require();
    return image;
  }

  template <typename T>
  static void expect_image(const io::ImageMessage& message, const char* encoding,
                           const Image<T>& wanted) {
    EXPECT_EQ(message.encoding, encoding);
    ASSERT_EQ(message.data.size(), wanted.size() * sizeof(T));
    EXPECT_EQ(std::memcmp(message.data.data(), wanted.data(), message.data.size()), 0) << encoding;
  }

  /// Writes results.mcap where no file may be larger than 1 kB.
  Outcome run_without_room() {
    bag_.write_mcap(path("tiny.mcap"));
    const std::string folder = path();
    const std::string line = "trap '' XFSZ; ulimit -f 2; " + std::string(PENUMBRA_PROGRAM) +
                             " run " + folder + "/tiny.mcap -o " + folder + "/results.mcap > " +
                             folder + "/out 2> " + folder + "/err";
    const int result = std::system(line.c_str());
    return {WEXITSTATUS(result), read_file(folder + "/out"), read_file(folder + "/err")};
  }
  [[nodiscard]] std::size_t names_with(const std::string& start) const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(path()))
      if (entry.path().filename().string().starts_with(start)) ++count;
    return count;
  }
};

/// What decode.mjs says of an array of so many bytes.
nlohmann::json array_of(std::span<const std::byte> bytes) {
  char crc[9];
  std::snprintf(crc, sizeof crc, "%08x", io::mcap::crc32(bytes));
  return {{"length", bytes.size()}, {"crc", crc}};
}

TEST_F(OutputBagTest, TheReferenceLibraryReadsTheSame) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  ASSERT_EQ(run("out", {"--save", "labels,vdi,overlay,robot_mask"}).status, 0);
  ASSERT_EQ(run("results.mcap").status, 0);
  const std::string file = path("results.mcap").string();
  const ScriptResult checked = run_script("read_back.mjs", file);
  EXPECT_EQ(checked.status, 0) << checked.errors;
  const ScriptResult decoded = run_script("decode.mjs", file);
  ASSERT_EQ(decoded.status, 0) << decoded.errors;

  std::map<std::string, std::size_t> numbers;
  std::istringstream lines(decoded.output);
  for (std::string line; std::getline(lines, line);) {
    const auto told = nlohmann::json::parse(line);
    const std::string topic = told["topic"];
    const std::size_t number = numbers[topic]++;
    const auto& message = told["message"];
    const std::int64_t stamp = tiny_stamp(static_cast<int>(number));
    EXPECT_EQ(message["header"]["stamp"]["sec"], stamp / 1'000'000'000) << line;
    EXPECT_EQ(message["header"]["stamp"]["nanosec"], stamp % 1'000'000'000) << line;
    EXPECT_EQ(told["logTime"], std::to_string(stamp)) << line;
    EXPECT_EQ(message["header"]["frame_id"], "optical") << line;
    if (topic == "/penumbra/labels") {
      const auto labels = written<std::uint8_t>("labels", number);
      EXPECT_EQ(message["encoding"], "8UC1");
      EXPECT_EQ(message["width"], labels.width());
      EXPECT_EQ(message["height"], labels.height());
      EXPECT_EQ(message["data"], array_of(std::as_bytes(std::span(labels.data(), labels.size()))));
    } else if (topic == "/penumbra/robot_mask") {
      const auto mask = written<std::uint8_t>("robot_mask", number);
      EXPECT_EQ(message["encoding"], "mono8");
      EXPECT_EQ(message["data"], array_of(std::as_bytes(std::span(mask.data(), mask.size()))));
    } else if (topic == "/penumbra/vdi") {
      const auto vdi = written<float>("vdi", number);
      EXPECT_EQ(message["encoding"], "32FC1");
      EXPECT_EQ(message["data"], array_of(std::as_bytes(std::span(vdi.data(), vdi.size()))));
    } else if (topic == "/penumbra/overlay/compressed") {
      const std::string png =
          read_file(out() / "overlay" / ("00000" + std::to_string(number) + ".png"));
      EXPECT_EQ(message["data"], array_of(std::as_bytes(std::span(png))));
    } else if (topic == "/penumbra/points") {
      EXPECT_EQ(told["type"], "sensor_msgs/msg/PointCloud2");
      EXPECT_EQ(message["fields"][2]["name"], "z");
      EXPECT_EQ(message["row_step"], message["width"].get<int>() * 12);
    } else if (topic == "/penumbra/targets") {
      EXPECT_EQ(message["status"], "ok");
      EXPECT_EQ(message["root_frame"], "base");
    }
  }
  EXPECT_EQ(numbers.size(), 8U);
  for (const auto& [topic, count] : numbers) EXPECT_EQ(count, 3U) << topic;
}

TEST_F(OutputBagTest, TrustsClearAndFrontAlone) {
  ASSERT_EQ(run("out", {"--save", "labels"}).status, 0);
  ASSERT_EQ(run("results.mcap").status, 0);
  for_each<io::ImageMessage>("/penumbra/mask", [&](const auto& image, std::size_t i) {
    Image<std::uint8_t> wanted = written<std::uint8_t>("labels", i);
    for (std::size_t p = 0; p < wanted.size(); ++p)
      wanted.data()[p] = wanted.data()[p] <= 1 ? 0 : 255;
    expect_image(image, "mono8", wanted);
  });
  std::vector<std::size_t> measured;
  for_each<io::ImageMessage>("/penumbra/filtered_depth", [&](const auto& image, std::size_t i) {
    Image<std::uint16_t> wanted = depth(i);
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
  const auto bag = io::open_bag(path("results.mcap"));
  std::map<std::string, int> counts;
  for (io::BagMessage message; bag->next(message);) ++counts[bag->topics()[message.topic].name];
  EXPECT_EQ(counts["/penumbra/vdi"], 0);
  EXPECT_EQ(counts["/penumbra/mask"], 3);
  for_each<io::ImageMessage>("/penumbra/mask", [&](const auto& image, std::size_t) {
    for (const std::byte pixel : image.data) ASSERT_EQ(pixel, std::byte{255});
  });
  for_each<io::TargetsMessage>("/penumbra/targets", [](const auto& targets, std::size_t) {
    EXPECT_EQ(targets.status, "missing_joints");
  });
}

TEST_F(OutputBagTest, WithoutALinkNothingIsTrusted) {
  bag_.edit<io::StringMessage>("/robot_description", [](auto& text) {
    const std::string end = "</robot>";
    text.data.replace(
        text.data.rfind(end), end.size(),
        "<link name=\"hand\"><collision><geometry><mesh filename=\"file:///nowhere.stl\"/>"
        "</geometry></collision></link><joint name=\"h\" type=\"fixed\"><parent link=\"base\"/>"
        "<child link=\"hand\"/></joint></robot>");
  });
  const Outcome outcome = run("results.mcap", {"--allow-missing-meshes"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_has(outcome.err, {"trusts nothing"});
  for_each<io::ImageMessage>("/penumbra/mask", [&](const auto& image, std::size_t) {
    for (const std::byte pixel : image.data) ASSERT_EQ(pixel, std::byte{255});
  });
  for_each<io::PointCloud2Message>(
      "/penumbra/points", [](const auto& cloud, std::size_t) { EXPECT_EQ(cloud.width, 0U); });
}

TEST_F(OutputBagTest, RefusesWhatABagCannotHold) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--save", "labels"}, {"--image", "rectified"}, {"--force"}}) {
    const Outcome outcome = run("results.mcap", options);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(options[0]), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(path("results.mcap")));
  }
  const Outcome own = run("tiny.mcap");
  EXPECT_EQ(own.status, 2) << "its own input";
  EXPECT_TRUE(fs::exists(path("tiny.mcap")));
}

TEST_F(OutputBagTest, AFormerBagStaysUntilTheNextIsWhole) {
  const fs::path results = path("results.mcap");
  ASSERT_EQ(run("results.mcap").status, 0);
  const std::string former = read_file(results);
  const auto expect_left = [&](const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_TRUE(read_file(results) == former);
    EXPECT_EQ(names_with("results.mcap"), 1U);
  };
  expect_left(penumbra({"run", path("nowhere.mcap"), "-o", results}));
  expect_left(run("results.mcap", {"--targets", path("nowhere.yaml")}));
  expect_left(run_without_room());

  write_file(results.string() + ".penumbra.part", "of a run that was killed");
  EXPECT_EQ(run("results.mcap", {"--frames", "0:1"}).status, 0);
  EXPECT_LT(fs::file_size(results), former.size());
  EXPECT_EQ(names_with("results.mcap"), 1U);
}

TEST_F(OutputBagTest, OnlyABagOfResultsIsReplaced) {
  ASSERT_EQ(run("results.mcap").status, 0);
  const fs::path keep = path("keep.mcap");
  const auto expect_kept = [&](const std::string& input) {
    const std::string before = read_file(keep);
    const Outcome outcome = penumbra({"run", path() / input, "-o", keep});
    expect_refused(outcome, {"keep.mcap: is "});
    EXPECT_TRUE(read_file(keep) == before);
  };
  bag_.write_mcap(keep);
  expect_kept("tiny.mcap");
  expect_kept("nowhere.mcap");
  expect_kept("results.mcap");  // input and output swapped
  write_file(keep, read_file(keep).substr(0, 5000));
  expect_kept("tiny.mcap");
  write_file(keep, "another program's");
  expect_kept("tiny.mcap");
  bag_.rename("/joint_states", "/penumbra/joint_states");
  bag_.write_mcap(keep);
  expect_kept("tiny.mcap");

  write_file(keep, "");
  EXPECT_EQ(penumbra({"run", path("tiny.mcap"), "-o", keep}).status, 0);
  EXPECT_GT(fs::file_size(keep), 0U);
}

/// Frames of a folder without stamps have no place in time, unless it is said how fast they came.
TEST_F(OutputBagTest, FramesWithoutStampsNeedARate) {
  const fs::path results = path("results.mcap");
  const auto write = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"run", path(), "-o", results};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return penumbra(arguments);
  };
  const Outcome outcome = write({});
  EXPECT_EQ(outcome.status, 2);
  expect_has(outcome.err, {"--fps"});
  EXPECT_FALSE(fs::exists(results));
  EXPECT_EQ(write({"--fps", "0"}).status, 2);
  EXPECT_EQ(write({"--fps", "4"}).status, 0);
  std::vector<std::int64_t> stamps;
  const auto bag = io::open_bag(results);
  for (io::BagMessage message; bag->next(message);)
    if (bag->topics()[message.topic].name == "/penumbra/labels") stamps.push_back(message.log_time);
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{0, 250'000'000, 500'000'000}));
  EXPECT_EQ(run("other.mcap", {"--fps", "4"}).status, 2) << "a bag has stamps";
}

}  // namespace
}  // namespace penumbra::test
