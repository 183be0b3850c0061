// SPDX-License-Identifier: Apache-2.0
#include "../support/run_length.hpp"
#include "bag_files.hpp"

#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/disk_file.hpp>
#include <io/mcap/compression.hpp>

namespace penumbra::io {
namespace {

using test::BagContent;
using test::BagDatabase;
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
    return test::refusal([&] { return open_bag(file); });
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
  std::filesystem::remove(path("metadata.yaml"));  // as of a recorder that was killed
  folder_.write("notes.txt", "x");
  const BagContent found = test::read_bag(folder_.path());
  EXPECT_EQ(times(found), times(all));
  ASSERT_EQ(found.faults.size(), 1U);
  EXPECT_HAS(found.faults[0], "metadata.yaml: ");
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

TEST_F(Bags, AMissingOrBrokenFileCostsItsPart) {
  mcap("r_0.mcap", {1, 2});
  folder_.write("r_1.mcap", "no bag");
  const std::string old = folder_.path().filename() / "r_0.mcap";  // with the folder's name
  metadata(test::metadata_yaml("mcap", {old, "r_1.mcap", "r_2.mcap"}));
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
  for (const char* name : {"r_0.mcap", "r_1.mcap", "r_2.db3"}) zip(path(name));
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
}

TEST_F(Bags, RefusesWhatItCannotRead) {
  EXPECT_HAS(refusal(folder_.path()), "holds no bag: neither metadata.yaml nor *.mcap");
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

class SqliteBags : public testing::Test {
 protected:
  BagContent read(const std::string& bytes) {
    folder_.write("b.db3", bytes);
    BagContent all;
    test::refusal([&] { all = test::read_bag(folder_.path() / "b.db3"); });
    return all;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a b?#%.db3";  // a name that a URI must spell
};

std::vector<RecordedMessage> random_messages(std::size_t count, std::size_t most_bytes) {
  std::mt19937_64 random = test::seeded_random(91);
  std::vector<RecordedMessage> messages;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(random() % 3);
    const auto time = static_cast<std::int64_t>(random() % 500);
    std::string data(random() % most_bytes, '\0');
    for (char& c : data) c = static_cast<char>(random());
    messages.push_back({"/t" + number, "p/msg/T" + number, 0, time, time, std::move(data)});
  }
  return messages;
}

void put(BagDatabase& database, const std::vector<RecordedMessage>& messages) {
  for (int i = 0; i < 3; ++i)
    database.topic(i + 1, "/t" + std::to_string(i), "p/msg/T" + std::to_string(i));
  database.run("BEGIN");
  for (const RecordedMessage& m : messages)
    database.message(m.topic.back() - '0' + 1, m.log_time, m.data);
  database.run("COMMIT");
}

TEST_F(SqliteBags, GiveMessagesByTime) {
  const auto messages = random_messages(300, 9000);
  for (const bool with_index : {true, false}) {
    {
      BagDatabase database(file_);
      database.make_tables(false, with_index);
      put(database, messages);
    }
    const BagContent all = test::read_bag(file_);
    EXPECT_TRUE(all.faults.empty()) << all.faults[0];
    EXPECT_EQ(all.messages, test::by_time(messages));
    ASSERT_EQ(all.topics.size(), 3U);
    EXPECT_EQ(all.topics[1], (BagTopic{"/t1", "p/msg/T1", "", "cdr", std::nullopt}));
  }
}

TEST_F(SqliteBags, TakeDefinitionsFromTheFile) {
  BagDatabase database(file_);
  database.make_tables(true);
  database.topic(1, "/a", "p/msg/A");
  database.topic(2, "/b", "p/msg/B");
  database.topic(3, "/c", "sensor_msgs/msg/JointState");
  database.run(
      "INSERT INTO message_definitions VALUES(1, 'p/msg/A', 'ros2msg', 'int32 a', ''),"
      "(2, 'p/msg/B', 'ros2idl', 'struct', '')");
  const BagContent all = test::read_bag(file_);
  EXPECT_EQ(all.topics.at(0).definition, "int32 a");
  EXPECT_EQ(all.topics.at(1).definition, "");
  EXPECT_HAS(all.topics.at(2).definition, "float64[] position");  // built in
  EXPECT_TRUE(all.messages.empty());
}

// The recorder was killed: what it wrote last stands in a journal beside the file.
TEST_F(SqliteBags, AreReadWithTheirJournal) {
  const auto messages = random_messages(50, 100);
  const auto copy = folder_.path() / "killed.db3";
  {
    BagDatabase database(file_);
    database.run("PRAGMA journal_mode=WAL; PRAGMA wal_autocheckpoint=0;");
    database.make_tables(false);
    put(database, messages);
    std::filesystem::copy_file(file_, copy);
    std::filesystem::copy_file(file_.string() + "-wal", copy.string() + "-wal");
  }
  const BagContent all = test::read_bag(copy);
  EXPECT_EQ(all.messages, test::by_time(messages));
  EXPECT_TRUE(all.faults.empty()) << all.faults[0];
}

TEST_F(SqliteBags, TellWhatRowsAreWrong) {
  {
    BagDatabase database(file_);
    database.make_tables(false);
    database.topic(1, "/a", "p/msg/A");
    database.message(1, 10, "fine");
    database.message(7, 20, "lost");
    database.run("INSERT INTO messages VALUES(30, 1, 30, 'a text')");
    database.run("INSERT INTO topics VALUES(9, x'00', 'p/msg/B', 'cdr', '')");
  }
  const BagContent all = test::read_bag(file_);
  EXPECT_EQ(all.messages.size(), 1U);
  ASSERT_EQ(all.faults.size(), 3U) << testing::PrintToString(all.faults);
  EXPECT_HAS(all.faults[0], file_.string() + ": a topic's row");
  EXPECT_HAS(all.faults[1], file_.string() + ": message 2 ");
  EXPECT_HAS(all.faults[2], file_.string() + ": message 30 ");
}

TEST_F(SqliteBags, RefuseWhatIsNoBag) {
  const auto refusal = [&](const std::string& tables) {
    { BagDatabase(file_).run(tables); }
    return test::refusal([&] { return open_bag(file_); });
  };
  EXPECT_HAS(refusal("CREATE TABLE other(x)"), "has no table 'topics'");
  EXPECT_HAS(refusal("CREATE TABLE topics(id, name); CREATE TABLE messages(timestamp)"),
             "is not a bag that can be read: no such column: type");
}

class SqliteDamage : public SqliteBags {
 protected:
  SqliteDamage() {
    BagDatabase database(file_);
    database.make_tables(true);
    put(database, messages_);
    for (int i = 0; i < 3; ++i)
      database.run("INSERT INTO message_definitions VALUES(" + std::to_string(i + 1) +
                   ", 'p/msg/T" + std::to_string(i) + "', 'ros2msg', 'int32 a', '')");
  }
  std::vector<RecordedMessage> messages_ = random_messages(120, 300);
};

TEST_F(SqliteDamage, CutFilesAreReadUpToTheCut) {
  constexpr std::size_t page = 4096;  // SQLite's own choice
  const std::string whole = test::read_bytes(file_);
  ASSERT_GT(whole.size(), 8 * page);
  std::size_t most = 0;
  for (std::size_t length = page; length < whole.size(); length += page) {
    const BagContent all = read(whole.substr(0, length));
    if (!all.topics.empty()) {
      EXPECT_FALSE(all.faults.empty()) << length;
    }
    for (const RecordedMessage& m : all.messages)
      ASSERT_NE(std::find(messages_.begin(), messages_.end(), m), messages_.end()) << length;
    most = std::max(most, all.messages.size());
  }
  EXPECT_GT(most, messages_.size() / 4);
  for (std::size_t length = 0; length < whole.size(); length += test::is_full_run() ? 1 : 509) {
    if (length % page == 0) continue;
    const BagContent all = read(whole.substr(0, length));
    ASSERT_TRUE(all.topics.empty()) << length;  // it was refused
  }
  folder_.write("b.db3", whole.substr(0, 2 * page + 7));
  test::expect_refused([&] { return open_bag(folder_.path() / "b.db3"); },
                       {"b.db3: is cut", "'truncate -s 8192'"});
}

TEST_F(SqliteDamage, SurvivesRandomDamage) {
  std::mt19937_64 random = test::seeded_random(92);
  const std::string whole = test::read_bytes(file_);
  const int rounds = test::is_full_run() ? 50'000 : 1000;
  for (int i = 0; i < rounds; ++i) {
    std::string damaged = whole;
    for (std::size_t n = 0; n < 1 + random() % 20; ++n) {
      // Pages' own heads matter most.
      const std::size_t page = random() % (damaged.size() / 4096) * 4096;
      const std::size_t at = random() % 2 == 0 ? page + random() % 64 : random() % damaged.size();
      damaged[at] = static_cast<char>(random());
    }
    const BagContent all = read(damaged);
    ASSERT_LT(all.messages.size(), whole.size());
  }
}

}  // namespace
}  // namespace penumbra::io
