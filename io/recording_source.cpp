// SPDX-License-Identifier: Apache-2.0
#include <io/recording_source.hpp>

namespace penumbra::io {

Frame frame_of(const FrameData& data) {
  Frame frame;
  frame.stamp = data.stamp;
  frame.depth = data.depth_view();
  frame.joints = data.positions;
  frame.source_status = data.status;
  frame.source_message = data.message;
  frame.index = static_cast<std::size_t>(data.index);
  // A recording's joint row is of the frame's own stamp.
  if (data.stamp && !data.positions.empty()) frame.joints.age = 0;
  return frame;
}

bool RecordingSource::next(FrameData& data, Frame& frame) {
  if (next_ == selected_.size()) return false;
  reader_.read(selected_[next_++], with_color_, data);
  frame = frame_of(data);
  return true;
}

}  // namespace penumbra::io
