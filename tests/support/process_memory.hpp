// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace penumbra::test {

/// Reads a value of /proc for a process: "self" or its number.
struct ProcessMemory {
  double resident = 0.0;  ///< MiB
  std::size_t open_files = 0;
};

inline ProcessMemory memory_of(const std::string& process = "self") {
  const std::filesystem::path proc = "/proc/" + process;
  std::string all;
  double pages = 0;
  std::ifstream(proc / "statm") >> all >> pages;
  const std::filesystem::directory_iterator files(proc / "fd"), none;
  return {pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20),
          static_cast<std::size_t>(std::distance(files, none))};
}

}  // namespace penumbra::test
