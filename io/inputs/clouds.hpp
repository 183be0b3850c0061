// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <penumbra/tuning/cloud_tuning.hpp>

#include <io/inputs/run_input.hpp>

namespace penumbra::io {

/// A recording folder with `frames.cloud`, or a bag, and how its clouds are read.
struct CloudRunOptions {
  InputOptions input;
  /// What options change of the recording's rule, or of the default, in their order.
  std::vector<std::function<void(CloudRule&)>> rule_changes;
  bool use_times = true;     ///< see CloudInputOptions
  bool has_rays = true;      ///< see CloudInputOptions
  std::string sensor_frame;  ///< likewise; of bags
  int threads = 1;
};

/// Opens the sensors of an input that measure points; `print` gets the used topics of a bag. Throws
/// InputError that names the file.
[[nodiscard]] std::vector<RunInput> open_clouds(const CloudRunOptions& options,
                                                const LineSink& print);

/// Measures a sensor's rule in some of its clouds: enough, and not all of one moment. Calls `go_on`
/// after each cloud and stops if it returns false.
[[nodiscard]] CloudTuning tune_clouds(const RunInput& input, const std::function<bool()>& go_on);

}  // namespace penumbra::io
