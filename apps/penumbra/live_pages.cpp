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

/// One camera's page.
class LivePages::Page final : public io::FrameWatcher {
 public:
  Page(const std::string& input, const io::WebOptions& options)
      : view_(input), server_(options, view_) {}

  [[nodiscard]] std::string url() const { return server_.url(); }
  void set_note(std::string note) { note_ = std::move(note); }

  [[nodiscard]] bool wants_color() const override { return view_.needs(io::Part::color); }
  void take(const io::AssembledFrame& job, const DepthView& depth, const FrameReport& report,
            const Drift& drift) override {
    if (view_.show(job, depth, report, drift, io::LiveRunner::steady_now())) server_.wake();
  }

  /// `statuses`: the robot's, if there is one, and the camera's.
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
  std::string note_;  // what this camera lacks from the start
};

LivePages::LivePages(const LiveArguments& arguments, int domain) {
  if (!arguments.server.port) return;
  io::WebOptions options = web_options(arguments.server);
  std::vector<std::string> cameras;
  for (const auto& camera : arguments.cameras) cameras.push_back(", " + camera.name);
  if (cameras.empty()) cameras.emplace_back();
  for (const std::string& camera : cameras) {
    const std::string input = "live, domain " + std::to_string(domain) + camera;
    pages_.push_back(std::make_unique<Page>(input, options));
    if (options.port > 0) ++options.port;
  }
}

LivePages::~LivePages() = default;

void LivePages::print() const {
  for (const auto& page : pages_) std::cout << "page: " << page->url() << '\n';
  std::cout << std::flush;
}

void LivePages::watch(io::LiveRunner& runner, const std::vector<io::CameraInputOptions>& cameras) {
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    runner.watch(i, *pages_[i]);
    if (cameras[i].color_topic.empty())
      pages_[i]->set_note("color: no color images were found; --color-topic names them");
  }
}

void LivePages::publish(const io::DiagnosticArrayMessage& message) {
  // The robot's, those of the cameras and of clouds, or the one of a camera that is searched.
  const std::size_t first_camera = message.status.size() > 1 ? 1 : 0;
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    std::vector<const Status*> statuses;
    for (std::size_t s = 0; s < message.status.size(); ++s)
      if (s < first_camera || s >= first_camera + pages_.size())
        statuses.push_back(&message.status[s]);
    statuses.push_back(&message.status[first_camera + i]);
    pages_[i]->publish(statuses);
  }
}

bool LivePages::need_color() const {
  return std::any_of(pages_.begin(), pages_.end(),
                     [](const auto& page) { return page->wants_color(); });
}

}  // namespace penumbra::app
