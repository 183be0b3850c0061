// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/targets/target.hpp>

#include <io/files/frame_values.hpp>
#include <io/files/targets_file.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {

/// The context of one target of a targets.yaml.
struct TargetReader {
  const YamlNode& node;
  const std::string& name;
  const TargetsContext& context;
  const std::filesystem::path& folder;  ///< of named files
  ValueTables& tables;

  /// Reads the values of a key of this target.
  [[nodiscard]] std::shared_ptr<FrameValues> values(const YamlNode& at, const ValueFormat& format,
                                                    const FrameValues::Check& check) const {
    return std::make_shared<FrameValues>(at, format, check, folder, name, tables);
  }
};

/// A target's shape by frame.
struct ShapeSource {
  /// Sets a target's shape and, if the file has it, stamp. Throws InputError with the place if the
  /// frame has no valid shape.
  std::function<void(std::int64_t index, Target& target)> set;
  bool may_be_late = false;
  bool has_pose = false;  ///< with an orientation
};

/// Returns the frame of the key `link`; without it the camera's.
[[nodiscard]] ReferenceFrame link_of(const YamlNode& node, const Robot& robot);

/// Returns whether the target is given by pixels of an image.
[[nodiscard]] bool names_pixels(const YamlNode& target);

/// Reads the keys extent, expected_depth and height.
[[nodiscard]] RegionTarget region_settings(const YamlNode& node, Extent extent);

/// Returns a number above 0. Throws InputError for another.
[[nodiscard]] double positive_number(const YamlNode& node);

/// Reads the one key that says what the target is (box, polygon, ...), and those that belong to it.
[[nodiscard]] ShapeSource read_shape(const TargetReader& reader);

/// An estimate by frame; std::monostate in frames without one.
struct EstimateSource {
  std::function<TargetEstimate(std::int64_t index)> of_frame;
  bool is_pose = false;
};
[[nodiscard]] EstimateSource read_estimate(const TargetReader& reader, const YamlNode& node);

/// `thresholds` and `handling` of a target.
[[nodiscard]] TargetThresholds read_thresholds(const YamlNode& node, TargetThresholds thresholds);
[[nodiscard]] TargetHandling read_handling(const YamlNode& node);

}  // namespace penumbra::io
