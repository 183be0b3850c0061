// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/mcap/file_window.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::size_t short_block = std::size_t{4} << 10;   // block size after a jump
constexpr std::size_t long_block = std::size_t{256} << 10;  // block size for sequential reading

}  // namespace

std::span<const std::byte> FileWindow::view(std::uint64_t offset, std::size_t count) {
  if (offset >= file_size()) return {};
  const std::uint64_t left = file_size() - offset;
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
  const std::uint64_t end = start_ + bytes_.size();
  if (offset < start_ || offset + count > end) {
    const bool goes_on = offset >= start_ && offset <= end;
    const std::size_t block = goes_on ? long_block : short_block;
    const std::uint64_t wanted = std::min<std::uint64_t>(std::max(count, block), left);
    bytes_.clear();
    bytes_.resize(static_cast<std::size_t>(wanted));
    start_ = offset;
    bytes_.resize(file_->read_at(offset, bytes_.data(), static_cast<std::size_t>(wanted)));
    count = std::min(count, bytes_.size());
  }
  return std::span<const std::byte>(bytes_).subspan(static_cast<std::size_t>(offset - start_),
                                                    count);
}

}  // namespace penumbra::io::mcap
