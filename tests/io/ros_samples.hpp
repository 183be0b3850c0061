// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <tuple>

#include <io/ros/cdr_writer.hpp>
#include <io/ros/lidar_messages.hpp>

// One message of each type that is written, with odd lengths, so that alignment matters.
namespace penumbra::test {

constexpr std::array<std::byte, 5> sample_bytes = {std::byte{1}, std::byte{2}, std::byte{250},
                                                   std::byte{0}, std::byte{7}};

inline io::MessageHeader sample_header() { return {1'699'999'999'987'654'321, "camera/optical"}; }

inline Eigen::Isometry3d sample_pose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()));
  pose.translation() = Eigen::Vector3d(0.25, -1.5, 3.125);
  return pose;
}

inline io::CameraInfoMessage sample_camera() {
  io::CameraInfoMessage info{.header = sample_header(), .height = 480, .width = 640};
  info.distortion_model = "plumb_bob";
  info.d = {0.1, -0.2, 0.001, 0.002, 0.05};
  for (std::size_t i = 0; i < info.k.size(); ++i) info.k[i] = 1.5 * static_cast<double>(i);
  for (std::size_t i = 0; i < info.r.size(); ++i) info.r[i] = 100.0 - static_cast<double>(i);
  for (std::size_t i = 0; i < info.p.size(); ++i) info.p[i] = 0.25 + static_cast<double>(i);
  info.binning_x = 2;
  info.binning_y = 4;
  info.roi = {1, 2, 3, 4, true};
  return info;
}

inline io::TargetsMessage sample_targets() {
  io::TargetMessage target{.name = "part"};
  target.has_stamp = true;
  target.stamp = 5'000'000'001;
  target.verdict = io::TargetMessage::partial;
  target.verdict_name = "partial";
  target.judged = true;
  target.covered = 5'000'000'000;
  target.inside = 120;
  target.occluded_fraction = 0.25;
  target.front_fraction = 0.5;
  target.clear_fraction = 0.125;
  target.unknown_fraction = 0.125;
  target.blame = {{"wrist_3", 0.2}, {"tool", 0.05}};
  target.point = {1, 2, 3};
  target.point_pixels = 77;
  target.point_spread = 0.003;
  target.source = io::TargetMessage::predicted;
  target.age = 0.5;
  target.pose.position = {4, 5, 6};
  target.sigma = 0.01;
  target.forecast_seconds = 2.0;
  target.hidden_in = 1.25;
  target.hidden_for = std::numeric_limits<double>::infinity();
  target.lost_in = 1.75;
  target.hidden_by = "forearm";
  target.estimate = io::TargetMessage::refused_gate;
  io::TargetMessage unknown{.name = "wrist", .reason = "joint states are stale"};
  unknown.age = INFINITY;
  return {sample_header(), "base_link", "stale_joints", "elbow: 0.3 s old", {target, unknown}};
}

inline io::TargetViewsMessage sample_views() {
  io::TargetViewMessage part{.name = "part"};
  part.verdict = io::TargetMessage::visible;
  part.verdict_name = "visible";
  part.best = "left";
  part.point = {1, 2, 3};
  part.covariance = {1, 0.5, 0.25, 0.5, 2, 0.125, 0.25, 0.125, 3};
  part.views = {{.camera = "left"}, {.camera = "right"}};
  part.views[0].has_stamp = true;
  part.views[0].stamp = 5'000'000'001;
  part.views[0].verdict = io::TargetMessage::visible;
  part.views[0].verdict_name = "visible";
  part.views[0].visible_fraction = 0.75;
  part.views[0].point = {1.5, 2, 3};
  part.views[0].distance = 0.5;
  part.views[0].angle = 0.125;
  part.views[1].reason = "no view of it within the window of time";
  io::TargetViewMessage tool{.name = "tool", .reason = "cameras measure it at different places"};
  tool.contradicting = {"left", "right"};
  tool.contradiction_distance = 0.25;
  tool.contradiction_chi_square = 40;
  return {sample_header(), {part, tool}};
}

/// A sample of each type that is written.
inline auto all_samples() {
  using namespace io;
  using Status = DiagnosticStatusMessage;
  const MessageHeader header = sample_header();
  const float nan = NAN;
  return std::tuple{
      ImageMessage{header, 1, 5, "mono8", {}, 5, sample_bytes},
      CompressedImageMessage{header, "png", sample_bytes},
      sample_camera(),
      JointStateMessage{header, {"elbow", "", "shoulder_pan"}, {0.5, -1.25, 3}, {}, {7, 8}},
      TfMessage{{{header, "tool", sample_pose()}, {{-1, "a"}, "", sample_pose().inverse()}}},
      StringMessage{"<robot name=\"r\"/>"},
      PoseStampedMessage{header, sample_pose()},
      PointCloud2Message{
          .header = header,
          .height = 1,
          .width = 1,
          .fields = {{"x", 0, PointFieldMessage::float32, 1}, {"intensity", 4, 2, 1}},
          .point_step = 5,
          .row_step = 5,
          .data = sample_bytes,
          .is_dense = true},
      LaserScanMessage{
          header, -1.5F, 1.5F, 1.5F, 1e-4F, 0.025F, 0.1F, 30.0F, {1, nan, 2}, {7, 8, 9}},
      LivoxMessage{header,
                   1'000'000'000,
                   2,
                   3,
                   {4, 5, 6},
                   {{0, 1, 2, 3, 10, 11, 12}, {100, 4, 5, 6, 20, 21, 22}}},
      DiagnosticArrayMessage{
          header,
          {{Status::warn, "camera", "late", "d435", {{"age_ms", "35.5"}, {"drops", "3"}}},
           {Status::stale, "joints", "none", "", {}}}},
      KeypointsMessage{header, {{"left/wrist", 12.5, -3, 0.75, 1.25}, {"nose", 0, 0, 0, NAN}}},
      sample_targets(),
      sample_views()};
}

template <typename M>
M sample() {
  return std::get<M>(all_samples());
}

/// Calls `call` with a sample of each type that is written.
template <typename F>
void for_each_sample(const F& call) {
  std::apply([&](const auto&... message) { (call(message), ...); }, all_samples());
}

/// A copy that ends where its memory ends, so that sanitizers see each byte read past it.
struct ExactCopy {
  explicit ExactCopy(std::span<const std::byte> from)
      : size(from.size()), memory(new std::byte[from.size()]) {
    std::copy(from.begin(), from.end(), memory.get());
  }
  [[nodiscard]] std::span<std::byte> bytes() const { return {memory.get(), size}; }

  std::size_t size;
  std::unique_ptr<std::byte[]> memory;
};

// Payloads of messages that are read but not written, put together by hand: one detection each.

inline void write_detections_header(io::CdrWriter& writer) {
  writer.write(std::int32_t{1'699'999'999});
  writer.write(std::uint32_t{987'654'321});
  writer.write_string("camera/optical");
}

inline void write_doubles(io::CdrWriter& writer, std::initializer_list<double> values) {
  for (const double value : values) writer.write(value);
}

// Header, detections, and of the one its header and two hypotheses.
inline void begin_detections(io::CdrWriter& writer) {
  write_detections_header(writer);
  writer.write_count(1);
  write_detections_header(writer);
  writer.write_count(2);
  for (const char* name : {"cup", "person"}) {
    writer.write_string(name);
    writer.write(0.5);
    write_doubles(writer, {1, 2, 3, 0, 0, 0, 1});
    for (int i = 0; i < 36; ++i) writer.write(static_cast<double>(i));
  }
}

inline std::vector<std::byte> detection_2d_payload() {
  std::vector<std::byte> payload;
  io::CdrWriter writer(payload);
  begin_detections(writer);
  write_doubles(writer, {320.5, 240.25, 0.1, 64, 32});
  writer.write_string("track/7");
  return payload;
}

inline std::vector<std::byte> detection_3d_payload() {
  std::vector<std::byte> payload;
  io::CdrWriter writer(payload);
  begin_detections(writer);
  write_doubles(writer, {0.5, -0.25, 2, 0, 0, 0.6, 0.8, 0.1, 0.2, 0.3});
  writer.write_string("box");
  return payload;
}

}  // namespace penumbra::test
