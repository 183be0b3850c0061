// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/targets/target_judge.hpp>

#include <io/files/frame_pattern.hpp>

namespace penumbra::io {

/// What a detector found in an image.
struct Detection {
  std::string category;  ///< name of its class, or its number
  std::string track;     ///< the same for one object in all frames; empty: not known
  Region region;         ///< a box or a mask
  std::optional<double> score = {};
};

/// By the frames' numbers.
using Detections = std::unordered_map<std::int64_t, std::vector<Detection>>;

/// Reads a detector's output (docs/targets.md): COCO results (*.json), a table with a header
/// (*.csv), MOT text (*.txt) or YOLO text, one file for each frame (labels/%d.txt). `images`: which
/// the boxes are of. `names`: of classes that have numbers in the file. `first_frame`: the file's
/// number of frame 0. `stamps`: of the frames, for YOLO's files that are named by time (%t). Throws
/// InputError that names the file and, for text, the line.
[[nodiscard]] Detections read_detections(const std::string& file_or_pattern,
                                         const std::filesystem::path& folder,
                                         const Intrinsics& images,
                                         const std::map<std::int64_t, std::string>& names,
                                         std::int64_t first_frame,
                                         const std::optional<FrameStamps>& stamps = {});

/// Returns the number that files of this kind give to the first frame: 1 of MOT, else 0.
[[nodiscard]] std::int64_t usual_first_frame(const std::string& file_or_pattern);

/// Returns what is doubtful about the boxes: most of them end outside of the image. Empty: nothing.
[[nodiscard]] std::string doubt_of(const Detections& all, const Intrinsics& images);

/// Returns whether a file is a detector's, not a targets.yaml.
[[nodiscard]] bool is_detections_name(const std::filesystem::path& file);

}  // namespace penumbra::io
