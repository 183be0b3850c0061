// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <io/assembly/result_encoder.hpp>
#include <io/live/live_diagnostics.hpp>
#include <io/live/live_inbox.hpp>

namespace penumbra::io {

/// What of a camera's results was published: what nobody subscribes to is not.
struct WrittenResults {
  std::array<std::size_t, result_topics.size()> written = {};  ///< by Result
  std::size_t not_written = 0;  ///< that slow subscribers kept from being published
};

/// How long live went on.
struct LiveRun {
  double seconds = 0.0;
  double cpu_seconds = 0.0;                  ///< of all threads
  std::vector<WrittenResults> results = {};  ///< of each of the inbox's cameras
  std::string fault = {};                    ///< what ended it before its time; empty: nothing did
};

/// What came of all messages, as JSON. `links`: one for each of inbox.topics().
[[nodiscard]] std::string live_summary_json(const LiveInbox& inbox, std::span<const LiveLink> links,
                                            const LiveRun& run);

}  // namespace penumbra::io
