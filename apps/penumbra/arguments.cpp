// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/version.hpp>

#include <apps/penumbra/arguments.hpp>
#include <apps/penumbra/build_info.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <io/files/names.hpp>

namespace penumbra::app {
namespace {

constexpr int most_repeats = 1'000'000;

void add_robot(CLI::App& app, RobotOptions& options) {
  add_packages(app, options.packages);
  add_drawn(app, options, "collision");
}

void add_render(CLI::App& app, RenderArguments& render) {
  app.footer(render_examples);
  add_text(app, "--robot", "the robot", "URDF", render.robot)->required();
  add_robot(app, render.options);
  add_text(app, "--camera", "ROS camera_info YAML", "FILE", render.camera_info)->required();
  app.add_flag("--rectified", render.rectified,
               "the images are free of distortion already: take the camera's p, not its k and d");
  add_text(app, "--pose", "4x4 pose of the optical frame in the parent link, metres", "FILE",
           render.pose)
      ->required();
  app.add_option("--parent", render.parent, "link that the pose is given in; default: the root")
      ->type_name("LINK");
  add_list(app, "--joint", "a joint's position, rad or m; may be given several times", "NAME=VALUE",
           [&](const std::string& text) {
             const char* const wanted = "NAME=VALUE with a number (radians or metres)";
             const auto [name, value] = to_pair("--joint", text, wanted);
             const auto number = io::parse_number<double>(value);
             if (!number) refuse_option("--joint", text, wanted);
             render.joints.emplace_back(name, *number);
           });
  add_text(app, "-o,--output", "virtual depth image, float32 metres, 0 = no robot", "NPY",
           render.output)
      ->required();
  add_text(app, "--links", "link image, 16-bit: link number + 1, 0 = none", "PNG", render.links);
  add_renderer(app, render.backend, render.renderer);
  add_number(app, "--repeat", "render N times and print the times", "N", render.repeat, 1,
             most_repeats);
  app.add_flag("--json", render.json, "print counts, times and joint positions as JSON");
}

void add_init(CLI::App& app, io::InitOptions& init) {
  app.footer(init_examples);
  add_text(app, "FOLDER", "images, joint file, URDF, camera_info", "", init.folder)->required();
  add_text(app, "--robot", "the robot; default: the URDF in the folder", "URDF", init.robot);
  add_packages(app, init.packages);
  app.add_flag("--force", init.force, "replace a recording.yaml");
}

void add_inspect(CLI::App& app, InspectArguments& inspect) {
  app.footer(inspect_examples);
  add_text(app, "URDF", "the robot", "", inspect.robot)->required();
  add_robot(app, inspect.options);
  app.add_flag("--json", inspect.json, "print JSON instead of tables");
}

void add_doctor(CLI::App& app, DoctorArguments& doctor) {
  app.footer(doctor_examples);
  app.add_flag("--json", doctor.json, "print JSON instead of text");
}

using Commands = std::vector<std::pair<const CLI::App*, std::function<Command()>>>;

std::string known_commands(std::string_view name, const Commands& commands) {
  std::vector<std::string> names;
  for (const auto& [command, made] : commands) names.push_back(command->get_name());
  return io::near_names(name, std::vector<std::string_view>(names.begin(), names.end()));
}

/// Throws InputError if the first argument is neither an option nor a command.
void check_command(int argc, const char* const* argv, const Commands& commands) {
  const std::string_view name = argc > 1 ? argv[1] : "-";
  const auto is_it = [&](const auto& command) { return command.first->get_name() == name; };
  if (name.starts_with('-') || std::any_of(commands.begin(), commands.end(), is_it)) return;
  throw InputError("no such command: '" + std::string(name) + "'" + known_commands(name, commands) +
                   " (penumbra --help lists the commands)");
}

/// Returns a hint at the help of the given command.
std::string help_hint(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  const std::string command = commands.empty() ? "" : commands.front()->get_name() + " ";
  return " (penumbra " + command + "--help lists the options)";
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
  CalibrateArguments calibrate;
  ViewPlanningArguments planning;
  LookAheadArguments ahead;
  CloudArguments cloud;
  io::InitOptions init;
  CLI::App app{about, "penumbra"};
  app.footer(main_examples);
  app.set_version_flag("--version", std::string("penumbra ") + PENUMBRA_VERSION);
  app.require_subcommand(0, 1);
  Commands commands;
  const auto add = [&](const char* name, const std::string& what, auto& arguments, auto add_options,
                       auto check) {
    CLI::App* const of = app.add_subcommand(name, what);
    add_options(*of, arguments);
    commands.emplace_back(of, [&arguments, of, check] {
      check(*of, arguments);
      return Command(arguments);
    });
  };
  const auto any = [](const CLI::App&, const auto&) {};
  add("init", "write the recording.yaml of a folder of images", init, add_init, any);
  add("run", "label every frame of a recording or bag", run, add_run, check_run);
  add("cloud", "take the robot out of point clouds and laser scans", cloud, add_cloud, check_cloud);
  add("tune", "measure the sensor: tolerance, fringe, missing parts of the URDF", tune, add_tune,
      check_tune);
  add("calibrate", "find the camera's pose from the robot that it sees", calibrate, add_calibrate,
      check_calibrate);
  add("render", "render one virtual depth image", render, add_render,
      [](const CLI::App&, const RenderArguments& given) {
        check_renderer(given.backend, given.renderer);
      });
  add("inspect", "list which links of a URDF are drawn", inspect, add_inspect, any);
  add("doctor", "print what this machine offers", doctor, add_doctor, any);
  const auto add_if = [&](bool is_built, const char* name, std::string what, auto& arguments,
                          auto add_options, auto check) {
    if (!is_built) what += " (not in this build: penumbra " + std::string(name) + " says why)";
    add(name, what, arguments, add_options, check);
  };
  add_if(build_simulation, "simulate", "record a simulated scene with its truth", simulate,
         add_simulate, any);
  add_if(build_dds, "topics", "list the live topics of ROS 2's graph", topics, add_topics, any);
  add_if(build_dds, "play", "publish a bag on ROS 2's graph", play, add_play, any);
  add_if(build_dds, "live", "label live topics of ROS 2 and publish the results", live, add_live,
         check_live);
  add("view", "show a recording or bag in the browser: 3-D, images, timeline", view, add_view,
      check_view);
  add("view-planning", "find where cameras see targets while the robot moves", planning,
      add_view_planning, check_view_planning);
  add("look-ahead", "say what a planned motion will hide, when, and by which link", ahead,
      add_look_ahead, check_look_ahead);
  check_command(argc, argv, commands);
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
  throw InputError("a command is needed, as 'penumbra run' (penumbra --help lists them)");
}

}  // namespace penumbra::app
