// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/result_encoder.hpp>
#include <io/cloud/cloud_file.hpp>
#include <io/outputs/cloud_output.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* clouds_folder = "clouds";  // below the output

/// Clouds and report.json.
class CloudFolder final : public Sink {
 public:
  CloudFolder(ResultFolder& folder, const CloudOutput& how) : folder_(folder), how_(how) {}

  void begin(const ReportHead& head) override {
    missing_links_.assign(head.missing_links.begin(), head.missing_links.end());
    folder_.begin();
    folder_.add("report.json",
                [&](const fs::path& part) { report_.emplace(part, report_start(head)); });
  }
  void take(const Frame& frame, const FrameReport& report) override {
    report_->add(report_frame(report));
    if (frame.scan->points.count == 0 && !frame.source_message.empty()) return;  // not read
    const auto& cloud = std::get<PointCloud2Message>(frame.scan->received->message);
    write_cloud(folder_.frame_file(0, static_cast<std::int64_t>(report.index)),
                cloud_output(cloud, report, how_, data_));
  }
  void finish(const Statistics& statistics, std::span<const std::string> notes) override {
    report_->finish(report_end(statistics, missing_links_, notes));
    folder_.finish();
  }

 private:
  ResultFolder& folder_;
  CloudOutput how_;
  std::optional<ReportWriter> report_;
  std::vector<std::string> missing_links_;
  std::vector<std::byte> data_;
};

/// The topics of a sensor in a bag.
class CloudTopics final : public Sink, private ResultSink {
 public:
  CloudTopics(mcap::Writer& writer, std::string topic, const Robot& robot, CloudOutput how)
      : writer_(writer), topic_(std::move(topic)), how_(how), encoder_(robot, how) {}

  void take(const Frame& frame, const FrameReport& report) override {
    arrived_ = frame.scan->received->arrived;
    encoder_.encode(frame, report, *this);
  }

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
    writer_.write(channel.id, arrived_, std::max<std::int64_t>(0, stamp), ++channel.messages,
                  payload);
  }
  void add_channel(Result result, const std::string& topic, const std::string& type) {
    channels_[result].id =
        writer_.add_channel("/penumbra" + topic, "cdr",
                            writer_.add_schema(type, "ros2msg", std::string(definition_of(type))));
  }

  mcap::Writer& writer_;
  std::string topic_;
  CloudOutput how_;
  ResultEncoder encoder_;
  std::int64_t arrived_ = 0;  // the current cloud
  Result clouds_ = Result::without_robot;
  std::map<Result, Channel> channels_;
};

}  // namespace

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

std::unique_ptr<Sink> open_cloud_folder(ResultFolder& folder, const CloudOutput& how) {
  return std::make_unique<CloudFolder>(folder, how);
}

std::unique_ptr<Sink> CloudBag::sensor(const std::string& topic, const Robot& robot,
                                       const CloudOutput& how) {
  return std::make_unique<CloudTopics>(writer_, topic, robot, how);
}

void CloudBag::finish() {
  writer_.close();
  pending_.finish();
}

}  // namespace penumbra::io
