// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <io/live/live_diagnostics.hpp>
#include <io/live/live_inbox.hpp>

namespace penumbra::io {

/// How long live went on.
struct LiveRun {
  double seconds = 0.0;
  double cpu_seconds = 0.0;     ///< of all threads
  std::size_t not_written = 0;  ///< results that slow subscribers kept from being published
  std::string fault = {};       ///< what ended it before its time; empty: nothing did
};

/// What came of all messages, as JSON. `links`: one for each of inbox.topics().
[[nodiscard]] std::string live_summary_json(const LiveInbox& inbox, std::span<const LiveLink> links,
                                            const LiveRun& run);

}  // namespace penumbra::io
