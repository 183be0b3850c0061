// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include <io/files/json.hpp>
#include <io/web/live_view.hpp>

namespace penumbra::io {
namespace {

constexpr std::int64_t rate_window = 2'000'000'000;  // nanoseconds

std::int64_t system_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

Json json_of(const std::vector<LiveView::Diagnostic>& diagnostics) {
  Json json = Json::array();
  for (const LiveView::Diagnostic& one : diagnostics)
    json.push_back({{"level", one.level}, {"message", one.message}});
  return json;
}

/// Parses {"type": "want", "with": [...], "step": 4}. Returns nothing for other messages.
std::optional<Wanted> wanted_of(const Json& message) {
  std::string with;
  const auto names = message.find("with");
  if (names == message.end() || !names->is_array()) return std::nullopt;
  for (const Json& name : *names) {
    if (!name.is_string()) return std::nullopt;
    with += (with.empty() ? "" : ",") + name.get<std::string>();
  }
  const auto step = message.find("step");
  if (step != message.end() && !step->is_number_unsigned()) return std::nullopt;
  return parse_wanted(with, step == message.end() ? "" : step->dump());
}

/// Returns the parts that a frame must have for a client that wants these.
PartSet needed_for(const std::vector<Part>& wanted) {
  PartSet needed;
  for (const Part part : wanted) needed.set(static_cast<std::size_t>(part));
  if (needed[static_cast<std::size_t>(Part::cloud)])
    for (const Part part : {Part::depth, Part::labels, Part::color})
      needed.set(static_cast<std::size_t>(part));
  return needed;
}

std::vector<std::string> missing_links(const Robot& robot) {
  std::vector<std::string> lines;
  for (const LinkReport& link : robot.report())
    if (link.missing)
      lines.push_back("link " + link.link + " is drawn without its geometry: " + link.reason);
  return lines;
}

}  // namespace

/// A browser. It gets the newest frame after it reports that it has drawn the last one.
class LiveView::Client final : public WebChannel {
 public:
  explicit Client(LiveView& view) : view_(view) {
    const std::lock_guard lock(view_.mutex_);
    ++view_.clients_;
  }
  ~Client() override {
    std::shared_ptr<const LiveFrame> last;  // destroyed after the lock is released
    const std::lock_guard lock(view_.mutex_);
    count_needed(-1);
    if (--view_.clients_ == 0) last = std::move(view_.frame_);
  }

  bool take(std::string_view text) override {
    const Json message = Json::parse(text, nullptr, false);
    const auto type = message.is_object() ? message.find("type") : message.end();
    if (!message.is_object() || type == message.end()) return false;
    if (*type == "ready") {
      is_ready_ = true;
      return true;
    }
    auto wanted = *type == "want" ? wanted_of(message) : std::nullopt;
    if (!wanted) return false;
    const std::lock_guard lock(view_.mutex_);
    count_needed(-1);
    wanted_ = *std::move(wanted);
    needed_ = needed_for(wanted_.parts);
    count_needed(1);
    return true;
  }

  std::optional<std::vector<SharedBytes>> next() override {
    if (!is_ready_) return std::nullopt;
    const Moment moment = view_.now();
    const auto& frame = moment.frame;
    // A frame from before the client's last request may lack a part. The next frame has it.
    if (!frame || frame == sent_.lock() || !frame->has_kept(needed_)) return std::nullopt;
    const std::uint64_t dropped =
        last_ && frame->index() > *last_ ? frame->index() - *last_ - 1 : 0;
    is_ready_ = false;
    sent_ = frame;
    last_ = frame->index();
    const Json live{{"age_ms", 1e-6 * static_cast<double>(system_now() - frame->stamp())},
                    {"dropped", dropped},
                    {"rate_hz", moment.rate},
                    {"calibration", drift_json(moment.drift)},
                    {"calibrating", frame->calibration().message},
                    {"missing", moment.missing},
                    {"diagnostics", json_of(moment.diagnostics)}};
    const LiveScene& scene = frame->scene();
    const bool has_cloud = needed_[static_cast<std::size_t>(Part::cloud)];
    return make_packet(frame->packet_frame(), wanted_, has_cloud ? scene.cloud() : nullptr,
                       scene.version, ", \"live\": " + json_text(live));
  }

 private:
  void count_needed(int sign) {
    for (std::size_t part = 0; part < part_count; ++part)
      if (needed_[part]) view_.needed_[part] += static_cast<std::size_t>(sign);
  }

  LiveView& view_;
  Wanted wanted_;
  PartSet needed_;
  bool is_ready_ = false;
  std::weak_ptr<const LiveFrame> sent_;
  std::optional<std::uint64_t> last_;  // index of the last frame sent
};

LiveView::LiveView(std::string input, bool of_clouds)
    : input_(std::move(input)), of_clouds_(of_clouds) {}

bool LiveView::show(const AssembledFrame& job, const FrameReport& report, const Drift& drift,
                    std::int64_t now) {
  PartSet kept;
  std::shared_ptr<const LiveScene> scene;
  {
    const std::lock_guard lock(mutex_);
    judged_at_.push_back(now);
    drift_ = drift;
    // The last interval is kept, however long it is, so that a slow camera has a rate too.
    while (judged_at_.size() > 2 && now - judged_at_.front() > rate_window) judged_at_.pop_front();
    if (setup_.lock() != job.setup) {
      scene_ = std::make_shared<LiveScene>(*job.setup, scene_ ? scene_->version + 1 : 1);
      setup_ = job.setup;
    }
    if (clients_ == 0) return false;
    scene = scene_;
    for (std::size_t part = 0; part < part_count; ++part) kept[part] = needed_[part] > 0;
  }
  CalibrationProgress calibration;
  if (calibration_ != nullptr) calibration = calibration_->progress();
  std::shared_ptr<const LiveFrame> frame =
      std::make_shared<LiveFrame>(std::move(scene), job, report, kept, std::move(calibration));
  const std::lock_guard lock(mutex_);
  if (clients_ == 0) return false;
  std::swap(frame_, frame);
  return true;
}

void LiveView::set_diagnostics(std::vector<Diagnostic> diagnostics,
                               std::vector<std::string> missing) {
  const std::lock_guard lock(mutex_);
  diagnostics_ = std::move(diagnostics);
  missing_ = std::move(missing);
}

bool LiveView::needs(Part part) const {
  const std::lock_guard lock(mutex_);
  return needed_[static_cast<std::size_t>(part)] > 0;
}

LiveView::Moment LiveView::now() const {
  Moment moment;
  {
    const std::lock_guard lock(mutex_);
    if (judged_at_.size() > 1)
      moment.rate =
          1e9 * static_cast<double>(judged_at_.size() - 1) /
          static_cast<double>(std::max<std::int64_t>(judged_at_.back() - judged_at_.front(), 1));
    moment.drift = drift_;
    moment.scene = scene_;
    moment.frame = frame_;
    moment.diagnostics = diagnostics_;
    moment.missing = missing_;
  }
  if (moment.scene)
    for (std::string& line : missing_links(moment.scene->robot()))
      moment.missing.push_back(std::move(line));
  return moment;
}

std::string LiveView::session() const {
  const Moment moment = now();
  SessionInfo info{.mode = "live", .input = input_, .links = {}};
  if (!of_clouds_)
    info.parts = {Part::color, Part::labels, Part::links, Part::vdi, Part::depth, Part::outlines};
  info.parts.push_back(Part::cloud);
  if (moment.scene) {
    info.camera = moment.scene->camera;
    const auto links = moment.scene->robot().links();
    info.links.assign(links.begin(), links.end());
  }
  std::string session = session_json(info, 0, std::nullopt, false,
                                     moment.scene ? moment.scene->version : 0, moment.missing);
  session.pop_back();
  return session + ", \"diagnostics\": " + json_text(json_of(moment.diagnostics)) + "}";
}

Scene LiveView::scene() const {
  const auto scene = now().scene;
  return scene ? scene->drawn() : make_scene(std::span<const std::string>());
}

WebAnswer LiveView::answer(const WebRequest& request) {
  if (request.path == "/api/session") return {.body = {shared_bytes(session())}};
  if (request.path.starts_with("/api/scene"))
    if (auto answer = scene_answer(request, scene())) return *std::move(answer);
  if (auto page = page_answer(request.path)) return *std::move(page);
  return web_error(404, "nothing is served live at " + request.path);
}

std::unique_ptr<WebChannel> LiveView::open_channel(const std::string& path) {
  if (path != "/api/live") return nullptr;
  return std::make_unique<Client>(*this);
}

}  // namespace penumbra::io
