// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>

#include <io/files/report_json.hpp>

namespace penumbra::io {

/// Takes the judged frames of a run. Members throw InputError if writing fails. Unfinished results
/// are removed with this.
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;

  /// Called once, before frames.
  virtual void begin(const ReportHead& /*head*/) {}
  virtual void take(const Frame& frame, const FrameReport& report) = 0;
  virtual void finish(const Statistics& /*statistics*/, std::span<const std::string> /*notes*/) {}

  /// Returns what could not be written, a line each.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

/// All that take the frames of a run, in order.
using Sinks = std::vector<Sink*>;

}  // namespace penumbra::io
