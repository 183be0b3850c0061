// SPDX-License-Identifier: Apache-2.0
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

}  // namespace penumbra::io
