// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/names.hpp>
#include <io/files/result_folder.hpp>
#include <io/inputs/look_ahead_input.hpp>
#include <io/web/moment_painter.hpp>

namespace penumbra::app {
namespace {

struct LookAheadArguments {
  io::LookAheadOptions input;
  std::filesystem::path output;  ///< empty: nothing is written
  std::optional<int> threads;    ///< null: one per core
};

std::string seconds_text(const std::optional<double>& time) {
  return time ? fixed(*time, 2) + " s" : "-";
}

std::vector<std::string> row_of(const std::string& target, const std::string& camera,
                                const CameraForecast& forecast) {
  const auto worst = std::ranges::max_element(forecast.intervals, {}, &VerdictInterval::hidden);
  double hidden = 0.0;
  for (const VerdictInterval& each : forecast.intervals)
    if (each.verdict == Verdict::hidden) hidden += each.end - each.begin;
  return {target,
          camera,
          std::string(to_string(forecast.intervals.front().verdict)),
          seconds_text(forecast.hidden_at()),
          hidden > 0.0 ? fixed(hidden, 2) + " s" : "-",
          fixed(100.0 * worst->hidden, 0) + " %",
          worst->by.empty() ? "-" : worst->by,
          seconds_text(forecast.seen_again_at())};
}

void print_motion(const io::LookAheadResult& result, std::size_t motion) {
  print_line(result.motions[motion].name + ": " +
             fixed(result.motions[motion].trajectory.duration(), 2) + " s");
  std::vector<std::vector<std::string>> rows{{"target", "camera", "at first", "hidden in",
                                              "hidden for", "most hidden", "by", "seen again in"}};
  for (const TargetForecast& target : result.forecasts[motion]) {
    for (std::size_t c = 0; c < result.cameras.size(); ++c)
      rows.push_back(row_of(target.name,
                            result.cameras[c].name.empty() ? "-" : result.cameras[c].name,
                            target.cameras[c]));
    if (result.cameras.size() > 1) rows.push_back(row_of(target.name, "any", target.any));
  }
  print_table(std::move(rows));
}

/// The first unknown interval of each target.
void add_unknown(const std::string& motion, const std::vector<TargetForecast>& targets,
                 std::vector<std::string>& notes) {
  for (const TargetForecast& target : targets) {
    const auto unknown =
        std::ranges::find(target.any.intervals, Verdict::unknown, &VerdictInterval::verdict);
    if (unknown != target.any.intervals.end())
      notes.push_back(motion + ": '" + target.name + "' is unknown from " +
                      fixed(unknown->begin, 2) + " to " + fixed(unknown->end, 2) +
                      " s: " + unknown->reason);
  }
}

void add_options(CLI::App& app, LookAheadArguments& ahead) {
  app.footer(look_ahead_examples);
  io::InputOptions& input = ahead.input.input;
  add_input(app, input);
  add_list(
      app, "--trajectory",
      "a planned motion: *.csv with time,JOINT,..., or a message in YAML or JSON; may be given "
      "several times: they are ranked; default: the bag's plan",
      "FILE", [&](const std::string& file) { ahead.input.trajectories.emplace_back(file); });
  add_text(app, "--targets", "what to keep in view; default: the recording's", "YAML",
           ahead.input.targets);
  add_number<std::int64_t>(
      app, "--from",
      "frame in which the motion begins; default: the first with joints and a motion", "N",
      ahead.input.from, 0, std::numeric_limits<std::int64_t>::max() - 1);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", ahead.output);
  add_number(app, "--threads", "default: one per core; results do not depend on it", "N",
             ahead.threads, 1, RendererOptions::max_threads);
  add_drawn(app, input, "the recording's, else collision");
  add_bag(app, input.bag);
}

void check_options(const CLI::App& app, LookAheadArguments& ahead) {
  check_planned(app, ahead.input.input);
}

int execute(const LookAheadArguments& arguments) {
  std::optional<io::ResultFolder> folder;
  if (!arguments.output.empty())
    folder.emplace(io::ResultFolderOptions{.path = arguments.output,
                                           .report = {"look_ahead.json", io::json_begin},
                                           .others = {{"report.html", io::page_begin}}});
  io::LookAheadInput input = io::read_look_ahead_input(arguments.input, print_line);
  if (folder) folder->begin();
  LookAheadConfig config;
  config.threads = arguments.threads.value_or(
      std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  LookAhead ahead(input.robot, input.cameras, input.targets, input.pose, config);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<io::NamedTrajectory>& motions = input.trajectories;
  std::vector<std::vector<TargetForecast>> forecasts;
  for (const io::NamedTrajectory& each : motions) forecasts.push_back(ahead.along(each.trajectory));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const std::vector<RankedMotion> ranking = rank(forecasts);
  for (std::size_t i = 0; i < motions.size(); ++i)
    add_unknown(motions[i].name, forecasts[i], input.notes);
  const io::LookAheadResult result{.input = io::input_name(arguments.input.input.path),
                                   .frame = input.frame,
                                   .cameras = input.cameras,
                                   .now = input.now,
                                   .motions = motions,
                                   .forecasts = forecasts,
                                   .ranking = ranking,
                                   .notes = input.notes};
  print_notes(input.notes);
  for (std::size_t i = 0; i < motions.size(); ++i) print_motion(result, i);
  if (motions.size() > 1) {
    std::vector<std::vector<std::string>> rows{{"motion", "targets seen", "what costs most"}};
    for (const RankedMotion& each : ranking)
      rows.push_back({motions[each.trajectory].name, fixed(100.0 * each.seen, 1) + " %",
                      each.reason.empty() ? "-" : each.reason});
    print_table(std::move(rows));
  }
  std::cout << "looked ahead in " << fixed(1e3 * elapsed.count(), 1) << " ms\n";
  if (!folder) return 0;
  std::vector<io::PagePicture> pictures;
  io::MomentPainter painter(input.robot, input.cameras.front(), input.color.view(), input.targets,
                            input.pose);
  for (std::size_t i = 0; i < motions.size(); ++i)
    painter.add_pictures(motions[i].trajectory, forecasts[i], i, pictures);
  const std::string json = io::look_ahead_json(result) + "\n";
  folder->add_text("report.html", io::report_page(json, pictures));
  folder->add_text("look_ahead.json", json);
  folder->finish();
  return 0;
}

}  // namespace

Execute add_look_ahead(CLI::App& app) {
  return make_command<LookAheadArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
