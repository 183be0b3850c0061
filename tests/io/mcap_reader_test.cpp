// SPDX-License-Identifier: Apache-2.0
#include "mcap_files.hpp"

namespace penumbra::io::mcap {
namespace {

using namespace test::mcap_file;
using test::McapContents;
using test::RecordedMessage;

RecordedMessage hand_made(const std::string& topic, std::int64_t time) {
  return {topic, "p/msg/A", static_cast<std::uint32_t>(time), time, time, "data"};
}

class McapReader : public testing::Test {
 protected:
  McapContents read(const std::string& bytes) {
    return test::read_mcap(folder_.write("a.mcap", bytes));
  }

  test::TemporaryFolder folder_;
  const std::string definitions_ = schema(1, "p/msg/A") + channel(0, 1, "/a") + channel(7, 1, "/b");
};

TEST_F(McapReader, ReadsTheSmallestFiles) {
  const McapContents empty = read(file(""));
  EXPECT_TRUE(empty.messages.empty());
  EXPECT_TRUE(empty.faults.empty()) << empty.faults[0];
  EXPECT_TRUE(
      read(magic + header() + footer()).faults.empty());  // the specification's "empty file"
  const McapContents one = read(file(channel(3, 0, "/x") + message(3, 5)));
  ASSERT_EQ(one.messages.size(), 1U);
  EXPECT_EQ(one.messages[0], (RecordedMessage{"/x", "-", 5, 5, 5, "data"}));
  EXPECT_TRUE(one.faults.empty());
}

TEST_F(McapReader, ReadsFilesWithoutChecksumsAndDataEndAndWithFieldsOfLaterVersions) {
  const auto longer = [](const std::string& one) {
    return record(one[0], one.substr(9) + "later");
  };
  const std::string records =
      longer(schema(1, "p/msg/A")) + longer(channel(0, 1, "/a")) + message(0, 1);
  const McapContents all =
      read(magic + longer(header()) + compressed_chunk("", records.size(), records) + footer());
  EXPECT_EQ(all.messages, std::vector{hand_made("/a", 1)});
  EXPECT_TRUE(all.faults.empty()) << all.faults[0];
}

TEST_F(McapReader, GivesWhatOursWroteInEverySize) {
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
  for (const Compression compression : {Compression::none, Compression::lz4, Compression::zstd}) {
    const auto file = folder_.write("b.mcap", "");
    test::write_mcap(file, {compression, 1 << 20, ""}, messages);
    const auto all = test::read_mcap(file);
    EXPECT_TRUE(all.faults.empty()) << all.faults[0];
    EXPECT_TRUE(all.messages == messages);
  }
}

TEST_F(McapReader, SaysWhenAnIndexLies) {
  const std::string only = chunk(5, 9, definitions_ + message(0, 9) + message(0, 5));
  const std::uint64_t at = data_start();
  const auto with = [&](const std::string& index) {
    return read(file(only, definitions_ + index));
  };

  // What the index passes over is found, so that no message is missing.
  const McapContents elsewhere = with(chunk_index(5, 9, at + 1, only.size() - 1));
  ASSERT_FALSE(elsewhere.faults.empty());
  EXPECT_HAS(elsewhere.faults.back(), "there is no chunk of");

  const McapContents twice =
      with(chunk_index(5, 9, at, only.size()) + chunk_index(5, 9, at, only.size()));
  EXPECT_EQ(twice.messages.size(), 2U);
  ASSERT_EQ(twice.faults.size(), 1U);
  EXPECT_HAS(twice.faults[0], "chunks that overlap");
  EXPECT_HAS(with(chunk_index(5, 9, 1ULL << 63, only.size())).faults[0], "outside of the data");
  EXPECT_HAS(with(chunk_index(5, 9, at, ~0ULL)).faults[0], "outside of the data");

  const std::string second = chunk(7, 7, message(7, 7));
  const McapContents late =
      read(file(only + second, definitions_ + chunk_index(8, 9, at, only.size()) +
                                   chunk_index(7, 7, at + only.size(), second.size())));
  ASSERT_EQ(late.messages.size(), 3U);
  ASSERT_EQ(late.faults.size(), 1U);
  EXPECT_HAS(late.faults[0], "they come late");
}

TEST_F(McapReader, NamesEveryOtherFault) {
  const test::BadInputs cases = {
      {message(9, 1) + message(9, 2), "channel 9"},
      {schema(0, "x"), "schema"},
      {schema(1, "x") + schema(1, "x") + schema(1, "y"), "schema 1"},
      {record(0x04, "xy"), "channel"},
      {channel(0, 0, "/a") + message(0, 1ULL << 63), "2262"},
      {channel(0, 0, "/a") + record(0x05, "short"), "message"},
      {chunk(0, 0, definitions_ + data_end()), "records that no chunk may hold"},
      {chunk(0, 0, definitions_ + std::string(20, '\0')), "damaged at byte"},
      {compressed_chunk("brotli", 4, "abcd"), "'brotli'"},
      {compressed_chunk("zstd", 4, "abcd"), "zstd"},
      {compressed_chunk("lz4", 4, "abcd"), "lz4"},
      {compressed_chunk("lz4", 1ULL << 40, "abcd"), "decompress from 4"},
      {compressed_chunk("", 5, "abcd"), "two different sizes"},
      {std::string(30, '\0') + message(0, 1), "no record"}};
  for (const auto& [data, named] : cases) {
    const McapContents all = read(file(data));
    ASSERT_FALSE(all.faults.empty()) << named;
    EXPECT_HAS(all.faults[0], named);
  }
}

TEST_F(McapReader, GoesOnBehindDamageThatHidesALength) {
  const std::string first = chunk(1, 1, definitions_ + message(0, 1));
  const std::string second = chunk(2, 2, message(0, 2));
  const std::string third = chunk(3, 3, message(7, 3));
  std::string bytes = magic + header() + first + second + third + data_end() + footer();
  const std::size_t at = data_start() + first.size();
  bytes.replace(at + 1, 8, u64(1ULL << 60));
  const McapContents all = read(bytes);
  ASSERT_EQ(all.faults.size(), 1U) << testing::PrintToString(all.faults);
  EXPECT_EQ(all.fault_offsets[0], at);
  EXPECT_HAS(all.faults[0], std::to_string(second.size()) + " bytes are left out");
  EXPECT_EQ(all.messages, (std::vector<RecordedMessage>{hand_made("/a", 1), hand_made("/b", 3)}));
}

TEST_F(McapReader, RefusesWhatIsNoMcap) {
  const auto refusal = [&](const std::string& bytes) {
    return test::refusal([&] { read(bytes); });
  };
  for (const char* const bytes : {"", "#ROSBAG V2.0\n"})
    EXPECT_HAS(refusal(bytes), "a.mcap: is not an MCAP file");
  EXPECT_HAS(refusal("\x89MCAP1\r\n"), "version 0 is read");
  EXPECT_HAS(test::refusal([&] { Reader reader(folder_.path()); }), "regular file");
}

TEST_F(McapReader, SaysWhenMessagesAreMissing) {
  const std::string only = chunk(5, 5, definitions_ + message(0, 5));
  const std::string counts = record(
      0x0b, u64(2) + u16(1) + u32(2) + u32(0) + u32(0) + u32(1) + u64(5) + u64(5) + text(""));
  const McapContents all = read(file(only, definitions_ + counts));
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_HAS(all.faults[0], "2 messages");
}

}  // namespace
}  // namespace penumbra::io::mcap
