// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/temporary_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>

namespace penumbra::test {

inline std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Whether long tests are asked for.
inline bool full() { return std::getenv("PENUMBRA_FULL") != nullptr; }

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
