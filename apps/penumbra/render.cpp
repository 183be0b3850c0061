// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/session/warnings.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/camera_info.hpp>
#include <io/files/json.hpp>
#include <io/files/names.hpp>
#include <io/files/npy.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/png.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/report_json.hpp>
#include <io/inputs/input_session.hpp>

namespace penumbra::app {
namespace {

struct RenderArguments {
  std::filesystem::path robot;
  RobotOptions options;
  std::filesystem::path camera_info;
  bool rectified = false;  ///< the images are free of distortion: p of camera_info is the camera
  std::filesystem::path pose;
  std::string parent;
  std::vector<std::pair<std::string, double>> joints;  ///< name and value, in the given order
  std::filesystem::path output;
  std::optional<std::filesystem::path> links;
  Backend backend = Backend::cpu;
  RendererOptions renderer;
  int repeat = 1;
  bool json = false;
};

constexpr int most_repeats = 1'000'000;

std::vector<double> positions_of(const Robot& robot, const RenderArguments& arguments) {
  std::vector<double> positions = robot.rest_positions();
  std::vector<bool> given(positions.size(), false);
  for (const auto& [name, value] : arguments.joints) {
    const auto variable = robot.find_variable(name);
    if (!variable) {
      const std::vector<std::string_view> known(robot.variables().begin(), robot.variables().end());
      throw InputError("--joint: robot '" + robot.name() + "' has no joint variable '" + name +
                       "'" + io::near_names(name, known));
    }
    if (given[*variable]) throw InputError("--joint: '" + name + "' is given twice");
    given[*variable] = true;
    positions[*variable] = value;
  }
  return positions;
}

/// Returns a note about joints at rest if others are given.
std::vector<std::string> rest_notes(const Robot& robot, const RenderArguments& arguments) {
  const auto& joints = arguments.joints;
  std::string names;
  for (const std::string& name : robot.variables())
    if (std::none_of(joints.begin(), joints.end(), [&](const auto& j) { return j.first == name; }))
      names += (names.empty() ? "" : ", ") + name;
  if (joints.empty() || names.empty()) return {};
  return {"no --joint for " + names + ": drawn at rest (0, or no rotation)"};
}

Session make_session(const RenderArguments& arguments, Robot robot, Camera camera) {
  PipelineConfig config;
  config.backend = arguments.backend;
  config.renderer = arguments.renderer;
  camera.parent = arguments.parent;
  camera.T_parent_camera = io::read_pose_csv(arguments.pose);
  return io::make_session(std::move(robot), camera, config, {}, arguments.camera_info);
}

/// Throws if `file` is an input or another output.
void check_own(const std::string& option, const std::filesystem::path& file,
               const std::vector<std::pair<std::string, std::filesystem::path>>& others) {
  std::error_code error;
  for (const auto& [other, path] : others) {
    if (file != path && !std::filesystem::equivalent(file, path, error)) continue;
    std::string message = option + ": " + file.string();
    message += " is the file of " + other + " too";
    throw InputError(message);
  }
}

/// Refuses a name whose ending does not match the content.
void check_ending(const std::string& option, const std::filesystem::path& file,
                  const std::string& ending, const std::string& content) {
  if (file.extension() == ending) return;
  std::string message = option + ": " + file.string();
  message += ": " + content + " would be written; name a file that ends in " + ending;
  throw InputError(message);
}

void check_outputs(const RenderArguments& arguments) {
  std::vector<std::pair<std::string, std::filesystem::path>> others = {
      {"--robot", arguments.robot},
      {"--camera", arguments.camera_info},
      {"--pose", arguments.pose}};
  check_own("-o", arguments.output, others);
  others.emplace_back("-o", arguments.output);
  if (arguments.links) check_own("--links", *arguments.links, others);
  check_ending("-o", arguments.output, ".npy", "NumPy's format (float32 metres)");
  if (arguments.links) check_ending("--links", *arguments.links, ".png", "a 16-bit PNG");
  io::check_is_no_folder("-o", arguments.output);
  if (arguments.links) io::check_is_no_folder("--links", *arguments.links);
}

void append(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

/// The wanted images. finish() gives them their names.
class RenderedImages {
 public:
  RenderedImages(const RenderArguments& arguments, const FrameReport& report)
      : depth_(arguments.output) {
    if (!has_pose(report.status)) throw InputError("--joint or --pose: " + report.message);
    if (report.status == FrameStatus::missing_link)
      print_error(std::string(to_string(report.status)) + ": " + report.message);
    io::write_npy(depth_.part(), report.virtual_depth.depth);
    if (!arguments.links) return;
    links_.emplace(*arguments.links);
    io::write_png(links_->part(), report.virtual_depth.links);
  }

  void finish() {
    if (links_) links_->finish();
    depth_.finish();
  }

 private:
  io::PendingFile depth_;
  std::optional<io::PendingFile> links_;
};

void print_text(const std::filesystem::path& output, const Pipeline& pipeline,
                const PixelCounts& pixels, const io::Statistics& repeats) {
  std::cout << output.string() << ": " << pixels.robot.value_or(0) << " robot pixels of "
            << pipeline.triangle_count() << " triangles\n";
  for (std::size_t i = 0; i < io::stages.size(); ++i)
    if (const auto q = repeats.timing(i))
      std::cout << io::stages[i].name << ": min " << fixed(q->min, 3) << " ms, median "
                << fixed(q->median, 3) << " ms, p99 " << fixed(q->p99, 3) << " ms\n";
}

void print_json(const Pipeline& pipeline, const PixelCounts& pixels,
                const std::vector<double>& positions, const std::vector<std::string>& notes,
                const io::Statistics& repeats) {
  io::Json json = {{"triangles", pipeline.triangle_count()},
                   {"robot_pixels", pixels.robot.value_or(0)},
                   {"uncovered", pixels.uncovered}};
  for (std::size_t i = 0; i < io::stages.size(); ++i) {
    if (io::stages[i].name == "targets") continue;
    const auto q = repeats.timing(i);
    json[std::string(io::stages[i].name) + "_ms"] =
        q ? io::Json{{"min", q->min}, {"median", q->median}, {"p99", q->p99}} : io::Json();
  }
  json["renderer"] = io::renderer_json(pipeline.renderer());
  json["joints"] = io::Json::object();
  for (std::size_t i = 0; i < positions.size(); ++i)
    json["joints"][pipeline.robot().variables()[i]] = positions[i];
  const auto missing = pipeline.missing_links();
  json["missing_links"] = std::vector<std::string>(missing.begin(), missing.end());
  json["notes"] = notes;
  std::cout << json.dump(2, ' ', false, io::Json::error_handler_t::replace) << '\n';
}

void add_options(CLI::App& app, RenderArguments& render) {
  app.footer(render_examples);
  add_text(app, "--robot", "the robot", "URDF", render.robot)->required();
  add_robot(app, render.options);
  add_text(app, "--camera", "camera_info YAML, or of OpenCV, kalibr, RealSense", "FILE",
           render.camera_info)
      ->required();
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

int execute(const RenderArguments& arguments) {
  check_outputs(arguments);
  Robot robot = Robot::load(arguments.robot, arguments.options);
  const std::vector<double> positions = positions_of(robot, arguments);
  const Camera camera = io::read_camera_info(arguments.camera_info, arguments.rectified);
  Session session = make_session(arguments, std::move(robot), camera);
  Pipeline& pipeline = session.pipeline();

  // The results do not depend on this depth.
  const Image<float> any_depth(camera.intrinsics.width(), camera.intrinsics.height(), 1.0F);
  const FrameReport& first =
      pipeline.process({.depth = any_depth.view(), .pose = {.positions = positions}});
  if (!first.T_root_camera) throw InputError(first.message);
  RenderedImages images(arguments, first);
  print_notes(pipeline.robot().notes());
  std::vector<std::string> of_pose = rest_notes(pipeline.robot(), arguments);
  Warnings doubts(pipeline.robot());
  doubts.add(first, {.pose = {.positions = positions}});
  append(of_pose, doubts.lines());
  print_notes(of_pose);

  const PixelCounts pixels = first.pixels;
  const Image<float> seen = io::copy_of(first.virtual_depth.depth);
  io::Statistics repeats;
  for (int i = 0; i < arguments.repeat; ++i)
    repeats.add(pipeline.process({.depth = seen.view(), .pose = {.positions = positions}}));
  images.finish();
  const auto of_robot = pipeline.robot().notes();
  std::vector<std::string> notes(of_robot.begin(), of_robot.end());
  append(notes, of_pose);

  if (arguments.json)
    print_json(pipeline, pixels, positions, notes, repeats);
  else
    print_text(arguments.output, pipeline, pixels, repeats);
  return 0;
}

}  // namespace

Execute add_render(CLI::App& app) {
  return make_command<RenderArguments>(app, add_options, nullptr, execute);
}

}  // namespace penumbra::app
