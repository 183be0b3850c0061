// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/statistics.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/files/report_json.hpp>

namespace penumbra::app {

/// Where results of `run` go. Members throw InputError where writing fails; what is not finished
/// is taken away with this.
class RunOutput {
 public:
  RunOutput() = default;
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;
  virtual ~RunOutput() = default;

  /// To be called once, before frames.
  virtual void begin(const io::ReportHead& head) = 0;
  virtual void save(const FrameReport& report, const io::FrameData& frame,
                    const io::ShownTargets& targets) = 0;
  virtual void finish(const Statistics& statistics, std::span<const std::string> notes) = 0;

  /// What could not be written, a line each.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
  /// "report: FILE", for people.
  [[nodiscard]] virtual std::string where() const = 0;
};

}  // namespace penumbra::app
