// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/live/live_fusion.hpp>
#include <io/live/live_inbox.hpp>
#include <io/live/live_worker.hpp>

namespace penumbra::io {

/// Judges the messages of the graph. One thread serves each sensor, one does what takes a second
/// (makes robots, diagnoses setups), and one receives.
///
/// One mutex guards the inbox: robot, poses, waiting frames and counts. It is held while a message
/// is received, while a job is picked and while a pose during a scan is looked up, and never while
/// a job is rendered or meshes are read. So no thread waits for rendering, files or the network.
/// Only a sensor's own thread writes to its sink, without the mutex.
class LiveRunner {
 public:
  using RobotMaker = std::function<MadeRobot(const RobotLoadRequest&)>;

  static constexpr std::chrono::seconds default_robot_retry{5};

  /// `sinks`: one for each sensor, the cameras' first. All must outlive this. `robot_retry`: the
  /// time after which a robot that could not be made is tried again.
  /// Throws like LiveInbox.
  LiveRunner(const LiveOptions& options, const PipelineConfig& config,
             const std::vector<ResultSink*>& sinks, RobotMaker maker = make_robot,
             std::chrono::milliseconds robot_retry = default_robot_retry);
  ~LiveRunner() { stop(); }
  LiveRunner(const LiveRunner&) = delete;
  LiveRunner& operator=(const LiveRunner&) = delete;

  /// Hands the sensor's frames to `watcher`, which must outlive the threads. Call it before
  /// start().
  void watch(std::size_t sensor, FrameWatcher& watcher) { sensors_[sensor].watcher = &watcher; }

  /// Hands the targets of all cameras to `fusion`, which must outlive the threads. Call it before
  /// start().
  void fuse(LiveFusion& fusion) { fusion_ = &fusion; }

  void start();
  /// Ends the threads after their current job, which may be reading a robot's meshes. Waiting
  /// images are not judged.
  void stop();

  /// Receives a message. Any thread may call this.
  void receive(std::size_t topic, const SerializedMessage& message);
  /// Receives a decoded image, as FrameAssembler does.
  void receive(std::size_t topic, const ImageMessage& image, std::shared_ptr<const void> owner);

  /// Returns the calibration of a camera, which waits until it is asked to begin.
  [[nodiscard]] RunningCalibration& calibration(std::size_t camera) {
    return *sensors_[camera].calibration;
  }
  /// Returns how far it is. If a pose of the user's replaces TF's, also says if TF contradicts.
  [[nodiscard]] CalibrationProgress calibration_progress(std::size_t camera);
  /// Returns the transform of TF that a camera's calibration gives; null: no pose was found.
  [[nodiscard]] std::optional<TransformMessage> calibrated_transform(std::size_t camera);
  /// Judges later images with the pose that a camera's calibration found, in place of TF's. Returns
  /// why not; empty: it does.
  [[nodiscard]] std::string apply_calibration(std::size_t camera);
  /// Adds the state of the cameras' calibrations to the statuses of LiveDiagnostics.
  void add_calibrations(DiagnosticArrayMessage& message);

  /// Judges later images by another configuration. Forgets verdicts and tracks.
  void configure(const PipelineConfig& config);
  /// Forgets poses, verdicts and tracks.
  void forget();

  /// Calls `read` with the inbox while it does not change.
  template <typename F>
  auto with_inbox(const F& read) {
    const std::lock_guard lock(mutex_);
    return read(inbox_);
  }

  /// Return nanoseconds of the inbox's clock, and since 1970.
  [[nodiscard]] static std::int64_t steady_now();
  [[nodiscard]] static std::int64_t system_now();

  /// Returns whether a thread ended by an exception, which fault() returns.
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  [[nodiscard]] std::exception_ptr fault();

 private:
  struct SensorThread {
    ResultSink* sink = nullptr;
    FrameWatcher* watcher = nullptr;
    std::unique_ptr<RunningCalibration> calibration;  // of a camera
    std::unique_ptr<LiveWorker> worker;
    bool has_config = false;  // whether the worker has config_; guarded by mutex_
    // Earliest times; used by this thread only.
    std::int64_t next_overlay = 0, next_points = 0;
    std::thread thread;
  };
  /// Warnings that the background thread has not found yet.
  struct PendingWarnings {
    std::size_t sensor;
    std::shared_ptr<const SensorSetup> setup;
    std::function<std::vector<std::string>()> find;
  };
  void work(std::size_t sensor);
  void work_in_background();
  void serve(const RobotLoadRequest& request, std::unique_lock<std::mutex>& lock);
  void find_warnings(std::unique_lock<std::mutex>& lock);
  void fail(std::unique_lock<std::mutex>& lock);
  void wait(const std::optional<std::int64_t>& wake_at, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable changed_, requested_;
  std::deque<PendingWarnings> pending_warnings_;  // guarded by mutex_
  LiveInbox inbox_;                               // guarded by mutex_
  PipelineConfig config_;                         // likewise
  bool stopping_ = false;                         // likewise
  std::exception_ptr fault_;                      // likewise
  std::atomic<bool> has_failed_ = false;
  std::vector<SensorThread> sensors_;
  LiveFusion* fusion_ = nullptr;
  RobotMaker maker_;
  std::chrono::milliseconds robot_retry_;
  std::thread background_;
};

}  // namespace penumbra::io
