// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <system_error>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/former_results.hpp>
#include <apps/penumbra/judging.hpp>
#include <apps/penumbra/output_bag.hpp>
#include <apps/penumbra/output_folder.hpp>
#include <apps/penumbra/progress.hpp>
#include <io/pending_file.hpp>

namespace penumbra::app {
namespace {

/// What an earlier run wrote will be removed or replaced: nothing else may stand there.
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
  check_former_run(output);
  if (arguments.report_page) check_former_page(output);
}

/// Of an error's message: that an earlier run's results still stand.
std::string left_of(const RunArguments& arguments) {
  const bool is_bag = is_output_bag(arguments.output);
  return io::left_as_it_was(is_bag ? arguments.output : arguments.output / "report.json");
}

/// Makes room for the results in a folder; a bag takes the place of an earlier one at the end.
std::unique_ptr<RunOutput> open_output(const RunArguments& arguments, const RunInput& input,
                                       const Pipeline& pipeline) {
  if (is_output_bag(arguments.output))
    return std::make_unique<OutputBag>(arguments.output, input.camera,
                                       pipeline.robot().links().front());
  if (!arguments.points_frame.empty() && !pipeline.robot().find_link(arguments.points_frame))
    throw InputError("--points-frame: no link '" + arguments.points_frame + "'; the root is '" +
                     pipeline.robot().links().front() +
                     "', and `penumbra inspect URDF` lists the others");
  remove_former_run(arguments.output);
  return std::make_unique<OutputFolder>(arguments.output, arguments, pipeline.rectification());
}

int judge_all(const RunArguments& arguments) {
  Judging judging(arguments);
  const auto output = open_output(arguments, judging.input(), judging.pipeline());
  output->begin(judging.head());
  {
    Progress progress(judging.size().value_or(0));
    judging.run(*output, [&] {
      progress.step();
      return true;
    });
  }
  judging.tell(output->where());
  return judging.status();
}

}  // namespace

int execute(const RunArguments& arguments) {
  check_output(arguments);
  return run_or_tell_left([&] { return judge_all(arguments); }, [&] { return left_of(arguments); });
}

}  // namespace penumbra::app
