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

/// Counts the published results of a camera. Results without a subscriber are not published.
struct WrittenResults {
  std::array<std::size_t, result_topics.size()> written = {};  ///< indexed by Result
  std::size_t not_written = 0;     ///< not published because subscribers were too slow
  std::size_t unacknowledged = 0;  ///< published; reliable subscribers may have lost them
};

/// The duration and outcome of a `penumbra live`.
struct LiveRun {
  double seconds = 0.0;
  double cpu_seconds = 0.0;                          ///< of all threads
  std::vector<WrittenResults> results = {};          ///< one for each camera of the inbox
  std::vector<std::size_t> clouds_not_written = {};  ///< of each sensor: subscribers were too slow
  std::string fault = {};  ///< the fault that ended it; empty if there was none
};

/// Returns the outcome of all messages as JSON. `links`: one for each of inbox.topics().
[[nodiscard]] std::string live_summary_json(const LiveInbox& inbox, std::span<const LiveLink> links,
                                            const LiveRun& run);

}  // namespace penumbra::io
