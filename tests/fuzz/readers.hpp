// SPDX-License-Identifier: Apache-2.0
// The readers of bytes that others wrote. Each is a program of libFuzzer (fuzzer.cpp) and a test
// (corpus_test.cpp). seeds/NAME/ holds its good files and the bad ones that once were misread;
// dictionaries/NAME.dict, where there is one, the words of its format.
#pragma once

#include "../support/temporary_folder.hpp"

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::fuzz {

struct Reader {
  std::string name;
  /// Throws InputError for bytes that it refuses. Anything else that it throws is a bug.
  std::function<void(std::string_view)> read;
  int trials = 2000;  ///< of the test; fewer of a slow one
  /// It asks for less at once: more than any seed takes, and less than any lie in a header wants.
  /// Few bytes of RVL may be of any image of up to 2^24 depths.
  std::size_t large_memory = std::size_t{64} << 20U;
};

inline std::vector<Reader>& readers() {
  static std::vector<Reader> all;
  return all;
}

/// Adds readers before main().
struct Added {
  explicit Added(const std::vector<Reader>& more) {
    readers().insert(readers().end(), more.begin(), more.end());
  }
};

/// Where bytes become a file, next to the files that they may name.
inline const test::TemporaryFolder& folder() {
  static const test::TemporaryFolder own;
  return own;
}
inline std::filesystem::path file(const std::string& name, std::string_view bytes) {
  return folder().write(name, bytes);
}

/// Throws, which is a bug found, unless a reader keeps its promise.
inline void require(bool is_kept, const char* promise) {
  if (!is_kept) throw std::logic_error(promise);
}

}  // namespace penumbra::fuzz
