// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_reader.hpp>
#include <io/files/frame_reader.hpp>
#include <io/files/joint_file.hpp>
#include <io/files/names.hpp>
#include <io/inputs/read_ahead.hpp>
#include <io/inputs/run_input.hpp>

namespace penumbra::io {
namespace {

/// Returns the positions of the wanted frames. The range must lie inside the recording.
std::vector<std::size_t> select_frames(const FrameRange& range, const FrameReader& reader) {
  std::int64_t least = reader.index(0);
  std::int64_t most = reader.index(0);
  for (std::size_t i = 0; i < reader.size(); ++i) {
    least = std::min(least, reader.index(i));
    most = std::max(most, reader.index(i));
  }
  const std::int64_t first = range.first.value_or(least);
  const std::int64_t end = range.end.value_or(most + 1);
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < reader.size(); ++i)
    if (reader.index(i) >= first && reader.index(i) < end) selected.push_back(i);
  if (selected.empty() || first < least || end > most + 1)
    throw InputError(range.option + " " + std::to_string(first) + ":" + std::to_string(end) +
                     ": the recording has the frames " + std::to_string(least) + " to " +
                     std::to_string(most) + ", all of them " + std::to_string(least) + ":" +
                     std::to_string(most + 1));
  return selected;
}

void check_links(const Recording& recording, const Robot& robot,
                 const std::vector<ExtraMesh>& extra) {
  const auto check = [&](const std::string& key, const std::string& link) {
    if (link.empty() || robot.find_link(link)) return;
    const std::vector<std::string_view> known(robot.links().begin(), robot.links().end());
    throw InputError(recording.file.string() + ": " + key + ": '" + link +
                     "' is no link of the robot" + near_names(link, known));
  };
  try {
    static_cast<void>(find_camera_parent(robot, recording.camera.camera.parent));
  } catch (const InputError& error) {
    throw InputError(recording.file.string() + ": camera.parent: " + error.what());
  }
  for (const RecordedBody& each : recording.attached)
    check("attached: " + each.body.name + ": link", each.body.link);
  for (const ExtraMesh& part : extra) check("--extra", part.link);
}

/// Some frames of a recording folder.
class RecordingSource final : public FrameSource {
 public:
  RecordingSource(std::shared_ptr<const FrameReader> reader,
                  const std::vector<std::size_t>& selected, const InputOptions& options)
      : reader_(std::move(reader)),
        selected_(selected),
        with_color_(options.with_color),
        color_step_(options.with_color     ? 1
                    : reader_->has_depth() ? 0
                                           : std::max<std::size_t>(1, selected.size() / enough)),
        fps_(options.fps),
        threads_(options.threads) {}

  /// Throws InputError if the recording has stamps of its own and --fps is given.
  bool read(std::size_t number, Frame& frame) override {
    if (number >= selected_.size()) return false;
    frame = reader_->read(selected_[number], color_step_ > 0 && number % color_step_ == 0);
    if (!with_color_) frame.color_message.clear();  // nobody asked for a picture
    if (fps_ && frame.stamp)
      throw InputError("frame " + std::to_string(*frame.index) +
                       " has a stamp of its own: leave --fps out");
    if (fps_) {
      frame.stamp = std::llround(1e9 * static_cast<double>(*frame.index) / *fps_);
      if (!frame.pose.positions.empty()) frame.pose.age = 0;
    }
    return true;
  }
  /// Most of the time goes into decoding.
  [[nodiscard]] std::size_t at_once() const override {
    const auto cores = static_cast<int>(std::thread::hardware_concurrency());
    return static_cast<std::size_t>(std::clamp(threads_ > 0 ? threads_ : cores, 1, most_at_once));
  }
  [[nodiscard]] std::optional<std::size_t> size() const override { return selected_.size(); }
  [[nodiscard]] std::vector<std::string> notes() const override { return {}; }

 private:
  static constexpr int most_at_once = 8;  // each has images in memory
  /// Colour images, from which Session diagnoses a setup without depth.
  static constexpr std::size_t enough = 64;

  std::shared_ptr<const FrameReader> reader_;
  std::vector<std::size_t> selected_;
  bool with_color_;
  std::size_t color_step_;  // frames from one colour image that is read to the next; 0: none is
  std::optional<double> fps_;
  int threads_;
};

RunInput open_recording_input(const InputOptions& options) {
  check_is_recording(options.path);
  Recording recording = Recording::open(options.path, options.camera);
  check_no_bag_option(options);
  if (options.needs_depth && !recording.frames.depth)
    throw InputError(recording.file.string() +
                     ": frames: key 'depth' is missing: " + needs_depth_images);
  if (!options.needs_camera_pose && !recording.camera.camera.T_parent_camera)
    recording.camera.camera.T_parent_camera = Eigen::Isometry3d::Identity();
  std::vector<std::string> names;
  for (const RecordedRobot& robot : recording.robots) names.push_back(robot.name);
  check_robots_of(options.joints, names);
  for (RecordedRobot& robot : recording.robots) options.apply_to(robot.options, robot.name);
  Robot robot = recording.load_robot();
  const auto reader = std::make_shared<const FrameReader>(recording, robot);
  std::vector<std::size_t> selected = select_frames(options.frames, *reader);
  check_links(recording, robot, options.extra);
  const auto by_time = [](const auto& pattern) { return pattern && pattern->is_by_time(); };
  const bool is_by_time = by_time(recording.frames.depth) || by_time(recording.frames.color);
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < reader->size(); ++i) numbers.push_back(reader->index(i));
  std::ranges::sort(numbers);
  return {.robot_options = recording.robot_options(),
          .robot = std::move(robot),
          .camera = recording.camera.camera,
          .camera_info = recording.camera.info,
          .config = recording.pipeline_config(),
          .beyond = recording.camera.beyond,
          .targets = recording.targets,
          .frame_numbers = std::move(numbers),
          .stamps =
              is_by_time ? std::optional(read_frame_stamps(recording.frames.joints)) : std::nullopt,
          .bag = {},
          .made_files = {recording.camera.pose},
          .frames = [reader, selected = std::move(selected),
                     options]() -> std::unique_ptr<FrameSource> {
            return std::make_unique<RecordingSource>(reader, selected, options);
          }};
}

RunInput open_folder_or_bag(const InputOptions& options, const LineSink& print) {
  if (!is_bag(options.path)) return open_recording_input(options);
  if (!options.camera.empty())
    throw InputError(
        "--camera: is for recording folders; choose a bag's by --depth-topic, or "
        "several by --camera NAME=TOPIC");
  if (options.fps)
    throw InputError("--fps: is for recording folders; the messages of a bag have stamps");
  return open_bag_input(options, print);
}

}  // namespace

bool is_bag(const std::filesystem::path& input) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(input, ignored)) return is_bag_file(input);
  return is_bag_folder(input);
}

void check_is_recording(const std::filesystem::path& input) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(input, ignored) && input.extension() != ".yaml" &&
      input.extension() != ".yml")
    throw InputError(
        input.string() +
        ": is neither a recording (a folder, or its recording.yaml) nor a bag (*.mcap, "
        "*.db3)");
  const auto has = [&](const char* file) { return std::filesystem::exists(input / file, ignored); };
  if (!std::filesystem::is_directory(input, ignored) || has("recording.yaml")) return;
  if (has("report.json") || has("views.json"))
    throw InputError(input.string() +
                     ": holds results, which `penumbra view` shows; give what they were made from");
  throw InputError(input.string() +
                   ": holds neither a recording (recording.yaml, which `penumbra init` writes) nor "
                   "a bag (metadata.yaml, *.mcap, *.db3)");
}

void check_no_bag_option(const InputOptions& options) {
  if (!options.bag_option.empty())
    throw InputError(options.bag_option + ": is for bags, and " + options.path.string() +
                     " is a recording folder, which says this itself; leave it out");
}

void InputOptions::apply_to(RobotOptions& robot, const std::string& name) const {
  if (geometry) robot.geometry = *geometry;
  robot.geometry_fallback |= geometry_fallback;
  robot.allow_missing_meshes |= allow_missing_meshes;
  const std::vector<ExtraMesh> own = extra_of(extra, name);
  robot.extra.insert(robot.extra.end(), own.begin(), own.end());
  const std::vector<std::string> ignored = patterns_of(ignore_links, name);
  robot.ignore_links.insert(robot.ignore_links.end(), ignored.begin(), ignored.end());
  for (const auto& [joint, position] : joints_of(joints, name)) robot.joints[joint] = position;
}

std::vector<std::string> cameras_of(const std::filesystem::path& input) {
  if (is_bag(input)) return {};
  check_is_recording(input);
  return Recording::cameras(input);
}

RunInput open_input(const InputOptions& options, const LineSink& print) {
  RunInput input = open_folder_or_bag(options, print);
  for (const ExtraMesh& part : input.robot_options.extra) input.made_files.push_back(part.mesh);
  if (options.bag.pose) input.made_files.push_back(*options.bag.pose);
  if (options.threads != 1)
    input.frames = [open = std::move(input.frames)] { return std::make_unique<ReadAhead>(open()); };
  return input;
}

}  // namespace penumbra::io
