// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <penumbra/pipeline/statistics.hpp>

namespace penumbra::app {

/// Counts the overlays that could not show the recorded colour.
struct ColorFaults {
  std::size_t frames = 0;
  std::string first;

  void add(const std::string& message) {
    if (message.empty()) return;
    if (frames == 0) first = message;
    ++frames;
  }
};

/// Prints what was wrong with frames, targets and overlays on stderr, a line for each kind.
void tell_faults(const Statistics& statistics, const ColorFaults& color);

/// Prints counts and times on stdout, and where the results are.
void tell_summary(const Statistics& statistics, const std::string& where);

}  // namespace penumbra::app
