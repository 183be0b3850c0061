// SPDX-License-Identifier: Apache-2.0
// Numbers, YAML and the files of poses and motions.
#include "cloud_samples.hpp"

#include <io/files/numbers.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/trajectory_file.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

using test::refusal;

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

/// A rotation that is written with four digits is off by up to 5e-5 an element.
TEST_F(PoseFile, ProjectsRoundedRotationsAndIsWrittenBitForBit) {
  const Eigen::Isometry3d pose =
      read("0,-1,0,1\n0.7071,0,-0.7071,2\n0.7071,0,0.7071,0.1\n0,0,0,1\n");
  const Eigen::Matrix3d exact = (Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()))
                                    .toRotationMatrix();
  constexpr double rounding = 1e-14, four_digits = 1e-4;
  EXPECT_TRUE((pose.linear().transpose() * pose.linear()).isIdentity(rounding));
  EXPECT_TRUE(pose.linear().isApprox(exact, four_digits));
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(1, 2, 0.1));
  const auto file = folder_.write("written.csv", "");
  write_pose_csv(file, pose);
  EXPECT_EQ(read_pose_csv(file).matrix(), pose.matrix());
}

TEST_F(PoseFile, RefusesWhatIsNoPose) {
  test::expect_refused({{"1,0,0,1\n0,1.001,0,2\n0,0,1,3\n0,0,0,1\n", "pose.csv: "},
                        {"1,0,0,1\n0,1,0,2\n0,0,-1,3\n0,0,0,1\n", "mirrors"},
                        {"0,0,0,1\n0,0,0,2\n0,0,0,3\n0,0,0,1\n", "no rigid transform"},
                        {"1,0,0,1\n0,1,0,2\n0,0,1,3\n0,0,0,2\n", "0,0,0,1"},
                        {"1,0,0,1\n0,1,0,2\n", "8 numbers in 2 rows"},
                        {"1,0,0,1\n0,1,0,2\n0,0,1,3\n0,0,0\n", "pose.csv:4: "},
                        {"1 2 3 0 0 0\n", "6 numbers"},
                        {"1 2 3 0 0 0.7 0.8\n", "length 1.06"},
                        {"1 2 3 0 0 0 1\n1 2 3 0 0 0 1\n", "14 numbers in 2 rows"},
                        {"x,y,z,qx,qy,qz,qw\n", "4 x 4"},
                        {"parameters: {}\ntransformation: {x: 1, y: 2, z: 3, qx: 0}\n",
                         "pose.csv:2: transformation: key 'qy'"},
                        {"parameters: {eye_on_hand: true}\n", "4 x 4"},
                        {"\x93NUMPY", "NumPy"},
                        {"1,0,0,1\n0,1,0,2\n0,0,1,3\n0,0,0,1\n0,0,0,1\n", "pose.csv:5: "},
                        {"1,0,0,1\n0,1,0\n", "pose.csv:2: "},
                        {"1,0,0,1\n0,x,0,1\n", ":2: 'x'"},
                        {"1,0,0,nan\n", ":1: 'nan'"},
                        {"", "0 numbers"},
                        {"1,0,0,1e300\n0,1,0,0\n0,0,1,0\n0,0,0,1\n", "1000 km"}},
                       [&](const std::string& text) { read(text); });
}

std::string npy(const std::string& header, const std::string& numbers) {
  return test::npy("{'descr': " + header + ", }\n", numbers);
}

// A quarter turn about z and (1, 2, 3) in the forms of other programs.
const std::vector<std::string> quarter_turns{
    "0,-1,0,1\n1,0,0,2\n0,0,1,3\n0,0,0,1\n",
    "# 4 x 4: camera to base\n0.0e+00 -1.0e+00 0.0e+00 1.0e+00\n1 0 0 2\n0 0 1 3\n0 0 0 1\n",
    "0\t-1\t0\t1\n1\t0\t0\t2\n0\t0\t1\t3\n",
    "0 -1 0 1 1 0 0 2 0 0 1 3\n",
    "[[0, -1, 0, 1],\n [1, 0, 0, 2],\n [0, 0, 1, 3],\n [0, 0, 0, 1]]\n",
    "1 2 3 0 0 0.70710678118654757 0.70710678118654757\n",
    "1, 2, 3, 0, 0, 0.70710678118654757, 0.70710678118654757",
    "parameters:\n  eye_on_hand: false\n  robot_base_frame: base_link\ntransformation:\n"
    "  {x: 1, y: 2, z: 3, qx: 0, qy: 0, qz: 0.70710678118654757, qw: 0.70710678118654757}\n",
    "parameters: {name: a}\ntransform:\n  translation: {x: 1, y: 2, z: 3}\n"
    "  rotation: {x: 0, y: 0, z: 0.70710678118654757, w: 0.70710678118654757}\n",
    "pose:\n  position: {x: 1, y: 2, z: 3}\n"
    "  orientation: {x: 0, y: 0, z: 0.70710678118654757, w: 0.70710678118654757}\n",
    npy("'<f8', 'fortran_order': False, 'shape': (4, 4)",
        test::raw(0., -1., 0., 1., 1., 0., 0., 2., 0., 0., 1., 3.) + test::raw(0., 0., 0., 1.)),
    npy("'<f4', 'fortran_order': False, 'shape': (3, 4)",
        test::raw(0.F, -1.F, 0.F, 1.F, 1.F, 0.F, 0.F, 2.F, 0.F, 0.F, 1.F, 3.F)),
    npy("'<f8', 'fortran_order': True, 'shape': (3, 4)",
        test::raw(0., 1., 0., -1., 0., 0., 0., 0., 1., 1., 2., 3.))};

TEST_F(PoseFile, ReadsTheFormsOfOtherPrograms) {
  constexpr double rounding = 1e-15;
  const Eigen::Matrix4d expected = read(quarter_turns[0]).matrix();
  EXPECT_EQ(expected.col(3), Eigen::Vector4d(1, 2, 3, 1));
  for (const std::string& text : quarter_turns)
    EXPECT_LT((read(text).matrix() - expected).cwiseAbs().maxCoeff(), rounding) << text;
}

TEST(TrajectoryFile, ReadsGoalsAndPlansOfRos1) {
  const test::TemporaryFolder folder;
  const std::string points =
      "{joint_names: [a, b], points: [{positions: [0, 1], time_from_start: {secs: 0, nsecs: 5}},\n"
      " {positions: [1, 2], velocities: [0, 0], time_from_start: {secs: 2}}]}\n";
  for (const auto& [file, text] : std::initializer_list<std::pair<const char*, std::string>>{
           {"goal.yaml", "goal:\n  trajectory: " + points},
           {"plan.yaml", "trajectory: [{joint_trajectory: " + points + "}]\n"}}) {
    const auto read = [&, name = file](const std::string& from) {
      return read_trajectories(folder.write(name, from)).front();
    };
    EXPECT_EQ(read(text).points.at(0).time, 5e-9);
    EXPECT_EQ(read(text).points.at(1).time, 2.0);
  }
}

YamlNode parse_yaml(const std::string& text) { return YamlNode::parse(text, "f.yaml"); }

TEST(Yaml, WhatIsNoNumberIsNamedWithFileLineAndKey) {
  for (const char* value : {"text", "12x", "'1'", "", "1.5", "[1]"}) {
    const YamlNode root = parse_yaml(std::string("a:\n  n: ") + value);
    const std::string message = refusal([&] { return root.at("a").at("n").integer(); });
    EXPECT_TRUE(message.starts_with("f.yaml:2: a.n: ")) << message;
  }
}

TEST(Yaml, RefusesWhatItCannotBeSureOf) {
  test::expect_refused({{"a: 1\nb: 2\na: 3\n", "f.yaml:3: key 'a' is there already, in line 1"},
                        {"a: &x 1\nb: *x\n", "f.yaml:2: aliases"},
                        {"a: 1\n---\nb: 1\n", "one document"},
                        {"", "is empty"},
                        {"# only a comment\n", "is empty"},
                        {"]", "is not YAML"},
                        {"a: 1\n---\n}\n", "is not YAML"},
                        {"a: [1, 2\nb: 3\n", "f.yaml:"},
                        {"a: b: c\n", "is not YAML"},
                        {"? [1, 2]\n: 3\n", "a key"},
                        {"a: " + std::string(17, '[') + std::string(17, ']'), "16 deep"}},
                       parse_yaml);
  const YamlNode zero = parse_yaml("a: \"x\\0y\"\n");
  EXPECT_HAS(refusal([&] { return zero.at("a").text(); }), "character 0");
}

/// Without a bound each of these takes gigabytes or minutes.
TEST(Yaml, BoundsItsWork) {
  const test::TemporaryFolder folder;
  const auto big = folder.write("big.yaml", std::string(20'000'000, '#'));
  EXPECT_HAS(refusal([&] { return YamlNode::read(big); }), "big.yaml: has 20000000 bytes");
  for (const char* part : {"[", "{", "- ", "? ", "a: [", "{a: ", "[],", "{a: 1},", "a:\n"}) {
    std::string many;
    for (int i = 0; i < 1'000'001; ++i) many += part;
    EXPECT_HAS(refusal([&] { return parse_yaml(many); }), "f.yaml: has more than 1000000 lines");
  }
  std::string keys;
  for (int i = 0; i < 100'000; ++i) keys += std::to_string(i) + ": 1\n";
  EXPECT_EQ(parse_yaml(keys).entries().size(), 100'000U);
  EXPECT_HAS(refusal([&] { return parse_yaml(keys + "5: 1\n"); }), "f.yaml:100001: key '5'");
}

}  // namespace
}  // namespace penumbra::io
