// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <io/files/disk_file.hpp>

namespace penumbra::io {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void throw_unwritable(const std::filesystem::path& file, int error) {
  throw InputError(file.string() + ": cannot be written: " + reason(error));
}

}  // namespace

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FileResult InputFile::open(const std::filesystem::path& file) {
  // Without O_NONBLOCK, opening a pipe would wait for its writer.
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    const FileStatus status = errno == ENOENT ? FileStatus::missing : FileStatus::bad;
    return {status, file.string() + ": cannot be read: " + reason(errno)};
  }
  struct stat info = {};
  if (::fstat(descriptor_, &info) != 0 || !S_ISREG(info.st_mode))
    return FileResult::bad(file, "is not a regular file");
  size_ = static_cast<std::uint64_t>(info.st_size);
  return {};
}

std::size_t InputFile::read(void* to, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::read(descriptor_, static_cast<char*>(to) + done, count - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::size_t InputFile::read_at(std::uint64_t offset, void* to, std::size_t count) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor_, static_cast<char*>(to) + done, count - done,
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

OutputFile::OutputFile(const std::filesystem::path& file)
    : file_(file),
      descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw_unwritable(file_, errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(const void* from, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const ssize_t put = ::write(descriptor_, static_cast<const char*>(from) + done, count - done);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_unwritable(file_, errno);
    done += static_cast<std::size_t>(put);
  }
}

void OutputFile::close() {
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) throw_unwritable(file_, errno);
}

void write_file(const std::filesystem::path& file, const void* from, std::size_t count) {
  OutputFile output(file);
  output.write(from, count);
  output.close();
}

}  // namespace penumbra::io
