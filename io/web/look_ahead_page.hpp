// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/look_ahead_report.hpp>

namespace penumbra::io {

/// A moment of a motion.
struct MomentPicture {
  std::string caption;
  Image<Rgb8> image;
};

/// Returns the page of a result. `pictures`: of each motion.
[[nodiscard]] std::string look_ahead_page(const LookAheadResult& result,
                                          const std::vector<std::vector<MomentPicture>>& pictures);

}  // namespace penumbra::io
