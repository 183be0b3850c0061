// SPDX-License-Identifier: Apache-2.0
// The values that the pipeline's stages pass on. Each is complete when it is made.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/reach-inl.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// An attached body at its place.
struct PlacedBody {
  std::size_t link;           ///< index into FrameReport::links
  std::string name, carrier;  ///< its own, and the name of the link that carries it
  std::shared_ptr<const PreparedMesh> mesh;
  Eigen::Isometry3d T_camera_body;
};

/// Poses of the robot and its camera at a frame's stamp, or the fault that makes them unknown.
struct PoseResult {
  std::optional<std::int64_t> stamp;                ///< nanoseconds
  FrameStatus status = FrameStatus::ok;             ///< all faults except those of the depth image
  std::string message;                              ///< empty if the status is ok
  std::vector<Eigen::Isometry3d> T_root_link = {};  ///< valid if known()
  std::vector<Eigen::Isometry3d> T_camera_link = {};  ///< valid if known()
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  std::vector<PlacedBody> attached = {};        ///< valid if known()
  std::vector<Reach> reaches = {};              ///< of links that are not drawn; valid if known()
  std::vector<std::string> missing_links = {};  ///< as in FrameReport
  std::vector<std::size_t> uncertain_links = {};
  std::string uncertain_reason = {};
  std::optional<double> kinematics_ms = {};

  [[nodiscard]] bool known() const { return has_pose(status); }
  [[nodiscard]] bool is_uncertain(std::size_t link) const {
    return std::find(uncertain_links.begin(), uncertain_links.end(), link) != uncertain_links.end();
  }
};

/// A frame with its labels. Without a pose every pixel is unknown.
struct LabelledFrame {
  const PoseResult* poses = nullptr;
  FrameStatus status = FrameStatus::ok;
  std::string_view message;       ///< empty if the status is ok
  bool nothing_measured = false;  ///< the depth image has no pixel within the sensor's range
  DepthView depth;                ///< the camera's image
  LabelledImages images = {};
  std::size_t uncovered = 0;  ///< PixelCounts::uncovered
  std::optional<double> render_ms = {}, classify_ms = {};

  [[nodiscard]] std::optional<std::int64_t> stamp() const { return poses->stamp; }
};

/// Returns the status that makes more of the frame unknown.
[[nodiscard]] FrameStatus worse(FrameStatus a, FrameStatus b);

/// Appends a part to a line of parts.
void add_part(std::string& line, std::string_view part);

/// Writes the wall time of its scope, milliseconds.
class StageTimer {
 public:
  explicit StageTimer(std::optional<double>& to) : to_(to) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer() { to_ = std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<double>& to_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace penumbra
