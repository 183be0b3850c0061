// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <system_error>
#include <vector>

#include <io/bag/bag_file.hpp>

namespace penumbra::io {

bool is_zstd_file(const std::filesystem::path& file) {
  return file.extension() == ".zstd" || file.extension() == ".zst";
}

bool is_bag_file(const std::filesystem::path& file) {
  const std::filesystem::path name = is_zstd_file(file) ? file.stem() : file;
  // *.bag is of ROS 1, which open_bag() says.
  return name.extension() == ".mcap" || name.extension() == ".db3" || file.extension() == ".bag";
}

std::vector<std::filesystem::path> bags_in(const std::filesystem::path& folder,
                                           std::error_code& fault) {
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator entry(folder, fault), end; !fault && entry != end;
       entry.increment(fault))
    if (is_bag_file(entry->path())) files.push_back(entry->path());
  // A bag that somebody decompressed is read once.
  std::erase_if(files, [&](const std::filesystem::path& file) {
    return is_zstd_file(file) &&
           std::find(files.begin(), files.end(), file.parent_path() / file.stem()) != files.end();
  });
  return files;
}

bool is_bag_folder(const std::filesystem::path& folder) {
  std::error_code fault;
  if (std::filesystem::exists(folder / "recording.yaml", fault)) return false;
  if (std::filesystem::exists(folder / "metadata.yaml", fault)) return true;
  return !bags_in(folder, fault).empty();
}

}  // namespace penumbra::io
