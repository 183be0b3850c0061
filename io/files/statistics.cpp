// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include <penumbra/base/statistics-inl.hpp>

#include <io/files/statistics.hpp>

namespace penumbra::io {
namespace {

/// Returns a message without the digits of frame numbers, files and lines. Those of joints and
/// links stay.
std::string reason_of(const std::string& message) {
  std::istringstream words(message);
  std::string reason, before;
  for (std::string word; words >> word; before = word) {
    const bool is_place = word.find_first_of("/.") != std::string::npos || before == "frame";
    if (is_place) std::erase_if(word, [](char c) { return c >= '0' && c <= '9'; });
    reason += word + ' ';
  }
  return reason;
}

}  // namespace

std::optional<Quantiles> quantiles(std::vector<double> samples) {
  if (samples.empty()) return std::nullopt;
  return Quantiles{detail::quantile(samples, 0.0), detail::median(samples),
                   detail::quantile(samples, 0.99), detail::quantile(samples, 1.0)};
}

void Statistics::add(const FrameReport& report) {
  ++frames_;
  pixels_.add(report.pixels);
  parts_ = std::max(parts_, report.parts);
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (const auto time = report.timing.*stages[i].time) times_[i].push_back(*time);

  if (report.status == FrameStatus::ok || report.status == FrameStatus::missing_link)
    ++usable_frames_;
  if (report.status != FrameStatus::ok) add_fault(report);
  for (std::size_t i = 0; i < report.targets.size(); ++i)
    add_target(report.targets[i], i, report.index);
}

/// `place`: index among the frame's targets, which usually come in the same order.
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
    return reason_of(known.message) == reason_of(report.message);
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

bool Statistics::shows_robot() const {
  constexpr double most_beyond = 0.8;      // of the robot's measured pixels
  constexpr std::size_t least_robot = 10;  // pixels per frame; less is a robot far away
  const std::size_t robot = pixels_.robot.value_or(0);
  const std::size_t measured = pixels_.front + pixels_.occluded + pixels_.beyond;
  const bool is_in_view =
      parts_ > 0 ? pixels_.occluded + pixels_.beyond > 0 : robot >= least_robot * usable_frames_;
  return is_in_view &&
         static_cast<double>(pixels_.beyond) <= most_beyond * static_cast<double>(measured);
}

std::optional<Quantiles> Statistics::timing(std::size_t stage) const {
  return quantiles(times_[stage]);
}

}  // namespace penumbra::io
