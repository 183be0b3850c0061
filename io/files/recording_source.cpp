// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <penumbra/base/error.hpp>

#include <io/files/recording_source.hpp>

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
  if (fps_ && data.stamp)
    throw InputError("frame " + std::to_string(data.index) +
                     " has a stamp of its own: leave --fps out");
  if (fps_) data.stamp = std::llround(1e9 * static_cast<double>(data.index) / *fps_);
  frame = frame_of(data);
  return true;
}

}  // namespace penumbra::io
