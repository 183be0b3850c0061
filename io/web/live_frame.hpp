// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <io/live/live_job.hpp>
#include <io/ros/messages.hpp>
#include <io/ros_frames/color_images.hpp>
#include <io/ros_frames/depth_input.hpp>
#include <io/web/packet.hpp>

namespace penumbra::io {

/// What is needed of a camera to show its frames; another one for each setup. For several threads.
class LiveScene {
 public:
  LiveScene(const LiveSetup& setup, std::uint64_t scene_version)
      : version(scene_version),
        cameras(setup.cameras),
        cloud(setup.cameras.judged),
        depth_(setup.cameras.judged, setup.cameras.depth) {}

  /// Depth in metres as it was judged; nothing where it cannot be read, or brought to the judged
  /// camera.
  [[nodiscard]] std::optional<PartBytes> depth(const LiveJob& job);

  const std::uint64_t version;
  const JudgedCameras cameras;
  const CloudMaker cloud;

 private:
  std::mutex mutex_;
  DepthInput depth_;
};

/// What `penumbra live` publishes of an image.
struct LiveResults {
  std::optional<TargetsMessage> targets;
  std::optional<KeptImage> labels, virtual_depth, overlay;
};

/// A judged image of live topics. Its parts are decoded when they are asked for, once.
class LiveFrame final : public PacketFrame {
 public:
  /// `results` with targets and labels; `number`: counted by who makes frames.
  LiveFrame(std::shared_ptr<LiveScene> scene, LiveJob job, LiveResults results,
            std::uint64_t number);

  [[nodiscard]] std::string report() const override;
  [[nodiscard]] std::string poses() const override;
  [[nodiscard]] std::optional<PartBytes> part(Part part) const override;
  [[nodiscard]] std::shared_ptr<const Image<Rgb8>> color_pixels() const override;

  [[nodiscard]] const Robot& robot() const { return job_.setup->posed->robot; }
  [[nodiscard]] const LiveScene& scene() const { return *scene_; }
  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] std::int64_t stamp() const { return job_.pose.stamp; }

 private:
  [[nodiscard]] std::optional<PartBytes> decode(Part part) const;
  [[nodiscard]] std::optional<PartBytes> color() const;

  std::shared_ptr<LiveScene> scene_;
  LiveJob job_;
  LiveResults results_;
  std::uint64_t number_;
  mutable std::mutex mutex_;
  mutable std::array<std::optional<std::optional<PartBytes>>, part_count> decoded_;
  mutable std::shared_ptr<const Image<Rgb8>> pixels_;  // once color is decoded
};

/// The frame's object of report.json, by what was published: what nobody publishes is null. So are
/// the counts of pixels where `labels` is empty: they could not be read.
[[nodiscard]] std::string live_report(const TargetsMessage& message, std::uint64_t number,
                                      std::optional<std::int64_t> joint_age,
                                      const std::string& labels);

/// Whether the robot's pose was known in a frame of this status.
[[nodiscard]] bool has_live_pose(const std::string& status);

}  // namespace penumbra::io
