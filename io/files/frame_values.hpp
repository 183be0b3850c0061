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

/// What is given of one frame.
struct FrameValue {
  std::vector<double> numbers;
  std::optional<std::int64_t> stamp;     ///< nanoseconds; of the image that they are of
  std::optional<double> expected_depth;  ///< metres
  std::string place;                     ///< of a file's row: "FILE:LINE: "
  std::string fault;                     ///< why there are no numbers, with its place; else empty
};

/// CSV files of per-frame values, each read once: a header "frame,[name,]...", then a row per frame
/// (and name).
class ValueTables {
 public:
  ValueTables();
  ~ValueTables();

  struct Table;
  /// Throws InputError for a file that cannot be read, or is none of the kind.
  const Table& read(const std::filesystem::path& file);

 private:
  std::map<std::filesystem::path, std::unique_ptr<Table>> tables_;
};

/// How values of one kind are written.
struct ValueFormat {
  std::function<std::vector<double>(const YamlNode&)> read;  ///< one frame's value in YAML
  std::vector<std::string_view> columns;           ///< in a CSV file; empty: there is no such file
  std::vector<std::string_view> optional_columns;  ///< follow in the numbers where all are there
};

/// A target's numbers: the same in every frame, or given by frame.
class FrameValues {
 public:
  /// Reads a value: the numbers themselves, {frames: {INDEX: numbers or null, ...}} or
  /// {csv: FILE}. Throws InputError for what cannot be right in any frame; a bad cell is its
  /// frame's fault.
  static FrameValues read(const YamlNode& node, const ValueFormat& format,
                          const std::filesystem::path& folder, std::string_view name,
                          ValueTables& tables);

  /// Of a frame; with a fault where nothing is given of it.
  [[nodiscard]] FrameValue at(std::int64_t index) const;

  /// Calls check(value) for every value that stands in the YAML file itself; what it throws is told
  /// as that value's fault.
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

  std::string file_;  // that a missing frame is missing in
  std::optional<Written> constant_;
  std::vector<Written> written_;  // of `frames`
  std::unordered_map<std::int64_t, FrameValue> by_frame_;
  bool has_stamps_ = false;
};

}  // namespace penumbra::io
