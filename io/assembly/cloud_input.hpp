// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <penumbra/poses/robot_pose.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/assembly/message_handler.hpp>
#include <io/assembly/sensor_input.hpp>
#include <io/cloud/cloud_points.hpp>

namespace penumbra::io {

struct CloudInputOptions {
  std::string topic = {};
  CloudRule rule = {};
  int threads = 1;
  bool use_times = true;          ///< see read_points
  bool has_rays = true;           ///< false: merged clouds, see Scan::origin
  std::string sensor_frame = {};  ///< where rays start, in TF; empty: the clouds' own frame
  MountOptions mount = {};
  PoseSource poses = PoseSource::joints;
  double time_offset = 0.0;    ///< see FrameQueueOptions
  double max_wait = 0.5;       ///< likewise
  std::size_t max_frames = 8;  ///< likewise
  CloudOutput output = {};     ///< what LiveRunner publishes
  bool has_targets = false;    ///< clouds of bags wait for targets that come later, others are kept
  HiddenTargets hidden_targets = HiddenTargets::not_handled;
  /// Set for bags: every cloud is given out; one that cannot be labelled says so
  /// (DropPolicy::every). Not set for live topics: the setup follows what is received, and the
  /// newest cloud is given (DropPolicy::newest).
  std::optional<CameraMount> known = {};
  std::string known_frame = {};  ///< of these clouds, without "/"

  /// Returns whether the clouds' own frame need not be their sensor's.
  [[nodiscard]] bool is_in_other_frame() const { return !has_rays || !sensor_frame.empty(); }
};

/// The clouds of one sensor.
class CloudInput final : public SensorInput {
 public:
  /// `robot` must outlive this. Throws InputError for options that FrameQueue refuses.
  CloudInput(CloudInputOptions options, const RobotInput& robot);

  /// Takes a decoded message and the bytes that it refers to. Returns why a live one cannot be
  /// used, one line, or nothing.
  template <typename M>
  std::string take(M message, const SerializedMessage& bytes, std::int64_t now);

  [[nodiscard]] const CloudInputOptions& options() const { return options_; }

 private:
  std::shared_ptr<SensorSetup> find_setup() override;
  void complete(AssembledFrame& frame) override;
  std::shared_ptr<SensorSetup> make_setup(CameraMount mount);

  CloudInputOptions options_;
};

}  // namespace penumbra::io
