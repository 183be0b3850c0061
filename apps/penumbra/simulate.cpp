// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>
#include <string>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <io/outputs/output_folder.hpp>
#include <sim/recording_bag.hpp>
#include <sim/recording_folder.hpp>
#include <sim/simulation.hpp>

namespace penumbra::app {
namespace {

struct SimulateArguments {
  std::string scene;
  std::filesystem::path output;
  io::FrameRange frames;
  sim::SimulationOptions options;
};

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

void add_options(CLI::App& app, SimulateArguments& simulate) {
  app.footer(simulate_examples);
  sim::SimulationOptions& options = simulate.options;
  app.add_option("SCENE", simulate.scene, "conveyor, handover, random, carry or two_arms")
      ->required();
  add_text(app, "-o,--output", "folder for the recording, new or empty; or a new bag NAME.mcap",
           "OUT", simulate.output)
      ->required();
  add_number(app, "--seed", "of the random numbers; default 0", "N", options.seed);
  add_frames(app, simulate.frames);
  add_number(app, "--duration", "length of the scene; default: its own", "S", options.duration,
             1e-3, 1e6);
  add_number(app, "--rate", "frames per second; default 30", "HZ", options.frame_rate, 1e-3, 1e3);
  app.add_flag_callback(
      "--no-noise", [&] { options.depth = {}; },
      "true depth, rounded to millimetres; default: noise as a RealSense D415's");
  add_number(app, "--joint-sigma", "noise of the reported joint positions; default 0", "RAD",
             options.joint_sigma);
  add_number(app, "--joint-latency", "how much older they are than their stamps; default 0", "S",
             options.joint_latency);
  add_number(app, "--belt-jitter", "variation of the belt's speed, relative; default 0", "SHARE",
             options.belt_jitter);
  add_number(app, "--camera", "which of the scene's three cameras draws; default 0, its own", "N",
             options.camera, 0, 2);
  app.add_flag("--second-camera", options.second_camera,
               "a depth camera on the other side, too: second_depth/, in bags /second_camera/...");
}

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

}  // namespace

Execute add_simulate(CLI::App& app) {
  return make_command<SimulateArguments>(app, add_options, nullptr, execute);
}

}  // namespace penumbra::app
