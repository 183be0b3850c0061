// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <python/arrays.hpp>

#include <penumbra/pipeline/link_points.hpp>
#include <penumbra/pipeline/without_robot.hpp>
#include <penumbra/session/session.hpp>

namespace penumbra::python {

/// None, or a mask.
using BoolImage = Shown<"Optional[Annotated[NDArray[bool_], '(H, W)']]">;

/// A session, and what its reports need.
struct SessionState {
  SessionState(const Robot& robot, const Camera& camera, const PipelineConfig& config)
      : session(robot, camera, config),
        depth_size(camera.intrinsics),
        report_camera(session.pipeline().report_camera()),
        cloud_maker(*report_camera) {}
  SessionState(const Robot& robot, const CloudConfig& config) : session(robot, config) {}

  Session session;
  std::optional<Intrinsics> depth_size;   ///< of depth images as they come; null: of scans
  std::optional<Camera> report_camera;    ///< likewise
  std::optional<CloudMaker> cloud_maker;  ///< likewise
  std::optional<PointJudge> point_judge;  ///< once points are judged
  std::uint64_t calls = 0;
  OneThread thread;
};

/// A report whose numbers are its own. Images lie in the pipeline until the next frame.
class Report {
 public:
  /// `depth`: the owner of the frame's image, which the report may refer to.
  Report(std::shared_ptr<SessionState> state, const FrameReport& report,
         std::shared_ptr<const void> depth);

  FrameReport numbers;  ///< without spans of poses, names and targets
  std::vector<TargetReport> targets;
  Poses T_root_link;
  std::vector<std::string> links, missing_links, attached, near_links;

  /// Images. All throw ValueError once the pipeline has judged another frame, if they were not
  /// read before.
  [[nodiscard]] ImageResult<std::uint8_t> labels() const;
  [[nodiscard]] std::optional<ImageResult<float>> virtual_depth() const;
  [[nodiscard]] std::optional<ImageResult<std::uint16_t>> link_image() const;
  [[nodiscard]] BoolImage robot_mask() const;
  [[nodiscard]] std::optional<py::dict> coco_annotation() const;
  /// Raises IndexError outside of the image.
  [[nodiscard]] Label label(int u, int v) const;
  [[nodiscard]] DepthImage depth_without_robot() const;
  [[nodiscard]] PointCloud points(const std::optional<std::string>& frame) const;
  [[nodiscard]] std::vector<PointView> point_views(const std::string& link,
                                                   const Points& points) const;

 private:
  void check_is_last() const;
  /// The numbers with the poses and names of links.
  [[nodiscard]] FrameReport with_names() const;
  /// Nothing if the report has none.
  template <typename T>
  [[nodiscard]] std::optional<ImageResult<T>> read(const ReadImage<T>& image,
                                                   ImageView<const T> view) const {
    if (view.empty()) return std::nullopt;
    return image.read([&] { return check_is_last(), view; });
  }

  std::shared_ptr<SessionState> state_;
  std::uint64_t call_;
  std::shared_ptr<const void> depth_;
  ReadImage<std::uint8_t> labels_;
  ReadImage<float> virtual_depth_;
  ReadImage<std::uint16_t> link_image_;
  mutable BoolImage robot_mask_;
};

}  // namespace penumbra::python
