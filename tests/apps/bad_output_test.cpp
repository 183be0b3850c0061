// SPDX-License-Identifier: Apache-2.0
// Folders that run may not write to, and what of earlier contents goes or stays.
#include "fixtures.hpp"

#include <io/files/pending_file.hpp>

namespace penumbra::test {
namespace {

const Words all_saves = {"--save", "vdi,labels,links,overlay"};

class BadOutputTest : public TinyTest {
 protected:
  void expect_no_output(const fs::path& output, const std::string& named) const {
    expect_refused(penumbra(Words{"run", path(), "-o", output, "--force"} + all_saves), {named});
    EXPECT_FALSE(fs::exists(output / "report.json"));
  }
};

TEST_F(BadOutputTest, IsNoFolderOfItsOwn) {
  expect_no_output(path("tiny.urdf"), "tiny.urdf");
  expect_no_output(path("."), "the recording's own folder");
  expect_no_output(path("tiny.urdf/out"), "tiny.urdf");
  expect_no_output("/proc/penumbra", "/proc");

  const fs::path other = path("other");  // a recording
  fs::create_directories(other / "labels");
  write_file(other / "recording.yaml", "robot:\n");
  write_file(other / "labels/000000.png", "recorded");
  expect_no_output(other, "other");
  EXPECT_TRUE(fs::exists(other / "labels/000000.png"));
}

TEST_F(BadOutputTest, AFormerRunStaysUntilAllOfTheNextsInputIsRead) {
  succeed(run(all_saves));
  const std::string former = read_file(out("report.json"));
  const auto expect_left = [&](const Words& line) {
    EXPECT_EQ(penumbra(line + Words{"-o", out()}).status, 2);
    EXPECT_TRUE(read_file(out("report.json")) == former);
    for (const char* kind : {"vdi", "labels", "links", "overlay"})
      EXPECT_FALSE(fs::is_empty(out(kind))) << kind;
  };
  expect_left({"run", path("nowhere")});
  expect_left({"run", "x.mcap"});
  expect_left({"run", path(), "--targets", path("nowhere.yaml")});
  expect_left({"run", path(), "--frames", "1:4"});
  fs::rename(path("board.stl"), path("board.away"));
  expect_left({"run", path()});
  fs::rename(path("board.away"), path("board.stl"));

  write_file(out("labels/notes.txt"), "the user's own");
  const fs::path part = out("report.json.penumbra.part");
  fs::rename(out("report.json"), part);  // as of a run that was killed
  succeed(run());
  EXPECT_FALSE(fs::exists(part));
  EXPECT_TRUE(fs::is_empty(out("vdi"))) << "the former run's";
  EXPECT_EQ(read_file(out("labels/notes.txt")), "the user's own");
}

TEST_F(BadOutputTest, AFolderOfAnotherIsRefusedAndLeftAsItIs) {
  fs::create_directories(out("labels"));
  for (const char* file : {"notes.txt", "report.json", "labels/000000.png", "labels/mine.png"}) {
    write_file(out(file), "{\"lighthouse\": 11}");
    expect_refused(run(all_saves), {"--force"});
    EXPECT_EQ(read_file(out(file)), "{\"lighthouse\": 11}");
    EXPECT_FALSE(fs::exists(out("vdi")));
  }
  succeed(run({"--force", "--save", "vdi"}));
  for (const char* file : {"notes.txt", "labels/000000.png", "labels/mine.png"})
    EXPECT_EQ(read_file(out(file)), "{\"lighthouse\": 11}") << file;
}

TEST_F(BadOutputTest, IsWrittenByAnotherRun) {
  succeed(run({"--save", "labels"}));
  {
    const io::FileLock lock(out());
    expect_refused(run({"--save", "labels"}), {"out: another program is writing it"});
    EXPECT_TRUE(fs::exists(out("report.json")));
    EXPECT_TRUE(fs::exists(out("labels/000000.png")));
  }
  succeed(run({"--save", "labels"}));
}

TEST_F(BadOutputTest, AFailedRunRemovesWhatItWroteAndNothingElse) {
  fs::create_directories(out("labels"));
  write_file(out("labels/000100.png"), "the user's own");
  constexpr std::size_t less_than_a_vdi = tiny_width * tiny_height * sizeof(float);
  EXPECT_EQ(penumbra_within(less_than_a_vdi, TooLarge::fails,
                            {"run", path(), "-o", out(), "--force", "--save", "vdi,labels"}),
            2);
  for (const char* file : {"report.json", "vdi/000000.npy", "report.json.penumbra.part",
                           "labels/000000.png"})  // no report says whose it is
    EXPECT_FALSE(fs::exists(out(file))) << file;
  EXPECT_EQ(read_file(out("labels/000100.png")), "the user's own");
  fs::remove(out("labels/000100.png"));
  succeed(run({"--save", "labels"}));
}

}  // namespace
}  // namespace penumbra::test
