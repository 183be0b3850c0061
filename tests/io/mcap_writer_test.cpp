// SPDX-License-Identifier: Apache-2.0
#include "mcap_files.hpp"

#include <gtest/gtest.h>

namespace penumbra::io::mcap {
namespace {

using test::RecordedMessage;

class McapWriter : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.mcap";
};

TEST_F(McapWriter, KeepsMessagesOfEverySize) {
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
    test::write_mcap(file_, {compression, 1 << 20, ""}, messages);
    const auto all = test::read_mcap(file_);
    EXPECT_TRUE(all.faults.empty()) << all.faults[0];
    EXPECT_TRUE(all.messages == messages);
  }
}

TEST_F(McapWriter, CountsAndDescribes) {
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
  EXPECT_EQ(reader.statistics().value().messages, 10U);
}

}  // namespace
}  // namespace penumbra::io::mcap
