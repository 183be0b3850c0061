// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <memory>
#include <string>
#include <system_error>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/judging.hpp>
#include <apps/penumbra/output_bag.hpp>
#include <apps/penumbra/output_folder.hpp>
#include <apps/penumbra/progress.hpp>
#include <io/files/pending_file.hpp>

namespace penumbra::app {
namespace {

/// Throws InputError if results would take the place of anything but an earlier run's.
void check_output(const RunArguments& arguments) {
  std::error_code error;
  const std::filesystem::path input = std::filesystem::absolute(arguments.input);
  const std::filesystem::path& output = arguments.output;
  if (is_output_bag(output)) {
    if (std::filesystem::equivalent(output, input, error))
      throw InputError("--output: " + output.string() + " is the input; choose another name");
    return check_former_bag(output);
  }
  const bool is_own = std::filesystem::equivalent(output, input, error) ||
                      (std::filesystem::is_regular_file(input, error) &&
                       std::filesystem::equivalent(output, input.parent_path(), error));
  if (is_own)
    throw InputError("--output: " + output.string() +
                     " is the recording's own folder; choose another, or one inside of it");
  if (std::filesystem::exists(output / "recording.yaml", error))
    throw InputError("--output: " + output.string() +
                     " is a recording (it has a recording.yaml); choose another folder");
  check_output_folder(arguments);
}

/// Takes the place of earlier results: in a folder now, in a bag at the end.
std::unique_ptr<RunOutput> open_output(const RunArguments& arguments, const RunInput& input,
                                       const Pipeline& pipeline) {
  if (is_output_bag(arguments.output))
    return std::make_unique<OutputBag>(arguments.output, input.camera,
                                       pipeline.robot().links().front());
  if (!arguments.points_frame.empty() && !pipeline.robot().find_link(arguments.points_frame))
    throw InputError("--points-frame: no link '" + arguments.points_frame + "'; the root is '" +
                     pipeline.robot().links().front() +
                     "', and `penumbra inspect URDF` lists the others");
  return std::make_unique<OutputFolder>(arguments.output, arguments, pipeline.rectification());
}

volatile std::sig_atomic_t interrupted_by = 0;  // a signal's number

/// From now on the first Ctrl-C or SIGTERM only sets interrupted_by; a second one ends the program.
void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { interrupted_by = signal; };
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int judge_all(const RunArguments& arguments) {
  Judging judging(arguments);
  const auto output = open_output(arguments, judging.input(), judging.pipeline());
  catch_interrupts();
  output->begin(judging.head());
  bool is_whole = false;
  {
    Progress progress(judging.size().value_or(0));
    is_whole = judging.run(*output, [&] {
      progress.step();
      return interrupted_by == 0;
    });
  }
  judging.tell(output->where());
  return is_whole ? judging.status() : 128 + interrupted_by;
}

}  // namespace

int execute(const RunArguments& arguments) {
  check_output(arguments);
  const std::filesystem::path& output = arguments.output;
  return io::run_or_say_state({is_output_bag(output) ? output : output / "report.json"},
                              [&] { return judge_all(arguments); });
}

}  // namespace penumbra::app
