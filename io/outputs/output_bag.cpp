// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/assembly/result_encoder.hpp>
#include <io/files/pending_file.hpp>
#include <io/mcap/reader.hpp>
#include <io/mcap/writer.hpp>
#include <io/outputs/output_bag.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

constexpr std::string_view topics_start = "/penumbra/";

/// Returns why a file may not be replaced; empty if it is a bag of results.
std::string why_kept(const std::filesystem::path& file) {
  try {
    const mcap::Reader reader(file);
    const auto& channels = reader.channels();
    const bool is_ours = reader.library().starts_with("penumbra ") && !channels.empty() &&
                         std::all_of(channels.begin(), channels.end(), [](const auto& channel) {
                           return channel.second.topic.starts_with(topics_start);
                         });
    return is_ours ? std::string() : file.string() + ": is no bag of results of penumbra";
  } catch (const InputError& error) {
    return error.what();
  }
}

class OutputBag final : public Sink, private ResultSink {
 public:
  OutputBag(const std::filesystem::path& file, const Pipeline& pipeline);

  void take(const Frame& frame, const FrameReport& report) override;
  void finish(const Statistics& statistics, std::span<const std::string> notes) override;
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t messages = 0;
  };
  [[nodiscard]] bool wants(Result) const override { return true; }
  void write(Result result, std::int64_t stamp, std::span<const std::byte> payload) override;

  std::filesystem::path file_;
  PendingFile pending_;
  mcap::Writer writer_;
  ResultEncoder encoder_;
  std::array<Channel, result_topics.size()> channels_;  // by Result
  std::string missing_link_;
};

OutputBag::OutputBag(const std::filesystem::path& file, const Pipeline& pipeline)
    : file_(file),
      pending_(file),
      writer_(pending_.part(), {.profile = "ros2"}),
      encoder_(pipeline.robot(), pipeline.report_camera()) {
  for (const ResultTopic& topic : result_topics) {
    const std::uint16_t schema = writer_.add_schema(std::string(topic.type), "ros2msg",
                                                    std::string(definition_of(topic.type)));
    channels_[static_cast<std::size_t>(topic.result)].id =
        writer_.add_channel(std::string(topics_start).append(topic.name), "cdr", schema);
  }
}

void OutputBag::write(Result result, std::int64_t stamp, std::span<const std::byte> payload) {
  Channel& channel = channels_[static_cast<std::size_t>(result)];
  writer_.write(channel.id, stamp, stamp, channel.messages++, payload);
}

void OutputBag::take(const Frame& frame, const FrameReport& report) {
  if (!report.stamp)
    throw InputError(
        "frame " + std::to_string(report.index) +
        " has no stamp, and a bag's messages need one: give --fps N, of the recording");
  if (!report.missing_links.empty()) missing_link_ = report.missing_links.front();
  encoder_.encode(frame, report, *this);
}

void OutputBag::finish(const Statistics& /*statistics*/, std::span<const std::string> /*notes*/) {
  writer_.close();
  pending_.finish();
}

std::vector<std::string> OutputBag::notes() const {
  std::vector<std::string> lines;
  if (!missing_link_.empty())
    lines.push_back(file_.string() + ": its mask trusts nothing, and it holds no points: link '" +
                    missing_link_ + "' is not drawn and may be anywhere");
  return lines;
}

}  // namespace

std::unique_ptr<Sink> open_output_bag(const std::filesystem::path& file, const Pipeline& pipeline) {
  return std::make_unique<OutputBag>(file, pipeline);
}

void check_former_bag(const std::filesystem::path& file) {
  check_is_no_folder("--output", file);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error) ||
      std::filesystem::file_size(file, error) == 0)
    return;
  if (const std::string why = why_kept(file); !why.empty())
    throw InputError(why +
                     ", and only a bag of results is replaced; move it away, or choose another "
                     "name with -o");
}

}  // namespace penumbra::io
