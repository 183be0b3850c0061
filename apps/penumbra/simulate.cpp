// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>
#include <string>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/progress.hpp>
#include <io/run/output_bag.hpp>
#include <sim/recording_bag.hpp>
#include <sim/recording_folder.hpp>

namespace penumbra::app {
namespace {

void check_output(const std::filesystem::path& output) {
  if (output.extension() == ".db3")
    throw InputError("--output: " + output.string() + ": bags are written as .mcap");
}

std::unique_ptr<sim::RecordingSink> open_recording(const SimulateArguments& arguments,
                                                   const sim::Simulation& simulation) {
  if (io::is_output_bag(arguments.output))
    return std::make_unique<sim::RecordingBag>(arguments.output, simulation, arguments.scene,
                                               arguments.options);
  return std::make_unique<sim::RecordingFolder>(arguments.output, simulation, arguments.scene,
                                                arguments.options);
}

}  // namespace

int execute(const SimulateArguments& arguments) {
  check_output(arguments.output);
  sim::Simulation simulation(arguments.scene, arguments.options);
  const std::size_t all = simulation.frames();
  const auto first = static_cast<std::size_t>(arguments.frames.first.value_or(0));
  const auto end =
      static_cast<std::size_t>(arguments.frames.end.value_or(static_cast<std::int64_t>(all)));
  if (first >= end || end > all)
    throw InputError("--frames " + std::to_string(first) + ":" + std::to_string(end) +
                     ": the scene has the frames 0:" + std::to_string(all));
  const auto recording = open_recording(arguments, simulation);
  {
    Progress progress(end - first);
    sim::SimFrame frame;
    simulation.skip(first);
    for (std::size_t index = first; index < end && simulation.next(frame); ++index) {
      recording->add(frame, index);
      progress.step();
    }
  }
  recording->finish();
  std::cout << end - first << " frames: " << recording->where() << '\n';
  return 0;
}

}  // namespace penumbra::app
