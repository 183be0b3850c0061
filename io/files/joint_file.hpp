// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>

#include <io/files/frame_pattern.hpp>

namespace penumbra::io {

/// One frame's row of a joint file.
struct JointRow {
  std::int64_t index = 0;             ///< the frame's number; at least 0
  std::optional<std::int64_t> stamp;  ///< nanoseconds, at least 0; nothing without that column
  std::vector<double> positions;      ///< order of Robot::variables(); empty if the row is at fault
  std::string fault;                  ///< why the row cannot be used, with file and line
  /// Variables whose cells cannot be read, indices into Robot::variables(). The other positions can
  /// be used; these are the rest positions. Empty: a fault concerns the whole row.
  std::vector<std::size_t> unknown = {};
};

/// Reads a joint file: a header "frame,NAME,..." with every variable of the robot once and perhaps
/// "stamp", then one row per frame, in the file's order. Columns of mimicking joints are ignored. A
/// bad or empty cell makes its joint unknown in this row. Throws InputError that names file and
/// line for what makes the whole file unsure: no rows, unknown, doubled or missing names, an
/// invalid or doubled frame number, a negative stamp.
[[nodiscard]] std::vector<JointRow> read_joint_file(const std::filesystem::path& file,
                                                    const Robot& robot);

/// Reads the stamps of a joint file of any robot; none without that column. Throws InputError for
/// another header or an invalid frame number.
[[nodiscard]] FrameStamps read_frame_stamps(const std::filesystem::path& file);

}  // namespace penumbra::io
