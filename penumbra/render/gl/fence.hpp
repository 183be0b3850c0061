// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::gl {

/// Waits for a GLsync of the current context, deletes it and makes it null; null is there already.
/// Throws std::runtime_error where it never comes or the context fails.
void wait_for(void*& fence);

}  // namespace penumbra::gl
