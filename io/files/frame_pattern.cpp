// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/base/error.hpp>

#include <io/files/frame_pattern.hpp>
#include <io/files/numbers.hpp>
#include <io/files/video_file.hpp>

namespace penumbra::io {

FramePattern::FramePattern(std::string_view pattern, const std::filesystem::path& folder)
    : folder_(folder) {
  const std::string fault = "'" + std::string(pattern) +
                            "': one %d or %0Nd (N from 1 to 9) is needed for the frame's "
                            "number; a percent sign is written %%. Or name a video, as color.mp4";
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
  is_video_ = !found && is_video_name(before_);
  if (!found && !is_video_) throw InputError(fault);
}

std::string FramePattern::written(std::int64_t index) const {
  std::string number = std::to_string(index);
  if (number.size() < digits_) number.insert(0, digits_ - number.size(), '0');
  return number;
}

std::filesystem::path FramePattern::file(std::int64_t index) const {
  return folder_ / (is_video_ ? before_ : before_ + written(index) + after_);
}

/// Returns the text before the number in the part of the path that has it.
std::string_view FramePattern::name_before() const {
  return std::string_view(before_).substr(before_.rfind('/') + 1);  // all of it without a slash
}

FramePattern FramePattern::moved_to(const std::filesystem::path& folder) const {
  if (after_.find('/') != std::string::npos)
    throw InputError(file(0).string() +
                     ": the number is in the name of a folder; expected it in the file's name");
  FramePattern moved = *this;
  moved.folder_ = folder;
  moved.before_ = name_before();
  return moved;
}

bool FramePattern::makes(std::string_view name) const {
  return index(name, name_before(), after_).has_value();
}

std::optional<std::int64_t> FramePattern::index(std::string_view name, std::string_view before,
                                                std::string_view after) const {
  if (name.size() < before.size() + after.size()) return std::nullopt;
  if (!name.starts_with(before) || !name.ends_with(after)) return std::nullopt;
  const std::string_view number =
      name.substr(before.size(), name.size() - before.size() - after.size());
  const auto index = parse_number<std::int64_t>(number);
  if (!index || *index < 0 || written(*index) != number) return std::nullopt;
  return index;
}

std::vector<std::int64_t> FramePattern::existing() const {
  // The number may be in a folder's name: only that part of the path varies.
  const std::string_view before = name_before();
  const std::string_view after = std::string_view(after_).substr(0, after_.find('/'));
  std::filesystem::path parent = folder_ / before_.substr(0, before_.size() - before.size());
  if (parent.empty()) parent = ".";
  std::vector<std::int64_t> indices;
  std::error_code error;
  if (!std::filesystem::is_directory(parent, error)) return indices;
  std::filesystem::directory_iterator entry(parent, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const auto found = index(entry->path().filename().string(), before, after);
    std::error_code unknown;
    if (found && std::filesystem::exists(file(*found), unknown)) indices.push_back(*found);
  }
  if (error)
    throw InputError(parent.string() + ": cannot be listed (" + error.message() +
                     "); the frames in it must be known");
  std::sort(indices.begin(), indices.end());
  return indices;
}

}  // namespace penumbra::io
