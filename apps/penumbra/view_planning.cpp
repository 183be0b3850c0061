// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/planning/view_planning.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/names.hpp>
#include <io/files/result_folder.hpp>
#include <io/files/view_planning_report.hpp>
#include <io/inputs/planning_input.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::app {
namespace {

struct ViewPlanningArguments {
  io::PlanningOptions input;
  std::filesystem::path output;  ///< empty: nothing is written
  std::size_t cameras = 1;       ///< of the largest set
  std::optional<int> threads;    ///< null: one per core
};

constexpr std::size_t most_planned_cameras = 1000;

std::string share_text(double share) { return fixed(100.0 * share, 1) + " %"; }

void print_shares(const io::ViewPlan& plan) {
  std::vector<std::vector<std::string>> rows{{"candidate", "target", "visible", "partly hidden",
                                              "hidden", "unknown", "out of view", "held"}};
  for (std::size_t c = 0; c < plan.views.candidates(); ++c)
    for (std::size_t t = 0; t < plan.views.targets(); ++t) {
      rows.push_back({plan.candidates[c].name, plan.target(t)});
      for (const Verdict verdict : all_verdicts)
        rows.back().push_back(share_text(plan.views.share(c, t, verdict)));
    }
  print_table(std::move(rows));
}

void print_best(const io::ViewPlan& plan) {
  std::vector<std::vector<std::string>> rows{{"cameras", "best set", "visible, mean"}};
  for (std::size_t t = 0; t < plan.views.targets(); ++t) rows[0].push_back(plan.target(t));
  for (const CameraSet& set : plan.best) {
    rows.push_back({std::to_string(set.candidates.size()), plan.names(set), share_text(set.mean)});
    for (const double share : set.visible) rows.back().push_back(share_text(share));
  }
  print_table(std::move(rows));
}

/// One line, whose reason is often that of all candidates.
void print_unknown(const io::ViewPlan& plan) {
  std::size_t count = 0, first = 0;
  for (std::size_t c = plan.views.candidates(); c-- > 0;)
    if (!plan.views.unknown(c).empty()) ++count, first = c;
  if (count > 0)
    print_notes(std::vector{std::to_string(count) + " of " +
                            std::to_string(plan.views.candidates()) +
                            " candidates have unknown verdicts; the first is " +
                            plan.candidates[first].name + ", " + plan.views.unknown(first)});
}

void add_options(CLI::App& app, ViewPlanningArguments& planning) {
  app.footer(view_planning_examples);
  io::InputOptions& input = planning.input.input;
  add_input(app, input);
  add_text(app, "--candidates",
           "poses of the camera: name,x,y,z,qx,qy,qz,qw and, if not in the root link, link", "CSV",
           planning.input.candidates)
      ->required();
  add_text(app, "--targets", "3-D targets to see; default: the recording's", "YAML",
           planning.input.targets);
  add_number<std::size_t>(app, "--cameras", "find the best sets of up to K cameras; default 1", "K",
                          planning.cameras, 1, most_planned_cameras);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", planning.output);
  add_number(app, "--threads", "default: one per core; results do not depend on it", "N",
             planning.threads, 1, RendererOptions::max_threads);
  add_frames(app, input.frames);
  add_drawn(app, input, "the recording's, else collision");
  add_bag(app, input.bag);
}

void check_options(const CLI::App& app, ViewPlanningArguments& planning) {
  check_planned(app, planning.input.input);
}

int execute(const ViewPlanningArguments& arguments) {
  std::optional<io::ResultFolder> folder;
  if (!arguments.output.empty())
    folder.emplace(io::ResultFolderOptions{.path = arguments.output,
                                           .report = {"view_planning.json", io::json_begin},
                                           .others = {{"report.html", io::page_begin}}});
  const io::PlanningInput input = [&] {
    Progress progress(0);
    return io::read_planning_input(arguments.input, print_line, [&] { progress.step(); });
  }();
  print_notes(input.notes);
  try {
    check_camera_sets(input.candidates.size(), arguments.cameras);
  } catch (const InputError& fault) {
    throw InputError("--cameras, " + arguments.input.candidates.string() + ": " + fault.what());
  }
  if (folder) folder->begin();
  const int threads = arguments.threads.value_or(
      std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  const std::size_t renders = input.candidates.size() * input.motion.size();
  const auto start = std::chrono::steady_clock::now();
  const CandidateViews views = [&] {
    Progress progress(renders);
    try {
      return judge_candidates(input.input.robot, input.candidates, input.motion, threads,
                              [&] { progress.step(); });
    } catch (const LensError& error) {
      throw InputError(input.input.camera_info.string() + ": " + error.what());
    }
  }();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const std::vector<CameraSet> best = best_cameras(views, arguments.cameras);
  const io::ViewPlan plan{.input = io::input_name(arguments.input.input.path),
                          .seen = input.seen,
                          .candidates = input.candidates,
                          .motion = input.motion,
                          .views = views,
                          .best = best};
  print_shares(plan);
  std::cout << '\n';
  print_best(plan);
  print_unknown(plan);
  std::cout << input.candidates.size() << " candidates x " << input.motion.size() << " frames in "
            << fixed(elapsed.count(), 1)
            << " s: " << fixed(static_cast<double>(renders) / elapsed.count(), 0)
            << " per second\n";
  if (!folder) return 0;
  const std::string json = io::view_planning_json(plan) + "\n";
  folder->add_text("report.html", io::report_page(json));
  folder->add_text("view_planning.json", json);
  folder->finish();
  return 0;
}

}  // namespace

Execute add_view_planning(CLI::App& app) {
  return make_command<ViewPlanningArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
