// SPDX-License-Identifier: Apache-2.0
// Folders that run may not write to, and what of earlier contents goes or stays.
#include "fixtures.hpp"

#include <io/files/pending_file.hpp>

namespace penumbra::test {
namespace {

class BadOutputTest : public TinyTest {
 protected:
  void expect_no_output(const fs::path& output, const std::string& named) const {
    expect_refused(
        penumbra({"run", path(), "-o", output, "--force", "--save", "vdi,labels,links,overlay"}),
        {named});
    EXPECT_FALSE(fs::exists(output / "report.json"));
  }
};

TEST_F(BadOutputTest, IsNoFolderOfItsOwn) {
  expect_no_output(path("tiny.urdf"), "tiny.urdf");
  expect_no_output(path("."), "the recording's own folder");
  expect_no_output(path("tiny.urdf/out"), "tiny.urdf");
  expect_no_output("/proc/penumbra", "/proc");
}

TEST_F(BadOutputTest, AFormerRunStaysUntilAllOfTheNextsInputIsRead) {
  const fs::path output = path("out");
  const std::vector<std::string> again = {"run",  path(),   "-o",
                                          output, "--save", "vdi,labels,links,overlay"};
  ASSERT_EQ(penumbra(again).status, 0);
  const std::string former = read_file(output / "report.json");
  const auto expect_left = [&](std::vector<std::string> line) {
    line.insert(line.end(), {"-o", output});
    const Outcome outcome = penumbra(line);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_TRUE(read_file(output / "report.json") == former);
    for (const char* kind : {"vdi", "labels", "links", "overlay"})
      EXPECT_FALSE(fs::is_empty(output / kind)) << kind << outcome.err;
  };
  expect_left({"run", path("nowhere")});
  expect_left({"run", "x.mcap"});
  expect_left({"run", path(), "--targets", path("nowhere.yaml")});
  expect_left({"run", path(), "--frames", "1:4"});
  fs::rename(path("board.stl"), path("board.away"));
  expect_left({"run", path()});
  fs::rename(path("board.away"), path("board.stl"));

  write_file(output / "labels/notes.txt", "the user's own");
  const fs::path part = output / "report.json.penumbra.part";
  fs::rename(output / "report.json", part);  // as of a run that was killed
  EXPECT_EQ(penumbra({"run", path(), "-o", output}).status, 0);
  EXPECT_FALSE(fs::exists(part));
  EXPECT_TRUE(fs::is_empty(output / "vdi")) << "the former run's";
  EXPECT_EQ(read_file(output / "labels/notes.txt"), "the user's own");
}

TEST_F(BadOutputTest, ARecordingIsNoOutputFolder) {
  const fs::path other = path("other");
  fs::create_directories(other / "labels");
  write_file(other / "recording.yaml", "robot:\n");
  write_file(other / "labels/000000.png", "recorded");
  expect_no_output(other, "other");
  EXPECT_TRUE(fs::exists(other / "labels/000000.png"));
}

TEST_F(BadOutputTest, AFolderOfAnotherIsRefusedAndLeftAsItIs) {
  const fs::path output = path("out");
  fs::create_directories(output / "labels");
  for (const char* file : {"notes.txt", "report.json", "labels/000000.png", "labels/mine.png"}) {
    write_file(output / file, "{\"lighthouse\": 11}");
    const Outcome outcome =
        penumbra({"run", path(), "-o", output, "--save", "vdi,labels,links,overlay"});
    expect_refused(outcome, {"--force"});
    EXPECT_EQ(read_file(output / file), "{\"lighthouse\": 11}");
    EXPECT_FALSE(fs::exists(output / "vdi"));
  }
  EXPECT_EQ(penumbra({"run", path(), "-o", output, "--force", "--save", "vdi"}).status, 0);
  for (const char* file : {"notes.txt", "labels/000000.png", "labels/mine.png"})
    EXPECT_EQ(read_file(output / file), "{\"lighthouse\": 11}") << file;
}

TEST_F(BadOutputTest, IsWrittenByAnotherRun) {
  const fs::path output = path("out");
  const std::vector<std::string> line = {"run", path(), "-o", output, "--save", "labels"};
  ASSERT_EQ(penumbra(line).status, 0);
  {
    const io::FileLock lock(output);
    const Outcome outcome = penumbra(line);
    expect_refused(outcome, {"out: another program is writing it"});
    EXPECT_TRUE(fs::exists(output / "report.json"));
    EXPECT_TRUE(fs::exists(output / "labels/000000.png"));
  }
  EXPECT_EQ(penumbra(line).status, 0);
}

TEST_F(BadOutputTest, ImagesBehindALinkStayAndAreRefused) {
  const fs::path output = path("out");
  const fs::path photos = path("photos");
  fs::create_directory(photos);
  write_file(photos / "000000.png", "the user's own");
  ASSERT_EQ(penumbra({"run", path(), "-o", output}).status, 0);
  fs::create_directory_symlink(photos, output / "labels");
  const Outcome outcome = penumbra({"run", path(), "-o", output});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  expect_has(outcome.err, {"out/labels: "});
  EXPECT_EQ(read_file(photos / "000000.png"), "the user's own");

  fs::remove(output / "labels");
  fs::create_directory(output / "labels");
  fs::create_symlink(photos / "000000.png", output / "labels/000000.png");
  EXPECT_EQ(penumbra({"run", path(), "-o", output, "--save", "labels"}).status, 0);
  EXPECT_EQ(read_file(photos / "000000.png"), "the user's own") << "the link alone is replaced";
}

TEST_F(BadOutputTest, AFailedRunRemovesWhatItWroteAndNothingElse) {
  const fs::path output = path("out");
  fs::create_directories(output / "labels");
  write_file(output / "labels/000100.png", "the user's own");
  constexpr std::size_t less_than_a_vdi = tiny_width * tiny_height * sizeof(float);
  EXPECT_EQ(penumbra_within(less_than_a_vdi, TooLarge::fails,
                            {"run", path(), "-o", output, "--force", "--save", "vdi,labels"}),
            2);
  EXPECT_FALSE(fs::exists(output / "report.json"));
  EXPECT_FALSE(fs::exists(output / "labels/000000.png")) << "no report says whose it is";
  EXPECT_FALSE(fs::exists(output / "vdi/000000.npy"));
  EXPECT_FALSE(fs::exists(output / "report.json.penumbra.part"));
  EXPECT_EQ(read_file(output / "labels/000100.png"), "the user's own");
  fs::remove(output / "labels/000100.png");
  EXPECT_EQ(penumbra({"run", path(), "-o", output, "--save", "labels"}).status, 0);
}

}  // namespace
}  // namespace penumbra::test
