// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <penumbra/base/error.hpp>

#include <io/web/spool_file.hpp>

namespace penumbra::io {
namespace {

// The decompressor refuses larger blocks as decompression bombs.
constexpr std::size_t most_packed = std::size_t{48} << 20U;

std::filesystem::path temporary_folder() {
  const char* const named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/var/tmp";
}

[[noreturn]] void refuse(const std::filesystem::path& folder, int error) {
  throw InputError(folder.string() + ": has no room for the images of the frames (" +
                   std::generic_category().message(error) + "); name another folder by TMPDIR");
}

int open_unnamed(const std::filesystem::path& folder) {
  std::string name = (folder / "penumbra-view-XXXXXX").string();
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor >= 0) ::unlink(name.c_str());
  return descriptor;
}

}  // namespace

SpoolFile::SpoolFile() : folder_(temporary_folder()), descriptor_(open_unnamed(folder_)) {
  if (descriptor_ < 0) refuse(folder_, errno);
}

SpoolFile::~SpoolFile() { ::close(descriptor_); }

SpoolPlace SpoolFile::append(std::span<const std::byte> bytes, bool pack) {
  SpoolPlace place{.offset = end_, .stored = bytes.size(), .size = bytes.size()};
  if (pack && !bytes.empty() && bytes.size() <= most_packed) {
    compressor_.compress(bytes, packed_);
    bytes = packed_;
    place.stored = bytes.size();
    place.is_packed = true;
  }
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t put = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done,
                                 static_cast<off_t>(end_ + done));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) refuse(folder_, errno);
    done += static_cast<std::size_t>(put);
  }
  end_ += bytes.size();
  return place;
}

std::string SpoolFile::read(const SpoolPlace& place) const {
  std::string bytes(place.stored, '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(place.offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw std::runtime_error("the temporary file cannot be read");
    done += static_cast<std::size_t>(got);
  }
  if (!place.is_packed) return bytes;
  mcap::Decompressor decompressor;
  std::vector<std::byte> content;
  const std::string fault =
      decompressor.decompress("zstd", std::as_bytes(std::span(bytes)), place.size, content);
  if (!fault.empty()) throw std::runtime_error("the temporary file " + fault);
  return {reinterpret_cast<const char*>(content.data()), content.size()};
}

}  // namespace penumbra::io
