// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace penumbra::io {

/// What the headers of a message in H.264 say of its frame.
struct H264Frame {
  int pictures = 0;             ///< begun in the message
  std::string_view parameters;  ///< of the stream, if the message has them
  bool is_key = false;          ///< IDR: needs no frame before it
  bool is_between = false;      ///< has B slices: may need frames that are shown after it
  bool is_reference = false;    ///< frames after it may need it
  std::uint32_t number = 0;     ///< frame_num: one more than the last reference frame's; 0: IDR
};

/// Reads a message in Annex B. `number_bits`: of the numbers, which begin again after the largest
/// one; replaced by the message's parameters, if it has any; 0: numbers are not known.
[[nodiscard]] H264Frame read_h264(std::string_view message, int& number_bits);

}  // namespace penumbra::io
