// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <python/arrays.hpp>
#include <python/judgement.hpp>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/without_robot.hpp>

namespace penumbra::python {

/// The camera whose images a pipeline's reports are of.
[[nodiscard]] inline Camera judged_camera(const Camera& camera, const Pipeline& pipeline) {
  if (pipeline.rectification() == nullptr) return camera;
  return {.intrinsics = pipeline.intrinsics(),
          .distortion = {},
          .range = camera.range,
          .frame_id = camera.frame_id};
}

/// A pipeline, and whose images lie in it.
struct PipelineState {
  PipelineState(const Robot& robot, const Camera& camera, const PipelineConfig& config)
      : pipeline(robot, camera, config), cloud_maker(judged_camera(camera, pipeline)) {}
  Pipeline pipeline;
  CloudMaker cloud_maker;
  std::uint64_t calls = 0;
  Lease lease;
  OneThread thread;
};

/// A report whose numbers are its own; images and poses lie in the pipeline.
class Report {
 public:
  /// `depth`: the frame's image, which the report may refer to.
  Report(std::shared_ptr<PipelineState> state, const FrameReport& report, py::object depth);

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

  /// Copies of the depth and its points without the robot. Throw ValueError as image() does.
  [[nodiscard]] DepthImage filtered_depth() const;
  [[nodiscard]] PointCloud points(const std::optional<std::string>& frame) const;

 private:
  void check_is_last() const;
  [[nodiscard]] py::object base() const;

  std::shared_ptr<PipelineState> state_;
  std::uint64_t call_;
  FrameReport report_;  // without spans of poses and targets
  py::object depth_;
  std::vector<OwnedTargetReport> targets_;
  Poses T_root_link_;
  std::vector<std::string> near_links_;
};

}  // namespace penumbra::python
