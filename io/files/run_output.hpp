// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>

#include <io/files/overlay_painter.hpp>
#include <io/files/report_json.hpp>

namespace penumbra::io {

/// Takes the results of a run. Members throw InputError if writing fails. Unfinished results are
/// removed with this.
class RunOutput {
 public:
  RunOutput() = default;
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;
  virtual ~RunOutput() = default;

  /// Called once, before frames.
  virtual void begin(const ReportHead& head) = 0;
  virtual void save(const FrameReport& report, const Frame& frame, const ShownTargets& targets) = 0;
  virtual void finish(const Statistics& statistics, std::span<const std::string> notes) = 0;

  /// Returns what could not be written, a line each.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

}  // namespace penumbra::io
