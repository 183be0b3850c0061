// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>

namespace penumbra::test {

inline ::testing::AssertionResult holds(std::string_view text, std::string_view part) {
  if (text.find(part) != std::string_view::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << '"' << part << "\" is not in: " << text;
}

inline ::testing::AssertionResult holds(std::string_view text,
                                        std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts)
    if (const auto one = holds(text, part); !one) return one;
  return ::testing::AssertionSuccess();
}

/// Returns the message of the InputError that a call throws, or "" if it throws none. Fails the
/// test if the message is empty, has more than one line or an escape sequence.
template <typename Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    std::string message = error.what();
    EXPECT_FALSE(message.empty());
    EXPECT_EQ(message.find_first_of("\n\r\x1b"), std::string::npos) << message;
    return message;
  }
  return "";
}

/// Like refusal(), and fails the test if the call throws no InputError.
template <typename Call>
std::string message_of(Call&& call) {
  std::string message = refusal(call);
  EXPECT_NE(message, "") << "no InputError";
  return message;
}

/// Expects an InputError whose message holds all parts: the file, the element, the remedy.
template <std::invocable Call>
void expect_refused(Call&& call, std::initializer_list<std::string_view> parts) {
  EXPECT_TRUE(holds(message_of(call), parts));
}

}  // namespace penumbra::test
