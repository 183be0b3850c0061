// SPDX-License-Identifier: Apache-2.0
#include <system_error>
#include <utility>

#include <apps/penumbra/output_bag.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::app {

OutputBag::OutputBag(const std::filesystem::path& file, const Camera& camera, std::string root)
    : file_(file), writer_(file, {.profile = "ros2"}), encoder_(camera, std::move(root)) {
  for (const io::ResultTopic& topic : io::result_topics) {
    const std::uint16_t schema = writer_.add_schema(std::string(topic.type), "ros2msg",
                                                    std::string(io::definition_of(topic.type)));
    channels_[static_cast<std::size_t>(topic.result)].id =
        writer_.add_channel("/penumbra/" + std::string(topic.name), "cdr", schema);
  }
}

OutputBag::~OutputBag() {
  std::error_code ignored;
  if (!finished_) std::filesystem::remove(file_, ignored);
}

void OutputBag::write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) {
  Channel& channel = channels_[static_cast<std::size_t>(result)];
  writer_.write(channel.id, stamp, stamp, channel.messages++, payload);
}

void OutputBag::save(const FrameReport& report, const io::FrameData& frame,
                     const io::ShownTargets& targets) {
  if (!report.stamp) {
    ++without_stamp_;
    return;
  }
  if (!report.missing_links.empty()) missing_link_ = report.missing_links.front();
  encoder_.encode(report, {frame.depth_view(), frame.color.view()}, targets, *this);
}

void OutputBag::finish(const Statistics& /*statistics*/, std::span<const std::string> /*notes*/) {
  writer_.close();
  finished_ = true;
}

std::vector<std::string> OutputBag::notes() const {
  std::vector<std::string> lines;
  if (without_stamp_ > 0)
    lines.push_back(file_.string() + ": " + std::to_string(without_stamp_) +
                    " frames have no stamp and are not in it");
  if (!missing_link_.empty())
    lines.push_back(file_.string() + ": its mask trusts nothing, and it holds no points: link '" +
                    missing_link_ + "' is not drawn and may stand anywhere");
  return lines;
}

bool is_output_bag(const std::filesystem::path& output) { return output.extension() == ".mcap"; }

}  // namespace penumbra::app
