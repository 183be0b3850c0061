// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/targets/region.hpp>

#include <io/files/frame_pattern.hpp>

namespace penumbra::io {

/// What a detector found in an image.
struct Detection {
  std::string category;  ///< name of its class, or its number
  std::string track;     ///< the same for one object in all frames; empty: not known
  Region region;         ///< a box or a mask
  double score = 1.0;
};

/// By the frames' numbers.
using Detections = std::unordered_map<std::int64_t, std::vector<Detection>>;

/// Reads a detector's output (docs/targets.md): COCO results (*.json), a table with a header
/// (*.csv), MOT text (*.txt) or YOLO text, one file for each frame (labels/%d.txt). `images`: which
/// the boxes are of. `names`: of classes that have numbers in the file. `stamps`: of the frames,
/// for YOLO's files that are named by time (%t). Throws InputError that names the file and, for
/// text, the line.
[[nodiscard]] Detections read_detections(const std::string& file_or_pattern,
                                         const std::filesystem::path& folder,
                                         const Intrinsics& images,
                                         const std::map<std::int64_t, std::string>& names,
                                         const std::optional<FrameStamps>& stamps = {});

/// Returns whether a file is a detector's, not a targets.yaml.
[[nodiscard]] bool is_detections_name(const std::filesystem::path& file);

}  // namespace penumbra::io
