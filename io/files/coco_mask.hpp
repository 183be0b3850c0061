// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/image.hpp>

namespace penumbra::io {

/// A mask as COCO's annotations have it.
struct CocoMask {
  std::string counts;           ///< compressed run lengths, column by column
  std::array<int, 4> box = {};  ///< left, top, width, height; all 0 if the mask is empty
  std::int64_t area = 0;        ///< pixels
};

/// Returns where a depth image is above 0. The text is that of pycocotools: each count is the
/// difference to the one before the last, in groups of 5 bits, the lowest first
/// (https://github.com/cocodataset/cocoapi/blob/master/common/maskApi.c, rleToString).
[[nodiscard]] CocoMask coco_mask(ImageView<const float> depth);

/// Returns the run lengths of such a text; null: it is damaged.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> decoded_counts(std::string_view text);

}  // namespace penumbra::io
