// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <exception>
#include <iostream>
#include <optional>
#include <thread>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/live_cameras.hpp>
#include <apps/penumbra/live_follower.hpp>
#include <apps/penumbra/live_setup.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/text.hpp>
#include <apps/penumbra/view_live.hpp>
#include <io/dds/receive_buffers.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::app {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto poll_period = 100ms;     // for Ctrl-C and the end of the thread
constexpr auto follow_period = 250ms;   // for what clients want
constexpr auto longest_hearing = 50ms;  // shorter than LiveMatcher::companion_wait

/// Follows the graph in a thread of its own, until it is destroyed.
class Following {
 public:
  Following(const LiveArguments& arguments, io::Participant& graph, io::LiveView& view,
            io::WebServer& server)
      : arguments_(arguments),
        names_(live_names(arguments)),
        options_(live_options(arguments, names_)),
        graph_(graph),
        view_(view),
        server_(server),
        thread_([this] { run(); }) {}
  ~Following() {
    ends_ = true;
    graph_.wake();
    thread_.join();
  }
  Following(const Following&) = delete;
  Following& operator=(const Following&) = delete;

  [[nodiscard]] bool has_failed() const { return failed_; }
  void rethrow() const {
    if (failed_) std::rethrow_exception(error_);
  }

 private:
  void run() {
    try {
      if (find_camera()) follow();
    } catch (...) {
      error_ = std::current_exception();
      failed_ = true;
    }
  }

  bool find_camera() {
    const io::LiveCameraOptions common = camera_options(arguments_);
    options_.cameras = named_cameras(arguments_, names_, common);
    const io::TopicWishes wishes = camera_wishes(arguments_, names_);
    check_remaps(names_, options_.cameras);
    if (!options_.cameras.empty()) return true;
    CameraSearch search(graph_, wishes);
    while (!ends_) {
      if (const auto chosen = search.look()) {
        options_.cameras.push_back(found_camera(*chosen, common));
        return true;
      }
      view_.tell({{"stale", search.why()}}, {"camera: " + search.why()});
      graph_.wait(poll_period);
    }
    return false;
  }

  void follow() {
    LiveFollower follower(graph_, options_, names_, arguments_.reliable, view_);
    Clock::time_point next{};
    while (!ends_) {
      if (Clock::now() >= next) {
        follower.follow();
        next = Clock::now() + follow_period;
      }
      if (follower.receive(longest_hearing)) server_.wake();
    }
  }

  const LiveArguments& arguments_;
  io::NameResolver names_;
  io::LiveOptions options_;
  io::Participant& graph_;
  io::LiveView& view_;
  io::WebServer& server_;
  std::exception_ptr error_;
  std::atomic<bool> ends_ = false, failed_ = false;
  std::thread thread_;
};

}  // namespace

int view_live(const ViewArguments& arguments) {
  StopSignal stop;
  const auto graph = io::join_graph(arguments.live.graph);
  if (const std::string advice = io::receive_buffer_advice(io::receive_buffer_limit());
      !advice.empty())
    tell_notes(std::vector{advice});
  io::LiveView view("live, domain " + std::to_string(graph->domain()));
  io::WebServer server(arguments.server, view);
  const Following following(arguments.live, *graph, view, server);
  std::cout << server.url() << std::endl;
  while (!following.has_failed() && !stop.wait(poll_period)) continue;
  following.rethrow();
  return 0;
}

}  // namespace penumbra::app
