// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <variant>

#include <io/assembly/result_encoder.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/target_messages.hpp>

namespace penumbra::io {

template <typename M>
void ResultEncoder::write(Result result, const M& message, ResultSink& sink) {
  io::encode(message, payload_);
  sink.write(result, message.header.stamp, payload_);
}

void ResultEncoder::encode(const FrameReport& report, const ShownImages& images,
                           const ShownTargets& targets, ResultSink& sink) {
  results_.set(report);
  if (sink.wants(Result::virtual_depth))
    if (const auto virtual_depth = results_.virtual_depth())
      write(Result::virtual_depth, *virtual_depth, sink);
  if (sink.wants(Result::labels)) write(Result::labels, results_.labels(), sink);
  if (sink.wants(Result::mask)) write(Result::mask, results_.mask(), sink);
  if (sink.wants(Result::filtered_depth))
    write(Result::filtered_depth, results_.filtered_depth(), sink);
  if (sink.wants(Result::points)) write(Result::points, results_.points(), sink);
  if (sink.wants(Result::targets))
    write(Result::targets, targets_message(report, results_.header().frame_id, root_), sink);
  if (sink.wants(Result::robot_mask))
    if (const auto mask = results_.robot_mask()) write(Result::robot_mask, *mask, sink);
  if (!sink.wants(Result::overlay)) return;
  const auto overlay = painter_.draw(report, images, targets);
  write(Result::overlay, png_message(results_.header(), overlay, png_), sink);
}

void CloudEncoder::encode(const FrameReport& report, const Frame& frame,
                          const AssembledFrame& cloud, ResultSink& sink) {
  const std::int64_t stamp = frame.stamp.value_or(0);
  const auto write = [&]<typename M>(const M& message) {
    if (!std::exchange(has_type_, true)) sink.set_cloud_type(message_type<M>());
    for (const Result result : {Result::without_robot, Result::labelled}) {
      how_.labelled = result == Result::labelled;
      if (how_.labelled && !std::is_same_v<M, PointCloud2Message>) continue;
      if (!sink.wants(result)) continue;
      io::encode(cloud_output(message, report, how_, data_), payload_);
      sink.write(result, stamp, payload_);
    }
  };
  const bool is_read = frame.scan->points.count > 0 || frame.source_message.empty();
  if (is_read) std::visit(write, cloud.message);
  if (frame.targets.empty() || !sink.wants(Result::targets)) return;
  io::encode(targets_message(report, cloud.frame_id, root_), payload_);
  sink.write(Result::targets, stamp, payload_);
}

}  // namespace penumbra::io
