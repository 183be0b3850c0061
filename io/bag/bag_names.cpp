// SPDX-License-Identifier: Apache-2.0
#include <system_error>
#include <vector>

#include <io/bag/bag_file.hpp>

namespace penumbra::io {

bool is_bag_file(const std::filesystem::path& file) {
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

std::vector<std::filesystem::path> bags_in(const std::filesystem::path& folder,
                                           std::error_code& fault) {
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator entry(folder, fault), end; !fault && entry != end;
       entry.increment(fault))
    if (is_bag_file(entry->path())) files.push_back(entry->path());
  return files;
}

bool is_bag_folder(const std::filesystem::path& folder) {
  std::error_code fault;
  if (std::filesystem::exists(folder / "recording.yaml", fault)) return false;
  if (std::filesystem::exists(folder / "metadata.yaml", fault)) return true;
  return !bags_in(folder, fault).empty();
}

}  // namespace penumbra::io
