// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <io/dds/participant.hpp>

namespace penumbra::io {

/// Returns the output of `topics --json`. Values that discovery does not have are null.
[[nodiscard]] std::string graph_json(int domain, std::span<const GraphTopic> topics);

}  // namespace penumbra::io
