// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <io/assembly/arrivals.hpp>
#include <io/assembly/assembled_frame.hpp>
#include <io/assembly/robot_input.hpp>

namespace penumbra::io {

/// The messages of one sensor: keeps its images or clouds until their poses, and what comes with
/// them, are known. Part of FrameAssembler; uses no threads and no clock. There are two policies.
/// Lossless, for bags: each message becomes a frame of the one setup, and one without a pose says
/// why. Newest, for live topics: the setup follows what is received, and the newest frame is given.
class SensorInput {
 public:
  SensorInput(const SensorInput&) = delete;
  SensorInput& operator=(const SensorInput&) = delete;
  virtual ~SensorInput() = default;

  template <typename M>
  void take_targets(const std::string& topic, const M& message) {
    if (setup_)
      setup_->targets.add(topic, message);
    else
      ++counts_.early_targets;
  }

  /// Updates the setup. Call this when the robot may have changed.
  void refresh();
  /// Gives out what waits: no further message will come.
  void finish();

  /// See FrameAssembler.
  bool next(std::int64_t now, bool with_color, AssembledFrame& next);
  void done(bool is_judged, std::size_t unjudged_targets);
  [[nodiscard]] std::optional<std::int64_t> wake_at() const {
    return setup_ ? setup_->queue.wake_at() : std::nullopt;
  }

  [[nodiscard]] ImageCounts counts() const;
  /// Returns the current setup, or null if setup_fault() is set or robot or sensor are not known.
  [[nodiscard]] const SensorSetup* setup() const { return setup_.get(); }
  [[nodiscard]] const std::string& setup_fault() const { return setup_fault_; }
  [[nodiscard]] const Arrivals& arrivals() const { return arrivals_; }  ///< of images or clouds

 protected:
  /// `name`: of what becomes a frame. `robot` must outlive this.
  SensorInput(const RobotInput& robot, std::string name, PoseSource poses, bool is_lossless)
      : robot_(robot), name_(std::move(name)), poses_(poses), is_lossless_(is_lossless) {}

  /// Returns the setup of what is known now; null: that is not enough. Throws InputError.
  virtual std::shared_ptr<SensorSetup> find_setup() = 0;
  /// Returns whether what comes with a frame is there. `over`: it is awaited no longer. Targets of
  /// bags may always come.
  [[nodiscard]] virtual Companions check(const Frame& /*frame*/, bool over) {
    return awaits_targets_ && !over ? Companions::awaited : Companions::complete;
  }
  /// Adds what comes with the frame, whose setup is known.
  virtual void complete(AssembledFrame& frame) = 0;

  [[nodiscard]] bool is_lossless() const { return is_lossless_; }
  /// `options`: CameraInputOptions or CloudInputOptions.
  template <typename Options>
  std::shared_ptr<SensorSetup> make_setup(const Options& options, SensorSetup::Sensor sensor,
                                          CameraMount mount, std::string frame,
                                          double companion_wait) {
    awaits_targets_ = is_lossless() && options.has_targets;
    const FrameQueueOptions queue{
        .policy = is_lossless() ? DropPolicy::every : DropPolicy::newest,
        .time_offset = options.time_offset,
        .max_wait = options.max_wait,
        .companion_wait = awaits_targets_ ? topic_target_history : companion_wait,
        .max_frames = options.max_frames,
        .poses = {.source = options.poses,
                  .frame_prefix = options.mount.frame_prefix,
                  .camera_parent = mount.parent,
                  .camera_frame = mount.frame}};
    return std::make_shared<SensorSetup>(
        robot_.posed(), std::move(sensor), std::move(mount), std::move(frame), queue,
        options.hidden_targets,
        [this](std::shared_ptr<Frame> of, DropReason reason) { drop(std::move(of), reason); },
        [this](const Frame& of, bool over) { return check(of, over); });
  }
  /// Counts a message, and returns its frame.
  std::shared_ptr<AssembledFrame> begin(std::int64_t now);
  /// Adds a frame to those that wait for their pose.
  void push(std::shared_ptr<AssembledFrame> frame, std::int64_t now);
  /// Gives out a frame of a bag that does not wait for its pose.
  void keep_without_pose(std::shared_ptr<Frame> frame, const std::string& why);

  const RobotInput& robot_;
  std::shared_ptr<SensorSetup> setup_;
  std::string frame_;               // of the last message, TF
  std::uint64_t camera_infos_ = 0;  // that changed the camera
  std::size_t without_info_ = 0;    // consecutive images without camera_info
  bool with_color_ = false;         // of the last call of next()
  bool awaits_targets_ = false;
  ImageCounts counts_;  // its targets are of previous setups

 private:
  /// The inputs of a setup.
  struct Basis {
    const PosedRobot* robot = nullptr;
    std::uint64_t frames = 0, cameras = 0;
    std::string frame;
    bool operator==(const Basis&) const = default;
  };

  void drop(std::shared_ptr<Frame> frame, DropReason reason);

  std::string name_;
  PoseSource poses_;
  bool is_lossless_;
  Basis basis_;  // of the setup, or of the last attempt to make one
  std::string setup_fault_;
  std::deque<std::shared_ptr<Frame>> without_pose_;  // not in the queue
  Arrivals arrivals_;
};

}  // namespace penumbra::io
