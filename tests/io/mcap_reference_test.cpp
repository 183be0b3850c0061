// SPDX-License-Identifier: Apache-2.0
// Against the reference library of MCAP, which is written in TypeScript: the scripts of
// tests/reference with packages of npm.
#include "../support/data.hpp"
#include "../support/node_scripts.hpp"
#include "mcap_files.hpp"

#include <iomanip>

#include <io/mcap/compression.hpp>

namespace penumbra::io::mcap {
namespace {

using test::RecordedMessage;

// As the scripts' common.mjs.
std::string line(const RecordedMessage& message) {
  std::ostringstream out;
  out << message.topic << ' ' << message.schema << ' ' << message.sequence << ' '
      << message.log_time << ' ' << message.publish_time << ' ' << message.data.size() << ' '
      << std::hex << std::setw(8) << std::setfill('0') << crc32(test::as_bytes(message.data));
  return out.str();
}

std::string lines(const std::vector<RecordedMessage>& messages) {
  std::string all;
  for (const RecordedMessage& message : messages) all += line(message) + "\n";
  return all;
}

TEST(McapReference, EveryFileOfTheReferenceIsRead) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  test::TemporaryFolder folder;
  const auto made = test::run_script("generate.mjs", folder.path().string());
  ASSERT_EQ(made.status, 0) << made.errors;
  const std::string expected = test::read_bytes(folder.path() / "messages.txt");
  ASSERT_EQ(std::count(expected.begin(), expected.end(), '\n'), 12);
  int read = 0, wrong = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().extension() != ".mcap") continue;
    const std::string name = entry.path().stem().string();
    ++read;
    const auto all = test::read_mcap(entry.path());
    EXPECT_EQ(lines(all.messages), expected) << name;
    EXPECT_TRUE(all.faults.empty()) << name << ": " << all.faults[0];
    Reader reader(entry.path());
    EXPECT_EQ(reader.channels().size(), 3U) << name;
    EXPECT_EQ(reader.schemas().size(), 2U) << name;
    if (testing::Test::HasFailure() && ++wrong == 10) break;
  }
  EXPECT_EQ(read, 4096);
}

TEST(McapReference, ReadsEveryFileOfOurs) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  test::TemporaryFolder folder;
  std::mt19937_64 random = test::seeded_random(81);
  std::string files, expected;
  for (const Compression compression : {Compression::none, Compression::lz4, Compression::zstd}) {
    for (const std::size_t chunk_size : {std::size_t{1}, std::size_t{3000}, std::size_t{1} << 20}) {
      for (const std::size_t count : {0, 1, 200}) {
        std::vector<RecordedMessage> messages;
        for (std::uint32_t i = 0; i < count; ++i) {
          const std::string number = std::to_string(random() % 3);
          messages.push_back({"/t" + number, number == "0" ? "-" : "p/msg/T" + number, i,
                              static_cast<std::int64_t>(random() % 100), 1'700'000'000'000'000'000,
                              std::string(random() % 400, static_cast<char>(random() % 3))});
        }
        const auto path =
            folder.path() / (std::string(to_string(compression)) + "_" +
                             std::to_string(chunk_size) + "_" + std::to_string(count) + ".mcap");
        test::write_mcap(path, {compression, chunk_size, "ros2"}, messages);
        files += "'" + path.string() + "' ";
        expected += "# ros2\n" + lines(test::by_time(messages));
      }
    }
  }
  const auto read = test::run_script("read_back.mjs", files);
  ASSERT_EQ(read.status, 0) << read.errors;
  EXPECT_EQ(read.output, expected);
}

TEST(McapReference, ReadsTheRealRecordingAlike) {
  PENUMBRA_REQUIRE_DATA();
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  const auto file = test::data_folder() / "xarm7_realsense" / "xarm7.mcap";
  const auto read = test::run_script("read_back.mjs", "'" + file.string() + "'");
  ASSERT_EQ(read.status, 0) << read.errors;
  EXPECT_EQ("# ros2\n" + lines(test::read_mcap(file).messages), read.output);
}

}  // namespace
}  // namespace penumbra::io::mcap
