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

}  // namespace penumbra::test
