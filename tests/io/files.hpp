// SPDX-License-Identifier: Apache-2.0
// What the tests of readers share: tables of bad input, and damage to good input.
#pragma once

#include "../support/errors.hpp"
#include "../support/pixels.hpp"
#include "../support/random.hpp"
#include "../support/temporary_folder.hpp"

#include <cstring>
#include <utility>

#include <penumbra/base/image.hpp>

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

namespace penumbra::test {

template <typename T, typename U>
bool same_pixels(ImageView<T> a, ImageView<U> b) {
  if (a.width != b.width || a.height != b.height) return false;
  for (int v = 0; v < b.height; ++v)
    if (std::memcmp(a.row(v), b.row(v), sizeof(T) * static_cast<std::size_t>(b.width)) != 0)
      return false;
  return true;
}

/// Returns the bytes of numbers, one after the other.
template <typename... T>
std::string raw(T... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

/// Returns the text with one piece of it, which must be there, replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_HAS(text, from);
  return text.replace(text.find(from), from.size(), to);
}

/// Input, and what the one line of its error must name.
using BadInputs = std::initializer_list<std::pair<std::string, std::string>>;

template <class Read>
void expect_refused(const BadInputs& inputs, const Read& read) {
  for (const auto& [input, named] : inputs) {
    const std::string message = refusal([&, &text = input] { read(text); });
    EXPECT_NE(message, "") << "read: " << input;
    EXPECT_HAS(message, named) << input;
  }
}

/// Calls `read` with each beginning of `whole` and with random edits of it. Only an InputError may
/// come of it.
template <class Read>
void read_damaged(const std::string& whole, int rounds, const Read& read) {
  using namespace std::string_literals;
  const std::string special = "0123456789.-+eE:[]{},#&*!|>'\"%@`\n\r\t ~?=\\<\xff\x01\x1b\0"s;
  for (std::size_t length = 0; length < whole.size(); ++length)
    refusal([&] { read(whole.substr(0, length)); });
  std::mt19937_64 random = seeded_random(31);
  for (int i = 0; i < rounds; ++i) {
    std::string text = whole;
    for (std::size_t edits = 1 + random() % 5; edits > 0 && !text.empty(); --edits) {
      const std::size_t at = random() % text.size();
      const char letter =
          random() % 2 == 0 ? special[random() % special.size()] : static_cast<char>(random());
      const std::uint64_t kind = random() % 6;
      if (kind == 0) text.erase(at, 1 + random() % 8);
      if (kind == 1) text.insert(at, 1, letter);
      if (kind > 1) text[at] = letter;
    }
    refusal([&] { read(text); });
  }
}

}  // namespace penumbra::test
