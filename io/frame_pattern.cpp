// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include <penumbra/base/error.hpp>

#include <io/frame_pattern.hpp>

namespace penumbra::io {

FramePattern::FramePattern(std::string_view pattern, const std::filesystem::path& folder)
    : folder_(folder) {
  const std::string fault = "'" + std::string(pattern) +
                            "': exactly one %d or %0Nd (N from 1 to 9) must stand for the frame's "
                            "number; a percent sign is written %%";
  bool found = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    std::string& part = found ? after_ : before_;
    const std::string_view rest = pattern.substr(i + 1);
    if (pattern[i] != '%') {
      part += pattern[i];
    } else if (rest.starts_with('%')) {
      part += '%';
      ++i;
    } else if (!found && rest.starts_with('d')) {
      found = true;
      ++i;
    } else if (!found && rest.size() >= 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' &&
               rest[2] == 'd') {
      found = true;
      digits_ = static_cast<std::size_t>(rest[1] - '0');
      i += 3;
    } else {
      throw InputError(fault);
    }
  }
  if (!found) throw InputError(fault);
}

std::filesystem::path FramePattern::file(std::int64_t index) const {
  std::string number = std::to_string(index);
  if (number.size() < digits_) number.insert(0, digits_ - number.size(), '0');
  return folder_ / (before_ + number + after_);
}

bool FramePattern::has_extension(std::string_view extension) const {
  return after_.size() >= extension.size() &&
         std::equal(extension.rbegin(), extension.rend(), after_.rbegin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) ==
                  std::tolower(static_cast<unsigned char>(b));
         });
}

}  // namespace penumbra::io
