// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"
#include "robots.hpp"

#include <gtest/gtest.h>

#include <io/files/joint_file.hpp>

namespace penumbra::io {
namespace {

class JointFile : public testing::Test {
 protected:
  std::vector<JointRow> read(const std::string& text) {
    return read_joint_file(folder_.write("joints.csv", text), robot_);
  }
  std::size_t variable(const std::string& name) { return robot_.find_variable(name).value(); }

  Robot robot_ = test::arm();
  test::TemporaryFolder folder_;
};

TEST_F(JointFile, ReadsColumnsInAnyOrderAndFramesInTheFilesOrder) {
  const auto rows = read(
      "frame,stamp,elbow,finger_joint,shoulder\r\n"
      "7,1700000000123456789,0.25,9,1.5\r\n\r\n000003,6,-0.5,,+2");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].index, 7);
  EXPECT_EQ(rows[0].stamp, 1700000000123456789) << "exact";
  EXPECT_EQ(rows[0].fault, "");
  EXPECT_EQ(rows[0].positions[variable("elbow")], 0.25);
  EXPECT_EQ(rows[0].positions[variable("shoulder")], 1.5);
  EXPECT_EQ(rows[1].index, 3);
  EXPECT_EQ(rows[1].positions[variable("elbow")], -0.5);
  EXPECT_EQ(rows[1].positions[variable("shoulder")], 2.0);
  EXPECT_EQ(read("frame,shoulder,elbow\n0,1,2\n")[0].stamp, std::nullopt);
}

TEST_F(JointFile, RefusesFilesItCannotBeSureOf) {
  const std::string header = "frame,shoulder,elbow\n";
  test::expect_refused({{"", "joints.csv: "},
                        {header, "no frames"},
                        {"shoulder,elbow\n1,2\n", ":1: "},
                        {"frame;shoulder;elbow\n0;1;2\n", "commas"},
                        {"frame,shoulder\n0,1\n", "'elbow'"},
                        {"frame,shoulder,elbw,elbow\n0,1,2,3\n", "'elbw'"},
                        {"frame,shoulder,elbow,flange\n0,1,2,3\n", "'flange'"},
                        {"frame,shoulder,elbow,\n0,1,2,\n", "''"},
                        {"frame,shoulder,elbow,shoulder\n0,1,2,3\n", "'shoulder' is there twice"},
                        {header + "0,1,2\n1,1,2\n0,1,2\n", ":4: frame 0"},
                        {"frame,stamp,shoulder,elbow\n0,0,1,2\n1,-5,1,2\n", ":3: stamp -5"},
                        {header + "-1,1,2\n", ":2: '-1'"},
                        {header + "1.0,1,2\n", ":2: '1.0'"},
                        {header + "9223372036854775808,1,2\n", "'9223372036854775808'"},
                        {header + "0,1,2\n9223372036854775807,1,2\n", ":3: '9223372036854775807'"}},
                       [&](const std::string& text) { read(text); });
}

TEST_F(JointFile, ABadCellLeavesTheOtherJointsOfItsRowKnown) {
  const auto rows = read("frame,shoulder,elbow\n0,0.5,\n1,x,0.25\n2,1,2,3\n");
  ASSERT_EQ(rows.size(), 3U);
  for (const auto& [row, unknown] :
       {std::pair(std::size_t{0}, "elbow"), {std::size_t{1}, "shoulder"}}) {
    EXPECT_EQ(rows[row].unknown, std::vector{variable(unknown)});
    EXPECT_NE(rows[row].fault.find(unknown), std::string::npos) << rows[row].fault;
  }
  EXPECT_EQ(rows[0].positions[variable("shoulder")], 0.5);
  EXPECT_TRUE(rows[2].unknown.empty() && rows[2].positions.empty()) << "too many cells";
}

TEST_F(JointFile, SurvivesDamage) {
  test::read_damaged("frame,stamp,shoulder,elbow\n0,10,0.5,-1e-3\n1,20,1,2\n", 5000,
                     [&](const std::string& text) {
                       for (const JointRow& row : read(text)) {
                         const bool is_usable = row.fault.empty() || !row.unknown.empty();
                         EXPECT_EQ(row.positions.size(), is_usable ? 2U : 0U);
                         for (const double p : row.positions) EXPECT_TRUE(std::isfinite(p));
                       }
                     });
}

}  // namespace
}  // namespace penumbra::io
