// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace penumbra::io {

/// Returns an identifier of this process. A page uses it to detect that its data comes from another
/// server on the same port.
[[nodiscard]] const std::string& server_id();

}  // namespace penumbra::io
