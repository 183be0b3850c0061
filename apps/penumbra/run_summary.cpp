// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <span>
#include <string>

#include <apps/penumbra/run_summary.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

constexpr std::size_t most_targets = 20;  // with a line each

std::string more_reasons(const io::Fault& fault) {
  if (fault.frames == fault.reasons.front().frames) return "";
  return " (other frames for other reasons, see the report)";
}

std::string first_in(std::size_t frame) {
  return ", first in frame " + std::to_string(frame) + ": ";
}

std::string percent(std::size_t part, std::size_t whole) {
  return whole == 0
             ? "-"
             : fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 2) + " %";
}

/// Returns nothing if no frame was usable: the faults say why.
std::span<const io::TargetStatistics> judged_targets(const io::Statistics& statistics) {
  if (statistics.usable_frames() == 0) return {};
  return statistics.targets();
}

/// Prints a line for each of the first targets.
void print_targets(const io::Statistics& statistics) {
  const auto targets = judged_targets(statistics);
  const char* const trust = statistics.shows_robot() ? "" : " (not to be trusted)";
  for (const io::TargetStatistics& target : targets.first(std::min(most_targets, targets.size())))
    std::cout << "target " << target.name << trust << ": " << target.frames(Verdict::visible)
              << " frames visible, " << target.frames(Verdict::partial) << " partial, "
              << target.frames(Verdict::hidden) << " hidden, " << target.frames(Verdict::unknown)
              << " unknown, " << target.frames(Verdict::out_of_view) << " out of view, "
              << target.frames(Verdict::held) << " held\n";
  if (targets.size() > most_targets)
    std::cout << "and " << targets.size() - most_targets << " more targets, see the report\n";
}

void print_summary(const io::Statistics& statistics, const std::string& where) {
  const PixelCounts& pixels = statistics.pixels();
  const std::size_t robot = pixels.robot.value_or(0);
  const std::size_t unknown = robot - pixels.front - pixels.occluded - pixels.beyond;
  std::cout << statistics.frames() << " frames, "
            << (statistics.shows_robot() || statistics.usable_frames() == 0
                    ? std::to_string(statistics.bad_frames()) + " bad"
                    : "none to be trusted")
            << "; of " << robot << " robot pixels " << percent(pixels.front, robot) << " front, "
            << percent(pixels.occluded, robot) << " occluded, " << percent(unknown, robot)
            << " unknown, " << percent(pixels.beyond, robot) << " beyond; " << pixels.fringe
            << " fringe pixels around it";
  if (pixels.uncovered > 0) std::cout << "; besides " << pixels.uncovered << " uncovered pixels";
  std::cout << '\n';
  print_targets(statistics);
  for (std::size_t i = 0; i < io::stages.size(); ++i)
    if (const auto q = statistics.timing(i))
      std::cout << io::stages[i].name << ": median " << fixed(q->median, 3) << " ms, p99 "
                << fixed(q->p99, 3) << " ms, max " << fixed(q->max, 3) << " ms\n";
  std::cout << where << '\n';
}

}  // namespace

void print_faults(const io::RunResult& result, const std::string& of) {
  const io::Statistics& statistics = result.statistics;
  const auto frames = [&](std::size_t n) {
    return std::to_string(n) + " of " + std::to_string(statistics.frames()) + " frames";
  };
  for (const io::Fault& fault : statistics.faults())
    print_error(of + std::string(to_string(fault.status)) + " in " + frames(fault.frames) +
                first_in(fault.reasons.front().first) + fault.reasons.front().message +
                more_reasons(fault));
  std::size_t unknown = 0;
  for (const io::TargetStatistics& target : judged_targets(statistics))
    if (target.frames(Verdict::unknown) > 0 && ++unknown <= most_targets)
      print_error(of + "target '" + target.name + "' unknown in " +
                  frames(target.frames(Verdict::unknown)) + first_in(target.first_unknown) +
                  target.reason);
  if (unknown > most_targets)
    print_error(of + std::to_string(unknown - most_targets) +
                " more targets unknown in some frames");
  if (result.frames_without_color > 0)
    print_error("no colour in the overlay of " + frames(result.frames_without_color) +
                ", first: " + result.first_without_color);
}

void print_result(const io::RunResult& result, const Robot& robot, const std::string& where) {
  if (result.statistics.usable_frames() > 0) print_notes(robot.notes());
  print_faults(result);
  print_notes(result.notes);
  print_summary(result.statistics, where);
}

}  // namespace penumbra::app
