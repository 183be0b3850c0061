// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/run_cameras.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/pending_file.hpp>
#include <io/outputs/output_bag.hpp>
#include <io/outputs/output_folder.hpp>

namespace penumbra::app {
namespace {

std::atomic<int> interrupted_by = 0;  // a signal's number

void add_cameras(CLI::App& app, RunArguments& run) {
  add_list(app, "--camera",
           "one of a recording's cameras; or depth images of a bag, whose results come into "
           "OUT/NAME, may be given several times",
           "NAME|NAME=TOPIC", [&](const std::string& text) {
             const std::size_t middle = text.find('=');
             const std::string name = text.substr(0, middle);
             if (middle == std::string::npos) {
               run.session.input.camera = name;
               return;
             }
             add_camera(run.cameras, name, text.substr(middle + 1));
           });
}

io::Saves to_saves(const std::string& text) {
  static const std::map<std::string, bool io::Saves::*> kinds{
      {"vdi", &io::Saves::vdi},
      {"labels", &io::Saves::labels},
      {"links", &io::Saves::links},
      {"overlay", &io::Saves::overlay},
      {"filtered", &io::Saves::filtered},
      {"points", &io::Saves::points},
      {"robot_mask", &io::Saves::robot_mask}};
  io::Saves saves;
  for (const std::string& part : split(text, ',')) {
    const auto kind = kinds.find(part);
    if (kind == kinds.end())
      refuse_option("--save", part,
                    "one of vdi, labels, links, robot_mask, overlay, filtered, points");
    saves.*kind->second = true;
  }
  return saves;
}

void add_options(CLI::App& app, RunArguments& run) {
  app.footer(run_examples);
  add_path(app, run.session.input);
  add_cameras(app, run);
  add_text(app, "-o,--output",
           "folder for the results, made if need be; or *.mcap: a bag of results", "OUT",
           run.output.path)
      ->required();
  add_session(app, run.session);
  app.get_option("--threads")
      ->description(
          "threads of the cpu renderer, default 1, and of those that read and write images, "
          "default "
          "one per core; results do not depend on it");
  add_sequence(app, run.session);
  add_number(app, "--fps",
             "frames per second of a recording without stamps: frame i gets the stamp i / N s", "N",
             run.session.input.fps, 0.001, 1000.0);
  add_option(
      app, "--save",
      "what to write for each frame: of vdi,labels,links,robot_mask,overlay, and without the robot "
      "filtered (depth) and points (PCD and PLY)",
      "LIST", [&](const std::string& text) { run.output.saves = to_saves(text); });
  add_option(app, "--points-frame", "link that points are given in; default: the camera's frame",
             "LINK", [&](const std::string& text) { run.output.points_frame = text; });
  app.add_flag("--report", run.output.report_page,
               "write report.html, too: one file with the targets' timeline and key frames");
  app.add_flag(
      "--force", run.output.force,
      "write into a folder that holds files and no report.json of penumbra; and exit with 0 "
      "although the images do not show the robot where the setup says");
  add_bag(app, run.session.input.bag);
}

/// A bag always holds all of its topics, in the camera's own image.
void check_output_bag(const RunArguments& run) {
  const auto refuse = [](const std::string& option) {
    throw InputError(option +
                     ": a bag of results (-o *.mcap) always holds the same topics, of the " +
                     "camera's images; leave it out, or give a folder with -o");
  };
  if (run.output.saves != io::Saves{}) refuse("--save");
  if (!run.output.points_frame.empty()) refuse("--points-frame");
  if (run.output.report_page) refuse("--report");
  if (run.output.force) refuse("--force");
  if (run.session.image == ImageSpace::rectified) refuse("--image rectified");
}

void check_options(const CLI::App& app, RunArguments& run) {
  check_session(app, run.session);
  const io::Saves& saves = run.output.saves;
  const bool is_bag = io::is_output_bag(run.output.path);
  if (is_bag) check_output_bag(run);
  if (!run.output.points_frame.empty() && !saves.points)
    throw InputError("--points-frame: no points are saved; add --save points, or leave it out");
  if (app.get_option("--threads")->count() > 0)
    run.output.threads = run.session.input.threads = run.session.renderer.threads;
  run.session.input.with_color = is_bag || saves.overlay || saves.points || run.output.report_page;
}

int execute(const RunArguments& arguments) {
  io::check_output_place(arguments.session.input.path, arguments.output.path);
  const std::filesystem::path& path = arguments.output.path;
  std::vector<NamedCamera> cameras = arguments.cameras;
  if (cameras.empty() && arguments.session.input.camera.empty())
    for (const std::string& name : io::cameras_of(arguments.session.input.path))
      cameras.push_back({name, {}});
  if (!cameras.empty()) return run_cameras(arguments, cameras);
  std::optional<io::ResultFolder> folder;
  if (!io::is_output_bag(path)) folder.emplace(io::run_results(arguments.output));
  io::InputSession session(arguments.session, print_line);
  const Pipeline& pipeline = session.pipeline();
  const std::unique_ptr<io::Sink> output = folder ? open_output(arguments.output, *folder, pipeline)
                                                  : io::open_output_bag(path, pipeline);
  catch_interrupts();
  const io::RunResult result = judge_all(session, {output.get()});
  print_result(result, pipeline.robot(),
               io::is_output_bag(path) ? "results: " + path.string()
                                       : "report: " + (path / "report.json").string());
  return status_of(result, arguments.output.force);
}

}  // namespace

std::unique_ptr<io::Sink> open_output(const io::OutputOptions& options, io::ResultFolder& folder,
                                      const Pipeline& pipeline) {
  const std::string& root = pipeline.robot().links().front();
  if (!options.points_frame.empty() && !pipeline.robot().find_link(options.points_frame))
    throw InputError("--points-frame: no link '" + options.points_frame + "'; the root is '" +
                     root + "', and `penumbra inspect URDF` lists the others");
  return std::make_unique<io::OutputFolder>(options, folder, pipeline);
}

io::RunResult judge_all(io::InputSession& session, const io::Sinks& sinks) {
  Progress progress(session.size().value_or(0));
  return session.run(sinks, [&] {
    progress.step();
    return !was_interrupted();
  });
}

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { interrupted_by = signal; };
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool was_interrupted() { return interrupted_by != 0; }

int interrupt_status() { return 128 + interrupted_by; }

int status_of(const io::RunResult& result, bool force) {
  if (result.is_stopped) return interrupt_status();
  if (!result.device_fault.empty()) return device_failed;
  const bool is_good =
      result.statistics.usable_frames() > 0 && (force || result.statistics.shows_robot());
  return is_good ? 0 : nothing_judged;
}

Execute add_run(CLI::App& app) {
  return make_command<RunArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
