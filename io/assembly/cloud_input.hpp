// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <penumbra/cloud/cloud_pipeline.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/poses/pose_lookup.hpp>

#include <io/assembly/arrivals.hpp>
#include <io/assembly/camera_mount.hpp>
#include <io/assembly/message_handler.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/cloud/cloud_points.hpp>
#include <io/ros/target_inbox.hpp>

namespace penumbra::io {

using CloudMessage = std::variant<PointCloud2Message, LaserScanMessage, LivoxMessage>;

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
  bool has_targets = false;    ///< keeps clouds for targets that come later
  HiddenTargets hidden_targets = HiddenTargets::not_handled;
  /// Set for bags: every cloud is given out; one that cannot be labelled says so
  /// (DropPolicy::every). Not set for live topics: the setup follows what is received, and the
  /// newest cloud is given (DropPolicy::newest).
  std::optional<CameraMount> known = {};

  /// Returns whether the clouds' own frame need not be their sensor's.
  [[nodiscard]] bool is_in_other_frame() const { return !has_rays || !sensor_frame.empty(); }
};

/// The robot and the mount that a sensor's clouds are labelled with, and the clouds that wait for
/// their poses. Another robot, frame or mount gives another setup. Constant members may be read at
/// any time; see FrameAssembler for the others.
struct CloudSetup {
  /// `frame`: of the clouds.
  CloudSetup(std::shared_ptr<PosedRobot> of, CameraMount where, const std::string& frame,
             const FrameQueueOptions& options, HiddenTargets hidden, FrameQueue::OnDrop on_drop)
      : posed(std::move(of)),
        mount(std::move(where)),
        poses(options.poses),
        queue(posed->robot, posed->history, options, std::move(on_drop)),
        targets(posed->robot, frame, options.poses.frame_prefix, hidden) {}

  const std::shared_ptr<PosedRobot> posed;
  const CameraMount mount;
  const PoseOptions poses;
  FrameQueue queue;
  TargetInbox targets;
};

/// A message of points. Its stamp as a frame is that of its last point, whose pose is awaited. Its
/// targets are those of its header's stamp. A source_message says why it cannot be labelled.
struct ReceivedCloud : Frame {
  std::shared_ptr<CloudSetup> setup;
  CloudMessage message;
  MessageHeader header;
  CloudPoints points;
  std::shared_ptr<const void> owner;  ///< of the bytes that the message refers to
  std::int64_t arrived = 0;           ///< on the caller's clock
  bool is_again = false;              ///< given out once more, for targets that came since
};

/// The clouds of one sensor: keeps them until the poses of the whole scan are known. Part of
/// FrameAssembler; uses no threads and no clock. CloudWorker labels what it gives out.
class CloudInput {
 public:
  /// `robot` must outlive this. Throws InputError for options that FrameQueue refuses.
  CloudInput(CloudInputOptions options, const RobotInput& robot);

  /// Takes a decoded message and the bytes that it refers to. Returns why a live one cannot be
  /// used, one line, or nothing.
  template <typename M>
  std::string take(M message, const SerializedMessage& bytes, std::int64_t now);

  template <typename M>
  void take_targets(const std::string& topic, const M& message) {
    if (setup_) setup_->targets.add(topic, message);
  }

  /// Updates the setup. Call this when the robot may have changed.
  void refresh();
  /// Gives out what waits: no further message will come.
  void finish();

  /// Returns the next cloud whose poses are known or no longer awaited, or an earlier one again
  /// with targets that came since; null if no cloud is ready.
  [[nodiscard]] std::shared_ptr<ReceivedCloud> next(std::int64_t now);
  /// Counts the outcome of a cloud. Call this once for each that is not given out again.
  void done(bool is_labelled);
  [[nodiscard]] std::optional<std::int64_t> wake_at() const {
    return setup_ ? setup_->queue.wake_at() : std::nullopt;
  }

  [[nodiscard]] const CloudInputOptions& options() const { return options_; }
  [[nodiscard]] ImageCounts counts() const;
  /// Returns the current setup, or null if setup_fault() is set or the robot is not known.
  [[nodiscard]] const CloudSetup* setup() const { return setup_.get(); }
  [[nodiscard]] const std::string& setup_fault() const { return setup_fault_; }
  [[nodiscard]] const Arrivals& arrivals() const { return arrivals_; }
  /// Returns the number of targets whose stamp no cloud has.
  [[nodiscard]] std::size_t late_targets() const { return late_targets_; }

 private:
  /// The inputs of a setup.
  struct Basis {
    const PosedRobot* robot = nullptr;
    std::uint64_t frames = 0;
    std::string frame;
    bool operator==(const Basis&) const = default;
  };

  void push(std::shared_ptr<ReceivedCloud> cloud, std::int64_t now);
  [[nodiscard]] std::optional<CameraMount> find_mount() const;
  [[nodiscard]] std::shared_ptr<CloudSetup> make_setup(CameraMount mount);
  void receive_targets();
  void give_targets(ReceivedCloud& cloud);
  [[nodiscard]] std::shared_ptr<ReceivedCloud> find_again();

  CloudInputOptions options_;
  const RobotInput& robot_;
  std::string frame_;  // of the clouds
  std::shared_ptr<CloudSetup> setup_;
  Basis basis_;  // of the setup, or of the last attempt to make one
  std::string setup_fault_;
  std::deque<std::shared_ptr<ReceivedCloud>> lost_;   // of bags: that do not wait for poses
  std::vector<Target> targets_;                       // that wait for their clouds
  std::deque<std::shared_ptr<ReceivedCloud>> given_;  // that wait for their targets
  std::size_t late_targets_ = 0;
  ImageCounts counts_;
  Arrivals arrivals_;
};

}  // namespace penumbra::io
