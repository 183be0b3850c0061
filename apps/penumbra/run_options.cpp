// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>

namespace penumbra::app {
namespace {

/// Adds an option for bags whose text `take` reads.
template <typename Take>
void add_bag_option(CLI::App& app, BagArguments& bag, const std::string& name,
                    const std::string& help, const std::string& value, Take take) {
  const auto take_text = [&bag, name, value, take](const std::string& text) {
    if (text.empty()) refuse_option(name, text, "a " + value);
    bag.given = name;
    take(text);
  };
  add_option(app, name, help, value, take_text)->group(bag.group);
}

template <typename T>
void add_bag_text(CLI::App& app, BagArguments& bag, const std::string& name,
                  const std::string& help, const std::string& value, T& to) {
  add_bag_option(app, bag, name, help, value, [&to](const std::string& text) { to = text; });
}

void add_bag_flag(CLI::App& app, BagArguments& bag, const std::string& name,
                  const std::string& help, bool& to) {
  const auto take = [&bag, &to, name] {
    to = true;
    bag.given = name;
  };
  app.add_flag_callback(name, take, help)->group(bag.group);
}

template <typename Take>
void add_bag_list(CLI::App& app, BagArguments& bag, const std::string& name,
                  const std::string& help, const std::string& value, Take take) {
  add_list(app, name, help, value, [&bag, name, take](const std::string& text) {
    bag.given = name;
    take(text);
  })->group(bag.group);
}

void add_input(CLI::App& app, RunArguments& run) {
  add_path(app, "INPUT",
           "a recording folder or its recording.yaml, or a bag of ROS 2: *.mcap, *.db3, or a "
           "folder with metadata.yaml",
           "", run.input)
      ->required();
}

void add_frames(CLI::App& app, RunArguments& run) {
  add_option(app, "--frames", "the frames from A up to but without B", "A:B",
             [&](const std::string& text) { run.frames = to_range(text); });
}

/// A bag holds its topics, all of them, in the camera's own image.
void check_output_bag(RunArguments& run) {
  if (run.output.extension() != ".mcap") return;
  const auto refuse = [](const std::string& option) {
    throw InputError(option +
                     ": a bag of results (-o *.mcap) always holds the same topics, of the " +
                     "camera's images; leave it out, or give a folder with -o");
  };
  if (run.saves != Saves{}) refuse("--save");
  if (!run.points_frame.empty()) refuse("--points-frame");
  if (run.report_page) refuse("--report");
  if (run.force) refuse("--force");
  if (run.image == ImageSpace::rectified) refuse("--image rectified");
  run.saves.overlay = true;
}

}  // namespace

void add_bag(CLI::App& app, BagArguments& bag) {
  add_bag_text(app, bag, "--depth-topic", "depth images; default: the only ones called depth",
               "TOPIC", bag.depth_topic);
  add_bag_text(app, bag, "--camera-info-topic", "default: beside the depth images", "TOPIC",
               bag.camera_info_topic);
  add_bag_text(app, bag, "--color-topic",
               "judge in this camera's image: depth is brought there by tf, if it is another's",
               "TOPIC", bag.color_topic);
  add_bag_list(app, bag, "--joint-topic",
               "default: " + bag.joints_default + "; may be given several times", "TOPIC",
               [&](const std::string& text) { bag.joint_topics.push_back(text); });
  add_bag_list(
      app, bag, "--target-topic",
      "Detection2DArray, Detection3DArray, Keypoints or PoseStamped to judge; may be given "
      "several times",
      "TOPIC", [&](const std::string& text) { bag.target_topics.push_back(text); });
  add_bag_option(
      app, bag, "--poses",
      "where links are: joints, tf, or both, which must agree; default: " + bag.poses_default,
      "NAME", [&](const std::string& text) { bag.poses = to_poses(text); });
  add_bag_text(app, bag, "--robot", "the robot, in place of the robot_description", "URDF",
               bag.robot);
  add_bag_list(app, bag, "--package", "where package://NAME is; may be given several times",
               "NAME=DIR", [&](const std::string& text) { take_package(text, bag.packages); });
  add_bag_option(app, bag, "--frame-prefix",
                 "before link names in tf, as robot_state_publisher's frame_prefix: left/", "TEXT",
                 [&](const std::string& text) { bag.frame_prefix = text.substr(text[0] == '/'); });
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
  add_bag_flag(
      app, bag, "--first-publisher",
      "do not compare several publishers of one joint or transform: use the first one heard; "
      "default: where they disagree, the pose is unknown",
      bag.first_publisher);
  add_bag_flag(app, bag, "--rectified",
               "the images are free of distortion already, as those called image_rect... are",
               bag.rectified);
}

void add_judging(CLI::App& app, RunArguments& run) {
  add_renderer(app, run.renderer);
  add_option(app, "--geometry", "collision or visual; default: " + run.geometry_default, "NAME",
             [&](const std::string& text) { run.geometry = to_geometry(text); });
  add_leniency(app, run.allow_missing_meshes, run.geometry_fallback);
  add_extra(app, run.extra);
  add_option(app, "--tolerance", "e(z) = A + B z + C z^2, metres", "A,B,C",
             [&](const std::string& text) { run.tolerance = to_tolerance(text); });
  add_option(app, "--front-min-width", "narrower front regions become occluded; 0: off", "PX",
             [&](const std::string& text) {
               run.front_min_width = to_count("--front-min-width", text, 0, LabelRule::max_width);
             });
  add_option(app, "--fringe-reach",
             "pixels past the robot's outline that the sensor carries its depth; 0: off", "PX",
             [&](const std::string& text) {
               run.fringe_reach = to_count("--fringe-reach", text, 0, LabelRule::max_fringe_reach);
             });
  add_option(app, "--sensor",
             "realsense_d4xx (default), zed, tof, structured_light or none: their tolerance and "
             "fringe reach; the two options override",
             "NAME", [&](const std::string& text) {
               static_cast<void>(LabelRule::for_sensor(text));
               run.sensor = text;
             });
  add_option(app, "--labels",
             "full (default), or paper: constant 0.01 m, no clean-up, no fringe, no beyond; "
             "--tolerance, --front-min-width and --fringe-reach override",
             "NAME", [&](const std::string& text) { run.paper_labels = to_paper(text); });
}

void add_sequence(CLI::App& app, RunArguments& run) {
  add_option(app, "--image", "raw (default): results fit the recorded images; or rectified", "NAME",
             [&](const std::string& text) { run.image = to_image(text); });
  add_frames(app, run);
  add_option(app, "--targets", "which targets to judge, or none; default: the recording's, if any",
             "YAML", [&](const std::string& text) {
               if (text.empty()) refuse_option("--targets", text, "a path, or none");
               run.no_targets = text == "none";
               if (!run.no_targets) run.targets = text;
             });
}

void add_tune(CLI::App& app, TuneArguments& tune) {
  app.footer(tune_examples);
  RunArguments& run = tune.judging;
  run.is_shown = true;  // the picture wants colour
  add_input(app, run);
  add_path(app, "-o,--output", "folder for the results, made if need be", "OUT", run.output)
      ->required();
  add_judging(app, run);
  add_frames(app, run);
  add_bag(app, run.bag);
}

void add_run(CLI::App& app, RunArguments& run) {
  app.footer(run_examples);
  add_input(app, run);
  add_path(app, "-o,--output",
           "folder for the results, made if need be; or *.mcap: a bag of results", "OUT",
           run.output)
      ->required();
  add_judging(app, run);
  add_sequence(app, run);
  add_option(app, "--fps",
             "frames per second of a recording without stamps: frame i gets the stamp i / N s", "N",
             [&](const std::string& text) { run.fps = to_fps(text); });
  add_option(app, "--save",
             "what to write for each frame: of vdi,labels,links,overlay, and without the robot "
             "filtered (depth) and points (PCD and PLY)",
             "LIST", [&](const std::string& text) { run.saves = to_saves(text); });
  add_option(app, "--points-frame", "link that points are given in; default: the camera's frame",
             "LINK", [&](const std::string& text) { run.points_frame = text; });
  app.add_flag("--report", run.report_page,
               "write report.html, too: one file with the targets' timeline and key frames");
  app.add_flag("--force", run.force,
               "write into a folder that holds files and no report.json of penumbra");
  add_bag(app, run.bag);
}

void check_targets(const RunArguments& run) {
  if (run.bag.target_topics.empty()) return;
  if (run.targets || run.no_targets)
    throw InputError("--target-topic: --targets is given too; leave one of them out");
  if (run.image == ImageSpace::rectified)
    throw InputError(
        "--target-topic: its pixels are those of the camera's images; leave --image rectified out");
}

void check_run(RunArguments& run) {
  check_renderer(run.renderer);
  check_targets(run);
  check_output_bag(run);
  if (!run.points_frame.empty() && !run.saves.points)
    throw InputError("--points-frame: no points are saved; add --save points, or leave it out");
}

}  // namespace penumbra::app
