// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
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
  std::string frame_prefix = {};  ///< PoseOptions::frame_prefix
  CameraMount mount = {};         ///< of the clouds' frame
  PoseSource poses = PoseSource::joints;
  double time_offset = 0.0;  ///< see FrameQueueOptions
  double max_wait = 0.5;     ///< likewise
  std::size_t max_frames = 32;
};

/// The clouds of one sensor of a bag: keeps them until the poses of the whole scan are known, and
/// labels them. Part of FrameAssembler. Gives out every cloud; one that cannot be labelled says so.
class CloudInput {
 public:
  /// Throws InputError as FrameQueue, PoseLookup and CloudPipeline.
  CloudInput(CloudInputOptions options, std::shared_ptr<PosedRobot> posed);

  /// Takes a decoded message and the bytes that it refers to.
  template <typename M>
  void take(M message, const SerializedMessage& bytes, std::int64_t now);
  /// Gives out what waits: no further message will come.
  void finish() { queue_.finish(); }

  /// Returns the next cloud whose poses are known or no longer awaited; null if there is none.
  [[nodiscard]] std::shared_ptr<ReceivedCloud> next(std::int64_t now);
  /// Labels a cloud that next() returned last; the report is valid until the next call.
  [[nodiscard]] const CloudReport& label(const ReceivedCloud& cloud);

 private:
  void push(std::shared_ptr<ReceivedCloud> cloud, std::int64_t now);
  void keep_lost(std::shared_ptr<Frame> cloud, const std::string& why);

  CloudInputOptions options_;
  std::shared_ptr<PosedRobot> posed_;
  std::string frame_;  // of the clouds
  FrameQueue queue_;
  PoseLookup lookup_;
  CloudPipeline pipeline_;
  std::deque<std::shared_ptr<ReceivedCloud>> lost_;  // that do not wait for poses
};

}  // namespace penumbra::io
