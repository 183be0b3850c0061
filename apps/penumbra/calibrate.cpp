// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/calibration_report.hpp>
#include <io/files/names.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/result_folder.hpp>
#include <io/inputs/calibration_input.hpp>
#include <io/web/calibration_pictures.hpp>

namespace penumbra::app {
namespace {

struct CalibrateArguments {
  io::CalibrationInputOptions input;
  std::filesystem::path output;  ///< empty: nothing is written
  std::optional<std::filesystem::path> initial;
  bool search = false;
  bool focal = false;
  bool joint_offsets = false;            ///< the time offset is in `input`
  std::optional<double> joint_accuracy;  ///< degrees
  std::optional<double> accept;          ///< millimetres
};

constexpr double degrees = 180.0 / std::numbers::pi;

/// The value and twice its standard deviation.
std::string plus_minus(const Estimate& estimate, double scale, int digits) {
  return fixed(scale * estimate.value, digits) + " +- " +
         fixed(2.0 * scale * estimate.sigma, digits);
}

std::string joined(const auto& values, int digits, const char* separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + fixed(value, digits);
  return text;
}

void print_fit(const Calibration& found, const Robot& robot, const Intrinsics& camera,
               bool by_images) {
  std::cout << "position within " << fixed(1e3 * found.position_error(), 1)
            << " mm, rotation within " << fixed(degrees * found.rotation_error(), 2)
            << " degrees (95 %)\n";
  if (found.depth_scale)
    std::cout << "depth: measured = " << plus_minus(*found.depth_scale, 100.0, 2) << " % + "
              << plus_minus(*found.depth_offset, 1e3, 1) << " mm more than true\n";
  else
    std::cout << "overlap with " << (by_images ? "what hides the background " : "the masks ")
              << fixed(100.0 * found.mask_overlap, 1) << " %\n";
  std::cout << "the robot's picture is " << plus_minus(found.outline, 1.0, 1) << " px larger\n";
  if (found.shift_right)
    std::cout << "the pose is that of the colour image: the depth image lies "
              << plus_minus(*found.shift_right, 1.0, 1) << " px to its right and "
              << plus_minus(*found.shift_down, 1.0, 1) << " px below; overlap with the masks "
              << fixed(100.0 * found.mask_overlap, 1) << " %\n";
  if (found.focal_x)
    std::cout << "focal lengths: fx " << plus_minus(*found.focal_x, 100.0, 2) << " %, fy "
              << plus_minus(*found.focal_y, 100.0, 2) << " % longer: use fx "
              << fixed(camera.fx() * (1.0 + found.focal_x->value), 2) << ", fy "
              << fixed(camera.fy() * (1.0 + found.focal_y->value), 2)
              << " px with this pose (in P too, if the camera_info has it)\n";
  for (std::size_t j = 0; j < found.joint_offsets.size(); ++j)
    std::cout << "  " << robot.variables()[j] << ": "
              << plus_minus(found.joint_offsets[j], degrees, 2) << " degrees\n";
  if (found.time_offset)
    std::cout << "time offset: " << plus_minus(*found.time_offset, 1e3, 1)
              << " ms: run with --time-offset " << fixed(found.time_offset->value, 4) << '\n';
  std::cout << found.advice << '\n';
  const bool has_depth = found.depth_scale.has_value();
  std::vector<std::vector<std::string>> rows{
      {"frame", has_depth ? "agrees" : "overlaps", "surface", "edge"}};
  for (const FrameFit& frame : found.frames)
    rows.push_back({std::to_string(frame.index) + (frame.used ? "" : " (left out)"),
                    fixed(100.0 * frame.agreeing, 0) + " %",
                    has_depth ? fixed(1e3 * frame.residual, 1) + " mm" : "-",
                    fixed(frame.outline, 1) + " px"});
  print_table(std::move(rows));
}

void print_pose(const Calibration& found, const std::string& parent, const std::string& frame) {
  const Eigen::Isometry3d& T = found.T_parent_camera;
  const Eigen::Quaterniond q(T.linear());
  const std::string xyz = joined(T.translation(), 5, " ");
  std::cout << "\n4x4, optical frame in " << parent << ", metres:\n";
  for (int row = 0; row < 4; ++row)
    std::cout << "  " << joined(T.matrix().row(row), 6, ", ") << '\n';
  std::cout << "xyz: " << xyz << "\nquaternion xyzw: " << joined(q.coeffs(), 6, " ") << '\n';
  if (frame == parent) {
    std::cout << "URDF: multiply the origin of this link's joint by the pose\n";
    return;
  }
  std::cout << "ROS 2: "
            << io::static_transform_command(T, parent,
                                            frame.empty() ? "camera_optical_frame" : frame)
            << "\n  (in place of the transforms that lead to this frame now)\n";
}

/// Prints how other commands take the pose's file.
void print_use(const CalibrateArguments& arguments, bool is_bag, const std::string& parent) {
  const std::filesystem::path& of = arguments.input.input.path;
  const std::filesystem::path file = arguments.output / "camera_pose.csv";
  if (is_bag) {
    std::cout << "with this bag, in place of tf: --pose " << io::for_shell(file.string())
              << " --parent " << io::for_shell(parent) << '\n';
    return;
  }
  const auto own = std::filesystem::is_directory(of) ? of : of.parent_path();
  std::cout << "in the recording.yaml, below 'camera:':\n  parent: " << parent
            << "\n  pose: " << std::filesystem::proximate(file, own).string() << '\n';
}

/// Returns what is wrong with the input other than the camera's pose; empty: nothing known.
std::string other_cause(const io::CalibrationInput& input, const CalibrationOptions& options) {
  if (!options.initial || input.frames.empty()) return {};
  const Robot& robot = input.input.robot;
  const std::size_t parent =
      options.camera_parent.empty() ? 0 : *robot.find_link(options.camera_parent);
  std::vector<KeptFrame> frames = input.frames;  // thinned to what a diagnosis compares
  const KeptFrames kept(robot, {input.camera, {}, {}, {}}, {.columns = SetupCheck::columns});
  const auto make_small = [&kept](auto& image) {
    if (!image.empty()) image = kept.image_of(std::as_const(image).view());
  };
  for (KeptFrame& frame : frames) {
    make_small(frame.depth);
    make_small(frame.mask);
    make_small(frame.color);
  }
  const Diagnosis found = diagnose(frames, kept.camera(), input.input.camera->intrinsics, robot,
                                   parent, *options.initial);
  using Cause = Diagnosis::Cause;
  const bool is_other = found.cause != Cause::camera_pose && found.cause != Cause::unexplained;
  return is_other ? found.message : std::string();
}

void add_options(CLI::App& app, CalibrateArguments& calibrate) {
  app.footer(calibrate_examples);
  io::InputOptions& input = calibrate.input.input;
  add_input(app, input);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", calibrate.output);
  add_text(app, "--initial",
           "first guess of the camera's pose, 4x4, at most 100 mm and 10 degrees off; default: the "
           "input's own",
           "FILE", calibrate.initial);
  app.add_flag("--search", calibrate.search, "find the camera without a first guess");
  add_text(
      app, "--masks",
      "images that are not 0 where the colour image shows the robot, and 128 where that is not "
      "known, as mask_%d.png",
      "PATTERN", calibrate.input.masks);
  app.add_flag("--images", calibrate.input.images,
               "take the colour images of a camera that stands still, in place of depth or masks");
  app.add_flag("--focal", calibrate.focal, "estimate the focal lengths fx and fy, too");
  app.add_flag("--joint-offsets", calibrate.joint_offsets,
               "estimate the zero offset of joints that the images contradict, too");
  add_number(app, "--joint-accuracy",
             "standard deviation of the joints' zeros, degrees; default 0.29, as industrial arms "
             "have; 1 to 2 for hobby servos",
             "DEG", calibrate.joint_accuracy, 1e-3, 10.0);
  add_number(app, "--accept",
             "take a pose that is known to so many millimetres and milliradians only; default 30, "
             "without depth 60 and 30",
             "MM", calibrate.accept, 1.0, 1000.0);
  app.add_flag("--time-offset", calibrate.input.time_offset,
               "estimate the time between images and poses, too, from frames of a moving arm");
  add_drawn(app, input, "the recording's, else collision");
  add_frames(app, input.frames);
  add_bag(app, input.bag, {.time_offset = false});
}

void check_options(const CLI::App& app, CalibrateArguments& calibrate) {
  note_bag_option(app, calibrate.input.input);
  if (calibrate.search && calibrate.initial)
    throw InputError("--search: --initial is given too; leave one of them out");
  calibrate.input.input.with_color = calibrate.input.images;
  calibrate.input.input.needs_depth = !calibrate.input.masks && !calibrate.input.images;
  calibrate.input.input.needs_camera_pose = !calibrate.search && !calibrate.initial;
}

int execute(const CalibrateArguments& arguments) {
  std::optional<io::ResultFolder> folder;
  if (!arguments.output.empty())
    folder.emplace(
        io::ResultFolderOptions{.path = arguments.output,
                                .report = {"calibration.json", io::json_begin},
                                .others = {{"camera_pose.csv"}, {"report.html", io::page_begin}}});
  const io::CalibrationInput input = [&] {
    Progress progress(0);
    return io::read_calibration_input(arguments.input, print_line, [&] { progress.step(); });
  }();
  std::vector<std::filesystem::path> used = input.input.made_files;
  if (arguments.initial) used.push_back(*arguments.initial);
  if (folder) folder->begin(used);
  print_notes(input.notes);
  const Robot& robot = input.input.robot;
  CalibrationOptions options{.camera_parent = input.input.camera->parent,
                             .initial = input.input.camera->pose(),
                             .focal = arguments.focal,
                             .joint_offsets = arguments.joint_offsets,
                             .time_offset = arguments.input.time_offset};
  if (arguments.joint_accuracy) options.joint_accuracy = *arguments.joint_accuracy / degrees;
  if (arguments.accept) options.accept = 1e-3 * *arguments.accept;
  if (arguments.initial) options.initial = io::read_pose_csv(*arguments.initial);
  if (arguments.search) options.initial.reset();
  std::cout << input.frames.size() << " of " << input.seen
            << " frames have different poses of the robot\n";
  Calibration found = calibrate(input.frames, input.camera, robot, options);
  print_notes(found.notes);
  found.notes.insert(found.notes.begin(), input.notes.begin(), input.notes.end());
  if (arguments.initial && input.T_by_tf && found.is_good())
    print_notes(std::vector{"compared with the found pose and its region, tf's pose is " +
                            distance_text(found, *input.T_by_tf)});
  if (folder) {
    if (found.is_good())
      folder->add("camera_pose.csv", [&](const std::filesystem::path& part) {
        io::write_pose_csv(part, found.T_parent_camera);
      });
    const std::string json = io::calibration_json(io::input_name(arguments.input.input.path), found,
                                                  robot, options.camera_parent) +
                             "\n";
    folder->add_text("report.html",
                     io::report_page(json, io::calibration_pictures(input.frames, input.camera,
                                                                    robot, options, found)));
    folder->add_text("calibration.json", json);
    folder->finish();
  }
  const std::string parent =
      options.camera_parent.empty() ? robot.links().front() : options.camera_parent;
  if (found.is_good() || found.is_wide) {
    print_fit(found, robot, input.input.camera->intrinsics, arguments.input.images);
    print_pose(found, parent, input.input.camera->frame_id);
  }
  if (!found.is_good()) {
    std::string why;
    for (const std::string& fault : found.faults) why += (why.empty() ? "" : "; ") + fault;
    if (const std::string wrong = other_cause(input, options); !wrong.empty()) why += "; " + wrong;
    if (found.is_wide)
      why += "; the pose above is the best known, --accept " +
             fixed(std::ceil(1e3 * std::max(found.position_error(), found.rotation_error())), 0) +
             " takes it";
    throw InputError(arguments.input.input.path.string() +
                     (found.is_wide ? ": not good: " : ": not calibrated: ") + why);
  }
  if (folder) print_use(arguments, input.input.bag.has_value(), parent);
  return 0;
}

}  // namespace

Execute add_calibrate(CLI::App& app) {
  return make_command<CalibrateArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
