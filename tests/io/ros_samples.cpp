// SPDX-License-Identifier: Apache-2.0
#include "ros_samples.hpp"

#include <io/ros/cdr_writer.hpp>

namespace penumbra::test {
namespace {

void write_header(io::CdrWriter& writer) {
  writer.write(std::int32_t{1'699'999'999});
  writer.write(std::uint32_t{987'654'321});
  writer.write_string("camera/optical");
}

void write_doubles(io::CdrWriter& writer, std::initializer_list<double> values) {
  for (const double value : values) writer.write(value);
}

// Header, detections, and of the one its header and two hypotheses.
void write_begin(io::CdrWriter& writer) {
  write_header(writer);
  writer.write_count(1);
  write_header(writer);
  writer.write_count(2);
  for (const char* name : {"cup", "person"}) {
    writer.write_string(name);
    writer.write(0.5);
    write_doubles(writer, {1, 2, 3, 0, 0, 0, 1});
    for (int i = 0; i < 36; ++i) writer.write(static_cast<double>(i));
  }
}

}  // namespace

std::vector<std::byte> detection_2d_payload() {
  std::vector<std::byte> payload;
  io::CdrWriter writer(payload);
  write_begin(writer);
  write_doubles(writer, {320.5, 240.25, 0.1, 64, 32});
  writer.write_string("track/7");
  return payload;
}

std::vector<std::byte> detection_3d_payload() {
  std::vector<std::byte> payload;
  io::CdrWriter writer(payload);
  write_begin(writer);
  write_doubles(writer, {0.5, -0.25, 2, 0, 0, 0.6, 0.8, 0.1, 0.2, 0.3});
  writer.write_string("box");
  return payload;
}

}  // namespace penumbra::test
