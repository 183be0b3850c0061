// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

struct LaserScanMessage {
  static constexpr std::string_view ros_type = "sensor_msgs/LaserScan";
  static auto layout(auto& m) {
    return fields_of(m.header, m.angle_min, m.angle_max, m.angle_increment, m.time_increment,
                     m.scan_time, m.range_min, m.range_max, m.ranges, m.intensities);
  }

  MessageHeader header = {};
  float angle_min = 0;
  float angle_max = 0;
  float angle_increment = 0;
  float time_increment = 0;  ///< seconds between two rays
  float scan_time = 0;
  float range_min = 0;
  float range_max = 0;
  std::vector<float> ranges = {};
  std::vector<float> intensities = {};
};

/// Livox's own cloud.
struct LivoxPoint {
  static constexpr std::string_view ros_type = "livox_ros_driver2/CustomPoint";
  static auto layout(auto& m) {
    return fields_of(m.offset_time, m.x, m.y, m.z, m.reflectivity, m.tag, m.line);
  }

  std::uint32_t offset_time = 0;  ///< nanoseconds after the message's timebase
  float x = 0;
  float y = 0;
  float z = 0;
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
  std::uint8_t line = 0;
};

struct LivoxMessage {
  static constexpr std::string_view ros_type = "livox_ros_driver2/CustomMsg";
  static auto layout(auto& m) {
    return fields_of(m.header, m.timebase, m.point_num, m.lidar_id, m.rsvd, m.points);
  }

  MessageHeader header = {};
  std::uint64_t timebase = 0;  ///< nanoseconds, of the first point
  std::uint32_t point_num = 0;
  std::uint8_t lidar_id = 0;
  std::array<std::uint8_t, 3> rsvd{};
  std::vector<LivoxPoint> points = {};
};

}  // namespace penumbra::io
