// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <fstream>
#include <system_error>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

namespace penumbra {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError(file.string() + ": " + why);
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& file, std::uint64_t most_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (error) refuse(file, "cannot be read: " + error.message());
  if (std::filesystem::is_directory(status)) refuse(file, "is a folder; name a file inside it");
  if (!std::filesystem::is_regular_file(status)) refuse(file, "is not a regular file");
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (error) refuse(file, "cannot be read: " + error.message());
  if (size > most_bytes)
    refuse(file, "has " + std::to_string(size) + " bytes, the limit is " +
                     std::to_string(most_bytes) + "; check that it is the right file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(file, "cannot be read: " + std::generic_category().message(errno));
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uint64_t>(stream.gcount()) != size)
    refuse(file, "cannot be read to its end; check the disk");
  return bytes;
}

}  // namespace penumbra
