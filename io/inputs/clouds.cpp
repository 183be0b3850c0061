// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/time/pose_history.hpp>

#include <io/assembly/cloud_input.hpp>
#include <io/cloud/cloud_file.hpp>
#include <io/files/frame_reader.hpp>
#include <io/inputs/clouds.hpp>
#include <io/inputs/input_session.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

/// The clouds of a recording folder.
class RecordedClouds final : public FrameSource {
 public:
  RecordedClouds(const CloudRecording& recording, const Robot& robot, std::vector<JointRow> rows,
                 const FrameRange& range, bool use_times)
      : recording_(recording),
        robot_(robot),
        rows_(std::move(rows)),
        use_times_(use_times),
        history_(robot_, {.joints = {.history = 1e9, .max_states = rows_.size() + 1}}),
        lookup_(robot_, {.camera_parent = recording_.parent}) {
    for (const JointRow& row : rows_)
      if (row.index >= range.first.value_or(0) && (!range.end || row.index < *range.end))
        wanted_.push_back(&row);
    if (wanted_.empty())
      throw InputError(range.option + ": the recording has none of these clouds");
    for (const JointRow& row : rows_)
      for (std::size_t i = 0; row.stamp && i < row.positions.size(); ++i)
        if (std::ranges::find(row.unknown, i) == row.unknown.end())
          history_.add_joints(*row.stamp, robot_.variables().subspan(i, 1), {&row.positions[i], 1});
  }

  bool read(std::size_t number, Frame& frame) override;
  [[nodiscard]] std::optional<std::size_t> size() const override { return wanted_.size(); }
  [[nodiscard]] std::vector<std::string> notes() const override {
    if (time_note_.empty()) return {};
    return {time_note_};
  }

 private:
  void read_file(const fs::path& file, Frame& frame) const;

  CloudRecording recording_;
  Robot robot_;
  const std::vector<JointRow> rows_;
  std::vector<const JointRow*> wanted_;
  bool use_times_;
  PoseHistory history_;
  PoseLookup lookup_;
  std::string time_note_;  // the first cloud's
};

bool RecordedClouds::read(std::size_t number, Frame& frame) {
  if (number >= wanted_.size()) return false;
  const JointRow& row = *wanted_[number];
  frame = {.index = static_cast<std::size_t>(row.index), .stamp = row.stamp};
  frame.pose =
      pose_of(row, robot_, find_camera_parent(robot_, recording_.parent), recording_.attached);
  frame.pose_at = [this, stamp = row.stamp, pose = frame.pose](std::int64_t at, RobotPose& to) {
    to = pose;
    if (!stamp || at == *stamp) return;
    lookup_.at(history_, at, to);
    to.attached = pose.attached;
  };
  read_file(recording_.clouds.file(row.index), frame);
  if (time_note_.empty()) time_note_ = frame.scan->received->points.time_note;
  return true;
}

void RecordedClouds::read_file(const fs::path& file, Frame& frame) const {
  const auto cloud = std::make_shared<ReceivedCloud>();
  CloudPoints& points = cloud->points;
  try {
    const auto stored = std::make_shared<StoredCloud>(read_cloud(file));
    stored->cloud.header.stamp = frame.stamp.value_or(0);
    cloud->owner = stored;
    cloud->message = stored->cloud;
    const std::string fault = read_points(stored->cloud, use_times_, points);
    if (!fault.empty()) throw InputError(file.string() + ": " + fault);
  } catch (const InputError& error) {
    frame.source_status = FrameStatus::bad_depth;
    frame.source_message = error.what();
  }
  if (!frame.stamp && !points.times.empty()) {
    points.times.clear();
    points.time_note = "the joint file has no stamps: the points' times are not used";
  }
  frame.scan = scan_of(cloud, recording_.has_rays);
}

CloudRule changed_rule(CloudRule rule, const CloudRunOptions& options) {
  for (const auto& change : options.rule_changes) change(rule);
  return rule;
}

RunInput open_recording(const CloudRunOptions& options) {
  check_is_recording(options.input.path);
  check_no_bag_option(options.input);
  auto opened = CloudRecording::open(options.input.path);
  if (!opened)
    throw InputError(options.input.path.string() +
                     ": its recording.yaml has no frames.cloud; `penumbra run` judges images");
  CloudRecording recording = std::move(*opened);
  recording.has_rays = recording.has_rays && options.has_rays;
  for (RecordedRobot& robot : recording.robots) options.input.apply_to(robot.options, robot.name);
  const Robot robot = load_robot(recording.robots);
  const std::string ending = recording.clouds.file(0).extension().string();
  if (!is_cloud_file("x" + ending))
    throw InputError(recording.file.string() + ": frames.cloud: '" + ending +
                     "' is no file of points; expected .pcd, .ply, .npy or .bin");
  std::vector<JointRow> rows = read_joint_file(recording.joints, robot);
  std::vector<std::int64_t> numbers;
  for (const JointRow& row : rows) numbers.push_back(row.index);
  return {.robot_options = recording.robots.front().options,
          .robot = robot,
          .camera_info = {},
          .config = {},
          .beyond = {},
          .targets = recording.targets,
          .frame_numbers = std::move(numbers),
          .bag = {},
          .made_files = {},
          .frames = [recording, robot, rows = std::move(rows), range = options.input.frames,
                     times = options.use_times]() -> std::unique_ptr<FrameSource> {
            return std::make_unique<RecordedClouds>(recording, robot, rows, range, times);
          },
          .cloud = {.rule = changed_rule(recording.rule, options),
                    .threads = options.threads,
                    .sensor_parent = recording.parent,
                    .T_parent_sensor = recording.T_parent_sensor},
          .used_clouds = {.rule = {}, .merged = !recording.has_rays, .times = options.use_times},
          .sensor = recording.clouds.file(0).parent_path().filename().string(),
          .cloud_files = recording.clouds};
}

}  // namespace

std::vector<RunInput> open_clouds(const CloudRunOptions& options, const LineSink& print) {
  if (!is_bag(options.input.path)) {
    std::vector<RunInput> one;
    one.push_back(open_recording(options));
    return one;
  }
  return open_bag_clouds(options.input,
                         {.rule = changed_rule({}, options),
                          .threads = options.threads,
                          .use_times = options.use_times,
                          .has_rays = options.has_rays,
                          .sensor_frame = options.sensor_frame},
                         print);
}

CloudTuning tune_clouds(const RunInput& input, const std::function<bool()>& go_on) {
  constexpr std::size_t step = 3, most = 40;  // clouds
  Pipeline pipeline(input.robot, input.cloud);
  CloudTuner tuner(input.cloud.rule);
  const std::unique_ptr<FrameSource> source = input.frames();
  Frame frame;
  for (std::size_t i = 0, measured = 0; measured < most && source->next(frame) && go_on(); ++i)
    if (i % step == 0 && tuner.add(pipeline, frame)) ++measured;
  return tuner.result();
}

Session make_session(Robot robot, const CloudConfig& config) { return {std::move(robot), config}; }

}  // namespace penumbra::io
