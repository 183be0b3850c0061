// SPDX-License-Identifier: Apache-2.0
// The numbers of a targets.yaml: constant, or by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <io/files/csv.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {

/// The value of one frame.
struct FrameValue {
  std::vector<double> numbers;
  std::optional<std::int64_t> stamp;     ///< of their image, nanoseconds
  std::optional<double> expected_depth;  ///< metres
  std::string place;                     ///< "FILE:LINE: " of a CSV row
  std::string fault;                     ///< with its place; empty if there are numbers
};

/// The CSV files of a targets.yaml, each read once: "frame,[name,]...".
using ValueTables = std::map<std::filesystem::path, FrameTable>;

/// The format of one kind of values.
struct ValueFormat {
  std::function<std::vector<double>(const YamlNode&)> read;  ///< one frame's value in YAML
  std::vector<std::string_view> columns;           ///< in a CSV file; empty: there is no such file
  std::vector<std::string_view> optional_columns;  ///< follow the numbers, if all are present
};

/// Numbers for the columns, or for these and all optional columns.
[[nodiscard]] ValueFormat fixed_format(std::vector<std::string_view> columns,
                                       std::vector<std::string_view> optional_columns = {});

/// x, y, z, qx, qy, qz, qw; and `optional_columns` after them.
[[nodiscard]] ValueFormat pose_format(std::vector<std::string_view> optional_columns = {});

/// Returns the first three numbers, metres.
[[nodiscard]] Eigen::Vector3d position_of(const std::vector<double>& numbers);
/// Returns the pose of the first seven. Throws InputError for a quaternion that is not of length 1.
[[nodiscard]] Eigen::Isometry3d isometry_of(const std::vector<double>& numbers);

/// A target's numbers: constant, or by frame.
class FrameValues {
 public:
  using Check = std::function<void(const FrameValue&)>;

  /// Reads a value: the numbers themselves, {frames: {INDEX: numbers or null, ...}} or
  /// {csv: FILE}. `name`: of the target. `check` throws InputError for values in the YAML file that
  /// are wrong; a bad cell of a CSV file is a fault of its frame.
  FrameValues(const YamlNode& node, const ValueFormat& format, const Check& check,
              const std::filesystem::path& folder, std::string_view name, ValueTables& tables);

  /// Returns the value of a frame, with a fault if there is none.
  [[nodiscard]] FrameValue at(std::int64_t index) const;

  [[nodiscard]] bool has_stamps() const { return has_stamps_; }

 private:
  void read_frames(const YamlNode& frames, const ValueFormat& format, const Check& check);
  void read_table(const FrameTable& table, const ValueFormat& format, std::string_view name,
                  const YamlNode& node);

  std::string file_ = "targets file";  // named for missing frames
  std::optional<FrameValue> constant_;
  std::unordered_map<std::int64_t, FrameValue> by_frame_;
  bool has_stamps_ = false;
};

/// Returns make(value). Throws InputError with the value's place for a fault of the value, and for
/// what `make` throws.
template <typename F>
auto made_of(const FrameValue& value, const F& make) {
  if (!value.fault.empty()) throw InputError(value.fault);
  try {
    return make(value);
  } catch (const InputError& fault) {
    throw InputError(value.place + fault.what());
  }
}

}  // namespace penumbra::io
