// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace penumbra::sim {

/// What an experiment's report says in sentences; plain text.
struct ReportWords {
  std::string title, story;
  std::string goal;    ///< what happens at SeedRun::goal, a word
  std::string limits;  ///< what the figures do not say, one point a line
};

/// conveyor or handover.
[[nodiscard]] const ReportWords& report_words(const std::string& experiment);

}  // namespace penumbra::sim
