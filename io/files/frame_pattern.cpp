// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/frame_pattern.hpp>
#include <io/files/numbers.hpp>
#include <io/files/video_file.hpp>

namespace penumbra::io {
namespace {

constexpr std::int64_t one_second = 1'000'000'000, one_ms = 1'000'000;

/// Returns the nanoseconds of a name: seconds with a point, or a whole number of `unit`.
std::optional<std::int64_t> time_in(std::string_view text, std::int64_t unit) {
  constexpr std::size_t most_digits = 9;
  const std::size_t point = text.find('.');
  std::string_view fraction;
  if (point != std::string_view::npos) {
    fraction = text.substr(point + 1);
    if (fraction.empty() || fraction.size() > most_digits) return std::nullopt;
    unit = one_second;
  }
  const std::string digits(text.substr(0, point));
  if (digits.find_first_not_of("0123456789") != std::string::npos ||
      fraction.find_first_not_of("0123456789") != std::string_view::npos)
    return std::nullopt;
  const auto whole = parse_number<std::int64_t>(digits);
  if (!whole || *whole >= std::numeric_limits<std::int64_t>::max() / unit) return std::nullopt;
  std::string nanoseconds(fraction);
  nanoseconds.resize(most_digits, '0');
  return *whole * unit + parse_number<std::int64_t>(nanoseconds).value_or(0);
}

/// A file whose name is a time, and the frame of the nearest stamp.
struct TimedFile {
  std::string text;
  std::int64_t frame = 0, difference = 0;  // nanoseconds
  [[nodiscard]] bool fits() const { return difference < one_ms; }
};

/// Returns the files by their times in this unit; texts that are no time are left out.
std::vector<TimedFile> timed(const std::vector<std::string>& texts, std::int64_t unit,
                             const std::vector<std::pair<std::int64_t, std::int64_t>>& frames) {
  std::multimap<std::int64_t, TimedFile> files;
  for (const std::string& text : texts) {
    const auto time = time_in(text, unit);
    if (!time) continue;
    TimedFile file{text, 0, std::numeric_limits<std::int64_t>::max()};
    const auto next =
        std::lower_bound(frames.begin(), frames.end(), std::pair(*time, std::int64_t{0}));
    for (auto at = next == frames.begin() ? next : next - 1; at != frames.end(); ++at) {
      if (const auto away = std::abs(at->first - *time); away < file.difference)
        file = {text, at->second, away};
      if (at >= next) break;
    }
    files.emplace(*time, std::move(file));
  }
  std::vector<TimedFile> sorted;
  for (auto& [time, file] : files) sorted.push_back(std::move(file));
  return sorted;
}

}  // namespace

FramePattern::FramePattern(std::string_view pattern, const std::filesystem::path& folder,
                           const std::optional<FrameStamps>& stamps)
    : folder_(folder) {
  const std::string fault = "'" + std::string(pattern) +
                            "': one %d or %0Nd (N from 1 to 9) is needed for the frame's "
                            "number, or %t for its stamp; a percent sign is written %%. Or name a "
                            "video, as color.mp4";
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
    } else if (!found && rest.starts_with('t')) {
      found = is_by_time_ = true;
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
  if (!is_by_time_) return;
  if (!stamps)
    throw InputError("'" + std::string(pattern) +
                     "': %t is for the images and clouds of a recording; name these files by the "
                     "frames' numbers (%d)");
  match(*stamps);
}

void FramePattern::match(const FrameStamps& stamps) {
  std::vector<std::pair<std::int64_t, std::int64_t>> frames;  // stamp and number
  for (const auto& [frame, stamp] : stamps) frames.emplace_back(stamp, frame);
  std::sort(frames.begin(), frames.end());
  const std::vector<std::string> all = texts();
  std::vector<TimedFile> files;
  const auto fitting = [](const std::vector<TimedFile>& of) {
    return std::count_if(of.begin(), of.end(), [](const TimedFile& file) { return file.fits(); });
  };
  for (const std::int64_t unit : {std::int64_t{1}, std::int64_t{1000}, one_ms})
    if (auto found = timed(all, unit, frames); fitting(found) > fitting(files) || files.empty())
      files = std::move(found);
  if (files.empty()) return;
  if (fitting(files) == 0)
    fault_ = (frames.empty() ? "the joint file has no stamps"
                             : "no stamp of the joint file is the time of one of the " +
                                   std::to_string(files.size()) + " files") +
             "; it needs a row for each file, with the file's time in the column stamp "
             "(nanoseconds)";
  std::map<std::int64_t, std::int64_t> differences;  // of the file that a frame has so far
  std::vector<std::string> others;
  for (const TimedFile& file : files) {
    const auto [before, is_first] = differences.try_emplace(file.frame, file.difference);
    if (!file.fits() || (!is_first && before->second <= file.difference)) {
      if (is_first) differences.erase(before);
      others.push_back(file.text);
      continue;
    }
    before->second = file.difference;
    others.push_back(std::exchange(names_[file.frame], file.text));
  }
  std::int64_t next = stamps.empty() ? -1 : stamps.rbegin()->first;
  for (std::string& text : others)
    if (!text.empty() && next < std::numeric_limits<std::int64_t>::max() - 1)
      names_[++next] = std::move(text);
}

std::string FramePattern::written(std::int64_t index) const {
  if (is_by_time_) {
    const auto name = names_.find(index);
    return name != names_.end() ? name->second : "<time of frame " + std::to_string(index) + ">";
  }
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
  const auto text = between(name, name_before(), after_);
  return text && index(*text);
}

std::optional<std::string_view> FramePattern::between(std::string_view name,
                                                      std::string_view before,
                                                      std::string_view after) {
  if (name.size() < before.size() + after.size()) return std::nullopt;
  if (!name.starts_with(before) || !name.ends_with(after)) return std::nullopt;
  return name.substr(before.size(), name.size() - before.size() - after.size());
}

std::optional<std::int64_t> FramePattern::index(std::string_view text) const {
  if (is_by_time_) {
    for (const auto& [frame, name] : names_)
      if (name == text) return frame;
    return std::nullopt;
  }
  const auto index = parse_number<std::int64_t>(text);
  if (!index || *index < 0 || written(*index) != text) return std::nullopt;
  return index;
}

std::vector<std::string> FramePattern::texts() const {
  // The number may be in a folder's name: only that part of the path varies.
  const std::string_view before = name_before();
  const std::string_view after = std::string_view(after_).substr(0, after_.find('/'));
  std::filesystem::path parent = folder_ / before_.substr(0, before_.size() - before.size());
  if (parent.empty()) parent = ".";
  std::vector<std::string> found;
  std::error_code error;
  if (!std::filesystem::is_directory(parent, error)) return found;
  std::filesystem::directory_iterator entry(parent, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const auto text = between(name, before, after);
    std::error_code unknown;
    if (text && std::filesystem::exists(folder_ / (before_ + std::string(*text) + after_), unknown))
      found.emplace_back(*text);
  }
  if (error)
    throw InputError(parent.string() + ": cannot be listed (" + error.message() +
                     "); the frames in it must be known");
  return found;
}

std::vector<std::int64_t> FramePattern::existing() const {
  std::vector<std::int64_t> indices;
  if (is_by_time_)
    for (const auto& [frame, name] : names_) indices.push_back(frame);
  else
    for (const std::string& text : texts())
      if (const auto found = index(text)) indices.push_back(*found);
  std::sort(indices.begin(), indices.end());
  return indices;
}

}  // namespace penumbra::io
