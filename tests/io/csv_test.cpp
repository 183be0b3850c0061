// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <io/files/csv.hpp>
#include <io/files/numbers.hpp>
#include <io/files/pose_file.hpp>

namespace penumbra::io {
namespace {

using Cells = std::vector<std::string_view>;

TEST(Csv, SplitsLinesAndCells) {
  CsvLines lines(
      "\xEF\xBB\xBF"
      "a, b ,c\r\n\n  \n1,,3\n,");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.cells(), (Cells{"a", "b", "c"}));
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.cells(), (Cells{"1", "", "3"}));
  EXPECT_EQ(lines.line(), 4U);
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.cells(), (Cells{"", ""}));
  EXPECT_FALSE(lines.next());
}

TEST(Numbers, AreReadStrictly) {
  EXPECT_EQ(parse_number<double>("-1.5e-3"), -0.0015);
  EXPECT_EQ(parse_number<double>("+2"), 2.0);
  EXPECT_EQ(parse_number<std::int64_t>("9223372036854775807"), 9223372036854775807);
  for (const char* text :
       {"", "+", "1 ", " 1", "1,5", "0x10", "nan", "inf", "-inf", "1e999", "1.5x", "+-1", "--1"})
    EXPECT_EQ(parse_number<double>(text), std::nullopt) << text;
  for (const char* text : {"9223372036854775808", "1.0", "1e3", "", "abc"})
    EXPECT_EQ(parse_number<std::int64_t>(text), std::nullopt) << text;
}

class PoseFile : public testing::Test {
 protected:
  Eigen::Isometry3d read(const std::string& text) {
    return read_pose_csv(folder_.write("pose.csv", text));
  }
  test::TemporaryFolder folder_;
};

TEST_F(PoseFile, ReadsWhatWasReadAndWrittenBitForBit) {
  const Eigen::Isometry3d pose =
      read("0,-1,0,1\n0.7071,0,-0.7071,2\n0.7071,0,0.7071,0.1\n0,0,0,1\n");
  const auto file = folder_.write("written.csv", "");
  write_pose_csv(file, pose);
  EXPECT_EQ(read_pose_csv(file).matrix(), pose.matrix());
}

/// A rotation that is written with four digits is off by up to 5e-5 an element.
TEST_F(PoseFile, ProjectsRoundedRotations) {
  const Eigen::Isometry3d pose = read("0,-1,0,1\n0.7071,0,-0.7071,2\n0.7071,0,0.7071,3\n0,0,0,1\n");
  const Eigen::Matrix3d exact = (Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()))
                                    .toRotationMatrix();
  constexpr double rounding = 1e-14, four_digits = 1e-4;
  EXPECT_TRUE((pose.linear().transpose() * pose.linear()).isIdentity(rounding));
  EXPECT_TRUE(pose.linear().isApprox(exact, four_digits));
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST_F(PoseFile, RefusesWhatIsNoPose) {
  test::expect_refused({{"1,0,0,1\n0,1.001,0,2\n0,0,1,3\n0,0,0,1\n", "pose.csv: "},
                        {"1,0,0,1\n0,1,0,2\n0,0,-1,3\n0,0,0,1\n", "mirrors"},
                        {"0,0,0,1\n0,0,0,2\n0,0,0,3\n0,0,0,1\n", "no rigid transform"},
                        {"1,0,0,1\n0,1,0,2\n0,0,1,3\n0,0,0,2\n", "0,0,0,1"},
                        {"1,0,0,1\n0,1,0,2\n0,0,1,3\n", "3 rows"},
                        {"1,0,0,1\n0,1,0,2\n0,0,1,3\n0,0,0,1\n0,0,0,1\n", "pose.csv:5: "},
                        {"1,0,0,1\n0,1,0\n", "pose.csv:2: "},
                        {"1,0,0,1\n0,x,0,1\n", ":2: 'x'"},
                        {"1,0,0,nan\n", ":1: 'nan'"},
                        {"", "0 rows"},
                        {"1,0,0,1e300\n0,1,0,0\n0,0,1,0\n0,0,0,1\n", "1000 km"}},
                       [&](const std::string& text) { read(text); });
}

TEST_F(PoseFile, SurvivesDamage) {
  test::read_damaged("0,-1,0,1\n1,0,0,2\n0,0,1,3\n0,0,0,1\n", 2000, [&](const std::string& text) {
    EXPECT_TRUE(read(text).matrix().allFinite());
  });
}

}  // namespace
}  // namespace penumbra::io
