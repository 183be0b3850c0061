// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <penumbra/pipeline/frame.hpp>

#include <io/ros/lidar_messages.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// The points of a message, and when each was measured.
struct CloudPoints {
  PointsView points;                ///< refers to the message or to `copied`
  std::vector<float> copied;        ///< x, y, z of each point
  std::vector<std::int32_t> times;  ///< as Scan::times
  std::string time_note;            ///< how the field of times, or the byte order, was understood

  CloudPoints() = default;
  CloudPoints(CloudPoints&&) = default;
  CloudPoints& operator=(CloudPoints&&) = default;
};

/// Finds the points of a message. `out` keeps its memory, and refers to the message's. Returns why
/// it cannot be used, one line, or nothing.
///
/// Clouds above most_cloud_points cannot. PointCloud2: x, y and z of float32 or float64 in any
/// order, aligned or not; other fields may be of unknown types. If is_bigendian is wrong, which
/// lengths show, the other byte order is used, and time_note says so. The first field
/// called t, time, timestamp, time_stamp or offset_time has the points' times. A scan lasts between
/// a millisecond and a second, which says whether its numbers are seconds, milliseconds,
/// microseconds or nanoseconds. If the first is within a second of the header's stamp they are of
/// its clock; if it is within a second of 0 they count from the stamp; else the first point is of
/// the stamp.
/// LaserScan: ranges outside of range_min to range_max are no measurement.
/// `use_times`: false: all points are measured at the stamp.
[[nodiscard]] std::string read_points(const PointCloud2Message& cloud, bool use_times,
                                      CloudPoints& out);
[[nodiscard]] std::string read_points(const LaserScanMessage& scan, bool use_times,
                                      CloudPoints& out);
[[nodiscard]] std::string read_points(const LivoxMessage& cloud, bool use_times, CloudPoints& out);

}  // namespace penumbra::io

namespace penumbra {

/// A cloud of a topic or a file, and its points.
struct ReceivedCloud {
  std::variant<io::PointCloud2Message, io::LaserScanMessage, io::LivoxMessage> message;
  std::shared_ptr<const void> owner;  ///< of the bytes that the message refers to
  io::CloudPoints points;
  std::string frame_id;      ///< without a leading "/"
  std::int64_t arrived = 0;  ///< on the clock of whoever received it
};

}  // namespace penumbra

namespace penumbra::io {

/// Returns the scan of a cloud, which it keeps. `has_rays`: false: merged clouds, see Scan::origin.
[[nodiscard]] Scan scan_of(const std::shared_ptr<const ReceivedCloud>& cloud, bool has_rays);

/// What is written of a labelled cloud.
struct CloudOutput {
  /// PointCloud2 with all points and two more fields, `label` (uint8) and `link` (uint16: index + 1
  /// in FrameReport::links), in place of one without the robot.
  bool labelled = false;
  /// Ranges of the robot in a LaserScan become inf in place of NaN; those that may be its stay NaN.
  bool infinite_ranges = false;
};

/// Returns the message with what is neither clear nor front removed. Points of a PointCloud2 of
/// several rows, and ranges, become NaN, others are left out. Other values are not changed. `data`
/// holds the result's.
[[nodiscard]] PointCloud2Message cloud_output(const PointCloud2Message& cloud,
                                              const FrameReport& report, const CloudOutput& how,
                                              std::vector<std::byte>& data);
[[nodiscard]] LaserScanMessage cloud_output(const LaserScanMessage& scan, const FrameReport& report,
                                            const CloudOutput& how, std::vector<std::byte>& data);
[[nodiscard]] LivoxMessage cloud_output(const LivoxMessage& cloud, const FrameReport& report,
                                        const CloudOutput& how, std::vector<std::byte>& data);

}  // namespace penumbra::io
