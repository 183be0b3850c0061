// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <variant>

#include <io/assembly/result_encoder.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/target_messages.hpp>

namespace penumbra::io {

template <typename M>
void ResultEncoder::write(Result result, std::int64_t stamp, const M& message, ResultSink& sink) {
  io::encode(message, payload_);
  sink.write(result, stamp, payload_);
}

void ResultEncoder::encode(const Frame& frame, const FrameReport& report, ResultSink& sink,
                           std::span<const Result> skipped) {
  if (images_)
    encode_images(frame, report, sink, skipped);
  else
    encode_cloud(frame, report, sink);
}

void ResultEncoder::encode_images(const Frame& frame, const FrameReport& report, ResultSink& sink,
                                  std::span<const Result> skipped) {
  images_->set(report);
  const auto wants = [&](Result result) {
    return std::ranges::find(skipped, result) == skipped.end() && sink.wants(result);
  };
  const auto put = [&](Result result, const auto& message) {
    write(result, message.header.stamp, message, sink);
  };
  if (wants(Result::virtual_depth))
    if (const auto virtual_depth = images_->virtual_depth())
      put(Result::virtual_depth, *virtual_depth);
  if (wants(Result::labels)) put(Result::labels, images_->labels());
  if (wants(Result::mask)) put(Result::mask, images_->mask());
  if (wants(Result::filtered_depth)) put(Result::filtered_depth, images_->filtered_depth());
  if (wants(Result::points)) put(Result::points, images_->points());
  if (wants(Result::targets))
    put(Result::targets, targets_message(report, images_->header().frame_id, root_));
  if (wants(Result::robot_mask))
    if (const auto mask = images_->robot_mask()) put(Result::robot_mask, *mask);
  if (wants(Result::overlay))
    put(Result::overlay, png_message(images_->header(), painter_->draw(frame, report), data_));
}

void ResultEncoder::encode_cloud(const Frame& frame, const FrameReport& report, ResultSink& sink) {
  const std::int64_t stamp = frame.stamp.value_or(0);
  const ReceivedCloud& cloud = *frame.scan->received;
  const auto write_cloud = [&]<typename M>(const M& message) {
    if (!std::exchange(has_type_, true)) sink.set_cloud_type(message_type<M>());
    for (const Result result : {Result::without_robot, Result::labelled}) {
      how_.labelled = result == Result::labelled;
      if (how_.labelled && !std::is_same_v<M, PointCloud2Message>) continue;
      if (sink.wants(result))
        write(result, stamp, cloud_output(message, report, how_, data_), sink);
    }
  };
  const bool is_read = frame.scan->points.count > 0 || frame.source_message.empty();
  if (is_read) std::visit(write_cloud, cloud.message);
  if (!frame.targets.empty() && sink.wants(Result::targets))
    write(Result::targets, stamp, targets_message(report, cloud.frame_id, root_), sink);
}

}  // namespace penumbra::io
