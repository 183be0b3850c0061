// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/ros/name_resolver.hpp>
#include <io/run/output_bag.hpp>

namespace penumbra::app {
namespace {

constexpr std::size_t most_planned_cameras = 1000;

void add_path(CLI::App& app, io::InputOptions& input) {
  add_text(app, "INPUT",
           "a recording folder or its recording.yaml, or a bag of ROS 2: *.mcap, *.db3, or a "
           "folder with metadata.yaml",
           "", input.path)
      ->required();
}

void add_input(CLI::App& app, io::InputOptions& input) {
  add_path(app, input);
  add_option(app, "--camera", "one of a recording's cameras", "NAME",
             [&](const std::string& name) { input.camera = name; });
}

void add_cameras(CLI::App& app, RunArguments& run) {
  add_list(app, "--camera",
           "one of a recording's cameras; or depth images of a bag, whose results come into "
           "OUT/NAME, may be given several times",
           "NAME|NAME=TOPIC", [&](const std::string& text) {
             const std::size_t middle = text.find('=');
             const std::string name = text.substr(0, middle);
             if (middle == std::string::npos) {
               run.session.input.camera = name;
               return;
             }
             add_camera(run.cameras, name, text.substr(middle + 1));
           });
}

void add_sequence(CLI::App& app, io::SessionOptions& session) {
  add_choice<ImageSpace>(
      app, "--image", "raw (default): results fit the recorded images; or rectified", session.image,
      {{"raw", ImageSpace::raw}, {"rectified", ImageSpace::rectified}});
  add_frames(app, session.input.frames);
  add_option(app, "--targets", "which targets to judge, or none; default: the recording's, if any",
             "YAML", [&](const std::string& text) {
               if (text.empty()) refuse_option("--targets", text, "a path, or none");
               session.no_targets = text == "none";
               if (!session.no_targets) session.targets = text;
             });
}

DriftLimits to_drift_limits(const std::string& text) {
  const std::vector<double> limits = io::parse_numbers(text);
  if (limits.size() != 2) refuse_option("--drift-limits", text, "MM,DEGREES: two numbers");
  const DriftLimits drift{.position = 1e-3 * limits[0],
                          .rotation = limits[1] * std::numbers::pi / 180.0};
  drift.check();
  return drift;
}

/// Adds an option for each setting of the label rule: front_min_width as --front-min-width.
void add_rule(CLI::App& app, io::RuleOptions& rule) {
  add_settings<LabelRule>(app, "PX", [&rule](const auto& setting, const auto& numbers) {
    return rule.give(setting, numbers);
  });
}

io::Saves to_saves(const std::string& text) {
  static const std::map<std::string, bool io::Saves::*> kinds{
      {"vdi", &io::Saves::vdi},
      {"labels", &io::Saves::labels},
      {"links", &io::Saves::links},
      {"overlay", &io::Saves::overlay},
      {"filtered", &io::Saves::filtered},
      {"points", &io::Saves::points},
      {"robot_mask", &io::Saves::robot_mask}};
  io::Saves saves;
  for (const std::string& part : split(text, ',')) {
    const auto kind = kinds.find(part);
    if (kind == kinds.end())
      refuse_option("--save", part,
                    "one of vdi, labels, links, robot_mask, overlay, filtered, points");
    saves.*kind->second = true;
  }
  return saves;
}

/// A bag always holds all of its topics, in the camera's own image.
void check_output_bag(const RunArguments& run) {
  const auto refuse = [](const std::string& option) {
    throw InputError(option +
                     ": a bag of results (-o *.mcap) always holds the same topics, of the " +
                     "camera's images; leave it out, or give a folder with -o");
  };
  if (run.output.saves != io::Saves{}) refuse("--save");
  if (!run.output.points_frame.empty()) refuse("--points-frame");
  if (run.output.report_page) refuse("--report");
  if (run.output.force) refuse("--force");
  if (run.session.image == ImageSpace::rectified) refuse("--image rectified");
}

/// Targets come from a file or from topics. Pixels in topics are those of the camera's images.
void check_targets(const io::SessionOptions& session) {
  if (session.input.bag.target_topics.empty()) return;
  if (session.targets || session.no_targets)
    throw InputError("--target-topic: --targets is given too; leave one of them out");
  if (session.image == ImageSpace::rectified)
    throw InputError(
        "--target-topic: its pixels are those of the camera's images; leave --image rectified out");
}

/// Checks what run, tune and view have in common.
void check_session(const CLI::App& app, io::SessionOptions& session) {
  check_renderer(session.backend, session.renderer);
  check_targets(session);
  note_bag_option(app, session.input);
}

}  // namespace

void add_camera(std::vector<NamedCamera>& cameras, const std::string& name,
                const std::string& depth_topic) {
  try {
    static_cast<void>(io::NameResolver().resolve("penumbra/" + name));
  } catch (const InputError&) {
    refuse_option("--camera", name, "a name of letters, digits and _, no digit first");
  }
  for (const NamedCamera& camera : cameras)
    if (camera.name == name) throw InputError("--camera: " + name + " is given twice");
  cameras.push_back({name, depth_topic});
}

void note_bag_option(const CLI::App& app, io::InputOptions& input) {
  for (const CLI::Option* option : app.get_options())
    if (option->count() > 0 && option->get_group() == BagHelp().group)
      input.bag_option = option->get_name();
}

void add_bag_robot(CLI::App& app, io::BagOptions& bag, const BagHelp& help) {
  add_list(app, "--joint-topic", "default: " + help.joints + "; may be given several times",
           "TOPIC", [&](const std::string& text) { bag.joint_topics.push_back(text); });
  add_choice<PoseSource>(
      app, "--poses",
      "where the links' poses come from: joints, tf, or both, which must agree; default: " +
          help.poses,
      bag.poses,
      {{"joints", PoseSource::joints}, {"tf", PoseSource::transforms}, {"both", PoseSource::both}});
  add_text(app, "--robot", "the robot, in place of the robot_description", "URDF", bag.robot);
  add_list(app, "--robot-namespace",
           "one of several robots: topics NS/robot_description and NS/joint_states, frames NS/LINK "
           "below 'world' in tf; give it for each",
           "NS", [&](const std::string& text) {
             const std::string name = text.substr(text.starts_with('/') ? 1 : 0);
             if (name.empty() || name.find('/') != std::string::npos)
               refuse_option("--robot-namespace", text, "a name without '/'");
             bag.robot_namespaces.push_back(name);
           });
  for (const char* const of_one : {"--robot", "--joint-topic"})
    app.get_option("--robot-namespace")->excludes(app.get_option(of_one));
  add_packages(app, bag.packages);
  add_option(app, "--frame-prefix",
             "before link names in tf, as robot_state_publisher's frame_prefix: left/", "TEXT",
             [&](const std::string& text) {
               if (text.empty()) refuse_option("--frame-prefix", text, "a TEXT");
               bag.frame_prefix = text.substr(text[0] == '/');
             });
  app.add_flag("--first-publisher", bag.first_publisher,
               "do not compare several publishers of one joint or transform: use the first one "
               "heard; default: where they disagree, the pose is unknown");
  add_text(app, "--parent",
           "link that the " + help.sensor + " is on; default: the first above its frame in tf",
           "LINK", bag.parent);
  add_text(app, "--pose",
           "4x4 pose of the " + help.frame + " in the parent link, metres, in place of tf's",
           "FILE", bag.pose);
  if (help.time_offset)
    add_number(app, "--time-offset",
               "added to the stamps of " + help.data + " before poses are looked up; default 0",
               "S", bag.time_offset, -10.0, 10.0);
}

void add_bag(CLI::App& app, io::BagOptions& bag, const BagHelp& help) {
  const std::size_t first = app.get_options().size();
  add_text(app, "--depth-topic", "depth images; default: the only ones called depth", "TOPIC",
           bag.depth_topic);
  add_text(app, "--camera-info-topic", "default: next to the depth images", "TOPIC",
           bag.camera_info_topic);
  add_text(app, "--color-topic",
           "judge in this camera's image: depth is brought there by tf, if it is another's",
           "TOPIC", bag.color_topic);
  app.add_flag("--no-depth", bag.no_depth,
               "the camera measures no depth: judge its colour images by the robot's model alone");
  add_list(app, "--target-topic",
           "Detection2DArray, Detection3DArray, Keypoints or PoseStamped to judge; may be given "
           "several times",
           "TOPIC", [&](const std::string& text) { bag.target_topics.push_back(text); });
  add_list(app, "--plan-topic",
           "JointTrajectory that the robot follows; default: MoveIt's display_planned_path; may be "
           "given several times",
           "TOPIC", [&](const std::string& text) { bag.plan_topics.push_back(text); });
  add_text(app, "--camera-frame", "the images' frame in tf, in place of their frame_id", "FRAME",
           bag.camera_frame);
  app.add_flag("--rectified", bag.rectified,
               "the images are free of distortion already, as those called image_rect... are");
  add_bag_robot(app, bag, help);
  const auto options = app.get_options();
  for (std::size_t i = first; i < options.size(); ++i) options[i]->group(help.group);
}

void add_session(CLI::App& app, io::SessionOptions& session, const std::string& geometry_default) {
  io::InputOptions& input = session.input;
  io::RuleOptions& rule = session.rule;
  add_renderer(app, session.backend, session.renderer);
  add_drawn(app, input, geometry_default);
  add_rule(app, rule);
  add_option(app, "--sensor",
             "realsense_d4xx (default), zed, tof, structured_light or none: their tolerance and "
             "fringe reach; the two options override",
             "NAME", [&](const std::string& text) {
               static_cast<void>(LabelRule::for_sensor(text));
               rule.sensor = text;
             });
  add_option(app, "--drift-limits",
             "how far a camera may be from its calibration without a note; default 2,0.1",
             "MM,DEGREES", [&](const std::string& text) { session.drift = to_drift_limits(text); });
  add_choice<bool>(app, "--labels",
                   "full (default), or paper: constant 0.01 m, no clean-up, no fringe, no beyond; "
                   "--tolerance and the other settings override",
                   rule.paper_labels, {{"full", false}, {"paper", true}});
}

void add_tune(CLI::App& app, TuneArguments& tune) {
  app.footer(tune_examples);
  add_input(app, tune.session.input);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", tune.output)
      ->required();
  app.add_flag("--force", tune.force, "advise although the setup looks wrong");
  add_session(app, tune.session);
  add_frames(app, tune.session.input.frames);
  add_bag(app, tune.session.input.bag);
}

void add_calibrate(CLI::App& app, CalibrateArguments& calibrate) {
  app.footer(calibrate_examples);
  io::InputOptions& input = calibrate.input.input;
  add_input(app, input);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", calibrate.output);
  add_text(app, "--initial",
           "first guess of the camera's pose, 4x4, at most 100 mm and 10 degrees off; default: the "
           "input's own",
           "FILE", calibrate.initial);
  app.add_flag("--search", calibrate.search, "find the camera without a first guess");
  add_text(app, "--masks",
           "images that are not 0 where the colour image shows the robot, as mask_%d.png; needed "
           "without depth",
           "PATTERN", calibrate.input.masks);
  app.add_flag("--focal", calibrate.focal, "estimate the focal lengths fx and fy, too");
  app.add_flag("--joint-offsets", calibrate.joint_offsets,
               "estimate the zero offset of joints that the images contradict, too");
  app.add_flag("--time-offset", calibrate.input.time_offset,
               "estimate the time between images and poses, too, from frames of a moving arm");
  add_drawn(app, input, "the recording's, else collision");
  add_frames(app, input.frames);
  add_bag(app, input.bag, {.time_offset = false});
}

void add_view_planning(CLI::App& app, ViewPlanningArguments& planning) {
  app.footer(view_planning_examples);
  io::InputOptions& input = planning.input.input;
  add_input(app, input);
  add_text(app, "--candidates",
           "poses of the camera: name,x,y,z,qx,qy,qz,qw and, if not in the root link, link", "CSV",
           planning.input.candidates)
      ->required();
  add_text(app, "--targets", "3-D targets to see; default: the recording's", "YAML",
           planning.input.targets);
  add_number<std::size_t>(app, "--cameras", "find the best sets of up to K cameras; default 1", "K",
                          planning.cameras, 1, most_planned_cameras);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", planning.output);
  add_number(app, "--threads", "default: one per core; results do not depend on it", "N",
             planning.threads, 1, RendererOptions::max_threads);
  add_frames(app, input.frames);
  add_drawn(app, input, "the recording's, else collision");
  add_bag(app, input.bag);
}

void add_look_ahead(CLI::App& app, LookAheadArguments& ahead) {
  app.footer(look_ahead_examples);
  io::InputOptions& input = ahead.input.input;
  add_input(app, input);
  add_list(
      app, "--trajectory",
      "a planned motion: *.csv with time,JOINT,..., or a message in YAML or JSON; may be given "
      "several times: they are ranked; default: the bag's plan",
      "FILE", [&](const std::string& file) { ahead.input.trajectories.emplace_back(file); });
  add_text(app, "--targets", "what to keep in view; default: the recording's", "YAML",
           ahead.input.targets);
  add_number<std::int64_t>(
      app, "--from",
      "frame in which the motion begins; default: the first with joints and a motion", "N",
      ahead.input.from, 0, std::numeric_limits<std::int64_t>::max() - 1);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", ahead.output);
  add_number(app, "--threads", "default: one per core; results do not depend on it", "N",
             ahead.threads, 1, RendererOptions::max_threads);
  add_drawn(app, input, "the recording's, else collision");
  add_bag(app, input.bag);
}

void add_run(CLI::App& app, RunArguments& run) {
  app.footer(run_examples);
  add_path(app, run.session.input);
  add_cameras(app, run);
  add_text(app, "-o,--output",
           "folder for the results, made if need be; or *.mcap: a bag of results", "OUT",
           run.output.path)
      ->required();
  add_session(app, run.session);
  app.get_option("--threads")
      ->description(
          "threads of the cpu renderer, default 1, and of those that read and write images, "
          "default "
          "one per core; results do not depend on it");
  add_sequence(app, run.session);
  add_number(app, "--fps",
             "frames per second of a recording without stamps: frame i gets the stamp i / N s", "N",
             run.session.input.fps, 0.001, 1000.0);
  add_option(
      app, "--save",
      "what to write for each frame: of vdi,labels,links,robot_mask,overlay, and without the robot "
      "filtered (depth) and points (PCD and PLY)",
      "LIST", [&](const std::string& text) { run.output.saves = to_saves(text); });
  add_option(app, "--points-frame", "link that points are given in; default: the camera's frame",
             "LINK", [&](const std::string& text) { run.output.points_frame = text; });
  app.add_flag("--report", run.output.report_page,
               "write report.html, too: one file with the targets' timeline and key frames");
  app.add_flag(
      "--force", run.output.force,
      "write into a folder that holds files and no report.json of penumbra; and exit with 0 "
      "although the images do not show the robot where the setup says");
  add_bag(app, run.session.input.bag);
}

void check_tune(const CLI::App& app, TuneArguments& tune) {
  check_session(app, tune.session);
  tune.session.input.needs_depth = true;
  tune.session.input.with_color = true;  // for the picture
  tune.session.no_targets = true;
  tune.session.image = ImageSpace::rectified;  // tuning takes a pinhole camera's images
}

void check_calibrate(const CLI::App& app, CalibrateArguments& calibrate) {
  note_bag_option(app, calibrate.input.input);
  if (calibrate.search && calibrate.initial)
    throw InputError("--search: --initial is given too; leave one of them out");
  calibrate.input.input.needs_depth = !calibrate.input.masks;
  calibrate.input.input.needs_camera_pose = !calibrate.search && !calibrate.initial;
}

void check_view_planning(const CLI::App& app, ViewPlanningArguments& planning) {
  note_bag_option(app, planning.input.input);
  if (!planning.input.input.bag.target_topics.empty())
    throw InputError("--target-topic: targets come from the file of --targets; leave it out");
}

void check_look_ahead(const CLI::App& app, LookAheadArguments& ahead) {
  note_bag_option(app, ahead.input.input);
  if (!ahead.input.input.bag.target_topics.empty())
    throw InputError("--target-topic: targets come from the file of --targets; leave it out");
}

void check_run(const CLI::App& app, RunArguments& run) {
  check_session(app, run.session);
  const io::Saves& saves = run.output.saves;
  const bool is_bag = io::is_output_bag(run.output.path);
  if (is_bag) check_output_bag(run);
  if (!run.output.points_frame.empty() && !saves.points)
    throw InputError("--points-frame: no points are saved; add --save points, or leave it out");
  if (app.get_option("--threads")->count() > 0)
    run.output.threads = run.session.input.threads = run.session.renderer.threads;
  run.session.input.with_color = is_bag || saves.overlay || saves.points || run.output.report_page;
}

void add_view(CLI::App& app, ViewArguments& view) {
  app.footer(view_examples);
  add_text(app, "INPUT",
           "a recording folder or its recording.yaml, a bag of ROS 2, or a folder that run wrote",
           "", view.session.input.path)
      ->required();
  add_server(app, view.server,
             "where the page is served; 0: any that is free; default 8470, or the next free one");
  add_session(app, view.session);
  add_sequence(app, view.session);
  add_bag(app, view.session.input.bag);
}

void check_view(const CLI::App& app, ViewArguments& view) {
  check_session(app, view.session);
  view.session.input.with_color = true;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() > 0 && name != "INPUT" && name != "--port" && name != "--address")
      view.judging_option = name;
  }
}

}  // namespace penumbra::app
