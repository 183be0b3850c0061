// SPDX-License-Identifier: Apache-2.0
// libFuzzer on SQLite bags.
#include "memory_file.hpp"

#include <cstdint>
#include <cstdlib>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  const penumbra::test::MemoryFile file(bytes, count);
  try {
    const auto bag = penumbra::io::open_sqlite_bag(file.path());
    unsigned sum = 0;
    for (penumbra::io::BagMessage message; bag->next(message);) {
      if (message.topic >= bag->topics().size()) std::abort();
      for (const std::byte b : message.data) sum += static_cast<unsigned>(b);
    }
    volatile unsigned kept = sum;
    static_cast<void>(kept);
  } catch (const penumbra::InputError&) {
    return 0;
  }
  return 0;
}
