// SPDX-License-Identifier: Apache-2.0
// libFuzzer on damage to an SQLite bag: each four bytes are a place in a sound file, in three, and
// what stands there then. Files of its own making would seldom pass SQLite's header.
#include "../support/temporary_folder.hpp"
#include "bag_files.hpp"
#include "memory_file.hpp"

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>

namespace {

using namespace penumbra;

std::string sound_bag() {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "sound.db3";
  {
    test::BagDatabase bag(file);
    bag.make_tables(true);
    bag.topic(1, "/a", "std_msgs/msg/String");
    bag.topic(2, "/b", "sensor_msgs/msg/JointState");
    // On overflow pages and in the middle of others.
    for (int i = 0; i < 40; ++i)
      bag.message(1 + i % 2, 1000 * i, std::string(i % 10 == 0 ? 6000 : 60, 'x'));
  }
  return test::read_bytes(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  static const std::string sound = sound_bag();
  static volatile std::byte seen;
  std::string damaged = sound;
  for (std::size_t i = 0; i + 4 <= count; i += 4) {
    const std::size_t place =
        bytes[i] | std::size_t{bytes[i + 1]} << 8 | std::size_t{bytes[i + 2]} << 16;
    damaged[place % damaged.size()] = static_cast<char>(bytes[i + 3]);
  }
  try {
    const test::MemoryFile file(damaged);
    const auto bag = io::open_sqlite_bag(file.path());
    for (io::BagMessage message; bag->next(message);) {
      if (message.topic >= bag->topics().size()) std::abort();
      for (const std::byte b : message.data) seen = b;
    }
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
