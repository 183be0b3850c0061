// SPDX-License-Identifier: Apache-2.0
#include "../support/random.hpp"
#include "mcap_files.hpp"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace penumbra::io::mcap {
namespace {

using test::RecordedMessage;

std::vector<RecordedMessage> some_messages(std::uint64_t seed, std::uint32_t count,
                                           std::uint64_t times) {
  std::mt19937_64 random = test::seeded_random(seed);
  std::vector<RecordedMessage> messages;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(random() % 4);
    std::string data(random() % 2000, '\0');
    for (char& c : data) c = static_cast<char>(random() % 5);
    messages.push_back({"/topic" + number, number == "0" ? "-" : "p/msg/T" + number, i,
                        static_cast<std::int64_t>(random() % times),
                        static_cast<std::int64_t>(random() >> 1), std::move(data)});
  }
  return messages;
}

class McapWriter : public testing::TestWithParam<Compression> {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.mcap";
};

TEST_P(McapWriter, ReturnsWhatWasWrittenByTime) {
  for (const std::size_t chunk_size : {std::size_t{1}, std::size_t{5000}, std::size_t{1} << 20}) {
    const auto messages = some_messages(61 + chunk_size, 300, 1'000'000'000'000);
    test::write_mcap(file_, {GetParam(), chunk_size, "ros2"}, messages);
    const auto all = test::read_mcap(file_);
    EXPECT_TRUE(all.faults.empty()) << all.faults[0];
    EXPECT_EQ(all.messages, test::by_time(messages));
  }
}

TEST_P(McapWriter, WritesTheSameBytesForTheSameCalls) {
  const auto messages = some_messages(62, 100, 50);
  test::write_mcap(file_, {GetParam(), 5000, "ros2"}, messages);
  const std::string first = test::read_bytes(file_);
  test::write_mcap(file_, {GetParam(), 5000, "ros2"}, messages);
  EXPECT_EQ(first, test::read_bytes(file_));
}

TEST_P(McapWriter, KeepsMessagesOfEverySize) {
  std::mt19937_64 random = test::seeded_random(63);
  std::vector<RecordedMessage> messages;
  for (const std::size_t size : {0, 1, 70'000, 3'000'000, 5}) {
    std::string data(size, '\0');
    for (char& c : data) c = static_cast<char>(random());
    messages.push_back({"/a", "-", 1, static_cast<std::int64_t>(messages.size()), 0, data});
  }
  for (const std::size_t size : {20'000'000, 70'000'000}) {  // shrink a thousandfold, like a bomb
    std::string data;
    data.resize(size, 'x');
    messages.push_back({"/a", "-", 1, static_cast<std::int64_t>(size), 0, data});
  }
  test::write_mcap(file_, {GetParam(), 1 << 20, ""}, messages);
  const auto all = test::read_mcap(file_);
  EXPECT_TRUE(all.faults.empty()) << all.faults[0];
  EXPECT_TRUE(all.messages == messages);
}

INSTANTIATE_TEST_SUITE_P(All, McapWriter,
                         testing::Values(Compression::none, Compression::lz4, Compression::zstd),
                         test::compression_name);

class McapWriterFile : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.mcap";
};

TEST_F(McapWriterFile, CountsAndDescribes) {
  Writer writer(file_, {.compression = Compression::lz4, .chunk_size = 100, .profile = "ros2"});
  const auto schema = writer.add_schema("p/msg/A", "ros2msg", "int32 a\n");
  const auto used = writer.add_channel("/a", "cdr", schema, {{"offered_qos_profiles", "- x"}});
  const auto unused = writer.add_channel("/b", "json", 0);
  for (int i = 0; i < 10; ++i) writer.write(used, 1000 - i, i, 0, test::as_bytes("0123456789"));
  writer.close();

  Reader reader(file_);
  EXPECT_EQ(reader.profile(), "ros2");
  EXPECT_TRUE(reader.library().starts_with("penumbra "));
  EXPECT_EQ(reader.schemas().at(schema), (Schema{schema, "p/msg/A", "ros2msg", "int32 a\n"}));
  const Channel expected{used, schema, "/a", "cdr", {{"offered_qos_profiles", "- x"}}};
  EXPECT_EQ(reader.channels().at(used), expected);
  EXPECT_EQ(reader.channels().at(unused), (Channel{unused, 0, "/b", "json", {}}));
  ASSERT_TRUE(reader.statistics());
  EXPECT_EQ(reader.statistics()->messages, 10U);
  EXPECT_EQ(reader.statistics()->channels, 2U);
  EXPECT_EQ(reader.statistics()->start_time, 991U);
  EXPECT_EQ(reader.statistics()->end_time, 1000U);
  EXPECT_EQ(reader.statistics()->channel_messages,
            (std::map<std::uint16_t, std::uint64_t>{{used, 10}}));
}

// A recorder that dies leaves what stood in whole chunks.
TEST_F(McapWriterFile, IsReadableWithoutItsEnd) {
  {
    Writer writer(file_, {.compression = Compression::zstd, .chunk_size = 100, .profile = ""});
    const auto channel = writer.add_channel("/a", "cdr", 0);
    for (int i = 0; i < 10; ++i)
      writer.write(channel, i, i, 0, test::as_bytes(std::string(60, 'a')));
  }
  const auto all = test::read_mcap(file_);
  EXPECT_EQ(all.messages.size(), 9U);  // one in the first chunk, beside the channel; two in each
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_HAS(all.faults[0], "the data has no end (was the recorder killed?)");
}

TEST_F(McapWriterFile, NamesWhatItRefuses) {
  Writer writer(file_, {});
  const auto channel = writer.add_channel("/a", "cdr", 0);
  EXPECT_EQ(test::input_error([&] { writer.write(channel, 1, -5, 0, {}); }),
            file_.string() + ": a message of /a has the time -5 ns; MCAP holds none before 1970");
  EXPECT_HAS(test::input_error([&] { Writer other(folder_.path() / "no" / "a.mcap", {}); }),
             "no/a.mcap: cannot be written");
  EXPECT_HAS(test::input_error([&] { Writer full("/dev/full", {}); }),
             "/dev/full: cannot be written: No space left on device");
}

// The disk is full: a limit of the file's size stands for it.
TEST_F(McapWriterFile, RefusesToGoOnWhenTheDiskIsFull) {
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20'000, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  Writer writer(file_, {.compression = Compression::none, .chunk_size = 1000, .profile = ""});
  const auto channel = writer.add_channel("/a", "cdr", 0);
  const auto put = [&] { writer.write(channel, 1, 1, 0, test::as_bytes(std::string(900, 'a'))); };
  const std::string first = test::input_error([&] {
    for (int i = 0; i < 100; ++i) put();
  });
  EXPECT_EQ(first, file_.string() + ": cannot be written: File too large");
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, ignored);
  EXPECT_HAS(test::input_error(put), "an earlier write failed");
  EXPECT_HAS(test::input_error([&] { writer.close(); }), "an earlier write failed");
  const auto all = test::read_mcap(file_);
  EXPECT_GT(all.messages.size(), 15U);
  EXPECT_EQ(all.faults.size(), 1U);
}

}  // namespace
}  // namespace penumbra::io::mcap
