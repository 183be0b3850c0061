// SPDX-License-Identifier: Apache-2.0
#include <system_error>
#include <utility>

#include <apps/penumbra/output_bag.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/message_definition.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/target_messages.hpp>

namespace penumbra::app {

OutputBag::OutputBag(const std::filesystem::path& file, const Camera& camera, std::string root)
    : file_(file),
      root_(std::move(root)),
      writer_(file, {.profile = "ros2"}),
      results_(camera),
      virtual_depth_(add_channel<io::ImageMessage>("vdi")),
      labels_(add_channel<io::ImageMessage>("labels")),
      mask_(add_channel<io::ImageMessage>("mask")),
      filtered_depth_(add_channel<io::ImageMessage>("filtered_depth")),
      overlay_(add_channel<io::CompressedImageMessage>("overlay/compressed")),
      targets_(add_channel<io::TargetsMessage>("targets")),
      points_(add_channel<io::PointCloud2Message>("points")) {}

OutputBag::~OutputBag() {
  std::error_code ignored;
  if (!finished_) std::filesystem::remove(file_, ignored);
}

template <typename M>
OutputBag::Channel OutputBag::add_channel(const std::string& name) {
  const std::string type = io::message_type<M>();
  const std::uint16_t schema =
      writer_.add_schema(type, "ros2msg", std::string(io::definition_of(type)));
  return {writer_.add_channel("/penumbra/" + name, "cdr", schema)};
}

template <typename M>
void OutputBag::write(Channel& channel, const M& message) {
  io::encode(message, payload_);
  const std::int64_t stamp = message.header.stamp;
  writer_.write(channel.id, stamp, stamp, channel.messages++, payload_);
}

void OutputBag::save(const FrameReport& report, const io::FrameData& frame,
                     const ShownTargets& targets) {
  if (!report.stamp) {
    ++without_stamp_;
    return;
  }
  if (!report.missing_links.empty()) missing_link_ = report.missing_links.front();
  results_.set(report, frame.depth_view());
  if (const auto virtual_depth = results_.virtual_depth()) write(virtual_depth_, *virtual_depth);
  write(labels_, results_.labels());
  write(mask_, results_.mask());
  write(filtered_depth_, results_.filtered_depth());
  write(points_, results_.points());
  write(targets_, io::targets_message(report, results_.header().frame_id, root_));
  const auto overlay = painter_.draw(report, frame, targets);
  write(overlay_, io::png_message(results_.header(), overlay, png_));
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
