// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/poses/pose_lookup.hpp>
#include <penumbra/time/pose_history.hpp>

#include <io/assembly/assembled_frame.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/cloud/cloud_file.hpp>
#include <io/files/frame_reader.hpp>
#include <io/ros/message_definition.hpp>
#include <io/run/cloud_run.hpp>
#include <io/run/output_folder.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* clouds_folder = "clouds";  // below the output

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
  [[nodiscard]] const AssembledFrame* assembled() const override { return &current_; }

 private:
  void read_file(const fs::path& file);

  CloudRecording recording_;
  Robot robot_;
  const std::vector<JointRow> rows_;
  std::vector<const JointRow*> wanted_;
  bool use_times_;
  PoseHistory history_;
  PoseLookup lookup_;
  AssembledFrame current_;
  std::string time_note_;  // the first cloud's
};

bool RecordedClouds::read(std::size_t number, Frame& frame) {
  if (number >= wanted_.size()) return false;
  const JointRow& row = *wanted_[number];
  current_ = {};
  current_.index = static_cast<std::size_t>(row.index);
  current_.stamp = row.stamp;
  current_.pose =
      pose_of(row, robot_, find_camera_parent(robot_, recording_.parent), recording_.attached);
  current_.pose_at = [this, stamp = row.stamp, pose = current_.pose](std::int64_t at,
                                                                     RobotPose& to) {
    to = pose;
    if (!stamp || at == *stamp) return;
    lookup_.at(history_, at, to);
    to.attached = pose.attached;
  };
  read_file(recording_.clouds.file(row.index));
  if (time_note_.empty()) time_note_ = current_.points.time_note;
  frame = std::move(static_cast<Frame&>(current_));
  return true;
}

void RecordedClouds::read_file(const fs::path& file) {
  try {
    const auto stored = std::make_shared<StoredCloud>(read_cloud(file));
    stored->cloud.header.stamp = current_.stamp.value_or(0);
    current_.owner = stored;
    current_.message = stored->cloud;
    const std::string fault = read_points(stored->cloud, use_times_, current_.points);
    if (!fault.empty()) throw InputError(file.string() + ": " + fault);
  } catch (const InputError& error) {
    current_.source_status = FrameStatus::bad_depth;
    current_.source_message = error.what();
  }
  CloudPoints& points = current_.points;
  if (!current_.stamp && !points.times.empty()) {
    points.times.clear();
    points.time_note = "the joint file has no stamps: the points' times are not used";
  }
  current_.scan = Scan{.points = points.points, .times = points.times};
  if (!recording_.has_rays) current_.scan->origin.reset();
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
          .camera = no_camera(),
          .camera_info = {},
          .config = {},
          .beyond = {},
          .targets = recording.targets,
          .frame_numbers = std::move(numbers),
          .bag = {},
          .made_files = {},
          .frames = [recording, rows = std::move(rows), range = options.input.frames,
                     times = options.use_times](const Robot& of) -> std::unique_ptr<FrameSource> {
            return std::make_unique<RecordedClouds>(recording, of, rows, range, times);
          },
          .cloud = CloudConfig{.rule = changed_rule(recording.rule, options),
                               .threads = options.threads,
                               .sensor_parent = recording.parent,
                               .T_parent_sensor = recording.T_parent_sensor},
          .used_clouds = {.rule = {}, .merged = !recording.has_rays, .times = options.use_times},
          .sensor = recording.clouds.file(0).parent_path().filename().string(),
          .cloud_files = recording.clouds};
}

/// Clouds and report.json.
class CloudFolder final : public RunOutput {
 public:
  CloudFolder(ResultFolder& folder, const FrameSource& source, const CloudOutput& how)
      : folder_(folder), source_(source), how_(how) {}

  void begin(const ReportHead& head) override {
    missing_links_.assign(head.missing_links.begin(), head.missing_links.end());
    folder_.begin();
    folder_.add("report.json",
                [&](const fs::path& part) { report_.emplace(part, report_start(head)); });
  }
  void save(const FrameReport& report, const Frame& frame, const ShownTargets&) override {
    report_->add(report_frame(report));
    if (frame.scan->points.count == 0 && !frame.source_message.empty()) return;  // not read
    const auto& cloud = std::get<PointCloud2Message>(source_.assembled()->message);
    write_cloud(folder_.frame_file(0, static_cast<std::int64_t>(report.index)),
                cloud_output(cloud, report, how_, data_));
  }
  void finish(const Statistics& statistics, std::span<const std::string> notes) override {
    report_->finish(report_end(statistics, missing_links_, notes));
    folder_.finish();
  }

 private:
  ResultFolder& folder_;
  const FrameSource& source_;
  CloudOutput how_;
  std::optional<ReportWriter> report_;
  std::vector<std::string> missing_links_;
  std::vector<std::byte> data_;
};

/// The topics of a sensor in a bag.
class CloudTopics final : public RunOutput, private ResultSink {
 public:
  CloudTopics(mcap::Writer& writer, std::string topic, const FrameSource& source, CloudOutput how)
      : writer_(writer), topic_(std::move(topic)), source_(source), how_(how) {}

  void begin(const ReportHead& head) override { encoder_.emplace(how_, head.links.front()); }
  void save(const FrameReport& report, const Frame& frame, const ShownTargets&) override {
    encoder_->encode(report, frame, *source_.assembled(), *this);
  }
  void finish(const Statistics&, std::span<const std::string>) override {}

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t messages = 0;
  };
  void set_cloud_type(const std::string& type) override {
    const bool is_labelled = how_.labelled && type == message_type<PointCloud2Message>();
    clouds_ = is_labelled ? Result::labelled : Result::without_robot;
    add_channel(clouds_, topic_, type);
  }
  [[nodiscard]] bool wants(Result result) const override {
    return result == clouds_ || result == Result::targets;
  }
  void write(Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    if (!channels_.contains(result))
      add_channel(result, topic_ + "/targets", message_type<TargetsMessage>());
    Channel& channel = channels_[result];
    writer_.write(channel.id, source_.assembled()->arrived, std::max<std::int64_t>(0, stamp),
                  ++channel.messages, payload);
  }
  void add_channel(Result result, const std::string& topic, const std::string& type) {
    channels_[result].id =
        writer_.add_channel("/penumbra" + topic, "cdr",
                            writer_.add_schema(type, "ros2msg", std::string(definition_of(type))));
  }

  mcap::Writer& writer_;
  std::string topic_;
  const FrameSource& source_;
  CloudOutput how_;
  std::optional<CloudEncoder> encoder_;
  Result clouds_ = Result::without_robot;
  std::map<Result, Channel> channels_;
};

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
  Pipeline pipeline(input.robot, *input.cloud);
  CloudTuner tuner(input.cloud->rule);
  const std::unique_ptr<FrameSource> source = input.frames(input.robot);
  Frame frame;
  for (std::size_t i = 0, measured = 0; measured < most && source->next(frame) && go_on(); ++i)
    if (i % step == 0 && tuner.add(pipeline, frame)) ++measured;
  return tuner.result();
}

ResultFolderOptions cloud_results(const RunInput& input, const fs::path& output, bool force) {
  const fs::path clouds = output / clouds_folder;
  std::error_code error;
  if (fs::equivalent(clouds, input.cloud_files->file(0).parent_path(), error))
    throw InputError("--output: " + clouds.string() + " holds the input; choose another folder");
  const FramePattern own = input.cloud_files->moved_to(clouds);
  ResultFolderOptions results{
      .path = output,
      .report = {"report.json", std::string(report_json_start)},
      .frames = {{own}},
      .force = force,
      .advice = "choose another folder with -o, or write into this one with --force"};
  if (force || !fs::is_directory(clouds, error)) return results;
  for (const auto& entry : fs::directory_iterator(clouds, error)) {
    const fs::path name = entry.path().filename();
    if (is_cloud_file(name) && !own.makes(name.string()))
      throw InputError(entry.path().string() +
                       ": is no cloud of this recording; move it away, or " + results.advice);
  }
  return results;
}

std::unique_ptr<RunOutput> open_cloud_folder(ResultFolder& folder, const FrameSource& source,
                                             const CloudOutput& how) {
  return std::make_unique<CloudFolder>(folder, source, how);
}

std::unique_ptr<RunOutput> CloudBag::sensor(const std::string& topic, const FrameSource& source,
                                            const CloudOutput& how) {
  return std::make_unique<CloudTopics>(writer_, topic, source, how);
}

void CloudBag::finish() {
  writer_.close();
  pending_.finish();
}

}  // namespace penumbra::io
