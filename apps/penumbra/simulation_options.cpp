// SPDX-License-Identifier: Apache-2.0
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>

namespace penumbra::app {

void add_simulate(CLI::App& app, SimulateArguments& simulate) {
  app.footer(simulate_examples);
  sim::SimulationOptions& options = simulate.options;
  app.add_option("SCENE", simulate.scene, "conveyor, handover or random")->required();
  add_path(app, "-o,--output", "folder for the recording, new or empty; or a new bag NAME.mcap",
           "OUT", simulate.output)
      ->required();
  add_number(app, "--seed", "of the random numbers; default 0", "N", options.seed);
  add_option(app, "--frames", "write only the frames from A up to but without B", "A:B",
             [&](const std::string& text) { simulate.frames = to_range(text); });
  add_option(app, "--duration", "length of the scene; default: its own", "S",
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
  add_number(app, "--joint-latency", "how much older they are than their stamps; default 0", "S",
             options.joint_latency);
  add_number(app, "--belt-jitter", "variation of the belt's speed, relative; default 0", "SHARE",
             options.belt_jitter);
  app.add_flag("--second-camera", options.second_camera,
               "a depth camera on the other side, too: second_depth/, in bags /second_camera/...");
}

}  // namespace penumbra::app
