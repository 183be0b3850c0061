// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <python/arrays.hpp>
#include <python/judgement.hpp>

#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::python {

/// A pipeline, and whose images lie in it.
struct PipelineState {
  PipelineState(const Robot& robot, const Camera& camera, const PipelineConfig& config)
      : pipeline(robot, camera, config) {}
  Pipeline pipeline;
  std::uint64_t calls = 0;
  Lease lease;
  OneThread thread;
};

/// A report whose numbers are its own; images and poses lie in the pipeline.
class Report {
 public:
  Report(std::shared_ptr<PipelineState> state, const FrameReport& report);

  [[nodiscard]] const FrameReport& numbers() const { return report_; }
  [[nodiscard]] const std::vector<OwnedTargetReport>& targets() const { return targets_; }
  [[nodiscard]] const Poses& T_root_link() const { return T_root_link_; }
  [[nodiscard]] std::vector<std::string> near_links() const { return near_links_; }
  [[nodiscard]] const PipelineState& state() const { return *state_; }

  /// Of an image of the report; nothing where the report has none. Throws ValueError once the
  /// pipeline has judged another frame.
  template <typename T>
  [[nodiscard]] std::optional<ImageResult<T>> image(ImageView<const T> view) const {
    if (view.empty()) return std::nullopt;
    return array_of(view, base());
  }

 private:
  [[nodiscard]] py::object base() const;

  std::shared_ptr<PipelineState> state_;
  std::uint64_t call_;
  FrameReport report_;  // without spans
  std::vector<OwnedTargetReport> targets_;
  Poses T_root_link_;
  std::vector<std::string> near_links_;
};

}  // namespace penumbra::python
