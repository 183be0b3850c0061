// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <penumbra/cloud/cloud_pipeline.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/poses/pose_lookup.hpp>

#include <io/assembly/camera_mount.hpp>
#include <io/assembly/message_handler.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/cloud/cloud_points.hpp>

namespace penumbra::io {

using CloudMessage = std::variant<PointCloud2Message, LaserScanMessage, LivoxMessage>;

/// A message of points. Its stamp as a frame is that of its last point, whose pose is awaited. A
/// source_message says why it cannot be labelled.
struct ReceivedCloud : Frame {
  CloudMessage message;
  MessageHeader header;
  CloudPoints points;
  std::vector<std::byte> payload;  ///< that the message refers to
  std::int64_t arrived = 0;        ///< on the caller's clock
};

struct CloudInputOptions {
  std::string topic = {};
  CloudRule rule = {};
  int threads = 1;
  bool use_times = true;          ///< see read_points
  bool has_rays = true;           ///< false: merged clouds, see Scan::origin
  std::string sensor_frame = {};  ///< where rays start, in TF; empty: the clouds' own frame
  MountOptions mount = {};
  std::optional<CameraMount> known_mount = {};  ///< in place of what TF says, as from a bag
  PoseSource poses = PoseSource::joints;
  double time_offset = 0.0;  ///< see FrameQueueOptions
  double max_wait = 0.2;     ///< likewise
  std::size_t max_frames = 8;
  DropPolicy policy = DropPolicy::newest;
};

/// The clouds of one sensor: keeps them until the poses of the whole scan are known, and labels
/// them. Part of FrameAssembler.
class CloudInput {
 public:
  /// `robot` must outlive this. Throws InputError for a known mount with which no setup can be
  /// made.
  CloudInput(CloudInputOptions options, const RobotInput& robot);

  /// Takes a decoded message and the bytes that it refers to.
  template <typename M>
  void take(M message, const SerializedMessage& bytes, std::int64_t now);
  /// Updates the setup. Call this when the robot may have changed.
  void refresh();
  /// Gives out what waits: no further message will come.
  void finish();

  /// Returns the next cloud whose poses are known or no longer awaited; null if there is none.
  [[nodiscard]] std::shared_ptr<ReceivedCloud> next(std::int64_t now);
  /// Labels a cloud that next() returned last; the report is valid until the next call.
  [[nodiscard]] const CloudReport& label(const ReceivedCloud& cloud);

 private:
  struct Setup {
    std::shared_ptr<PosedRobot> posed;
    CameraMount mount;
    FrameQueue queue;
    PoseLookup lookup;
    CloudPipeline pipeline;
  };

  void push(std::shared_ptr<ReceivedCloud> cloud, std::int64_t now);
  [[nodiscard]] std::unique_ptr<Setup> make_setup(const CameraMount& mount);
  void drop(std::shared_ptr<Frame> cloud, const std::string& why);

  CloudInputOptions options_;
  const RobotInput& robot_;
  std::string frame_;  // of the clouds
  std::unique_ptr<Setup> setup_;
  std::string setup_fault_;
  std::deque<std::shared_ptr<ReceivedCloud>> lost_;  // that do not wait for poses
};

}  // namespace penumbra::io
