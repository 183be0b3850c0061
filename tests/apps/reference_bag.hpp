// SPDX-License-Identifier: Apache-2.0
// Bags as the reference library of MCAP reads them.
#pragma once

#include "../support/node_scripts.hpp"
#include "program.hpp"

#include <cstdio>
#include <span>
#include <sstream>

#include <io/mcap/compression.hpp>

namespace penumbra::test {

/// What decode.mjs says of an array of such bytes.
template <typename T>
Json array_of(const T& values) {
  const auto bytes = std::as_bytes(std::span(values.data(), values.size()));
  char crc[9];
  std::snprintf(crc, sizeof crc, "%08x", io::mcap::crc32(bytes));
  return {{"length", bytes.size()}, {"crc", crc}};
}

/// What decode.mjs says of each message of a bag.
inline std::vector<Json> decoded_messages(const fs::path& bag) {
  const ScriptResult checked = run_script("read_back.mjs", "'" + bag.string() + "'");
  EXPECT_EQ(checked.status, 0) << checked.errors;
  const ScriptResult told = run_script("decode.mjs", "'" + bag.string() + "'");
  EXPECT_EQ(told.status, 0) << told.errors;
  std::vector<Json> messages;
  std::istringstream lines(told.output);
  for (std::string line; std::getline(lines, line);) messages.push_back(Json::parse(line));
  return messages;
}

}  // namespace penumbra::test
