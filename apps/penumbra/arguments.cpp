// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <iostream>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/version.hpp>

#include <apps/penumbra/arguments.hpp>
#include <apps/penumbra/graph_options.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>

namespace penumbra::app {
namespace {

constexpr int most_repeats = 1'000'000;

void add_robot(CLI::App& app, RobotOptions& options) {
  add_list(app, "--package", "where package://NAME is; may be given several times", "NAME=DIR",
           [&](const std::string& text) { take_package(text, options.packages); });
  add_option(app, "--geometry", "collision or visual; default collision", "NAME",
             [&](const std::string& text) { options.geometry = to_geometry(text); });
  add_extra(app, options.extra);
  add_leniency(app, options.allow_missing_meshes, options.geometry_fallback);
}

void add_render(CLI::App& app, RenderArguments& render) {
  app.footer(render_examples);
  add_path(app, "--robot", "the robot", "URDF", render.robot)->required();
  add_robot(app, render.options);
  add_path(app, "--camera", "ROS camera_info YAML", "FILE", render.camera_info)->required();
  app.add_flag("--rectified", render.rectified,
               "the images are free of distortion already: take the camera's p, not its k and d");
  add_path(app, "--pose", "4x4 pose of the optical frame in the parent link, metres", "FILE",
           render.pose)
      ->required();
  app.add_option("--parent", render.parent, "link that the pose is given in; default: the root")
      ->type_name("LINK");
  add_list(app, "--joint", "a joint's position, rad or m; may be given several times", "NAME=VALUE",
           [&](const std::string& text) { render.joints.push_back(to_joint(text)); });
  add_path(app, "-o,--output", "virtual depth image, float32 metres, 0 = no robot", "NPY",
           render.output)
      ->required();
  add_option(app, "--links", "link image, 16-bit: link number + 1, 0 = none", "PNG",
             [&](const std::string& text) {
               if (text.empty()) refuse_option("--links", text, "a path");
               render.links = text;
             });
  add_renderer(app, render.backend, render.renderer);
  add_option(app, "--repeat", "render N times and print the times", "N",
             [&](const std::string& text) {
               render.repeat = to_count("--repeat", text, 1, most_repeats);
             });
  app.add_flag("--json", render.json, "print counts, times and joint positions as JSON");
}

void check_render(const CLI::App&, const RenderArguments& render) {
  check_renderer(render.backend, render.renderer);
}

void add_inspect(CLI::App& app, InspectArguments& inspect) {
  app.footer(inspect_examples);
  add_path(app, "URDF", "the robot", "", inspect.robot)->required();
  add_robot(app, inspect.options);
  app.add_flag("--json", inspect.json, "print JSON instead of tables");
}

void add_doctor(CLI::App& app, DoctorArguments& doctor) {
  app.footer(doctor_examples);
  app.add_flag("--json", doctor.json, "print JSON instead of text");
}

/// Names the help that lists the options: the command's own, if one is given.
std::string help_hint(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  const std::string command = commands.empty() ? "" : commands.front()->get_name() + " ";
  return " (penumbra " + command + "--help tells the options)";
}

}  // namespace

std::optional<Command> parse_arguments(int argc, const char* const* argv) {
  RunArguments run;
  RenderArguments render;
  InspectArguments inspect;
  DoctorArguments doctor;
  SimulateArguments simulate;
  TopicsArguments topics;
  PlayArguments play;
  LiveArguments live;
  ViewArguments view;
  TuneArguments tune;
  CLI::App app{about, "penumbra"};
  app.footer(main_examples);
  app.set_version_flag("--version", std::string("penumbra ") + PENUMBRA_VERSION);
  app.require_subcommand(0, 1);
  std::vector<std::pair<const CLI::App*, std::function<Command()>>> commands;
  const auto add = [&](const char* name, const char* what, auto& arguments, auto add_options,
                       auto check) {
    CLI::App* const of = app.add_subcommand(name, what);
    add_options(*of, arguments);
    commands.emplace_back(of, [&arguments, of, check] {
      check(*of, arguments);
      return Command(arguments);
    });
  };
  const auto any = [](const CLI::App&, const auto&) {};
  add("run", "label every frame of a recording or bag", run, add_run, check_run);
  add("tune", "measure the sensor: tolerance, fringe, missing parts of the URDF", tune, add_tune,
      check_tune);
  add("render", "render one virtual depth image", render, add_render, check_render);
  add("inspect", "list which links of a URDF are drawn", inspect, add_inspect, any);
  add("doctor", "print what this machine offers", doctor, add_doctor, any);
  add("simulate", "record a simulated scene with its truth", simulate, add_simulate, any);
  add("topics", "list the live topics of ROS 2's graph", topics, add_topics, any);
  add("play", "publish a bag on ROS 2's graph", play, add_play, any);
  add("live", "label live topics of ROS 2 and publish the results", live, add_live, check_live);
  add("view", "show a recording or bag in the browser: 3-D, images, timeline", view, add_view,
      check_view);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& answered) {
    app.exit(answered, std::cout, std::cerr);
    return std::nullopt;
  } catch (const CLI::Error& error) {
    throw InputError(std::string(error.what()) + help_hint(app));
  }
  for (const auto& [command, made] : commands)
    if (command->parsed()) return made();
  throw InputError(
      "a command is needed: run, tune, render, inspect, doctor, simulate, topics, play, "
      "live or view (penumbra --help tells more)");
}

}  // namespace penumbra::app
