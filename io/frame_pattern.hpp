// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra::io {

/// A file name with one frame number in it: "depth_%d.png", "depth/%06d.npy" (%% is a percent
/// sign).
class FramePattern {
 public:
  /// `folder` is put before relative patterns. Throws InputError unless there is exactly one %d or
  /// %0Nd (N from 1 to 9) and no other %.
  FramePattern(std::string_view pattern, const std::filesystem::path& folder);

  /// The file of frame `index` >= 0.
  [[nodiscard]] std::filesystem::path file(std::int64_t index) const;

  /// Whether the pattern's name ends in `extension` (".npy"), whatever the case.
  [[nodiscard]] bool has_extension(std::string_view extension) const;

 private:
  std::filesystem::path folder_;
  std::string before_, after_;
  std::size_t digits_ = 0;  // 0: as many as the number has
};

}  // namespace penumbra::io
