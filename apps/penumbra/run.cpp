// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/run_cameras.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/pending_file.hpp>
#include <io/run/output_bag.hpp>
#include <io/run/output_folder.hpp>

namespace penumbra::app {
namespace {

std::atomic<int> interrupted_by = 0;  // a signal's number

/// Judges all frames, with a bar on the terminal.
io::RunResult judge_all(io::InputSession& session, io::RunOutput& output) {
  Progress progress(session.size().value_or(0));
  return session.run(output, [&] {
    progress.step();
    return !was_interrupted();
  });
}

}  // namespace

std::unique_ptr<io::RunOutput> open_output(const io::OutputOptions& options,
                                           io::ResultFolder& folder,
                                           const io::InputSession& session) {
  const Pipeline& pipeline = session.pipeline();
  const std::string& root = pipeline.robot().links().front();
  if (!options.points_frame.empty() && !pipeline.robot().find_link(options.points_frame))
    throw InputError("--points-frame: no link '" + options.points_frame + "'; the root is '" +
                     root + "', and `penumbra inspect URDF` lists the others");
  return std::make_unique<io::OutputFolder>(options, folder, pipeline.rectification());
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
  const std::unique_ptr<io::RunOutput> output =
      folder ? open_output(arguments.output, *folder, session)
             : std::make_unique<io::OutputBag>(path, session.camera(),
                                               session.pipeline().robot().links().front());
  catch_interrupts();
  output->begin(session.head());
  const io::RunResult result = judge_all(session, *output);
  print_result(result, session.pipeline().robot(),
               io::is_output_bag(path) ? "results: " + path.string()
                                       : "report: " + (path / "report.json").string());
  return status_of(result, arguments.output.force);
}

}  // namespace penumbra::app
