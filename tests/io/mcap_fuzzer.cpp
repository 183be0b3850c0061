// SPDX-License-Identifier: Apache-2.0
// libFuzzer on MCAP files: whatever the bytes, each message lies in memory that may be read, and
// the file is read to its end.
#include "memory_file.hpp"

#include <penumbra/base/error.hpp>

#include <io/mcap/reader.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  static volatile std::byte seen;
  const penumbra::test::MemoryFile file(bytes, count);
  try {
    penumbra::io::mcap::Reader reader(file.path());
    for (penumbra::io::mcap::Message message; reader.next(message);) {
      if (!reader.channels().contains(message.channel) || message.log_time < 0) std::abort();
      for (const std::byte b : message.data) seen = b;
    }
  } catch (const penumbra::InputError&) {
    return 0;
  }
  return 0;
}
