// SPDX-License-Identifier: Apache-2.0
#include "../support/random.hpp"
#include "random_robot.hpp"

#include <string>

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <penumbra/robot/glob-inl.hpp>

namespace penumbra::test {
namespace {

using detail::glob_match;

// A star, a question mark, a letter, or a set of up to three members and ranges.
std::string random_item(Random& random) {
  const std::string letters = "abc-]";
  if (below(random, 4) != 0) return std::string(1, "ab*?*c-"[below(random, 7)]);
  std::string set = below(random, 2) == 0 ? "[" : below(random, 2) == 0 ? "[!" : "[^";
  if (below(random, 4) == 0) set += ']';
  for (std::size_t n = 1 + below(random, 2); n > 0; --n)
    set += below(random, 2) == 0 ? "a-b" : std::string(1, letters[below(random, 4)]);
  return set + "]";
}

// The C library's matcher as the oracle.
TEST(Glob, AgreesWithFnmatch) {
  Random random = seeded_random(6);
  for (int trial = 0; trial < 200000; ++trial) {
    std::string pattern;
    std::string text;
    for (std::size_t n = below(random, 5); n > 0; --n) pattern += random_item(random);
    for (std::size_t n = below(random, 6); n > 0; --n) text += "abc-]"[below(random, 5)];
    const bool expected = ::fnmatch(pattern.c_str(), text.c_str(), FNM_NOESCAPE) == 0;
    ASSERT_EQ(glob_match(pattern, text), expected) << pattern << " on " << text;
  }
}

TEST(Glob, ManyStarsTakeNoTime) {
  std::string pattern;
  for (int i = 0; i < 200; ++i) pattern += "*a";
  EXPECT_FALSE(glob_match(pattern + "b", std::string(2000, 'a')));
}

}  // namespace
}  // namespace penumbra::test
