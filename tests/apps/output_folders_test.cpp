// SPDX-License-Identifier: Apache-2.0
// The output folder of every command: a link in each of its places, a kill and a full disk at each
// of its files. Folders that run may not write to, and what of earlier contents goes or stays.
#include "fixtures.hpp"
#include "tiny_clouds.hpp"

#include <csignal>
#include <ostream>
#include <set>

#include <io/cloud/cloud_file.hpp>

namespace penumbra::test {
namespace {

struct Command {
  std::string name;
  Words line;  // "@" is the folder of the inputs
  std::string output = "out";
  bool has_force = false;
};
void PrintTo(const Command& command, std::ostream* out) { *out << command.name; }

/// Files by their names in a folder; a file alone has no name.
using Files = std::map<std::string, std::string>;

Files files_of(const fs::path& place) {
  if (fs::is_regular_file(place)) return {{"", without_times(place)}};
  Files files;
  if (fs::exists(place))
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
      const std::string name = entry.path().lexically_relative(place);
      if (entry.is_symlink())
        files[name] = "a link";
      else if (entry.is_regular_file())
        files[name] = without_times(entry.path());
    }
  return files;
}

class Outputs : public TinyTest, public testing::WithParamInterface<Command> {
 protected:
  Outputs() {
    write_joints("frame,stamp,slide\n0,0,0.0\n1,100000000,0.05\n2,200000000,0.1\n");
    write("cameras.yaml", two_cameras_yaml());
    write_targets("- {name: hole, point: [0, 0, 2], radius: 0.05, link: base}\n");
    write("poses.csv", "name,x,y,z,qx,qy,qz,qw\nahead,0,0,0,0,0,0,1\n");
    write("plan.csv", "time,slide\n0,0\n1,1\n");
    write_clouds();
    TinyBag bag = tiny_bag(path());
    add_clouds(bag);
    bag.write_mcap(path("clouds.mcap"));
  }

  /// Each cloud is larger than the one before.
  void write_clouds() const {
    fs::create_directories(path("scans"));
    for (int i = 0; i < 3; ++i) {
      FourPoints few(0);
      const std::vector<std::byte> four = few.data;
      for (int more = 0; more < 20 * i; ++more)
        few.data.insert(few.data.end(), four.begin(), four.end());
      few.message.width = static_cast<std::uint32_t>(few.data.size() / few.message.point_step);
      few.message.row_step = static_cast<std::uint32_t>(few.data.size());
      few.message.data = few.data;
      io::write_cloud(path("scans/" + std::to_string(i) + ".pcd"), few.message);
    }
    write("clouds.yaml", clouds_yaml());
  }

  [[nodiscard]] fs::path output() const { return path(GetParam().output); }
  [[nodiscard]] Words line(const fs::path& output, bool force = false) const {
    Words words;
    for (std::string word : GetParam().line) {
      if (word.starts_with('@')) word.replace(0, 1, path().string() + "/");
      words.push_back(word);
    }
    words.insert(words.end(), {"-o", output});
    if (force) words.emplace_back("--force");
    return words;
  }

  [[nodiscard]] fs::path undisturbed() const {
    return path("undisturbed" + output().extension().string());
  }
  /// Returns the results of a command that nothing disturbs.
  [[nodiscard]] Files results() const {
    succeed(penumbra(line(undisturbed())));
    return files_of(undisturbed());
  }
  void expect_results(const Files& wanted, const std::string& after) const {
    succeed(penumbra(line(output())));
    EXPECT_TRUE(files_of(output()) == wanted) << after;
  }
};

using OutputFolders = Outputs;

TEST_P(OutputFolders, NothingBehindALinkIsWrittenOrRemoved) {
  const Files wanted = results();
  const fs::path precious = path("precious");
  for (const auto& entry : fs::recursive_directory_iterator(undisturbed()))
    for (const bool has_former : {false, true})
      for (const bool is_dangling : {false, true}) {
        const fs::path place = output() / entry.path().lexically_relative(undisturbed());
        const bool is_of_another_frame =
            place.stem().string().find_first_of("123456789") != std::string::npos;
        if (is_of_another_frame) continue;
        const std::string where = place.string() + (has_former ? ", former results" : "") +
                                  (is_dangling ? ", to nothing" : "");
        fs::remove_all(output());
        fs::remove_all(precious);
        fs::create_directories(precious);
        if (has_former) expect_results(wanted, where);
        fs::remove_all(place);
        fs::create_directories(place.parent_path());
        if (entry.is_directory() && !is_dangling)
          fs::copy(entry.path(), precious / "it", fs::copy_options::recursive);
        else if (!is_dangling)
          write_file(precious / "it", "the user's own");
        fs::create_symlink(precious / "it", place);
        const Files before = files_of(precious);
        const Outcome outcome = penumbra(line(output(), GetParam().has_force && !has_former));
        EXPECT_TRUE(files_of(precious) == before) << where;
        if (outcome.status == 0)
          EXPECT_TRUE(files_of(output()) == wanted) << where;
        else
          expect_refused(outcome, {GetParam().output});
      }
}

/// The folder that the user names may be a link.
TEST_P(OutputFolders, TheFolderItselfMayBeALink) {
  const Files wanted = results();
  fs::create_directory(path("elsewhere"));
  fs::create_directory_symlink(path("elsewhere"), output());
  expect_results(wanted, "into a link");
  expect_results(wanted, "again");
}

/// Every size of a file is a moment. Sizes of reports differ a little, by the times in them.
TEST_P(Outputs, AKillOrAFullDiskLeavesNoResultAndTheNextIsRight) {
  const Files wanted = results();
  std::set<std::size_t> sizes;
  for (const auto& [name, content] : wanted)
    sizes.insert(fs::file_size(name.empty() ? undisturbed() : undisturbed() / name) * 3 / 4);
  const fs::path notes = output() / "notes.txt";
  const bool is_folder = output().extension().empty();
  for (const std::size_t size : sizes)
    for (const TooLarge what : {TooLarge::fails, TooLarge::kills})
      for (const bool has_former : {false, true}) {
        const std::string when = (what == TooLarge::fails ? "full at " : "killed at ") +
                                 std::to_string(size) + (has_former ? ", former results" : "");
        fs::remove_all(output());
        Files all = wanted;
        if (has_former) expect_results(wanted, when);
        if (has_former && is_folder) {
          write_file(notes, "the user's own");
          all["notes.txt"] = "the user's own";
        }
        const int status = penumbra_within(size, what, line(output()));
        EXPECT_EQ(status, what == TooLarge::fails ? 2 : 128 + SIGXFSZ) << when;
        const Files left = files_of(output());
        for (const auto& [name, content] : wanted) {
          const bool is_whole = !is_folder && has_former && left == wanted;
          const bool is_of_camera = GetParam().name == "cameras" && name.find('/') != name.npos;
          const bool is_no_report =
              is_folder && what == TooLarge::kills && !name.ends_with(".json");
          EXPECT_TRUE(is_whole || is_of_camera || is_no_report || !left.contains(name))
              << when << ": " << name;
        }
        expect_results(all, when);
      }
}

using Init = TinyTest;

TEST_F(Init, LeavesNoHalfRecordingAndReplacesNone) {
  const fs::path file = path("recording.yaml");
  fs::remove(file);
  const Words line = {"init", path()};
  constexpr std::size_t too_few = 100;  // bytes
  for (const TooLarge what : {TooLarge::fails, TooLarge::kills}) {
    EXPECT_NE(penumbra_within(too_few, what, line), 0);
    EXPECT_FALSE(fs::exists(file));
  }
  expect_has(succeed(penumbra(line)).out, {"next:    penumbra run"});
  expect_refused(penumbra(line), {"recording.yaml", "--force"});
  fs::remove(path("joint_states.csv"));
  expect_has(succeed(penumbra(line + Words{"--force"})).out,
             {"next:    give joints in recording.yaml, then penumbra run"});
}

const std::vector<Command> folders = {
    {"run", {"run", "@", "--report", "--save", "vdi,labels,links,points"}, "out", true},
    {"cameras", {"run", "@cameras.yaml", "--report", "--save", "labels"}, "out", true},
    {"cloud", {"cloud", "@clouds.yaml"}, "out", true},
    {"view_planning",
     {"view-planning", "@", "--targets", "@targets.yaml", "--candidates", "@poses.csv"}},
    {"look_ahead", {"look-ahead", "@", "--targets", "@targets.yaml", "--trajectory", "@plan.csv"}},
};
const std::vector<Command> files = {
    {"bag", {"run", "@"}, "out.mcap"},
    {"clouds", {"cloud", "@clouds.mcap"}, "out.mcap"},
    {"render",
     {"render", "--robot", "@tiny.urdf", "--camera", "@camera_info.yaml", "--pose",
      "@camera_pose.csv"},
     "vdi.npy"},
};
INSTANTIATE_TEST_SUITE_P(Folders, Outputs, testing::ValuesIn(folders), name_of);
INSTANTIATE_TEST_SUITE_P(SingleFiles, Outputs, testing::ValuesIn(files), name_of);
INSTANTIATE_TEST_SUITE_P(All, OutputFolders, testing::ValuesIn(folders), name_of);

const Words all_saves = {"--save", "vdi,labels,links,overlay"};

using BadOutputTest = TinyTest;

TEST_F(BadOutputTest, IsNoFolderOfItsOwn) {
  const auto expect_no_output = [&](const fs::path& output, const std::string& named) {
    expect_refused(penumbra(Words{"run", path(), "-o", output, "--force"} + all_saves), {named});
    EXPECT_FALSE(fs::exists(output / "report.json"));
  };
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

}  // namespace
}  // namespace penumbra::test
