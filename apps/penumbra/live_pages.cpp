// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <iostream>
#include <string>
#include <utility>

#include <apps/penumbra/live_pages.hpp>
#include <io/web/live_view.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::app {
namespace {

using Status = io::DiagnosticStatusMessage;

const char* level_of(const Status& status) {
  constexpr std::array names{"ok", "warn", "error", "stale"};
  return names.at(status.level);
}

}  // namespace

/// The page of a camera, or of a sensor that measures points.
class LivePages::Page final : public io::FrameWatcher {
 public:
  Page(const std::string& input, bool of_clouds, const io::WebOptions& options)
      : view_(input, of_clouds), server_(options, view_) {}

  [[nodiscard]] std::string url() const { return server_.url(); }
  void watch(const RunningCalibration& calibration) { view_.watch(calibration); }
  void set_note(std::string note) { note_ = std::move(note); }

  [[nodiscard]] bool wants_color() const override { return view_.needs(io::Part::color); }
  void take(const io::AssembledFrame& job, const FrameReport& report, const Drift& drift) override {
    if (view_.show(job, report, drift, io::LiveRunner::steady_now())) server_.wake();
  }

  /// `statuses`: the robot's and the sensor's, or that of a camera that is searched.
  void publish(const std::vector<const Status*>& statuses) {
    std::vector<io::LiveView::Diagnostic> diagnostics;
    diagnostics.reserve(statuses.size());
    for (const Status* status : statuses)
      diagnostics.push_back({level_of(*status), status->name + ": " + status->message});
    std::vector<std::string> missing;
    if (statuses.back()->level >= Status::error) missing.push_back(statuses.back()->message);
    if (!note_.empty()) missing.push_back(note_);
    view_.set_diagnostics(std::move(diagnostics), std::move(missing));
  }

 private:
  io::LiveView view_;
  io::WebServer server_;
  std::string note_;  // what this sensor lacks from the start
};

LivePages::LivePages(const LiveArguments& arguments, int domain) {
  if (!arguments.server.port) return;
  io::WebOptions options = web_options(arguments.server);
  const auto add = [&](const std::string& sensor, bool of_clouds) {
    const std::string input = "live, domain " + std::to_string(domain) + sensor;
    pages_.push_back(std::make_unique<Page>(input, of_clouds, options));
    if (options.port > 0) ++options.port;
  };
  for (const auto& camera : arguments.cameras) add(", " + camera.name, false);
  const bool has_depth_topic = arguments.session.input.bag.depth_topic.has_value();
  if (arguments.cameras.empty() && (has_depth_topic || arguments.clouds.empty())) add("", false);
  for (const io::CloudInputOptions& cloud : arguments.clouds) add(", " + cloud.topic, true);
}

LivePages::~LivePages() = default;

void LivePages::print() const {
  for (const auto& page : pages_) std::cout << "page: " << page->url() << '\n';
  std::cout << std::flush;
}

void LivePages::watch(io::LiveRunner& runner, const std::vector<io::CameraInputOptions>& cameras) {
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    runner.watch(i, *pages_[i]);
    if (i < cameras.size()) pages_[i]->watch(runner.calibration(i));
    if (i < cameras.size() && cameras[i].color_topic.empty())
      pages_[i]->set_note("color: no color images were found; --color-topic names them");
  }
}

void LivePages::publish(const io::DiagnosticArrayMessage& message) {
  if (pages_.empty()) return;
  if (message.status.size() == 1) return pages_.front()->publish({&message.status.front()});
  for (std::size_t i = 0; i < pages_.size(); ++i)
    pages_[i]->publish({&message.status.front(), &message.status[1 + i]});
}

bool LivePages::need_color() const {
  return std::any_of(pages_.begin(), pages_.end(),
                     [](const auto& page) { return page->wants_color(); });
}

}  // namespace penumbra::app
