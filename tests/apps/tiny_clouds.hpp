// SPDX-License-Identifier: Apache-2.0
// Clouds of the tiny robot's board before a wall.
#pragma once

#include "tiny_bag.hpp"

#include <cmath>
#include <cstring>

#include <io/cloud/cloud_points.hpp>

namespace penumbra::test {

inline constexpr std::int64_t one_ms = 1'000'000;

/// Depth on the board, which slides by 0.05 m from frame to frame.
inline float on_board(int frame) { return 0.96F + 0.05F * static_cast<float>(frame); }

/// Points 1 m before the board's sensor and around it, x y z and their number: on the board, before
/// it, on the wall next to it, and no measurement.
struct FourPoints {
  explicit FourPoints(int frame) {
    const float no = std::nanf("");
    const float points[4][4] = {
        {0, 0, on_board(frame), 0}, {0, 0, 0.5F, 1}, {1, 0, 3, 2}, {no, no, no, 3}};
    data.resize(sizeof points);
    std::memcpy(data.data(), points, sizeof points);
    message = {.header = {0, "optical"},
               .height = 1,
               .width = 4,
               .fields = {{"x", 0}, {"y", 4}, {"z", 8}, {"number", 12}},
               .point_step = 16,
               .row_step = 64,
               .data = data};
  }
  std::vector<std::byte> data;
  io::PointCloud2Message message;
};

/// A recording.yaml of the clouds scans/0.pcd and so on.
inline std::string clouds_yaml() {
  return "robot: {urdf: tiny.urdf}\nsensor: {parent: base, pose: camera_pose.csv, model: "
         "lidar_2cm}\nframes: {joints: joint_states.csv, cloud: scans/%d.pcd}\n";
}

inline std::vector<int> numbers_of(const io::PointCloud2Message& cloud) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < cloud.width; ++i) {
    float number = 0;
    std::memcpy(&number, cloud.data.data() + i * cloud.point_step + 12, sizeof number);
    numbers.push_back(static_cast<int>(number));
  }
  return numbers;
}

/// Adds a cloud, a laser scan (of a scanner that looks along the optical axis) and a cloud of Livox
/// at each stamp, 10 ms of transport.
inline void add_clouds(TinyBag& bag) {
  Eigen::Isometry3d T_base_laser = Eigen::Isometry3d::Identity();
  T_base_laser.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  bag.add("/tf_static", tiny_stamp(0), io::TfMessage{{{{0, "base"}, "laser", T_base_laser}}});
  for (int i = 0; i < 3; ++i) {
    const std::int64_t stamp = tiny_stamp(i) + one_ms, arrival = stamp + 10 * one_ms;
    FourPoints cloud(i);
    cloud.message.header.stamp = stamp;
    bag.add("/points", arrival, cloud.message);
    bag.add("/scan", arrival,
            io::LaserScanMessage{.header = {stamp, "laser"},
                                 .angle_min = -0.6F,
                                 .angle_max = 0.6F,
                                 .angle_increment = 0.6F,
                                 .range_min = 0.1F,
                                 .range_max = 10,
                                 .ranges = {3, on_board(i), 3},
                                 .intensities = {1, 2, 3}});
    bag.add(
        "/livox/lidar", arrival,
        io::LivoxMessage{.header = {stamp, "laser"},
                         .point_num = 2,
                         .points = {{.x = on_board(i)}, {.offset_time = 1000, .x = 3, .y = 2}}});
  }
  bag.sort();
}

}  // namespace penumbra::test
