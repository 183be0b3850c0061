// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>
#include <utility>

#include <io/files/statistics.hpp>

namespace penumbra::io {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view take_word(std::string_view& text) {
  const std::size_t end = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

/// A file's name, or a place before what is said of it: "depth/12.png:", "joints.csv:7:".
bool is_place(std::string_view word) {
  return word.find('/') != std::string_view::npos || word.ends_with(':');
}

bool is_same_without_digits(std::string_view a, std::string_view b) {
  const auto skip = [](std::string_view text, std::size_t i) {
    while (i < text.size() && is_digit(text[i])) ++i;
    return i;
  };
  for (std::size_t i = 0, j = 0;; ++i, ++j) {
    i = skip(a, i);
    j = skip(b, j);
    if (i == a.size() || j == b.size()) return i == a.size() && j == b.size();
    if (a[i] != b[j]) return false;
  }
}

/// Whether two messages say the same, of other files, lines or frames perhaps.
bool is_same_reason(std::string_view a, std::string_view b) {
  for (std::string_view before; !a.empty() && !b.empty();) {
    const std::string_view word = take_word(a);
    const std::string_view other = take_word(b);
    const bool may_differ = before == "frame" || (is_place(word) && is_place(other));
    if (word != other && !(may_differ && is_same_without_digits(word, other))) return false;
    before = word;
  }
  return a.empty() && b.empty();
}

}  // namespace

std::optional<Quantiles> quantiles(std::vector<double> samples) {
  if (samples.empty()) return std::nullopt;
  std::sort(samples.begin(), samples.end());
  const std::size_t n = samples.size();
  const std::size_t rank99 = (n * 99 + 99) / 100;  // ceil(0.99 n), from 1
  return Quantiles{samples.front(), 0.5 * (samples[(n - 1) / 2] + samples[n / 2]),
                   samples[rank99 - 1], samples.back()};
}

void Statistics::add(const FrameReport& report) {
  ++frames_;
  const PixelCounts& p = report.pixels;
  if (p.robot) pixels_.robot = pixels_.robot.value_or(0) + *p.robot;
  pixels_.front += p.front;
  pixels_.occluded += p.occluded;
  pixels_.unknown += p.unknown;
  pixels_.beyond += p.beyond;
  pixels_.fringe += p.fringe;
  pixels_.uncovered += p.uncovered;
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (const auto time = report.timing.*stages[i].time) times_[i].push_back(*time);

  if (report.status == FrameStatus::ok || report.status == FrameStatus::missing_link)
    ++usable_frames_;
  if (report.status != FrameStatus::ok) add_fault(report);
  for (std::size_t i = 0; i < report.targets.size(); ++i)
    add_target(report.targets[i], i, report.index);
}

/// `place`: among the frame's targets; most often they come in the same order.
void Statistics::add_target(const TargetReport& target, std::size_t place, std::size_t frame) {
  if (place >= targets_.size() || targets_[place].name != target.name) {
    const auto [known, is_new] =
        target_places_.try_emplace(std::string(target.name), targets_.size());
    if (is_new) targets_.emplace_back().name = target.name;
    place = known->second;
  }
  TargetStatistics& sum = targets_[place];
  if (target.verdict == Verdict::unknown && sum.frames(Verdict::unknown) == 0) {
    sum.reason = target.reason;
    sum.first_unknown = frame;
  }
  ++sum.verdicts[static_cast<std::size_t>(target.verdict)];
  if (target.handled) ++sum.handled[static_cast<std::size_t>(target.handled->source)];
  if (target.estimate) ++sum.outcomes[static_cast<std::size_t>(*target.estimate)];
}

void Statistics::add_fault(const FrameReport& report) {
  auto fault = std::find_if(faults_.begin(), faults_.end(),
                            [&](const Fault& known) { return known.status == report.status; });
  if (fault == faults_.end()) {
    faults_.emplace_back().status = report.status;
    fault = faults_.end() - 1;
  }
  ++fault->frames;

  std::vector<Reason>& reasons = fault->reasons;
  const auto reason = std::find_if(reasons.begin(), reasons.end(), [&](const Reason& known) {
    return is_same_reason(known.message, report.message);
  });
  if (reason != reasons.end())
    ++reason->frames;
  else if (reasons.size() < Fault::max_reasons)
    reasons.push_back({report.message, 1, report.index});
  else
    ++fault->other_reasons;
}

std::size_t Statistics::bad_frames() const {
  std::size_t bad = 0;
  for (const Fault& fault : faults_) bad += fault.frames;
  return bad;
}

std::optional<Quantiles> Statistics::timing(std::size_t stage) const {
  return quantiles(times_[stage]);
}

}  // namespace penumbra::io
