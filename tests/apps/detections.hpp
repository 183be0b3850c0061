// SPDX-License-Identifier: Apache-2.0
// Detection arrays of vision_msgs, put together by the fields of their definitions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <io/ros/cdr_writer.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::test {

struct Detection {
  std::string id;
  std::vector<double> box;  ///< all fields of its BoundingBox2D or BoundingBox3D
};

/// A Detection2DArray, or a Detection3DArray: they differ in their boxes.
inline std::vector<std::byte> detections_payload(const io::MessageHeader& header,
                                                 const std::vector<Detection>& detections) {
  std::vector<std::byte> payload;
  io::CdrWriter writer(payload);
  const auto write_header = [&] {
    writer.write(static_cast<std::int32_t>(header.stamp / 1'000'000'000));
    writer.write(static_cast<std::uint32_t>(header.stamp % 1'000'000'000));
    writer.write_string(header.frame_id);
  };
  write_header();
  writer.write_count(detections.size());
  for (const Detection& detection : detections) {
    write_header();
    writer.write_count(0);  // hypotheses
    for (const double value : detection.box) writer.write(value);
    writer.write_string(detection.id);
  }
  return payload;
}

}  // namespace penumbra::test
