// SPDX-License-Identifier: Apache-2.0
#include "../support/data.hpp"
#include "../support/random.hpp"
#include "files.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <io/files/csv.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/pose_file.hpp>

namespace penumbra::io {
namespace {

using test::input_error;
using Cells = std::vector<std::string_view>;

TEST(Csv, SplitsLinesAndCells) {
  CsvLines lines(
      "\xEF\xBB\xBF"
      "a, b ,c\r\n\n  \n1,,3\n,");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.cells(), (Cells{"a", "b", "c"}));
  EXPECT_EQ(lines.line(), 1U);
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.cells(), (Cells{"1", "", "3"}));
  EXPECT_EQ(lines.line(), 4U);
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.cells(), (Cells{"", ""}));
  EXPECT_FALSE(lines.next());
  EXPECT_FALSE(CsvLines("").next());
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

TEST(Names, SuggestsTheNearOnes) {
  const Cells few = {"x", "y"};
  EXPECT_EQ(near_names("z", few), "; known are: x, y");
  const Cells many = {"shoulder_pan", "shoulder_lift", "elbow",    "wrist_1", "wrist_2",
                      "wrist_3",      "finger_left",   "finger_r", "base"};
  EXPECT_EQ(near_names("Elbo", many), "; near are: elbow");
  EXPECT_EQ(near_names("wrist_4", many), "; near are: wrist_1, wrist_2, wrist_3");
  EXPECT_EQ(near_names("qqqqqqqqqqqqqqqqqqqqqqqq", many), "");
  EXPECT_EQ(near_names("x", {}), "");
}

class PoseFile : public testing::Test {
 protected:
  Eigen::Isometry3d read(const std::string& text) {
    return read_pose_csv(folder_.write("pose.csv", text));
  }
  std::string fault(const std::string& text) {
    return input_error([&] { static_cast<void>(read(text)); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(PoseFile, ReadsRowMajor) {
  const Eigen::Isometry3d pose = read("0,-1,0,1\n1,0,0,2\n0,0,1,3\n0,0,0,1\n");
  EXPECT_EQ(pose * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 3, 3));
}

TEST_F(PoseFile, ProjectsRoundedRotations) {
  // A rotation written with four digits is off by up to 5e-5 an element.
  const Eigen::Matrix3d exact =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -3).normalized()).toRotationMatrix();
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      text += std::to_string(std::round(exact(row, column) * 1e4) / 1e4) + ",";
    text += "0.5\n";
  }
  const Eigen::Isometry3d pose = read(text + "0,0,0,1\n");
  constexpr double rounding = 1e-14;
  EXPECT_LT((pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity())
                .cwiseAbs()
                .maxCoeff(),
            rounding);
  constexpr double four_digits = 1e-4;
  EXPECT_LT((pose.linear() - exact).cwiseAbs().maxCoeff(), four_digits);
  EXPECT_GT(pose.linear().determinant(), 0.0);
}

TEST_F(PoseFile, RefusesWhatIsNoPose) {
  EXPECT_HAS(fault("1,0,0,1\n0,1.001,0,2\n0,0,1,3\n0,0,0,1\n"), "rotation part is off by 0.001");
  EXPECT_HAS(fault("1,0,0,1\n0,1,0,2\n0,0,-1,3\n0,0,0,1\n"), "it mirrors");
  EXPECT_HAS(fault("0,0,0,1\n0,0,0,2\n0,0,0,3\n0,0,0,1\n"), "is no rigid transform");
  EXPECT_HAS(fault("1,0,0,1\n0,1,0,2\n0,0,1,3\n0,0,0,2\n"), "its last row must be 0,0,0,1");
  EXPECT_HAS(fault("1,0,0,1\n0,1,0,2\n0,0,1,3\n"), "has 3 rows");
  EXPECT_HAS(fault("1,0,0,1\n0,1,0,2\n0,0,1,3\n0,0,0,1\n0,0,0,1\n"), ":5: is a fifth row");
  EXPECT_HAS(fault("1,0,0,1\n0,1,0\n"), ":2: has 3 cells");
  EXPECT_HAS(fault("1,0,0,1\n0,x,0,1\n"), ":2: 'x' is no finite number");
  EXPECT_HAS(fault("1,0,0,nan\n"), ":1: 'nan' is no finite number");
  EXPECT_HAS(fault(""), "has 0 rows");
  EXPECT_HAS(fault("1,0,0,1e300\n0,1,0,0\n0,0,1,0\n0,0,0,1\n"), "pose.csv: is more than 1000 km");
  EXPECT_HAS(input_error([&] { static_cast<void>(read_pose_csv(folder_.path() / "none.csv")); }),
             "none.csv: cannot be read");
}

TEST_F(PoseFile, SurvivesRandomDamage) {
  std::mt19937_64 random = test::seeded_random(1);
  const std::string whole = "0,-1,0,1\n1,0,0,2\n0,0,1,3\n0,0,0,1\n";
  for (std::size_t length = 0; length < whole.size(); ++length)
    test::only_input_errors([&] { static_cast<void>(read(whole.substr(0, length))); });
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = whole;
    for (int n = 0; n < 1 + i % 3; ++n)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    test::only_input_errors([&] { EXPECT_TRUE(read(damaged).matrix().allFinite()); });
  }
}

TEST_F(PoseFile, ReadsTheRealRecording) {
  PENUMBRA_REQUIRE_DATA();
  const Eigen::Isometry3d pose =
      read_pose_csv(test::data_folder() / "xarm7_realsense" / "camera_pose.csv");
  EXPECT_DOUBLE_EQ(pose.translation().x(), 1.23057497);
  // The camera looks back at the robot's base.
  EXPECT_LT(pose.linear()(0, 2), -0.99);
}

}  // namespace
}  // namespace penumbra::io
