// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/version.hpp>
#include <penumbra/poses/pose_lookup.hpp>
#include <penumbra/time/pose_history.hpp>

#include <io/assembly/bag_scene.hpp>
#include <io/assembly/cloud_worker.hpp>
#include <io/assembly/frame_assembler.hpp>
#include <io/cloud/cloud_file.hpp>
#include <io/cloud/cloud_json-inl.hpp>
#include <io/files/frame_reader.hpp>
#include <io/files/printable.hpp>
#include <io/files/result_folder.hpp>
#include <io/files/targets_file.hpp>
#include <io/mcap/writer.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/message_definition.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/target_messages.hpp>
#include <io/run/cloud_run.hpp>
#include <io/run/output_bag.hpp>
#include <io/run/output_folder.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_waiting = 32;         // clouds of a bag, for their poses
constexpr const char* clouds_folder = "clouds";  // below the output

CloudRule changed_rule(CloudRule rule, const CloudRunOptions& options) {
  for (const auto& change : options.rule_changes) change(rule);
  return rule;
}

/// Calls `label` and adds its report to the summary, with the time that it took.
template <typename F>
const CloudReport& timed(CloudSummary& summary, const std::string& fault, const F& label) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const CloudReport& report = label();
  summary.add(report, fault,
              std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  return report;
}

/// Measures the rule in some of a sensor's clouds: enough, and not all of one moment.
struct SensorTuner {
  static constexpr std::size_t step = 3, most = 40;  // clouds

  CloudTuner tuner;
  std::size_t clouds = 0, measured = 0;

  [[nodiscard]] bool is_done() const { return measured == most; }
  /// Calls `add` with some of the clouds.
  template <typename F>
  void next(const F& add) {
    if (clouds++ % step == 0 && !is_done()) measured += add() ? 1 : 0;
  }
};

/// The clouds of a recording folder.
class RecordedRun {
 public:
  RecordedRun(const CloudRunOptions& options, CloudRecording recording)
      : options_(options),
        recording_(std::move(recording)),
        robot_(make_robot()),
        rows_(read_joint_file(recording_.joints, robot_)),
        history_(robot_, {.joints = {.history = 1e9, .max_states = rows_.size() + 1}}),
        lookup_(robot_, {.camera_parent = recording_.parent}),
        targets_(open_targets()),
        pipeline_(robot_, {.rule = changed_rule(recording_.rule, options),
                           .threads = options.threads,
                           .sensor_parent = recording_.parent,
                           .T_parent_sensor = recording_.T_parent_sensor}) {
    for (const JointRow& row : rows_)
      for (std::size_t i = 0; row.stamp && i < row.positions.size(); ++i)
        if (std::ranges::find(row.unknown, i) == row.unknown.end())
          history_.add_joints(*row.stamp, robot_.variables().subspan(i, 1), {&row.positions[i], 1});
  }

  [[nodiscard]] CloudRunResult run(const std::function<bool()>& go_on);

 private:
  [[nodiscard]] Robot make_robot() {
    for (RecordedRobot& robot : recording_.robots)
      options_.input.apply_to(robot.options, robot.name);
    return load_robot(recording_.robots);
  }
  [[nodiscard]] std::optional<TargetsFile> open_targets() const {
    if (!recording_.targets) return std::nullopt;
    return TargetsFile::open(*recording_.targets, {.robot = robot_,
                                                   .image = ImageSpace::raw,
                                                   .images = Intrinsics(1, 1, 1.0, 1.0, 0.0, 0.0),
                                                   .has_distortion = false,
                                                   .beyond_hides = true});
  }
  [[nodiscard]] bool is_wanted(const JointRow& row) const;
  [[nodiscard]] ResultFolderOptions results() const;
  [[nodiscard]] std::string report_head() const;
  void label(const JointRow& row, CloudSummary& summary);
  void label_all(const std::function<bool()>& go_on, CloudRunResult& result);
  [[nodiscard]] RobotPose pose_at(std::int64_t stamp, const JointRow& row);

  const CloudRunOptions& options_;
  CloudRecording recording_;
  Robot robot_;
  std::vector<JointRow> rows_;
  PoseHistory history_;
  PoseLookup lookup_;
  std::optional<TargetsFile> targets_;
  CloudPipeline pipeline_;
  std::optional<SensorTuner> tuner_;    // if the rule is measured
  std::optional<ResultFolder> folder_;  // if it writes
  std::optional<ReportWriter> report_;  // likewise
};

/// The row's pose at its own stamp, else the pose between the rows.
RobotPose RecordedRun::pose_at(std::int64_t stamp, const JointRow& row) {
  RobotPose pose =
      pose_of(row, robot_, find_camera_parent(robot_, recording_.parent), recording_.attached);
  if (!row.stamp || stamp == *row.stamp) return pose;
  RobotPose between;
  lookup_.at(history_, stamp, between);
  between.attached = std::move(pose.attached);
  return between;
}

void RecordedRun::label(const JointRow& row, CloudSummary& summary) {
  const fs::path file = recording_.clouds.file(row.index);
  StoredCloud stored;
  CloudPoints points;
  std::string fault;
  try {
    stored = read_cloud(file);
    stored.cloud.header.stamp = row.stamp.value_or(0);
    fault = read_points(stored.cloud, options_.use_times, points);
    if (!fault.empty()) fault = file.string() + ": " + fault;
  } catch (const InputError& error) {
    fault = error.what();
  }
  if (!row.stamp && !points.times.empty()) {
    points.times.clear();
    points.time_note = "the joint file has no stamps: the points' times are not used";
  }
  Scan scan{.stamp = row.stamp, .points = points.points, .times = points.times};
  if (!recording_.has_rays) scan.origin.reset();
  std::vector<Target> targets;
  if (targets_) targets = targets_->of_frame(row.index);
  scan.targets = targets;
  const auto pose = [&](std::int64_t stamp, RobotPose& at) { at = pose_at(stamp, row); };
  if (tuner_) {
    ++summary.clouds;
    tuner_->next([&] { return tuner_->tuner.add(pipeline_, scan, pose); });
    return;
  }
  const CloudReport& report =
      timed(summary, fault, [&]() -> const CloudReport& { return pipeline_.process(scan, pose); });
  if (summary.time_note.empty()) summary.time_note = points.time_note;
  const auto index = static_cast<std::uint64_t>(row.index);
  if (report_) report_->add(json_text(cloud_frame_json(report, index, fault)));
  if (options_.on_cloud) options_.on_cloud(0, index, points.points, report, fault);
  if (!fault.empty() || !folder_) return;
  std::vector<std::byte> data;
  const PointCloud2Message out = cloud_output(stored.cloud, report, options_.how, data);
  write_cloud(folder_->frame_file(0, row.index), out);
}

void RecordedRun::label_all(const std::function<bool()>& go_on, CloudRunResult& result) {
  CloudSummary& summary = result.sensors.emplace_back();
  summary.name = recording_.clouds.file(0).parent_path().filename().string();
  if (options_.on_begin) options_.on_begin(robot_, {&summary.name, 1});
  for (const JointRow& row : rows_) {
    if (!is_wanted(row)) continue;
    label(row, summary);
    result.is_stopped = !go_on();
    if (result.is_stopped) break;
  }
}

bool RecordedRun::is_wanted(const JointRow& row) const {
  const FrameRange& range = options_.input.frames;
  return row.index >= range.first.value_or(0) && (!range.end || row.index < *range.end);
}

/// Throws InputError if the folder holds the input, or clouds that the report would not be of.
ResultFolderOptions RecordedRun::results() const {
  const fs::path clouds = options_.output / clouds_folder;
  std::error_code error;
  if (fs::equivalent(clouds, recording_.clouds.file(0).parent_path(), error))
    throw InputError("--output: " + clouds.string() + " holds the input; choose another folder");
  const FramePattern own = recording_.clouds.moved_to(clouds);
  ResultFolderOptions results{
      .path = options_.output,
      .report = {"report.json", std::string(report_json_start)},
      .frames = {{own}},
      .force = options_.force,
      .advice = "choose another folder with -o, or write into this one with --force"};
  if (options_.force || !fs::is_directory(clouds, error)) return results;
  for (const auto& entry : fs::directory_iterator(clouds, error)) {
    const fs::path name = entry.path().filename();
    if (is_cloud_file(name) && !own.makes(name.string()))
      throw InputError(entry.path().string() +
                       ": is no cloud of this recording; move it away, or " + results.advice);
  }
  return results;
}

/// Returns the report up to its first cloud.
std::string RecordedRun::report_head() const {
  Json settings = rule_json(changed_rule(recording_.rule, options_));
  settings["merged"] = !recording_.has_rays;
  settings["times"] = options_.use_times;
  settings["targets"] = recording_.targets ? Json(recording_.targets->string()) : Json();
  return std::string(report_json_start) + json_text(PENUMBRA_VERSION) +
         ",\n\"input\": " + json_text(options_.input.path.string()) +
         ",\n\"settings\": " + json_text(settings) +
         ",\n\"links\": " + json_text(Json(robot_.links())) + ",\n\"clouds\": [";
}

CloudRunResult RecordedRun::run(const std::function<bool()>& go_on) {
  const std::string ending = recording_.clouds.file(0).extension().string();
  if (!is_cloud_file("x" + ending))
    throw InputError(recording_.file.string() + ": frames.cloud: '" + ending +
                     "' is no file of points; expected .pcd, .ply, .npy or .bin");
  if (std::none_of(rows_.begin(), rows_.end(), [&](const auto& row) { return is_wanted(row); }))
    throw InputError("--frames: the recording has none of these clouds");
  CloudRunResult result;
  if (options_.tune) {
    tuner_.emplace(SensorTuner{CloudTuner(changed_rule(recording_.rule, options_))});
    label_all(go_on, result);
    result.tunings.push_back(tuner_->tuner.result());
    return result;
  }
  if (!options_.output.empty()) {
    folder_.emplace(results());
    folder_->begin();
    folder_->add("report.json",
                 [&](const fs::path& part) { report_.emplace(part, report_head()); });
  }
  label_all(go_on, result);
  if (!folder_) return result;
  report_->finish("\n],\n\"summary\": " + json_text(cloud_summary_json(result.sensors[0])) + "}\n");
  folder_->finish();
  return result;
}

/// The clouds of a bag.
class BagRun {
 public:
  BagRun(const CloudRunOptions& options, const BagClouds& clouds);

  [[nodiscard]] CloudRunResult run(const std::function<bool()>& go_on);

 private:
  [[nodiscard]] std::optional<std::size_t> input_of(const BagTopic& topic);
  void write_ready(std::int64_t now);
  const CloudReport& write(std::size_t sensor, const ReceivedCloud& cloud);
  void measure(std::size_t sensor, const ReceivedCloud& cloud);
  void write_targets(std::size_t sensor, const ReceivedCloud& cloud, const CloudReport& report,
                     std::int64_t now);

  const CloudRunOptions& options_;
  const BagClouds& clouds_;
  std::unique_ptr<BagReader> bag_;
  FrameAssembler assembler_;
  std::optional<PendingFile> pending_;                     // if it writes
  std::optional<mcap::Writer> writer_;                     // likewise
  std::vector<SensorTuner> tuners_;                        // of each sensor, else
  std::vector<std::uint16_t> channels_, target_channels_;  // of each sensor
  std::size_t target_messages_ = 0;
  std::vector<CloudWorker> workers_;
  CloudRunResult result_;
  std::vector<std::byte> data_, payload_;
};

std::vector<CloudInputOptions> cloud_inputs(const CloudRunOptions& options,
                                            const BagClouds& clouds) {
  std::vector<CloudInputOptions> inputs;
  for (std::size_t i = 0; i < clouds.mounts.size(); ++i)
    inputs.push_back({.topic = clouds.topics.clouds[i].name,
                      .rule = changed_rule({}, options),
                      .threads = options.threads,
                      .use_times = options.use_times,
                      .has_rays = options.has_rays,
                      .sensor_frame = options.sensor_frame,
                      .mount = {.frame_prefix = options.input.bag.frame_prefix},
                      .poses = clouds.topics.poses,
                      .time_offset = options.input.bag.time_offset,
                      .max_frames = most_waiting,
                      .has_targets = !options.tune && !clouds.topics.targets.empty(),
                      .known = clouds.mounts[i]});
  return inputs;
}

BagRun::BagRun(const CloudRunOptions& options, const BagClouds& clouds)
    : options_(options),
      clouds_(clouds),
      bag_(open_bag(options.input.path)),
      assembler_({.given = clouds.robot,
                  .joint_names = options.input.bag.joint_names,
                  .compare_sources = !options.input.bag.first_publisher,
                  .static_transforms = clouds.static_transforms},
                 {}, cloud_inputs(options, clouds)) {
  for (std::size_t i = 0; i < assembler_.cloud_count(); ++i) {
    const CloudInputOptions& input = assembler_.cloud(i).options();
    workers_.emplace_back(input);
    if (options.tune) tuners_.push_back({CloudTuner(input.rule)});
  }
  if (!options.output.empty()) {
    pending_.emplace(options.output);
    writer_.emplace(pending_->part(), mcap::WriterOptions{.profile = "ros2"});
  }
  const auto channel = [&](const std::string& topic, const std::string& type) {
    return writer_->add_channel(
        topic, "cdr", writer_->add_schema(type, "ros2msg", std::string(definition_of(type))));
  };
  std::vector<std::string> names;
  for (const TopicUse& use : clouds.topics.clouds)
    names.push_back(result_.sensors.emplace_back().name = use.name);
  if (options.on_begin) options.on_begin(clouds.robot, names);
  if (!writer_) return;
  for (const TopicUse& use : clouds.topics.clouds) {
    channels_.push_back(channel("/penumbra" + use.name, use.type));
    if (!clouds.topics.targets.empty())
      target_channels_.push_back(
          channel("/penumbra" + use.name + "/targets", message_type<TargetsMessage>()));
  }
}

std::optional<std::size_t> BagRun::input_of(const BagTopic& topic) {
  const auto role = clouds_.topics.role_of(topic);
  if (!role || *role == TopicRole::description) return std::nullopt;
  std::size_t sensor = 0;
  while (*role == TopicRole::cloud && clouds_.topics.clouds[sensor].name != topic.name) ++sensor;
  return assembler_.add_topic({.role = *role,
                               .camera = sensor,
                               .robot = clouds_.topics.robot_of(topic),
                               .name = topic.name,
                               .type = topic.type,
                               .definition = topic.definition});
}

const CloudReport& BagRun::write(std::size_t sensor, const ReceivedCloud& cloud) {
  CloudSummary& summary = result_.sensors[sensor];
  const CloudReport& report = timed(summary, cloud.source_message, [&]() -> const CloudReport& {
    return workers_[sensor].label(cloud);
  });
  if (summary.time_note.empty()) summary.time_note = cloud.points.time_note;
  if (options_.on_cloud)
    options_.on_cloud(sensor, summary.clouds - 1, cloud.points.points, report,
                      cloud.source_message);
  const bool is_unreadable = report.labels.empty() && !cloud.source_message.empty();
  if (!writer_ || is_unreadable) return report;
  std::visit(
      [&](const auto& message) {
        encode(cloud_output(message, report, options_.how, data_), payload_);
      },
      cloud.message);
  writer_->write(channels_[sensor], cloud.arrived, std::max<std::int64_t>(0, cloud.header.stamp),
                 static_cast<std::uint32_t>(summary.clouds), payload_);
  return report;
}

void BagRun::write_targets(std::size_t sensor, const ReceivedCloud& cloud,
                           const CloudReport& report, std::int64_t now) {
  if (!writer_ || cloud.targets.empty()) return;
  encode(targets_message(report, cloud.header.frame_id, report.links.front()), payload_);
  writer_->write(target_channels_[sensor], now, std::max<std::int64_t>(0, cloud.header.stamp),
                 static_cast<std::uint32_t>(++target_messages_), payload_);
}

void BagRun::measure(std::size_t sensor, const ReceivedCloud& cloud) {
  ++result_.sensors[sensor].clouds;
  SensorTuner& tuner = tuners_[sensor];
  tuner.next([&] { return workers_[sensor].measure(cloud, tuner.tuner); });
}

void BagRun::write_ready(std::int64_t now) {
  for (std::size_t i = 0; i < assembler_.cloud_count(); ++i)
    while (const auto cloud = assembler_.cloud(i).next(now)) {
      if (!tuners_.empty()) {
        measure(i, *cloud);
        continue;
      }
      const CloudReport& report = cloud->is_again ? workers_[i].label(*cloud) : write(i, *cloud);
      write_targets(i, *cloud, report, now);
      if (!cloud->is_again) assembler_.cloud(i).done(true);
    }
}

CloudRunResult BagRun::run(const std::function<bool()>& go_on) {
  std::vector<std::optional<std::size_t>> inputs;
  BagMessage message;
  std::int64_t now = 0;
  while (bag_->next(message)) {
    while (inputs.size() <= message.topic)
      inputs.push_back(input_of(bag_->topics()[inputs.size()]));
    now = message.log_time;
    if (!inputs[message.topic]) continue;
    assembler_.receive(*inputs[message.topic], {.data = message.data}, now);
    write_ready(now);
    if (!tuners_.empty() && std::all_of(tuners_.begin(), tuners_.end(),
                                        [](const SensorTuner& one) { return one.is_done(); }))
      break;
    if (!go_on()) {
      result_.is_stopped = true;
      break;
    }
  }
  assembler_.finish();
  write_ready(now);
  result_.notes = bag_notes(options_.input.path.string(), *bag_, assembler_.faults());
  for (const std::string& line : assembler_.notes())
    result_.notes.push_back(options_.input.path.string() + ": " + line);
  for (const SensorTuner& one : tuners_) result_.tunings.push_back(one.tuner.result());
  if (!writer_) return std::move(result_);
  writer_->close();
  pending_->finish();
  return std::move(result_);
}

}  // namespace

CloudRunResult run_clouds(const CloudRunOptions& options, const LineSink& print,
                          const std::function<bool()>& go_on) {
  if (!options.output.empty()) check_output_place(options.input.path, options.output);
  if (is_bag(options.input.path)) {
    if (options.input.frames.first || options.input.frames.end)
      throw InputError("--frames: is for recording folders; leave it out");
    if (!options.output.empty() && !is_output_bag(options.output))
      throw InputError("--output: " + options.output.string() +
                       " is no bag, and the clouds of a bag are written into one; name it *.mcap");
    const BagClouds clouds = open_bag_clouds(options.input, print);
    const bool is_of_one = options.input.bag.pose || options.input.bag.parent ||
                           !options.sensor_frame.empty() || !options.has_rays;
    if (is_of_one && clouds.mounts.size() > 1)
      throw InputError(
          "--pose, --parent, --sensor-frame and --merged are for one sensor, and the "
          "bag has " +
          std::to_string(clouds.mounts.size()) + " topics of clouds; choose one with --topic");
    return BagRun(options, clouds).run(go_on);
  }
  check_is_recording(options.input.path);
  check_no_bag_option(options.input);
  auto recording = CloudRecording::open(options.input.path);
  if (!recording)
    throw InputError(options.input.path.string() +
                     ": its recording.yaml has no frames.cloud; `penumbra run` judges images");
  return RecordedRun(options, std::move(*recording)).run(go_on);
}

}  // namespace penumbra::io
