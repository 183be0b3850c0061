// SPDX-License-Identifier: Apache-2.0
#include "bag_files.hpp"

#include <span>

#include <gtest/gtest.h>

#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/disk_file.hpp>
#include <io/mcap/compression.hpp>

namespace penumbra::io {
namespace {

using test::BagContent;
using test::RecordedMessage;

class Bags : public testing::Test {
 protected:
  // One topic in one file of a recording.
  void mcap(const std::string& name, const std::vector<std::int64_t>& times,
            const std::string& topic = "/a") {
    std::vector<RecordedMessage> messages;
    messages.reserve(times.size());
    for (const std::int64_t time : times)
      messages.push_back({topic, "p/msg/A", 0, time, time, name});
    test::write_mcap(path(name),
                     {.compression = mcap::Compression::lz4, .chunk_size = 50, .profile = "ros2"},
                     messages);
  }
  void metadata(const std::string& text) { folder_.write("metadata.yaml", text); }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }
  std::string refusal(const std::filesystem::path& file) {
    return test::refusal([&] { static_cast<void>(open_bag(file)); });
  }
  static std::string times(const BagContent& all) {
    std::string text;
    for (const RecordedMessage& m : all.messages)
      text += std::to_string(m.log_time) + m.data.substr(0, 1) + " ";
    return text;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Bags, OneTopicHasManyPublishers) {
  mcap::Writer writer(path("a.mcap"), {.compression = {}, .chunk_size = 100, .profile = "ros2"});
  const auto schema = writer.add_schema("p/msg/A", "ros2msg", "int32 a\n");
  const auto other = writer.add_schema("p/msg/B", "ros2idl", "struct B {};");
  for (const char* node : {"x", "y"}) {
    const auto channel = writer.add_channel("/a", "cdr", schema, {{"node", node}});
    writer.write(channel, 5, 4, 0, test::as_bytes("0123"));
  }
  writer.add_channel("/a", "cdr", other);
  writer.close();
  const BagContent all = test::read_bag(path("a.mcap"));
  ASSERT_EQ(all.topics.size(), 2U);
  EXPECT_EQ(all.topics[0], (BagTopic{"/a", "p/msg/A", "int32 a\n", "cdr", 2}));
  EXPECT_EQ(all.topics[1], (BagTopic{"/a", "p/msg/B", "", "cdr", 0}));
  const RecordedMessage expected{"/a", "p/msg/A", 0, 5, 4, "0123"};
  EXPECT_EQ(all.messages, (std::vector<RecordedMessage>{expected, expected}));
  EXPECT_TRUE(all.faults.empty());
}

TEST_F(Bags, FilesOfARecordingAreOneBag) {
  mcap("r_0.mcap", {1, 2, 7});
  mcap("r_1.mcap", {5, 6, 9});
  mcap("r_2.mcap", {20, 10}, "/b");
  metadata(test::metadata_yaml("mcap", {"r_2.mcap", "r_0.mcap", "r_1.mcap"}));
  const BagContent all = test::read_bag(folder_.path());
  EXPECT_EQ(times(all), "1r 2r 5r 6r 7r 9r 10r 20r ");
  EXPECT_EQ(all.messages[2].data, "r_1.mcap");
  EXPECT_EQ(all.messages[6].topic, "/b");
  EXPECT_EQ(all.topics.size(), 2U);
  EXPECT_TRUE(all.faults.empty());
}

/// As ROS 2's recorder has it: numbers up to Humble, words since.
std::string profile(const std::string& durability) {
  return "- history: 3\n  depth: 0\n  reliability: 1\n  durability: " + durability +
         "\n  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
         "  avoid_ros_namespace_conventions: false\n";
}

TEST_F(Bags, TellWhichTopicsWereLatched) {
  const OfferedQos latched{true}, volatile_qos{false}, not_told{}, damaged{{}, true};
  const std::pair<std::vector<std::string>, OfferedQos> cases[] = {
      {{profile("1"), profile("transient_local"), profile("2") + profile("1")}, latched},
      {{profile("2"), profile("volatile")}, volatile_qos},
      {{profile("0"), profile("unknown"), "", "[]", "- history: 3\n"}, not_told},
      {{"- x", "{", "durability: 1"}, damaged}};
  for (const auto& [texts, qos] : cases)
    for (const std::string& profiles : texts) {
      mcap::Writer writer(path("q.mcap"),
                          {.compression = {}, .chunk_size = 100, .profile = "ros2"});
      const auto schema = writer.add_schema("p/msg/A", "ros2msg", "int32 a\n");
      writer.add_channel("/a", "cdr", schema, {{"offered_qos_profiles", profiles}});
      writer.close();
      EXPECT_EQ(test::read_bag(path("q.mcap")).topics.at(0).qos, qos) << profiles;
    }
}

TEST_F(Bags, MetadataTellsWhichTopicsWereLatched) {
  mcap("r_0.mcap", {1});
  const std::string begin =
      "\n    - topic_metadata:\n        name: /a\n        type: p/msg/A\n"
      "        serialization_format: cdr\n        offered_qos_profiles: ";
  const std::string end = "\n      message_count: 41";
  const auto told = [&](const std::string& profiles) {
    metadata(test::metadata_yaml("mcap", {"r_0.mcap"}, begin + profiles + end));
    return test::read_bag(folder_.path()).topics.at(0).qos;
  };
  EXPECT_EQ(told("\"- history: 3\\n  durability: 1\\n  depth: 1\""), OfferedQos{true});
  EXPECT_EQ(told("\n          - history: keep_last\n            durability: volatile"),
            OfferedQos{false});
  EXPECT_EQ(told("\n          - history: keep_last\n            durability: transient_local"),
            OfferedQos{true});
  EXPECT_EQ(told("\"\""), OfferedQos{});
  EXPECT_EQ(told("\"- {\""), (OfferedQos{{}, true}));
}

TEST_F(Bags, OldMetadataNamesTheFolderToo) {
  mcap("r_0.mcap", {1});
  metadata(test::metadata_yaml("mcap", {folder_.path().filename() / "r_0.mcap"}));
  EXPECT_EQ(test::read_bag(folder_.path()).messages.size(), 1U);
}

TEST_F(Bags, ARecorderThatWasKilledLeavesNoMetadata) {
  mcap("r_0.mcap", {1, 2});
  mcap("r_10.mcap", {3, 3}, "/z");
  mcap("r_2.mcap", {2, 4});
  folder_.write("notes.txt", "x");
  const BagContent all = test::read_bag(folder_.path());
  EXPECT_EQ(times(all), "1r 2r 2r 3r 3r 4r ");
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_HAS(all.faults[0], "metadata.yaml: ");
}

TEST_F(Bags, AMissingOrBrokenFileCostsItsPart) {
  mcap("r_0.mcap", {1, 2});
  folder_.write("r_1.mcap", "no bag");
  metadata(test::metadata_yaml("mcap", {"r_0.mcap", "r_1.mcap", "r_2.mcap"}));
  const BagContent all = test::read_bag(folder_.path());
  EXPECT_EQ(all.messages.size(), 2U);
  ASSERT_EQ(all.faults.size(), 2U);
  EXPECT_HAS(all.faults[0], path("r_1.mcap").string() + ": ");
  EXPECT_HAS(all.faults[1], path("r_2.mcap").string() + ": ");
  metadata(test::metadata_yaml("mcap", {"r_1.mcap", "r_2.mcap"}));
  EXPECT_HAS(refusal(folder_.path()), path("r_1.mcap").string() + ": ");
}

/// Compresses a file of the folder as rosbag2 does; leaves `cut` bytes out at the end.
std::filesystem::path zip(const std::filesystem::path& file, std::size_t cut = 0) {
  const std::string plain = read_whole_file(file, FileLimit::data);
  std::vector<std::byte> packed;
  mcap::Compressor(mcap::Compression::zstd).compress(std::as_bytes(std::span(plain)), packed);
  const std::filesystem::path zipped = file.string() + ".zstd";
  write_file(zipped, packed.data(), packed.size() - cut);
  return zipped;
}

TEST_F(Bags, ReadsFilesThatAreCompressedAsAWhole) {
  mcap("r_0.mcap", {1, 2});
  mcap("r_1.mcap", {3, 4});
  {
    test::BagDatabase database(path("r_2.db3"));
    database.make_tables(false);
    database.topic(1, "/q", "std_msgs/msg/String");
    database.message(1, 5, "q");
  }
  for (const char* name : {"r_0.mcap", "r_1.mcap", "r_2.db3"}) {
    const BagContent plain = test::read_bag(path(name));
    const BagContent zipped = test::read_bag(zip(path(name)));
    EXPECT_EQ(times(zipped), times(plain));
    EXPECT_TRUE(zipped.faults.empty());
  }
  EXPECT_EQ(times(test::read_bag(folder_.path())), "1r 2r 3r 4r 5q ") << "both are there: once";
  for (const char* name : {"r_0.mcap", "r_1.mcap", "r_2.db3"}) std::filesystem::remove(path(name));
  metadata(test::metadata_yaml("mcap", {"r_0.mcap.zstd", "r_1.mcap.zstd", "r_2.db3.zstd"}, " []",
                               "FILE"));
  const BagContent all = test::read_bag(folder_.path());
  EXPECT_EQ(times(all), "1r 2r 3r 4r 5q ");
  EXPECT_TRUE(all.faults.empty());
}

TEST_F(Bags, SaysWhatIsWrongWithACompressedFile) {
  mcap("r_0.mcap", {1, 2});
  const auto cut = zip(path("r_0.mcap"), 5);
  EXPECT_HAS(refusal(cut), cut.string() + ": cannot be decompressed as zstd: ");
  folder_.write("r_1.mcap", "no bag");
  const auto other = zip(path("r_1.mcap"));
  EXPECT_HAS(refusal(other), other.string() + ": ");
  const auto none = folder_.write("r_2.mcap.zstd", "no zstd");
  EXPECT_HAS(refusal(none), none.string() + ": ");
  const std::string whole = read_whole_file(zip(path("r_0.mcap")), FileLimit::data);
  test::read_damaged(whole, 500, [&](const std::string& damaged) {
    for (const std::string& fault : test::read_bag(folder_.write("d.mcap.zstd", damaged)).faults)
      EXPECT_EQ(fault.find("penumbra-bag-"), std::string::npos) << fault;
  });
}

TEST_F(Bags, RefusesWhatItCannotRead) {
  EXPECT_HAS(refusal(folder_.path()), "holds no bag: neither metadata.yaml nor *.mcap");
  folder_.write("a.bag", "#ROSBAG V2.0\n");
  EXPECT_HAS(refusal(path("a.bag")), "a.bag: is a bag of ROS 1");
  EXPECT_HAS(refusal(folder_.path()), "a.bag: is a bag of ROS 1");
  folder_.write("a.bag", "other");
  EXPECT_HAS(refusal(path("a.bag")), "*.mcap, *.db3");
  for (const char* name : {"a.mcap", "a.db3.zstd"}) EXPECT_HAS(refusal(path(name)), "No such file");
  metadata("rosbag2_bagfile_information:\n  version: 5\n");
  EXPECT_HAS(refusal(folder_.path()), "key 'relative_file_paths' is missing");
  metadata(test::metadata_yaml("sqlite3", {"a.db3"}, " []", "MESSAGE"));
  EXPECT_HAS(refusal(folder_.path()), "'MESSAGE' is not read; 'ros2 bag convert'");
  metadata("rosbag2_bagfile_information:\n  relative_file_paths: []\n");
  EXPECT_HAS(refusal(folder_.path()), "names no file");
}

}  // namespace
}  // namespace penumbra::io
