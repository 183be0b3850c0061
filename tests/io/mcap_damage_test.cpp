// SPDX-License-Identifier: Apache-2.0
// Files that are cut or damaged anywhere: what is read is right, what is not read is told, and
// memory stays in proportion.
#include "../support/allocations.hpp"
#include "../support/run_length.hpp"
#include "mcap_files.hpp"
#include "memory_file.hpp"

#include <io/mcap/compression.hpp>
#include <io/mcap/file_index.hpp>

namespace penumbra::io::mcap {
namespace {

using test::McapContents;
using test::RecordedMessage;

// Files here have a few thousand bytes: nothing may ask for more memory than the readers' blocks.
constexpr std::size_t large_memory = std::size_t{2} << 20;

class McapDamage : public testing::TestWithParam<Compression> {
 protected:
  McapDamage() {
    std::mt19937_64 random = test::seeded_random(71);
    for (std::uint32_t i = 0; i < 24; ++i) {
      const auto stamp = static_cast<std::int64_t>(100 + 10 * i - random() % 30);
      const std::size_t length = random() % 80;
      const char letter = static_cast<char>('a' + random() % 3);
      messages_.push_back(
          {"/topic" + std::to_string(i % 3), "p/msg/A", i, stamp, i, std::string(length, letter)});
    }
    test::write_mcap(file_, {GetParam(), 500, "ros2"}, messages_);
    whole_ = test::read_bytes(file_);
  }

  McapContents read(const std::string& bytes) {
    const test::MemoryFile file(bytes);
    // A damaged chunk may claim so much, and Zstandard may ask for it
    // (since 1.5.4+dfsg2-5+deb12u1).
    const test::MemoryShortage none(most_decompressed(bytes.size()) + 1, 0);
    McapContents all;
    test::refusal([&] { all = test::read_mcap(file.path()); });
    return all;
  }

  [[nodiscard]] auto places() const {
    InputFile input;
    input.open(file_).require();
    FaultLog faults;
    return read_index(input, faults).places;
  }

  // Every message is one that was written, and none comes twice.
  void expect_genuine(const McapContents& all, std::size_t at) {
    std::vector<RecordedMessage> expected = messages_, found = all.messages;
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    ASSERT_TRUE(std::includes(expected.begin(), expected.end(), found.begin(), found.end())) << at;
    if (all.faults.empty()) {
      ASSERT_EQ(all.messages, test::by_time(messages_)) << at;
    }
  }

  // Each byte in turn; a chunk's kind becomes that of each record that is passed over.
  void damage_every_byte(const std::string& bytes) {
    for (std::size_t at = test::mcap_file::magic.size(); at < bytes.size();
         at += test::sample_stride) {
      for (const int flip : {0x01, 0x04, 0x09, 0x0a, 0x0f, 0x80, 0xff}) {
        std::string damaged = bytes;
        damaged[at] ^= static_cast<char>(flip);
        ASSERT_NO_FATAL_FAILURE(expect_genuine(read(damaged), at)) << flip;
      }
    }
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.mcap";
  std::vector<RecordedMessage> messages_;
  std::string whole_;
};

TEST_P(McapDamage, EveryTruncationKeepsTheChunksBefore) {
  std::vector<std::pair<std::size_t, std::size_t>> whole_at;  // bytes of the file, messages in them
  std::size_t messages = 0;
  for (const MessagePlace& place : places()) {
    const std::size_t end = place.offset + place.length;
    messages = read(whole_.substr(0, end)).messages.size();
    whole_at.emplace_back(end, messages);
  }
  ASSERT_GT(whole_at.size(), 3U);
  ASSERT_EQ(messages, messages_.size());
  for (std::size_t length = 0; length < whole_.size(); ++length) {
    const McapContents all = read(whole_.substr(0, length));
    if (length < test::mcap_file::magic.size()) {
      ASSERT_TRUE(all.messages.empty());  // it was refused
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(expect_genuine(all, length));
    std::size_t expected = 0;
    for (const auto& [end, count] : whole_at)
      if (end <= length) expected = count;
    ASSERT_EQ(all.messages.size(), expected) << length;
    ASSERT_FALSE(all.faults.empty()) << length;
  }
}

TEST_P(McapDamage, DamagedBytesNeverGiveOtherMessages) { damage_every_byte(whole_); }

TEST_P(McapDamage, DamagedBytesNeverGiveOtherMessagesWithoutASummary) {
  const std::size_t data_end = whole_.rfind(std::string("\x0f\x04\0\0\0\0\0\0\0", 9));
  ASSERT_NE(data_end, std::string::npos);
  damage_every_byte(whole_.substr(0, data_end) + test::mcap_file::data_end() +
                    test::mcap_file::footer());
}

// One damaged chunk costs its own messages and no others.
TEST_P(McapDamage, ADamagedChunkIsOneFault) {
  for (const MessagePlace& place : places()) {
    std::string damaged = whole_;
    damaged[place.offset + place.length - 1] ^= 0x40;
    const McapContents all = read(damaged);
    ASSERT_EQ(all.faults.size(), 1U) << testing::PrintToString(all.faults);
    EXPECT_EQ(all.fault_offsets[0], place.offset);
    EXPECT_HAS(all.faults[0], "its messages are left out");
    EXPECT_LT(all.messages.size(), messages_.size());
    EXPECT_GT(all.messages.size(), messages_.size() / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(All, McapDamage,
                         testing::Values(Compression::none, Compression::lz4, Compression::zstd),
                         [](const auto& test) {
                           return std::string(test.index == 0 ? "none" : to_string(test.param));
                         });

/// Of files, by this process.
std::uint64_t bytes_read() {
  std::string name;
  std::uint64_t bytes = 0;
  std::ifstream("/proc/self/io") >> name >> bytes;
  return bytes;
}

// A recorder's disk was full: 100 GB without a record are not searched through.
TEST(McapClaims, AHoleIsLeftAfterSomeGigabytes) {
  using namespace test::mcap_file;
  test::TemporaryFolder folder;
  const auto path = folder.write("a.mcap", magic + header());
  std::filesystem::resize_file(path, 100'000'000'000);  // takes no room on the disk
  const std::uint64_t before = bytes_read();
  ASSERT_GT(before, 0U);
  const McapContents all = test::read_mcap(path);
  EXPECT_LT(bytes_read() - before, 5'000'000'000U);
  EXPECT_TRUE(all.messages.empty());
  ASSERT_GE(all.faults.size(), 1U);
  EXPECT_HAS(all.faults.back(), "are left out");
}

// What a file claims costs nothing.
TEST(McapClaims, TakeNoMemory) {
  using namespace test::mcap_file;
  const std::string huge = u64(~0ULL >> 1), huge32 = u32(~0ULL);
  const std::string head = magic + header();
  std::vector<std::string> files;
  const std::string rest = huge + std::string(100, 'a') + footer();
  for (const int opcode : {1, 3, 4, 5, 6, 7, 8, 9, 11, 12, 15, 16, 200})
    files.push_back(std::string(head).append(1, static_cast<char>(opcode)).append(rest));
  for (const char* const compression : {"lz4", "zstd", ""})
    for (const std::uint64_t size : {std::uint64_t{60} << 20, ~std::uint64_t{0}})
      files.push_back(file(compressed_chunk(compression, size, std::string(50, '\0'))));
  for (const int opcode : {3, 4, 8, 11})
    for (std::size_t before = 0; before < 60; ++before)
      files.push_back(
          file("", record(opcode, std::string(before, '\1').append(huge32).append(huge))));
  files.push_back(magic + record(1, huge32 + huge));
  for (const std::string& bytes : files) {
    const test::MemoryFile file(bytes);
    const test::MemoryShortage none(large_memory, 0);
    const McapContents all = test::read_mcap(file.path());
    EXPECT_TRUE(all.messages.empty());
    EXPECT_EQ(none.asked(), 0U);
  }
}

}  // namespace
}  // namespace penumbra::io::mcap
