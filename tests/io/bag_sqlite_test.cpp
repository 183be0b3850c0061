// SPDX-License-Identifier: Apache-2.0
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "bag_files.hpp"

#include <gtest/gtest.h>

namespace penumbra::io {
namespace {

using test::BagContent;
using test::BagDatabase;
using test::RecordedMessage;

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
    return test::refusal([&] { static_cast<void>(open_bag(file_)); });
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
  const std::string message =
      test::refusal([&] { static_cast<void>(open_bag(folder_.path() / "b.db3")); });
  for (const char* part : {"b.db3: is cut", "'truncate -s 8192'"}) EXPECT_HAS(message, part);
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
