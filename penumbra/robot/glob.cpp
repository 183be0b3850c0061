// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <penumbra/robot/glob-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr std::size_t kNone = std::string_view::npos;

// Position of the ']' that closes the set at `open`; a ']' that comes first is a member.
std::size_t set_end(std::string_view pattern, std::size_t open) {
  std::size_t first = open + 1;
  if (first < pattern.size() && (pattern[first] == '!' || pattern[first] == '^')) ++first;
  return first < pattern.size() ? pattern.find(']', first + 1) : kNone;
}

bool in_set(std::string_view set, char c) {
  const bool negated = set.starts_with('!') || set.starts_with('^');
  if (negated) set.remove_prefix(1);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const bool range = i + 2 < set.size() && set[i + 1] == '-';
    const char last = range ? set[i + 2] : set[i];
    if (set[i] <= c && c <= last) return !negated;
    if (range) i += 2;
  }
  return negated;
}

// Length of the pattern's item at `p` if it matches c, else 0; not for '*'.
std::size_t match_one(std::string_view pattern, std::size_t p, char c) {
  if (pattern[p] == '?') return 1;
  if (pattern[p] == '[') {
    const std::size_t end = set_end(pattern, p);
    if (end != kNone) return in_set(pattern.substr(p + 1, end - p - 1), c) ? end - p + 1 : 0;
  }
  return pattern[p] == c ? 1 : 0;
}

}  // namespace

bool glob_match(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = kNone;  // the last '*' passed, and where its run ends so far
  std::size_t run_end = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      run_end = t;
      continue;
    }
    const std::size_t step = p < pattern.size() ? match_one(pattern, p, text[t]) : 0;
    if (step > 0) {
      p += step;
      ++t;
    } else if (star != kNone) {
      p = star + 1;
      t = ++run_end;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace penumbra::detail
