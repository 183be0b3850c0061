// SPDX-License-Identifier: Apache-2.0
#include "../support/run_length.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

using test::refusal;

YamlNode parse(const std::string& text) { return YamlNode::parse(text, "f.yaml"); }

TEST(Yaml, GivesTypedValues) {
  const YamlNode root = parse(
      "a: {b: text, 'c d': -2.5e3}\n"
      "list: [1, +2, 3.5]\n"
      "names:\n  - x\n  - 'y'\n"
      "yes: true\n"
      "whole: 42\n");
  EXPECT_EQ(root.at("a").at("b").text(), "text");
  EXPECT_EQ(root.at("a").at("c d").number(), -2500.0);
  EXPECT_EQ(root.at("list").numbers(), (std::vector<double>{1, 2, 3.5}));
  EXPECT_EQ(root.at("names").texts(), (std::vector<std::string>{"x", "y"}));
  EXPECT_TRUE(root.at("yes").boolean());
  EXPECT_EQ(root.at("whole").integer(), 42);
  EXPECT_EQ(root.find("none"), nullptr);
}

TEST(Yaml, ErrorsNameFileLineAndKey) {
  const YamlNode root = parse(
      "a:\n"
      "  b: text\n"
      "  n: 12x\n"
      "  list:\n"
      "    - 1\n"
      "    - .nan\n"
      "  quoted: '1'\n"
      "  empty:\n"
      "  long: 1.5\n");
  const YamlNode& a = root.at("a");
  const auto expect = [](const std::string& place, const auto& call) {
    const std::string message = refusal(call);
    EXPECT_TRUE(message.starts_with("f.yaml:" + place)) << message;
  };
  expect("2: a.b: ", [&] { return a.at("b").number(); });
  expect("3: a.n: ", [&] { return a.at("n").integer(); });
  expect("6: a.list[1]: ", [&] { return a.at("list").numbers(); });
  expect("7: a.quoted: ", [&] { return a.at("quoted").number(); });
  expect("8: a.empty: ", [&] { return a.at("empty").texts(); });
  expect("9: a.long: ", [&] { return a.at("long").integer(); });
  expect("2: a.b: ", [&] { return a.at("b").boolean(); });
  expect("1: a: ", [&] { return a.text(); });
  expect("1: a: key 'missing'", [&] { return a.at("missing"); });
  expect("4: a.list: unknown key", [&] { a.allow_only({"b", "n"}); });
  expect("2: a.b: ", [&] { return a.at("b").at("c"); });
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
                       parse);
  const YamlNode zero = parse("a: \"x\\0y\"\n");
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
    EXPECT_HAS(refusal([&] { return parse(many); }), "f.yaml: has more than 1000000 lines");
  }
  std::string keys;
  for (int i = 0; i < 100'000; ++i) keys += std::to_string(i) + ": 1\n";
  EXPECT_EQ(parse(keys).entries().size(), 100'000U);
  EXPECT_HAS(refusal([&] { return parse(keys + "5: 1\n"); }), "f.yaml:100001: key '5'");
}

TEST(Yaml, SurvivesDamage) {
  const std::string sample =
      "robot:\n"
      "  urdf: \"robot.urdf\"   # comment\n"
      "  packages: {a: b, 'c': [1, 2]}\n"
      "camera:\n"
      "  pose: |\n"
      "    text\n"
      "  range: [0.3, !!float 3]\n"
      "  ? x\n"
      "  : - 1\n"
      "    - ~\n";
  ASSERT_NO_THROW(parse(sample));
  test::read_damaged(sample, test::is_full_run() ? 100'000 : 5000, parse);
}

}  // namespace
}  // namespace penumbra::io
