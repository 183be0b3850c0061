// SPDX-License-Identifier: Apache-2.0
#include "../support/random.hpp"
#include "files.hpp"
#include "robots.hpp"

#include <random>

#include <gtest/gtest.h>

#include <io/files/joint_file.hpp>

namespace penumbra::io {
namespace {

using test::input_error;

class JointFile : public testing::Test {
 protected:
  std::vector<JointRow> read(const std::string& text) {
    return read_joint_file(folder_.write("joints.csv", text), robot_);
  }
  std::string fault(const std::string& text) {
    std::string message = input_error([&] { static_cast<void>(read(text)); });
    EXPECT_TRUE(message.starts_with((folder_.path() / "joints.csv").string() + ":")) << message;
    return message;
  }
  std::size_t variable(const std::string& name) { return robot_.find_variable(name).value(); }

  Robot robot_ = test::arm();
  test::TemporaryFolder folder_;
};

TEST_F(JointFile, ReadsColumnsInAnyOrderAndFramesInTheFilesOrder) {
  const auto rows =
      read("frame,stamp,elbow,finger_joint,shoulder\n7,5,0.25,9,1.5\n000003,6,-0.5,,+2\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].index, 7);
  EXPECT_EQ(rows[0].stamp, 5);
  EXPECT_EQ(rows[0].fault, "");
  EXPECT_EQ(rows[0].positions[variable("elbow")], 0.25);
  EXPECT_EQ(rows[0].positions[variable("shoulder")], 1.5);
  EXPECT_EQ(rows[1].index, 3);
  EXPECT_EQ(rows[1].positions[variable("elbow")], -0.5);
  EXPECT_EQ(rows[1].positions[variable("shoulder")], 2.0);
}

TEST_F(JointFile, NeedsNoStampAndNoLastLineEnd) {
  const auto rows = read("frame,shoulder,elbow\r\n0,1,2\r\n\r\n1,3,4");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].stamp, std::nullopt);
  EXPECT_EQ(rows[1].positions, (std::vector<double>{3, 4}));
}

TEST_F(JointFile, KeepsStampsExact) {
  EXPECT_EQ(read("frame,stamp,shoulder,elbow\n0,1700000000123456789,0,0\n")[0].stamp,
            1700000000123456789);
}

TEST_F(JointFile, ABadCellSpoilsItsRowOnly) {
  const auto rows = read(
      "frame,stamp,shoulder,elbow\n"
      "0,0,1,2\n"
      "1,1,,2\n"
      "2,2,abc,2\n"
      "3,3,1,nan\n"
      "4,4,1\n"
      "5,5,1,2,3\n"
      "6,1.5e9,1,2\n"
      "7,,1,2\n"
      "8,8,1e999,2\n"
      "9,9,1,2\n");
  const std::string file = (folder_.path() / "joints.csv").string();
  const std::vector<std::string> faults = {
      "",
      file + ":3: frame 1: column 'shoulder' is empty",
      file + ":4: frame 2: column 'shoulder' is 'abc', which is no finite number",
      file + ":5: frame 3: column 'elbow' is 'nan', which is no finite number",
      file + ":6: frame 4: has 3 cells; the header has 4",
      file + ":7: frame 5: has 5 cells; the header has 4",
      file + ":8: frame 6: stamp '1.5e9' is no whole number of nanoseconds",
      file + ":9: frame 7: stamp '' is no whole number of nanoseconds",
      file + ":10: frame 8: column 'shoulder' is '1e999', which is no finite number",
      ""};
  ASSERT_EQ(rows.size(), faults.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].fault, faults[i]);
    EXPECT_EQ(rows[i].positions.size(), faults[i].empty() ? 2U : 0U);
  }
}

TEST_F(JointFile, RefusesFilesItCannotBeSureOf) {
  EXPECT_HAS(fault(""), "is empty; a header frame,[stamp,]JOINT,... is wanted");
  EXPECT_HAS(fault("\n \n"), "is empty");
  EXPECT_HAS(fault("frame,shoulder,elbow\n"), "has no frames below its header");
  EXPECT_HAS(fault("shoulder,elbow\n1,2\n"), ":1: the first column is 'shoulder'");
  EXPECT_HAS(fault("frame;shoulder;elbow\n0;1;2\n"), "with commas between");
  EXPECT_HAS(fault("frame,shoulder\n0,1\n"), ":1: has no column for joint 'elbow'");
  EXPECT_HAS(fault("frame,shoulder,elbw,elbow\n0,1,2,3\n"),
             ":1: column 'elbw' is no joint of the robot that moves; known are: ");
  EXPECT_HAS(fault("frame,shoulder,elbow,flange\n0,1,2,3\n"), "column 'flange' is no joint");
  EXPECT_HAS(fault("frame,shoulder,stamp,elbow\n0,1,2,3\n"), "column 'stamp' is no joint");
  EXPECT_HAS(fault("frame,shoulder,elbow,\n0,1,2,\n"), "column '' is no joint");
  EXPECT_HAS(fault("frame,shoulder,elbow,shoulder\n0,1,2,3\n"),
             ":1: column 'shoulder' is there twice");
  EXPECT_HAS(fault("frame,shoulder,elbow\n0,1,2\n1,1,2\n0,1,2\n"),
             ":4: frame 0 is there already, in line 2");
  EXPECT_HAS(fault("frame,stamp,shoulder,elbow\n0,0,1,2\n1,-5,1,2\n"), ":3: stamp -5 is negative");
  for (const std::string number : {"-1", "1.0", "x", "", "9223372036854775808"})
    EXPECT_HAS(fault("frame,shoulder,elbow\n" + number + ",1,2\n"),
               ":2: '" + number + "' is no frame number");
  EXPECT_HAS(fault("frame,shoulder,elbow\n0,1,2\n9223372036854775807,1,2\n"),
             ":3: frame number 9223372036854775807 is too large; at most 9223372036854775806");
  EXPECT_HAS(
      input_error([&] { static_cast<void>(read_joint_file(folder_.path() / "none.csv", robot_)); }),
      "none.csv: cannot be read: No such file or directory");
}

TEST_F(JointFile, SurvivesDamage) {
  std::mt19937_64 random = test::seeded_random(1);
  const std::string whole = "frame,stamp,shoulder,elbow\n0,10,0.5,-1e-3\n1,20,1,2\n";
  const auto check = [&](const std::string& text) {
    test::only_input_errors([&] {
      for (const JointRow& row : read(text)) {
        EXPECT_EQ(row.positions.size(), row.fault.empty() ? 2U : 0U);
        for (const double position : row.positions) EXPECT_TRUE(std::isfinite(position));
      }
    });
  };
  for (std::size_t length = 0; length < whole.size(); ++length) check(whole.substr(0, length));
  using namespace std::string_literals;
  const std::string special = ",\n\r\0 .-+e0"s;
  for (int i = 0; i < 5000; ++i) {
    std::string damaged = whole;
    for (int n = 0; n < 1 + i % 4; ++n)
      damaged[random() % damaged.size()] =
          random() % 2 == 0 ? static_cast<char>(random()) : special[random() % special.size()];
    check(damaged);
  }
}

}  // namespace
}  // namespace penumbra::io
