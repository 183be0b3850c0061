// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/cloud_worker.hpp>
#include <io/live/live_runner.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

/// The shortest time between overlays, in nanoseconds. Drawing one takes longer than all other
/// steps, and people look at them, so not every frame needs one.
constexpr std::int64_t overlay_period = 200'000'000;

/// Forwards results, overlays and points only when it is their time.
class TimedResults final : public ResultSink {
 public:
  TimedResults(ResultSink& to, bool with_overlay, bool with_points)
      : to_(to), with_overlay_(with_overlay), with_points_(with_points) {}
  [[nodiscard]] bool wants(Result result) const override {
    if (result == Result::overlay && !with_overlay_) return false;
    if (result == Result::points && !with_points_) return false;
    return to_.wants(result);
  }
  void write(Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    to_.write(result, stamp, payload);
  }

 private:
  ResultSink& to_;
  bool with_overlay_, with_points_;
};

template <typename Clock>
std::int64_t nanoseconds_of() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

}  // namespace

std::int64_t LiveRunner::steady_now() { return nanoseconds_of<std::chrono::steady_clock>(); }
std::int64_t LiveRunner::system_now() { return nanoseconds_of<std::chrono::system_clock>(); }

LiveRunner::LiveRunner(const LiveOptions& options, const PipelineConfig& config,
                       const std::vector<ResultSink*>& sinks, RobotMaker maker,
                       std::chrono::milliseconds robot_retry,
                       const std::vector<CloudSink*>& cloud_sinks)
    : inbox_(options), config_(config), maker_(std::move(maker)), robot_retry_(robot_retry) {
  for (ResultSink* sink : sinks) cameras_.emplace_back().sink = sink;
  for (CloudSink* sink : cloud_sinks) clouds_.emplace_back().sink = sink;
}

void LiveRunner::start() {
  background_ = std::thread([this] { work_in_background(); });
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    cameras_[i].thread = std::thread([this, i] { work(i); });
  for (std::size_t i = 0; i < clouds_.size(); ++i)
    clouds_[i].thread = std::thread([this, i] { label(i); });
}

void LiveRunner::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  requested_.notify_all();
  if (background_.joinable()) background_.join();
  for (CameraThread& camera : cameras_)
    if (camera.thread.joinable()) camera.thread.join();
  for (CloudThread& cloud : clouds_)
    if (cloud.thread.joinable()) cloud.thread.join();
}

void LiveRunner::receive(std::size_t topic, const SerializedMessage& message) {
  bool has_load_request = false;
  {
    const std::lock_guard lock(mutex_);
    inbox_.receive(topic, message, steady_now());
    has_load_request = inbox_.robot().has_load_request();
  }
  if (has_load_request) requested_.notify_all();
  changed_.notify_all();
}

void LiveRunner::receive(std::size_t topic, const ImageMessage& image,
                         std::shared_ptr<const void> owner) {
  {
    const std::lock_guard lock(mutex_);
    inbox_.receive(topic, image, std::move(owner), steady_now());
  }
  changed_.notify_all();
}

void LiveRunner::configure(const PipelineConfig& config) {
  const std::lock_guard lock(mutex_);
  config_ = config;
  for (CameraThread& camera : cameras_) camera.has_config = false;
}

void LiveRunner::forget() {
  const std::lock_guard lock(mutex_);
  inbox_.forget();
}

void LiveRunner::work_in_background() {
  std::unique_lock lock(mutex_);
  try {
    while (!stopping_) {
      if (const auto request = inbox_.take_load_request())
        serve(*request, lock);
      else if (!pending_warnings_.empty())
        find_warnings(lock);
      else if (requested_.wait_for(lock, robot_retry_) == std::cv_status::timeout)
        inbox_.retry_robot();
    }
  } catch (...) {
    fail(lock);
  }
}

void LiveRunner::serve(const RobotLoadRequest& request, std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  MadeRobot made = maker_(request);
  lock.lock();
  inbox_.set_robot(std::move(made));
  changed_.notify_all();
}

void LiveRunner::find_warnings(std::unique_lock<std::mutex>& lock) {
  const PendingWarnings next = std::move(pending_warnings_.front());
  pending_warnings_.pop_front();
  lock.unlock();
  std::vector<std::string> lines = next.find();
  lock.lock();
  inbox_.warn(next.camera, next.setup, std::move(lines));
}

void LiveRunner::fail(std::unique_lock<std::mutex>& lock) {
  if (!lock.owns_lock()) lock.lock();
  fault_ = std::current_exception();
  has_failed_ = true;
}

std::exception_ptr LiveRunner::fault() {
  const std::lock_guard lock(mutex_);
  return fault_;
}

void LiveRunner::wait(const std::optional<std::int64_t>& wake_at,
                      std::unique_lock<std::mutex>& lock) {
  if (!wake_at) return changed_.wait(lock);
  const auto at_most = std::chrono::nanoseconds(std::max<std::int64_t>(*wake_at - steady_now(), 0));
  changed_.wait_for(lock, at_most);
}

void LiveRunner::work(std::size_t camera) {
  CameraThread& self = cameras_[camera];
  AssembledFrame job;
  std::unique_lock lock(mutex_);
  try {
    while (!stopping_) {
      lock.unlock();
      const bool with_overlay =
          steady_now() >= self.next_overlay && self.sink->wants(Result::overlay);
      const bool with_color = with_overlay || (self.watcher && self.watcher->wants_color());
      lock.lock();
      if (stopping_) break;
      if (!inbox_.next(camera, steady_now(), with_color, job)) {
        wait(inbox_.wake_at(camera), lock);
        continue;
      }
      if (with_overlay) self.next_overlay = steady_now() + overlay_period;
      if (!std::exchange(self.has_config, true))
        self.worker =
            std::make_unique<LiveWorker>(config_, inbox_.options().drift, inbox_.options().points);
      const double points_rate = inbox_.options().points_rate;
      lock.unlock();
      const std::int64_t begin = steady_now();
      const bool with_points = begin >= self.next_points;
      if (with_points && points_rate > 0) {
        const auto period = static_cast<std::int64_t>(1e9 / points_rate);
        const bool is_late = begin > self.next_points + period;
        self.next_points = (is_late ? begin : self.next_points) + period;
      }
      TimedResults sink(*self.sink, with_overlay, with_points);
      LiveOutcome outcome = self.worker->judge(job, sink, self.watcher);
      if (fusion_ != nullptr && outcome.is_published)
        fusion_->add(camera, outcome.views, job.setup->posed->robot.links().front());
      const std::int64_t now = steady_now(), system = system_now();
      job.image = {};
      job.color_image.reset();
      lock.lock();
      if (outcome.find_warnings) {
        pending_warnings_.push_back({camera, job.setup, std::exchange(outcome.find_warnings, {})});
        requested_.notify_all();
      }
      inbox_.done(camera, outcome, now, system);
    }
  } catch (...) {
    fail(lock);
  }
}

void LiveRunner::label(std::size_t number) {
  CloudThread& self = clouds_[number];
  std::unique_lock lock(mutex_);
  const CloudInputOptions options = inbox_.options().clouds[number];
  CloudWorker worker(options, &mutex_);
  try {
    while (!stopping_) {
      const auto cloud = inbox_.cloud(number).next(steady_now());
      if (!cloud) {
        wait(inbox_.cloud(number).wake_at(), lock);
        continue;
      }
      lock.unlock();
      if (cloud->is_again && !wants_targets(self)) {
        lock.lock();
        continue;
      }
      LiveOutcome outcome;
      outcome.stamp = cloud->header.stamp;
      outcome.arrived = cloud->arrived;
      const CloudReport* report = nullptr;
      try {
        report = &worker.label(*cloud);
        outcome.status = report->status;
        outcome.message = report->message;
        if (!cloud->is_again) publish(*cloud, *report, options.output, self);
        publish_targets(*cloud, *report, self);
        if (self.watcher != nullptr && !cloud->is_again) self.watcher->take_cloud(*cloud, *report);
        outcome.is_published = true;
      } catch (const InputError& error) {
        outcome.fault = error.what();
      }
      const std::int64_t now = steady_now(), system = system_now();
      lock.lock();
      if (!cloud->is_again)
        inbox_.done_cloud(number, outcome, report, cloud->points.time_note, now, system);
    }
  } catch (...) {
    fail(lock);
  }
}

void LiveRunner::publish(const ReceivedCloud& cloud, const CloudReport& report, CloudOutput how,
                         CloudThread& self) {
  const auto write = [&]<typename M>(const M& message) {
    for (const CloudResult result : {CloudResult::without_robot, CloudResult::labelled}) {
      how.labelled = result == CloudResult::labelled;
      if (how.labelled && !std::is_same_v<M, PointCloud2Message>) continue;
      if (!self.sink->wants(result, message_type<M>())) continue;
      encode(cloud_output(message, report, how, self.data), self.payload);
      self.sink->write(result, self.payload);
    }
  };
  std::visit(write, cloud.message);
}

bool LiveRunner::wants_targets(const CloudThread& self) {
  return self.sink->wants(CloudResult::targets, message_type<TargetsMessage>());
}

void LiveRunner::publish_targets(const ReceivedCloud& cloud, const CloudReport& report,
                                 CloudThread& self) {
  if (!wants_targets(self) || cloud.targets.empty()) return;  // known before the first one comes
  encode(targets_message(report, cloud.header.frame_id, report.links.front()), self.payload);
  self.sink->write(CloudResult::targets, self.payload);
}

}  // namespace penumbra::io
