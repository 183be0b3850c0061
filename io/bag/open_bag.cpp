// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {

bool is_bag_file(const std::filesystem::path& file) {
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

std::unique_ptr<BagReader> open_bag_file(const std::filesystem::path& file) {
  if (file.extension() == ".mcap") return open_mcap_bag(file);
  if (file.extension() == ".db3") return open_sqlite_bag(file);
  if (file.extension() == ".zstd")
    throw InputError(file.string() +
                     ": is compressed as a whole; 'zstd -d --rm' makes it readable");
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw InputError(file.string() + ": cannot be read: No such file or directory");
  throw InputError(file.string() +
                   ": is not a bag; *.mcap, *.db3 and folders with a metadata.yaml are");
}

std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return open_bag_folder(path);
  return open_bag_file(path);
}

std::string definition_or_built_in(std::string_view type, std::string_view encoding,
                                   std::string_view text) {
  if (encoding == "ros2msg" && !text.empty()) return std::string(text);
  return std::string(definition_of(type));
}

}  // namespace penumbra::io
