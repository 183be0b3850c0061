// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <io/json-inl.hpp>
#include <io/report_json.hpp>

namespace penumbra::io {

/// "renderer" of report.json.
[[nodiscard]] Json renderer_json(const UsedRenderer& used);

}  // namespace penumbra::io
