// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader that has this program's name.
#include "readers.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include <penumbra/base/error.hpp>

namespace {
const penumbra::fuzz::Reader* reader = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int* /*count*/, char*** words) {
  const auto& all = penumbra::fuzz::readers();
  const std::string name = std::filesystem::path(**words).filename();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  if (found != all.end()) {
    reader = &*found;
    return 0;
  }
  for (const auto& one : all) std::puts(one.name.c_str());
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  try {
    reader->read({reinterpret_cast<const char*>(bytes), count});
  } catch (const penumbra::InputError&) {
    return 0;
  }
  return 0;
}
