// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace penumbra::io {

/// Of this process, and of no other: a page that was served by another one on the same port sees
/// by it that what it has is not from here.
[[nodiscard]] const std::string& server_id();

}  // namespace penumbra::io
