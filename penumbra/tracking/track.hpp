// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace penumbra {

/// Where a handled target's position comes from.
enum class Source {
  measured,   ///< an estimate that was accepted, of this very stamp
  predicted,  ///< the last accepted estimates, carried on by their motion
  held,       ///< the last accepted estimates, of a target that is taken to stay
  lost        ///< no accepted estimate, or the last one is older than the time-out
};

/// The source's name in report.json.
[[nodiscard]] std::string_view to_string(Source source);

/// What a tracker did with an estimate.
enum class Outcome {
  accepted,
  refused_verdict,  ///< its target was not visible enough
  refused_gate,     ///< too far from where the target can be: an outlier
  refused_late,     ///< older than what is remembered
  refused_invalid  ///< not finite, no rotation, a covariance that is none, in a link whose place is
                   ///< not known, or another estimate of this stamp stands already (accepted or an
                   ///< outlier)
};

[[nodiscard]] std::string_view to_string(Outcome outcome);

}  // namespace penumbra
