// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <apps/penumbra/arguments.hpp>

namespace penumbra::app {

/// `penumbra view live`: shows what `penumbra live` publishes. Answers the exit status.
[[nodiscard]] int view_live(const ViewArguments& arguments);

}  // namespace penumbra::app
