// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/live/live_inbox.hpp>
#include <io/live/live_worker.hpp>

namespace penumbra::io {

/// Judges what comes on the graph: one thread for each camera and one that makes robots, beside the
/// one that receives.
///
/// One mutex guards the inbox: robot, poses, images that wait, counts. It is held while a message
/// is taken and while a job is picked, never while one is worked on or a robot's meshes are read,
/// so that nothing waits for rendering, for files or for the network. A sink is written to by its
/// camera's thread alone, without the mutex.
class LiveRunner {
 public:
  using RobotMaker = std::function<MadeRobot(const RobotOrder&)>;

  static constexpr std::chrono::seconds default_robot_retry{5};

  /// `sinks`: one for each camera, which must outlive this. `robot_retry`: how long after a robot
  /// could not be made that is tried again. Throws as LiveInbox.
  LiveRunner(const LiveOptions& options, const PipelineConfig& config,
             const std::vector<ResultSink*>& sinks, RobotMaker maker = make_robot,
             std::chrono::milliseconds robot_retry = default_robot_retry);
  ~LiveRunner() { stop(); }
  LiveRunner(const LiveRunner&) = delete;
  LiveRunner& operator=(const LiveRunner&) = delete;

  /// Hands the camera's frames to `watcher`, which must outlive the threads. Call it before
  /// start().
  void watch(std::size_t camera, FrameWatcher& watcher) { cameras_[camera].watcher = &watcher; }

  void start();
  /// Ends the threads once they have done what they are at: reading a robot's meshes, too. What
  /// waits is left.
  void stop();

  /// From any thread.
  void receive(std::size_t topic, const LiveMessage& message);

  /// Reads the inbox while nothing changes.
  template <typename F>
  auto with_inbox(const F& look) {
    const std::lock_guard lock(mutex_);
    return look(inbox_);
  }

  /// Nanoseconds of the clock that the inbox is told of, and since 1970.
  [[nodiscard]] static std::int64_t steady_now();
  [[nodiscard]] static std::int64_t system_now();

  /// Whether a thread ended by an exception, which is fault().
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  [[nodiscard]] std::exception_ptr fault();

 private:
  struct CameraThread {
    ResultSink* sink = nullptr;
    FrameWatcher* watcher = nullptr;
    std::unique_ptr<LiveWorker> worker;
    std::int64_t next_overlay = 0;  // not before; the thread's own
    std::thread thread;
  };
  void work(std::size_t camera);
  void make_robots();
  void fail(std::unique_lock<std::mutex>& lock);
  void wait(std::size_t camera, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable changed_, ordered_;
  LiveInbox inbox_;           // guarded by mutex_
  bool stopping_ = false;     // likewise
  std::exception_ptr fault_;  // likewise
  std::atomic<bool> has_failed_ = false;
  std::vector<CameraThread> cameras_;
  RobotMaker maker_;
  std::chrono::milliseconds robot_retry_;
  std::thread making_;
};

}  // namespace penumbra::io
