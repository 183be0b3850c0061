// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

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

/// CSV files of per-frame values, each read once: a header "frame,[name,]...", then a row per frame
/// (and name).
class ValueTables {
 public:
  ValueTables();
  ~ValueTables();

  struct Table;
  /// Throws InputError for a file that cannot be read or has another format.
  const Table& read(const std::filesystem::path& file);

 private:
  std::map<std::filesystem::path, std::unique_ptr<Table>> tables_;
};

/// The format of one kind of values.
struct ValueFormat {
  std::function<std::vector<double>(const YamlNode&)> read;  ///< one frame's value in YAML
  std::vector<std::string_view> columns;           ///< in a CSV file; empty: there is no such file
  std::vector<std::string_view> optional_columns;  ///< follow the numbers, if all are present
};

/// A target's numbers: constant, or by frame.
class FrameValues {
 public:
  /// Reads a value: the numbers themselves, {frames: {INDEX: numbers or null, ...}} or
  /// {csv: FILE}. Throws InputError for values that are wrong in every frame. A bad cell is a
  /// fault of its frame.
  static FrameValues read(const YamlNode& node, const ValueFormat& format,
                          const std::filesystem::path& folder, std::string_view name,
                          ValueTables& tables);

  /// Returns the value of a frame, with a fault if there is none.
  [[nodiscard]] FrameValue at(std::int64_t index) const;

  /// Calls check(value) for every value in the YAML file. What it throws becomes a fault of that
  /// value.
  void check_written(const std::function<void(const FrameValue&)>& check) const;

  [[nodiscard]] bool has_stamps() const { return has_stamps_; }

 private:
  struct Written {
    YamlNode node;
    FrameValue value;
  };

  void read_frames(const YamlNode& frames, const ValueFormat& format);
  void read_csv(const YamlNode& node, const ValueFormat& format,
                const std::filesystem::path& folder, std::string_view name, ValueTables& tables);

  std::string file_;  // named for missing frames
  std::optional<Written> constant_;
  std::vector<Written> written_;  // of `frames`
  std::unordered_map<std::int64_t, FrameValue> by_frame_;
  bool has_stamps_ = false;
};

}  // namespace penumbra::io
