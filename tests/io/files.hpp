// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/temporary_folder.hpp"

#include <string>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>

namespace penumbra::test {

/// The message of the InputError that `call` throws; it must be one line.
template <typename F>
std::string input_error(const F& call) {
  try {
    call();
  } catch (const InputError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

/// Runs `call`; what it throws must be an InputError.
template <typename F>
void only_input_errors(const F& call) {
  try {
    call();
  } catch (const InputError&) {
  }
}

}  // namespace penumbra::test

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)
