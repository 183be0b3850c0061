// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

#include <io/assembly/assembled_frame.hpp>
#include <io/web/packet.hpp>
#include <io/web/pose_outlines.hpp>
#include <io/web/scene.hpp>

namespace penumbra::io {

/// A set of parts, by Part.
using PartSet = std::bitset<part_count>;

/// The robot and the camera of a setup, in the form that pages show. Thread-safe.
class LiveScene {
 public:
  LiveScene(const SensorSetup& setup, std::uint64_t number) : version(number), posed_(setup.posed) {
    if (setup.cameras() == nullptr) return;
    camera.emplace(setup.cameras()->judged);
    outlines_.emplace(posed_->robot, *camera);
  }

  [[nodiscard]] const Robot& robot() const { return posed_->robot; }
  /// Returns the robot's triangles, collected at the first call.
  [[nodiscard]] const Scene& drawn() const;
  /// Returns the camera's rays, computed at the first call; null without a camera.
  [[nodiscard]] const PacketCloud* cloud() const;
  /// See PoseOutlines; nothing without a camera.
  [[nodiscard]] std::optional<PartBytes> outlines(const RobotPose& pose,
                                                  const CalibrationProgress& of) const {
    return outlines_ ? outlines_->draw(pose, of) : std::nullopt;
  }

  const std::uint64_t version;
  std::optional<Camera> camera;  ///< nothing: of a sensor that measures points

 private:
  std::shared_ptr<const PosedRobot> posed_;
  mutable std::once_flag drawn_once_, cloud_once_;
  mutable std::optional<Scene> drawn_;
  mutable std::optional<PacketCloud> cloud_;
  mutable std::optional<PoseOutlines> outlines_;
};

/// The parts of a judged frame, or of a labelled scan, that pages need. Colour is decoded and depth
/// converted to metres on demand.
class LiveFrame {
 public:
  /// Copies the parts in `kept`. `calibration`: of the camera.
  LiveFrame(std::shared_ptr<const LiveScene> scene, const AssembledFrame& job,
            const FrameReport& report, const PartSet& kept, CalibrationProgress calibration);

  /// Returns the frame for packets. This must outlive it.
  [[nodiscard]] PacketFrame packet_frame() const;

  /// Returns whether these parts were kept.
  [[nodiscard]] bool has_kept(const PartSet& parts) const { return (parts & ~kept_).none(); }
  [[nodiscard]] const LiveScene& scene() const { return *scene_; }
  [[nodiscard]] std::uint64_t index() const { return index_; }  ///< index in the report
  [[nodiscard]] std::int64_t stamp() const { return stamp_; }
  [[nodiscard]] const CalibrationProgress& calibration() const { return calibration_; }

 private:
  [[nodiscard]] std::optional<PartBytes> part(Part part) const;
  void decode_color() const;
  void convert_depth() const;

  const std::shared_ptr<const LiveScene> scene_;
  const PartSet kept_;
  const std::uint64_t index_;
  const std::int64_t stamp_;
  const std::string report_, poses_;
  std::optional<PartBytes> labels_, links_, virtual_depth_, scan_;
  std::variant<Image<std::uint16_t>, Image<float>> raw_depth_;
  std::optional<KeptImage> raw_color_;
  const RobotPose pose_;
  const CalibrationProgress calibration_;

  mutable std::once_flag color_once_, depth_once_;
  mutable std::optional<PartBytes> color_, depth_;
};

}  // namespace penumbra::io
