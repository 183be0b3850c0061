// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <type_traits>

#include <CLI/CLI.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/version.hpp>

#include <apps/penumbra/argument_values.hpp>
#include <apps/penumbra/arguments.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/text.hpp>
#include <io/numbers.hpp>

namespace penumbra::app {
namespace {

constexpr int most_gl_devices = 1000;
constexpr int most_repeats = 1'000'000;

/// Adds an option that may be given once and whose text `take` reads.
template <typename Take>
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& help,
                        const std::string& value, Take take) {
  return app.add_option_function<std::string>(names, take, help)->type_name(value)->expected(1);
}

/// The same for an option that may be given several times.
template <typename Take>
CLI::Option* add_list(CLI::App& app, const std::string& names, const std::string& help,
                      const std::string& value, Take take) {
  return app
      .add_option_function<std::vector<std::string>>(
          names,
          [take](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) take(text);
          },
          help)
      ->type_name(value)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::Option* add_path(CLI::App& app, const std::string& names, const std::string& help,
                      const std::string& value, std::filesystem::path& to) {
  return add_option(app, names, help, value, [&to, names](const std::string& text) {
    if (text.empty()) refuse_option(names, text, "a path");
    to = text;
  });
}

void add_renderer(CLI::App& app, RendererArguments& renderer) {
  add_option(app, "--renderer",
             "cpu (default), gl (OpenGL), reference, or auto: the faster of cpu and gl, measured",
             "NAME", [&](const std::string& text) { renderer.backend = to_backend(text); });
  add_option(app, "--gl-device", "OpenGL device by its number in penumbra doctor", "N",
             [&](const std::string& text) {
               renderer.options.gl_device = to_count("--gl-device", text, 0, most_gl_devices);
             });
  add_option(app, "--threads", "threads of the cpu renderer; results do not depend on it", "N",
             [&](const std::string& text) {
               renderer.options.threads =
                   to_count("--threads", text, 1, RendererOptions::max_threads);
             });
}

void add_leniency(CLI::App& app, bool& allow_missing_meshes, bool& geometry_fallback) {
  app.add_flag("--allow-missing-meshes", allow_missing_meshes,
               "go on without meshes that cannot be read; every result names the missing links");
  app.add_flag("--geometry-fallback", geometry_fallback,
               "draw links that have only the other geometry by that; inspect says which");
}

void add_robot(CLI::App& app, RobotOptions& options) {
  add_list(app, "--package", "where package://NAME is; may be given several times", "NAME=DIR",
           [&](const std::string& text) {
             const auto [name, folder] = to_pair("--package", text, "NAME=DIR");
             options.packages[name] = folder;
           });
  add_option(app, "--geometry", "collision or visual; default collision", "NAME",
             [&](const std::string& text) { options.geometry = to_geometry(text); });
  add_leniency(app, options.allow_missing_meshes, options.geometry_fallback);
}

/// Options of versions to come are told apart from mistyped ones; --help does not show them.
void add_unbuilt(CLI::App& app) {
  app.add_option_function<std::vector<std::string>>(
         "--report",
         [](const std::vector<std::string>&) {
           throw InputError("--report is not built into this version; leave it out");
         })
      ->group("")
      ->expected(0, 1);
}

/// Options that the chosen renderer would not heed are refused.
void check_renderer(const RendererArguments& renderer) {
  const std::optional<Backend> backend = renderer.backend;
  const int threads = renderer.options.threads, device = renderer.options.gl_device;
  if (backend && backend != Backend::cpu && threads > 1)
    throw InputError("--threads " + std::to_string(threads) + ": the " +
                     std::string(to_string(*backend)) +
                     " renderer uses one thread; leave --threads out, or choose --renderer cpu");
  if (backend && backend != Backend::gl && device >= 0)
    throw InputError("--gl-device " + std::to_string(device) + ": the " +
                     std::string(to_string(*backend)) +
                     " renderer uses no OpenGL; choose --renderer gl or auto");
}

/// Virtual depth and links stay on the device that labels.
void check_gl_labels(const RunArguments& run) {
  if (!run.gl_labels) return;
  if (run.renderer.backend != Backend::gl)
    throw InputError("--gl-labels: labels are made by OpenGL only with --renderer gl");
  if (run.saves.vdi || run.saves.links)
    throw InputError(
        "--gl-labels: vdi and links stay on the OpenGL device; --save labels and "
        "overlay, or leave --gl-labels out");
  if (run.targets || !run.bag.target_topics.empty())
    throw InputError(
        "--gl-labels: targets cannot be judged on labels that are made on the device; "
        "leave --gl-labels out, or say --targets none");
}

/// Adds an option for bags whose text `take` reads.
template <typename Take>
void add_bag_option(CLI::App& app, BagArguments& bag, const std::string& name,
                    const std::string& help, const std::string& value, Take take) {
  const auto take_text = [&bag, name, value, take](const std::string& text) {
    if (text.empty()) refuse_option(name, text, "a " + value);
    bag.given = name;
    take(text);
  };
  add_option(app, name, help, value, take_text)->group("Of bags");
}

template <typename T>
void add_bag_text(CLI::App& app, BagArguments& bag, const std::string& name,
                  const std::string& help, const std::string& value, T& to) {
  add_bag_option(app, bag, name, help, value, [&to](const std::string& text) { to = text; });
}

template <typename Take>
void add_bag_list(CLI::App& app, BagArguments& bag, const std::string& name,
                  const std::string& help, const std::string& value, Take take) {
  add_list(app, name, help, value, [&bag, name, take](const std::string& text) {
    bag.given = name;
    take(text);
  })->group("Of bags");
}

void add_bag(CLI::App& app, BagArguments& bag) {
  add_bag_text(app, bag, "--depth-topic", "depth images; default: the only ones called depth",
               "TOPIC", bag.depth_topic);
  add_bag_text(app, bag, "--camera-info-topic", "default: beside the depth images", "TOPIC",
               bag.camera_info_topic);
  add_bag_text(app, bag, "--color-topic",
               "judge in this camera's image: depth is brought there by tf, if it is another's",
               "TOPIC", bag.color_topic);
  add_bag_list(app, bag, "--joint-topic",
               "default: /joint_states, or the only one; may be given several times", "TOPIC",
               [&](const std::string& text) { bag.joint_topics.push_back(text); });
  add_bag_list(
      app, bag, "--target-topic",
      "Detection2DArray, Detection3DArray, Keypoints or PoseStamped to judge; may be given "
      "several times",
      "TOPIC", [&](const std::string& text) { bag.target_topics.push_back(text); });
  add_bag_option(app, bag, "--poses",
                 "where links are: joints, tf, or both, which must agree; default: joints, else tf",
                 "NAME", [&](const std::string& text) { bag.poses = to_poses(text); });
  add_bag_text(app, bag, "--robot", "the robot, in place of the bag's robot_description", "URDF",
               bag.robot);
  add_bag_list(app, bag, "--package", "where package://NAME is; may be given several times",
               "NAME=DIR", [&](const std::string& text) {
                 const auto [name, folder] = to_pair("--package", text, "NAME=DIR");
                 bag.packages[name] = folder;
               });
  add_bag_text(app, bag, "--camera-frame", "the images' frame in tf, in place of their frame_id",
               "FRAME", bag.camera_frame);
  add_bag_text(app, bag, "--parent",
               "link that the camera sits on; default: the first above its frame in tf", "LINK",
               bag.parent);
  add_bag_text(app, bag, "--pose",
               "4x4 pose of the optical frame in the parent link, metres, in place of tf's", "FILE",
               bag.pose);
  add_bag_option(app, bag, "--time-offset",
                 "added to the images' stamps before poses are looked up; default 0", "S",
                 [&](const std::string& text) { bag.time_offset = to_time_offset(text); });
  app.add_flag_callback(
         "--rectified",
         [&bag] {
           bag.rectified = true;
           bag.given = "--rectified";
         },
         "the images are free of distortion already, as those called image_rect... are")
      ->group("Of bags");
}

/// A bag holds its topics, all of them, in the camera's own image.
void check_output_bag(RunArguments& run) {
  if (run.output.extension() != ".mcap") return;
  const auto refuse = [](const std::string& option) {
    throw InputError(option +
                     ": a bag of results (-o *.mcap) always holds the same topics, of the " +
                     "camera's images; leave it out, or give a folder with -o");
  };
  if (run.saves.vdi || run.saves.labels || run.saves.links || run.saves.overlay) refuse("--save");
  if (run.gl_labels) refuse("--gl-labels");
  if (run.image == ImageSpace::rectified) refuse("--image rectified");
  run.saves.overlay = true;
}

/// Targets come from a file or from topics, and pixels of topics are those of the camera's images.
void check_targets(const RunArguments& run) {
  if (run.bag.target_topics.empty()) return;
  if (run.targets || run.no_targets)
    throw InputError("--target-topic: --targets is given too; leave one of them out");
  if (run.image == ImageSpace::rectified)
    throw InputError(
        "--target-topic: its pixels are those of the camera's images; leave --image rectified out");
}

void add_run(CLI::App& app, RunArguments& run) {
  app.footer(run_examples);
  add_path(app, "INPUT",
           "a recording folder or its recording.yaml, or a bag of ROS 2: *.mcap, *.db3, or a "
           "folder with metadata.yaml",
           "", run.input)
      ->required();
  add_path(app, "-o,--output",
           "folder for the results, made if need be; or *.mcap: a bag of results", "OUT",
           run.output)
      ->required();
  add_renderer(app, run.renderer);
  add_option(app, "--geometry", "collision or visual; default: the recording's, else collision",
             "NAME", [&](const std::string& text) { run.geometry = to_geometry(text); });
  add_leniency(app, run.allow_missing_meshes, run.geometry_fallback);
  add_option(app, "--tolerance", "e(z) = A + B z + C z^2, metres", "A,B,C",
             [&](const std::string& text) { run.tolerance = to_tolerance(text); });
  add_option(app, "--front-min-width", "narrower front regions become occluded; 0: off", "PX",
             [&](const std::string& text) {
               run.front_min_width = to_count("--front-min-width", text, 0, LabelRule::max_width);
             });
  add_option(app, "--labels",
             "full (default), or paper: constant 0.01 m, no clean-up, no beyond; --tolerance and "
             "--front-min-width override",
             "NAME", [&](const std::string& text) { run.paper_labels = to_paper(text); });
  add_option(app, "--image", "raw (default): results fit the recorded images; or rectified", "NAME",
             [&](const std::string& text) { run.image = to_image(text); });
  add_option(app, "--frames", "the frames from A up to but without B", "A:B",
             [&](const std::string& text) { run.frames = to_range(text); });
  add_option(app, "--save", "images to write: of vdi,labels,links,overlay", "LIST",
             [&](const std::string& text) { run.saves = to_saves(text); });
  add_option(app, "--targets", "which targets to judge, or none; default: the recording's, if any",
             "YAML", [&](const std::string& text) {
               if (text.empty()) refuse_option("--targets", text, "a path, or none");
               run.no_targets = text == "none";
               if (!run.no_targets) run.targets = text;
             });
  app.add_flag(
      "--gl-labels", run.gl_labels,
      "with --renderer gl: label on the OpenGL device, too; saves only labels and overlay");
  add_bag(app, run.bag);
  add_unbuilt(app);
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
  add_renderer(app, render.renderer);
  add_option(app, "--repeat", "render N times and print the times", "N",
             [&](const std::string& text) {
               render.repeat = to_count("--repeat", text, 1, most_repeats);
             });
  app.add_flag("--json", render.json, "print counts, times and joint positions as JSON");
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

template <typename T>
void add_number(CLI::App& app, const std::string& names, const std::string& help,
                const std::string& unit, T& to) {
  const std::string wanted = std::is_floating_point_v<T> ? "a number" : "a whole number from 0";
  add_option(app, names, help, unit, [&to, names, wanted](const std::string& text) {
    const auto value = io::parse_number<T>(text);
    if (!value) refuse_option(names, text, wanted);
    to = *value;
  });
}

void add_simulate(CLI::App& app, SimulateArguments& simulate) {
  app.footer(simulate_examples);
  sim::SimulationOptions& options = simulate.options;
  app.add_option("SCENE", simulate.scene, "conveyor, handover or random")->required();
  add_path(app, "-o,--output", "folder for the recording; new or empty", "OUT", simulate.output)
      ->required();
  add_number(app, "--seed", "what differs between runs; default 0", "N", options.seed);
  add_option(app, "--frames", "write only the frames from A up to but without B", "A:B",
             [&](const std::string& text) { simulate.frames = to_range(text); });
  add_number(app, "--duration", "of the scene; default: its own", "S", options.duration);
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
               "a depth camera on the other side, too: second_depth/");
}

}  // namespace

std::optional<Command> parse_arguments(int argc, const char* const* argv) {
  RunArguments run;
  RenderArguments render;
  InspectArguments inspect;
  DoctorArguments doctor;
  ExperimentArguments experiment;
  SimulateArguments simulate;
  CLI::App app{about, "penumbra"};
  app.footer(main_examples);
  app.set_version_flag("--version", std::string("penumbra ") + PENUMBRA_VERSION);
  app.require_subcommand(0, 1);
  CLI::App* const run_app = app.add_subcommand("run", "label every frame of a recording");
  CLI::App* const render_app = app.add_subcommand("render", "render one virtual depth image");
  CLI::App* const inspect_app = app.add_subcommand("inspect", "tell what of a URDF is drawn");
  CLI::App* const doctor_app = app.add_subcommand("doctor", "tell what this machine offers");
  CLI::App* const experiment_app =
      app.add_subcommand("experiment", "compare methods in simulation, as the paper does");
  add_run(*run_app, run);
  add_render(*render_app, render);
  add_inspect(*inspect_app, inspect);
  add_doctor(*doctor_app, doctor);
  add_experiment(*experiment_app, experiment);
  CLI::App* const simulate_app =
      app.add_subcommand("simulate", "record a simulated scene with its truth");
  add_simulate(*simulate_app, simulate);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& answered) {
    app.exit(answered, std::cout, std::cerr);
    return std::nullopt;
  } catch (const CLI::Error& error) {
    throw InputError(std::string(error.what()) + " (penumbra --help tells the options)");
  }
  check_renderer(run.renderer);
  check_gl_labels(run);
  check_targets(run);
  check_output_bag(run);
  check_renderer(render.renderer);
  if (run_app->parsed()) return run;
  if (render_app->parsed()) return render;
  if (inspect_app->parsed()) return inspect;
  if (doctor_app->parsed()) return doctor;
  if (experiment_app->parsed()) return experiment;
  if (simulate_app->parsed()) return simulate;
  throw InputError(
      "a command is needed: run, render, inspect, doctor, simulate or experiment (penumbra --help "
      "tells more)");
}

}  // namespace penumbra::app
