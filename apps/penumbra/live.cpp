// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/primitives.hpp>

#include <apps/penumbra/live_arguments.hpp>
#include <apps/penumbra/live_cameras.hpp>
#include <apps/penumbra/live_graph.hpp>
#include <apps/penumbra/live_pages.hpp>
#include <apps/penumbra/live_setup.hpp>
#include <apps/penumbra/receive_buffers.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/pose_file.hpp>
#include <io/live/diagnostic_changes.hpp>
#include <io/live/live_summary.hpp>
#include <io/ros/message_encoder.hpp>

namespace penumbra::app {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;
using Clock = std::chrono::steady_clock;

constexpr auto report_period = 1s;
constexpr auto longest_receive = 100ms;
constexpr auto discovery_step = 200ms;
constexpr const char* behind = "results not published: subscribers were behind";

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// `topic`: as it follows "/penumbra/".
bool is_published(const LiveArguments& arguments, std::string_view topic) {
  if (!arguments.publish) return true;
  for (const std::string& name : split(*arguments.publish, ','))
    if (topic.substr(0, topic.find('/')) == name) return true;
  return false;
}

std::string words_of(const std::exception_ptr& fault) {
  try {
    std::rethrow_exception(fault);
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Publishes statuses, shows them on the pages and prints new faults.
class Diagnostics {
 public:
  Diagnostics(io::Participant& graph, const io::NameResolver& names, LivePages& pages)
      : publication_(graph.advertise(names.resolve(diagnostics_topic),
                                     "diagnostic_msgs/msg/DiagnosticArray",
                                     {.reliable = true, .depth = 10})),
        source_(diagnostic_source(names)),
        pages_(pages) {}

  [[nodiscard]] const io::DiagnosticSource& source() const { return source_; }

  void publish(const io::DiagnosticArrayMessage& message) {
    io::encode(message, payload_);
    static_cast<void>(publication_->write(payload_));
    pages_.publish(message);
    for (const std::string& line : changes_.update(message)) print_error(line, "");
  }

  void tell_waiting(const std::string& why) {
    io::DiagnosticArrayMessage message{.header = {io::LiveRunner::system_now(), ""}, .status = {}};
    message.status.push_back({.level = io::DiagnosticStatusMessage::stale,
                              .name = source_.name + ": camera",
                              .message = why,
                              .hardware_id = source_.hardware_id,
                              .values = {}});
    publish(message);
  }

 private:
  std::unique_ptr<io::Publication> publication_;
  std::vector<std::byte> payload_;
  io::DiagnosticChanges changes_;
  io::DiagnosticSource source_;
  LivePages& pages_;
};

/// Waits for the graph's one camera. Returns nothing if it was stopped before. Throws InputError if
/// the time is over without a camera.
std::optional<io::CameraInputOptions> find_camera(const LiveArguments& arguments,
                                                  CameraSearch& search,
                                                  const io::CameraInputOptions& common,
                                                  Diagnostics& diagnostics, StopSignal& stop) {
  const Clock::time_point begin = Clock::now();
  Clock::time_point reported = begin;
  while (!stop.wait(discovery_step)) {
    if (const auto chosen = search.find()) return found_camera(*chosen, common);
    if (arguments.duration && Clock::now() - begin > to_duration(*arguments.duration))
      throw InputError("no camera was found: " + search.why());
    if (Clock::now() - reported < report_period) continue;
    reported = Clock::now();
    diagnostics.tell_waiting(search.why());
  }
  return std::nullopt;
}

/// Draws a small box with the chosen renderer: a device that cannot draw would fail every image.
/// Throws InputError if it cannot.
void check_draws(const io::SessionOptions& session) {
  const PreparedMesh mesh(make_box({0.1, 0.1, 0.1}));
  const Body box{"box", {&mesh, 1}};
  const Intrinsics small(32, 24, 30.0, 30.0, 15.5, 11.5);
  const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 1));
  try {
    static_cast<void>(make_depth_renderer(session.backend, small, {&box, 1}, session.renderer)
                          ->render({&pose, 1}));
  } catch (const DeviceError& fault) {
    throw InputError(fault.what());
  }
}

PipelineConfig config_of(const LiveArguments& arguments) {
  PipelineConfig config;
  const io::SessionOptions& session = arguments.session;
  config.backend = session.backend;
  config.renderer = session.renderer;
  config.rule = session.rule.applied_to(config.rule);
  if (!session.input.bag.target_topics.empty()) config.target_history = io::topic_target_history;
  return config;
}

/// A program on the graph: its cameras' results, what it receives, what it says of itself.
class Live {
 public:
  Live(const LiveArguments& arguments, const io::NameResolver& names, io::Participant& graph,
       const io::LiveOptions& options, LivePages& pages)
      : arguments_(arguments), pages_(pages) {
    std::vector<io::ResultSink*> sinks;
    for (const io::CameraInputOptions& camera : options.cameras) {
      cameras_.push_back(camera.name);
      results_.push_back(std::make_unique<GraphResults>(graph, [&](const io::ResultTopic& topic) {
        return is_published(arguments, topic.name) ? names.resolve(result_name(camera.name, topic))
                                                   : std::string();
      }));
      sinks.push_back(results_.back().get());
    }
    for (const io::CloudInputOptions& cloud : arguments.clouds) {
      auto topics = cloud_result_names(cloud.topic);
      for (std::string& topic : topics) topic = names.resolve(topic);
      clouds_.push_back(std::make_unique<GraphClouds>(graph, std::move(topics)));
      sinks.push_back(clouds_.back().get());
    }
    runner_ = std::make_unique<io::LiveRunner>(options, config_of(arguments), sinks);
    for (std::size_t i = 0; i < results_.size() && arguments.calibrate; ++i)
      runner_->calibration(i).begin(arguments.search);
    pages.watch(*runner_, options.cameras);
    if (options.cameras.size() > 1 && is_published(arguments, io::target_views_topic))
      fuse(options, names, graph);
    subscriptions_ = std::make_unique<LiveSubscriptions>(graph, *runner_, arguments.reliable);
  }

  /// Returns whether it was stopped before its time was over.
  bool run(io::Participant& graph, Diagnostics& diagnostics, StopSignal& stop) {
    runner_->start();
    std::atomic<bool> ends = false;
    std::thread receiving([&] {
      try {
        while (!ends) subscriptions_->receive(longest_receive);
      } catch (...) {
        fault_ = std::current_exception();
        ends = true;
      }
    });
    const bool stopped = report_until_end(diagnostics, stop, ends);
    ends = true;
    graph.wake();
    receiving.join();
    runner_->stop();
    print_calibrations();
    if (!fault_) fault_ = runner_->fault();
    return stopped;
  }

  /// Returns the fault that ended run(), or null.
  [[nodiscard]] const std::exception_ptr& fault() const { return fault_; }

  /// Returns the number of judged images and labelled clouds.
  [[nodiscard]] std::size_t judged() {
    return runner_->with_inbox([&](const io::LiveInbox& inbox) {
      std::size_t frames = 0;
      for (std::size_t i = 0; i < results_.size(); ++i) frames += inbox.camera(i).counts().judged;
      for (std::size_t i = results_.size(); i < inbox.sensor_count(); ++i)
        for (const auto& [status, count] : inbox.tally(i).statuses)
          frames += status == "ok" || status == "missing_link" ? count : 0;
      return frames;
    });
  }

  [[nodiscard]] std::string summary() {
    io::LiveRun run{.seconds = seconds(), .cpu_seconds = cpu_seconds() - cpu_at_start_};
    if (fault_) run.fault = words_of(fault_);
    for (const auto& results : results_) run.results.push_back(results->counts());
    for (const auto& clouds : clouds_) run.clouds_not_written.push_back(clouds->not_written());
    const auto links = subscriptions_->links();
    return runner_->with_inbox(
        [&](const io::LiveInbox& inbox) { return io::live_summary_json(inbox, links, run); });
  }

 private:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  bool report_until_end(Diagnostics& diagnostics, StopSignal& stop, const std::atomic<bool>& ends) {
    io::LiveDiagnostics words(io::LiveRunner::steady_now(), diagnostics.source());
    auto next = Clock::now();
    bool stopped = false;
    while (!stopped && !ends && !runner_->has_failed()) {
      if (arguments_.duration && seconds() >= *arguments_.duration) break;
      const bool pictures = std::any_of(results_.begin(), results_.end(), [](const auto& results) {
        return results->wants(io::Result::overlay);
      });
      subscriptions_->follow(pictures || pages_.need_color());
      const auto links = subscriptions_->links();
      io::DiagnosticArrayMessage message = runner_->with_inbox([&](const io::LiveInbox& inbox) {
        return words.report(inbox, links,
                            {io::LiveRunner::steady_now(), io::LiveRunner::system_now()});
      });
      add_losses(message);
      if (fusion_) fusion_->add_contradictions(message);
      runner_->add_calibrations(message);
      diagnostics.publish(message);
      print_calibrations();
      next += report_period;
      auto until = next;
      if (arguments_.duration)
        until = std::min(until, begin_ + std::chrono::duration_cast<Clock::duration>(
                                             to_duration(*arguments_.duration)));
      stopped = stop.wait_until(until);
    }
    return stopped;
  }

  /// Prints the good poses that were found since the last call.
  void print_calibrations() {
    printed_.resize(results_.size());
    for (std::size_t i = 0; i < results_.size(); ++i) {
      const CalibrationProgress of = runner_->calibration_progress(i);
      if (!of.is_ready() || printed_[i] == of.found) continue;
      printed_[i] = of.found;
      std::cout << (cameras_[i].empty() ? "" : cameras_[i] + ": ") << "calibrated: " << of.message
                << '\n';
      if (const auto transform = runner_->calibrated_transform(i))
        std::cout << "ROS 2: "
                  << io::static_transform_command(transform->T_parent_child,
                                                  transform->header.frame_id,
                                                  transform->child_frame_id)
                  << "\n  (in place of the transform that leads to this frame now)\n";
      std::cout << std::flush;
    }
  }

  void fuse(const io::LiveOptions& options, const io::NameResolver& names, io::Participant& graph) {
    std::vector<std::string> cameras;
    for (const io::CameraInputOptions& camera : options.cameras) cameras.push_back(camera.name);
    target_views_ =
        graph.advertise(names.resolve(target_views_name()), std::string(io::target_views_type),
                        {.reliable = true, .depth = 10});
    fusion_.emplace(cameras, [this](std::span<const std::byte> payload) {
      static_cast<void>(target_views_->write(payload));
    });
    runner_->fuse(*fusion_);
  }

  /// Adds the results that subscribers lost to the statuses of cameras and clouds, which follow the
  /// robot's.
  void add_losses(io::DiagnosticArrayMessage& message) const {
    auto status = message.status.begin() + 1;
    for (const auto& results : results_) {
      const io::WrittenResults counts = results->counts();
      const auto add = [&](const char* key, std::size_t number) {
        if (number > 0) status->values.push_back({key, std::to_string(number)});
      };
      add(behind, counts.not_written);
      add("results not acknowledged by subscribers", counts.unacknowledged);
      ++status;
    }
    for (const auto& clouds : clouds_) {
      if (const std::size_t number = clouds->not_written(); number > 0)
        status->values.push_back({behind, std::to_string(number)});
      ++status;
    }
  }

  const LiveArguments& arguments_;
  LivePages& pages_;
  Clock::time_point begin_ = Clock::now();
  double cpu_at_start_ = cpu_seconds();
  std::vector<std::string> cameras_;  // names
  std::vector<std::unique_ptr<GraphResults>> results_;
  std::vector<std::unique_ptr<GraphClouds>> clouds_;
  std::unique_ptr<io::Publication> target_views_;  // null with one camera
  std::optional<io::LiveFusion> fusion_;           // likewise
  std::unique_ptr<io::LiveRunner> runner_;
  std::unique_ptr<LiveSubscriptions> subscriptions_;
  std::vector<std::shared_ptr<const Calibration>> printed_;
  std::exception_ptr fault_;
};

void print_topics(const io::LiveOptions& options, int domain) {
  std::cout << "live on domain " << domain << ", until Ctrl-C\n";
  for (const std::string& topic : options.description_topics)
    if (!options.robot.given) print_line("robot: " + topic);
  for (const std::string& name : options.joint_topics)
    if (options.poses != PoseSource::transforms) print_line("joints: " + name);
  for (const io::CameraInputOptions& camera : options.cameras) {
    std::string line = camera.name.empty() ? "" : camera.name + ": ";
    line += "depth: " + camera.depth_topic + ", camera_info " + camera.info_topic;
    if (!camera.color_topic.empty()) line += ", color " + camera.color_topic;
    print_line(line);
  }
  for (const io::CloudInputOptions& cloud : options.clouds) print_line("cloud: " + cloud.topic);
  std::cout << "poses: from " << to_string(options.poses) << '\n' << std::flush;
}

void write_summary(io::PendingFile& file, const std::string& summary) {
  const std::string text = summary + "\n";
  io::write_file(file.part(), text.data(), text.size());
  file.finish();
}

/// Lets all threads share their free memory. By default each thread keeps its own peak for good: an
/// image is allocated by one thread, grown by the next and freed by a third.
void share_free_memory() {
#ifdef __GLIBC__
  mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace

int execute(const LiveArguments& arguments) {
  share_free_memory();
  check_draws(arguments.session);
  const io::NameResolver names = live_names(arguments);
  io::LiveOptions options = live_options(arguments, names);
  const io::CameraInputOptions common = camera_options(arguments);
  options.cameras = named_cameras(arguments, names, common);
  options.clouds = named_clouds(arguments, names);
  io::BagOptions searched = searched_topics(arguments, names);
  check_remaps(names, options.cameras, arguments.clouds);
  std::optional<io::PendingFile> summary;
  if (arguments.summary) {
    io::check_is_no_folder("--summary", *arguments.summary);
    summary.emplace(*arguments.summary);
  }
  StopSignal stop;
  const auto graph = io::join_graph(arguments.graph);
  if (const std::string advice = limit_advice(receive_buffers()); !advice.empty())
    print_notes(std::vector{advice});
  LivePages pages(arguments, graph->domain());
  pages.print();
  Diagnostics diagnostics(*graph, names, pages);
  if (options.cameras.empty() && options.clouds.empty()) {
    CameraSearch search(*graph, std::move(searched));
    auto camera = find_camera(arguments, search, common, diagnostics, stop);
    if (!camera) {
      if (summary) print_notes(std::vector{"no camera was found, and no summary is written"s});
      return 0;
    }
    options.cameras.push_back(std::move(*camera));
  }
  print_topics(options, graph->domain());
  Live live(arguments, names, *graph, options, pages);
  const bool stopped = live.run(*graph, diagnostics, stop);
  print_notes(graph->take_warnings());
  try {
    if (summary) write_summary(*summary, live.summary());
  } catch (const InputError& error) {
    if (!live.fault()) throw;
    print_notes(std::vector<std::string>{error.what()});
  }
  if (live.fault()) std::rethrow_exception(live.fault());
  if (stopped || live.judged() > 0) return 0;
  print_error("nothing was judged");
  return 2;
}

}  // namespace penumbra::app
