// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

void to_seeds(const std::string& text, ExperimentArguments& experiment) {
  const auto parts = split(text, ':');
  const char* const wanted = "A:B, the seeds from A up to but without B";
  if (parts.size() != 2) refuse_option("--seeds", text, wanted);
  const auto first = io::parse_number<std::uint64_t>(parts[0]);
  const auto end = io::parse_number<std::uint64_t>(parts[1]);
  if (!first || !end || *first >= *end) refuse_option("--seeds", text, wanted);
  experiment.first_seed = *first;
  experiment.end_seed = *end;
}

constexpr double longest_run = 600;  // seconds

}  // namespace

void add_experiment(CLI::App& app, ExperimentArguments& experiment) {
  app.footer(experiment_examples);
  app.add_option("NAME", experiment.experiment, "conveyor or handover")->required();
  add_path(app, "-o,--output", "folder for the results; made if need be", "OUT", experiment.output)
      ->required();
  add_option(app, "--seeds", "seeds from A up to but without B; default 0:30", "A:B",
             [&](const std::string& text) { to_seeds(text, experiment); });
  add_option(app, "--threads", "seeds side by side; default: one per core", "N",
             [&](const std::string& text) {
               experiment.threads = to_count("--threads", text, 1, RendererOptions::max_threads);
             });
  add_option(app, "--duration", "seconds of each run; default: the scene's own", "S",
             [&](const std::string& text) {
               const auto seconds = io::parse_number<double>(text);
               if (!seconds || !(*seconds > 0) || *seconds > longest_run)
                 refuse_option("--duration", text, "a number of seconds above 0, 600 at most");
               experiment.duration = *seconds;
             });
  app.add_flag("--frames", experiment.frames, "write the first seed's frames with boxes");
}

void add_simulate(CLI::App& app, SimulateArguments& simulate) {
  app.footer(simulate_examples);
  sim::SimulationOptions& options = simulate.options;
  app.add_option("SCENE", simulate.scene, "conveyor, handover or random")->required();
  add_path(app, "-o,--output", "folder for the recording, new or empty; or a new bag NAME.mcap",
           "OUT", simulate.output)
      ->required();
  add_number(app, "--seed", "what differs between runs; default 0", "N", options.seed);
  add_option(app, "--frames", "write only the frames from A up to but without B", "A:B",
             [&](const std::string& text) { simulate.frames = to_range(text); });
  add_option(app, "--duration", "of the scene; default: its own", "S",
             [&](const std::string& text) {
               const auto seconds = io::parse_number<double>(text);
               if (!seconds || !(*seconds > 0))
                 refuse_option("--duration", text, "a number of seconds above 0");
               options.duration = *seconds;
             });
  add_number(app, "--rate", "frames per second; default 30", "HZ", options.frame_rate);
  app.add_flag_callback(
      "--no-noise", [&] { options.depth = {}; },
      "true depth, rounded to millimetres; default: noise as a RealSense D415's");
  add_number(app, "--joint-sigma", "noise of the reported joint positions; default 0", "RAD",
             options.joint_sigma);
  add_number(app, "--joint-latency", "how much older they are than they say; default 0", "S",
             options.joint_latency);
  add_number(app, "--belt-jitter", "unrest of the belt's speed, relative; default 0", "SHARE",
             options.belt_jitter);
  app.add_flag("--second-camera", options.second_camera,
               "a depth camera on the other side, too: second_depth/, in bags /second_camera/...");
}

}  // namespace penumbra::app
