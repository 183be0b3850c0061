// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/live/diagnostic_changes.hpp>
#include <io/live/live_runner.hpp>

namespace penumbra::io {
namespace {

/// The shortest time between overlays, in nanoseconds. Drawing one takes longer than all other
/// steps, and people look at them, so not every frame needs one.
constexpr std::int64_t overlay_period = 200'000'000;

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
                       std::chrono::milliseconds robot_retry)
    : inbox_(options), config_(config), maker_(std::move(maker)), robot_retry_(robot_retry) {
  for (ResultSink* sink : sinks) {
    SensorThread& sensor = sensors_.emplace_back();
    sensor.sink = sink;
    if (sensors_.size() <= inbox_.camera_count())
      sensor.calibration = std::make_unique<RunningCalibration>();
  }
}

void LiveRunner::start() {
  background_ = std::thread([this] { work_in_background(); });
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    sensors_[i].thread = std::thread([this, i] { work(i); });
}

void LiveRunner::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  requested_.notify_all();
  if (background_.joinable()) background_.join();
  for (SensorThread& sensor : sensors_)
    if (sensor.thread.joinable()) sensor.thread.join();
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

CalibrationProgress LiveRunner::calibration_progress(std::size_t camera) {
  CalibrationProgress of = calibration(camera).progress();
  if (!of.is_ready()) return of;
  const std::lock_guard lock(mutex_);
  const SensorSetup* const setup = inbox_.camera(camera).setup();
  if (setup == nullptr || !setup->mount.frame.empty()) return of;  // its pose is TF's
  TransformAnswer tf;
  setup->posed->history.transforms().at(
      0, inbox_.camera(camera).options().mount.frame_prefix + of.camera_parent, setup->frame, tf);
  if (tf.status == TransformStatus::ok)
    of.message += "; TF's pose is " + distance_text(*of.found, tf.T_target_source);
  return of;
}

std::optional<TransformMessage> LiveRunner::calibrated_transform(std::size_t camera) {
  const CalibrationProgress of = calibration(camera).progress();
  if (!of.is_ready()) return std::nullopt;
  return with_inbox([&](const LiveInbox& inbox) -> std::optional<TransformMessage> {
    const CameraInput& input = inbox.camera(camera);
    if (input.setup() == nullptr) return std::nullopt;
    const PosedRobot& posed = *input.setup()->posed;
    return transform_of_mount(posed.robot, posed.history.transforms(), inbox.robot().frames(),
                              input.options().mount,
                              {.frame = input.setup()->frame,
                               .parent = of.camera_parent,
                               .T_parent_camera = of.found->T_parent_camera,
                               .source = {}});
  });
}

std::string LiveRunner::apply_calibration(std::size_t camera) {
  const CalibrationProgress of = calibration(camera).progress();
  if (!of.is_ready())
    return "there is no pose to apply: " +
           (of.message.empty() ? "no calibration was begun" : of.message);
  calibration(camera).end("the pose that was found is in use");
  {
    const std::lock_guard lock(mutex_);
    inbox_.mount(camera, of.camera_parent, of.found->T_parent_camera, "its calibration");
  }
  changed_.notify_all();
  return {};
}

void LiveRunner::add_calibrations(DiagnosticArrayMessage& message) {
  for (std::size_t i = 0; i < sensors_.size() && sensors_[i].calibration; ++i) {
    const CalibrationProgress of = calibration_progress(i);
    if (of.message.empty()) continue;
    DiagnosticStatusMessage& status = message.status[1 + i];  // the first is the robot's
    status.values.push_back({calibration_poses_key, std::to_string(of.poses)});
    status.values.push_back({calibration_key, of.message});
  }
}

void LiveRunner::configure(const PipelineConfig& config) {
  const std::lock_guard lock(mutex_);
  config_ = config;
  for (std::size_t i = 0; i < inbox_.camera_count(); ++i) sensors_[i].has_config = false;
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
  inbox_.warn(next.sensor, next.setup, std::move(lines));
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

void LiveRunner::work(std::size_t sensor) {
  SensorThread& self = sensors_[sensor];
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
      if (!inbox_.next(sensor, steady_now(), with_color, job)) {
        wait(inbox_.wake_at(sensor), lock);
        continue;
      }
      if (with_overlay) self.next_overlay = steady_now() + overlay_period;
      if (!std::exchange(self.has_config, true))
        self.worker = std::make_unique<LiveWorker>(inbox_.options(), sensor, config_, &mutex_,
                                                   self.calibration.get());
      const double points_rate = inbox_.options().points_rate;
      lock.unlock();
      const std::int64_t begin = steady_now();
      const bool with_points = begin >= self.next_points;
      if (with_points && points_rate > 0) {
        const auto period = static_cast<std::int64_t>(1e9 / points_rate);
        const bool is_late = begin > self.next_points + period;
        self.next_points = (is_late ? begin : self.next_points) + period;
      }
      std::vector<Result> skipped;  // it is not their time
      if (!with_overlay) skipped.push_back(Result::overlay);
      if (!with_points) skipped.push_back(Result::points);
      LiveOutcome outcome = self.worker->judge(job, *self.sink, self.watcher, skipped);
      if (fusion_ != nullptr && outcome.is_published && job.setup->cameras() != nullptr)
        fusion_->add(sensor, outcome.views, job.setup->posed->robot.links().front());
      const std::int64_t now = steady_now(), system = system_now();
      job.image = {};
      job.depth = {};
      job.color_image.reset();
      job.scan.reset();
      lock.lock();
      if (outcome.find_warnings) {
        pending_warnings_.push_back({sensor, job.setup, std::exchange(outcome.find_warnings, {})});
        requested_.notify_all();
      }
      inbox_.done(sensor, outcome, now, system);
    }
  } catch (...) {
    fail(lock);
  }
}

}  // namespace penumbra::io
