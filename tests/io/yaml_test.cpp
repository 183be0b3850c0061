// SPDX-License-Identifier: Apache-2.0
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "files.hpp"

#include <chrono>
#include <random>

#include <gtest/gtest.h>

#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

using test::input_error;

YamlNode parse(const std::string& text) { return YamlNode::parse(text, "f.yaml"); }

std::string fault(const std::string& text) {
  return input_error([&] { static_cast<void>(parse(text)); });
}

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
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("b").number()); }),
            "f.yaml:2: a.b: is 'text'; a finite number is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("n").integer()); }),
            "f.yaml:3: a.n: is '12x'; a whole number is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("list").numbers()); }),
            "f.yaml:6: a.list[1]: is '.nan'; a finite number is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("list").numbers(3)); }),
            "f.yaml:6: a.list[1]: is '.nan'; a finite number is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("quoted").number()); }),
            "f.yaml:7: a.quoted: is '1'; a finite number is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("empty").texts()); }),
            "f.yaml:8: a.empty: is empty; a list is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("long").integer()); }),
            "f.yaml:9: a.long: is '1.5'; a whole number is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("b").boolean()); }),
            "f.yaml:2: a.b: is 'text'; true or false is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.text()); }),
            "f.yaml:1: a: is a map; a text is wanted");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("missing")); }),
            "f.yaml:1: a: key 'missing' is missing");
  EXPECT_EQ(input_error([&] {
              a.allow_only({"b", "n"});
            }),
            "f.yaml:4: a.list: unknown key; known are: b, n");
  EXPECT_EQ(input_error([&] { static_cast<void>(a.at("b").at("c")); }),
            "f.yaml:2: a.b: is 'text'; keys with values are wanted");
}

TEST(Yaml, ReadsEveryDocument) {
  const auto documents = YamlNode::parse_all("a: 1\n---\nb: 2\n---\n", "f.yaml");
  ASSERT_EQ(documents.size(), 3U);
  EXPECT_EQ(documents[0].at("a").integer(), 1);
  EXPECT_EQ(documents[1].at("b").integer(), 2);
  EXPECT_TRUE(documents[2].is_null());
  EXPECT_EQ(input_error([&] { static_cast<void>(documents[1].at("b").boolean()); }),
            "f.yaml:3: b: is '2'; true or false is wanted");
  EXPECT_HAS(input_error([] { static_cast<void>(YamlNode::parse_all("", "f.yaml")); }), "is empty");
}

TEST(Yaml, RefusesWhatItCannotBeSureOf) {
  EXPECT_EQ(fault("a: 1\nb: 2\na: 3\n"), "f.yaml:3: key 'a' is there already, in line 1; keep one");
  EXPECT_HAS(fault("a: &x 1\nb: *x\n"), "f.yaml:2: aliases (*name) are not read");
  EXPECT_HAS(fault("a: 1\n---\nb: 1\n"), "more than one document");
  EXPECT_HAS(fault(""), "is empty");
  EXPECT_HAS(fault("# only a comment\n"), "is empty");
  for (const char* stray : {"]", "}", "a: 1\n]\n", "a: 1\n---\n}\n", "- 1\n, 2\n"})
    EXPECT_HAS(input_error([&] { static_cast<void>(YamlNode::parse_all(stray, "f.yaml")); }),
               "is not YAML");
  EXPECT_HAS(fault("a: [1, 2\nb: 3\n"), "f.yaml:");
  EXPECT_HAS(fault("a: b: c\n"), "is not YAML");
  EXPECT_HAS(fault("? [1, 2]\n: 3\n"), "a key must be a plain text");
  EXPECT_HAS(fault("a: " + std::string(17, '[') + std::string(17, ']')),
             "nested more than 16 deep");
  for (const char* opening : {"[", "{", "- ", "? ", "a: [", "{a: "}) {
    std::string deep;
    for (int i = 0; i < 20000; ++i) deep += opening;
    EXPECT_HAS(fault(deep), "f.yaml:");
  }
  const YamlNode zero = parse("a: \"x\\0y\"\n");
  EXPECT_HAS(input_error([&] { static_cast<void>(zero.at("a").text()); }), "character 0");
}

TEST(Yaml, BoundsItsWork) {
  const test::TemporaryFolder folder;
  EXPECT_HAS(
      input_error([&] {
        static_cast<void>(YamlNode::read(folder.write("big.yaml", std::string(20000000, '#'))));
      }),
      "big.yaml: has 20000000 bytes");
  for (const char* part : {"[", "[],", "{a: 1},", "- ", "? ", "a:\n"}) {
    std::string many;
    for (int i = 0; i < 1'000'001; ++i) many += part;
    EXPECT_HAS(fault(many), "f.yaml: has more than 1000000 lines");
  }
  EXPECT_HAS(input_error([&] { static_cast<void>(YamlNode::read(folder.path() / "none.yaml")); }),
             "none.yaml: cannot be read: No such file or directory");
}

/// Frames of an hour, and doubled keys among them. Were each key compared with all before it, this
/// would take minutes.
TEST(Yaml, ManyKeysTakeTimeByTheirNumberAlone) {
  constexpr int count = 100'000;
  constexpr double most_seconds = 30.0;  // of under one, on a busy machine and sanitized
  std::string keys;
  for (int i = 0; i < count; ++i) keys += std::to_string(i) + ": 1\n";
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(parse(keys).entries().size(), static_cast<std::size_t>(count));
  EXPECT_EQ(fault(keys + "5: 1\n"), "f.yaml:100001: key '5' is there already, in line 6; keep one");
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(time.count(), most_seconds);
  EXPECT_EQ(parse("a: {b: 1, c: {b: 2}}\nd: {b: 3}\n").at("a").at("c").at("b").integer(), 2);
}

constexpr const char* sample =
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

TEST(Yaml, SurvivesTruncation) {
  const std::string whole = sample;
  ASSERT_NO_THROW(static_cast<void>(parse(whole)));
  for (std::size_t length = 0; length < whole.size(); ++length)
    test::only_input_errors([&] { static_cast<void>(parse(whole.substr(0, length))); });
}

void survive_random_damage(int rounds) {
  std::mt19937_64 random = test::seeded_random(1);
  const std::string whole = sample;
  using namespace std::string_literals;
  const std::string special = "{}[]:,-?&*!|>'\"%@`#\n \t\0\\~<="s;
  for (int i = 0; i < rounds; ++i) {
    std::string damaged = whole;
    for (int n = 0; n < 1 + i % 6; ++n) {
      const std::size_t at = random() % damaged.size();
      const char c =
          random() % 2 == 0 ? special[random() % special.size()] : static_cast<char>(random());
      if (random() % 2 == 0)
        damaged[at] = c;
      else
        damaged.insert(at, 1, c);
    }
    test::only_input_errors([&] { static_cast<void>(parse(damaged)); });
  }
}

TEST(Yaml, SurvivesRandomDamage) { survive_random_damage(5000); }

TEST(YamlFull, SurvivesRandomDamage) {
  if (!test::is_full_run()) GTEST_SKIP() << "skipped: PENUMBRA_FULL is not set";
  survive_random_damage(100000);
}

}  // namespace
}  // namespace penumbra::io
