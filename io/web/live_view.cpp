// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include <io/json-inl.hpp>
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

/// {"type": "want", "with": [...], "step": 4}; nothing: it is not that.
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

}  // namespace

/// One browser. Sent the newest frame when it says that it has drawn the last one.
class LiveView::Client final : public WebChannel {
 public:
  explicit Client(LiveView& view) : view_(view) {
    const std::lock_guard lock(view_.mutex_);
    ++view_.clients_;
  }
  ~Client() override {
    const std::lock_guard lock(view_.mutex_);
    --view_.clients_;
    count_wanted(-1);
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
    count_wanted(-1);
    wanted_ = *std::move(wanted);
    count_wanted(1);
    return true;
  }

  std::optional<std::vector<SharedBytes>> next() override {
    if (!is_ready_) return std::nullopt;
    const Moment moment = view_.newest();
    if (!moment.frame || moment.frame == sent_.lock()) return std::nullopt;
    const std::uint64_t number = moment.frame->number();
    const std::uint64_t dropped = last_ && number > *last_ ? number - *last_ - 1 : 0;
    is_ready_ = false;
    sent_ = moment.frame;
    last_ = number;
    const Json live{{"age_ms", 1e-6 * static_cast<double>(system_now() - moment.frame->stamp())},
                    {"dropped", dropped},
                    {"rate_hz", moment.rate},
                    {"missing", moment.missing},
                    {"diagnostics", json_of(moment.diagnostics)}};
    const std::string more = ", \"live\": " + json_text(live);
    const LiveScene& scene = moment.frame->scene();
    return make_packet(*moment.frame, wanted_, &scene.cloud, scene.version, more);
  }

 private:
  void count_wanted(int sign) {
    for (const Part part : wanted_.parts)
      view_.wanted_[static_cast<std::size_t>(part)] += static_cast<std::size_t>(sign);
  }

  LiveView& view_;
  Wanted wanted_;
  bool is_ready_ = false;
  std::weak_ptr<const LiveFrame> sent_;
  std::optional<std::uint64_t> last_;  // the number of the frame that was sent last
};

LiveView::LiveView(std::string input) : input_(std::move(input)) {}

void LiveView::publish(std::shared_ptr<const LiveFrame> frame, const Robot& robot,
                       std::int64_t now) {
  const std::uint64_t version = frame->scene().version;
  std::optional<Scene> made;
  {
    const std::lock_guard lock(mutex_);
    if (scene_ && scene_->version == version) made = scene_;
  }
  if (!made) made = make_scene(robot, version);
  const std::lock_guard lock(mutex_);
  scene_ = std::move(made);
  links_.assign(robot.links().begin(), robot.links().end());
  frame_ = std::move(frame);
  published_.push_back(now);
  // The last interval stays, however long: a slow camera has a rate, too.
  while (published_.size() > 2 && now - published_.front() > rate_window) published_.pop_front();
}

void LiveView::tell(std::vector<Diagnostic> diagnostics, std::vector<std::string> missing) {
  const std::lock_guard lock(mutex_);
  diagnostics_ = std::move(diagnostics);
  missing_ = std::move(missing);
}

std::size_t LiveView::clients() const {
  const std::lock_guard lock(mutex_);
  return clients_;
}

bool LiveView::is_wanted(Part part) const {
  const std::lock_guard lock(mutex_);
  return wanted_[static_cast<std::size_t>(part)] > 0;
}

LiveView::Moment LiveView::newest() const {
  const std::lock_guard lock(mutex_);
  double rate = 0;
  if (published_.size() > 1)
    rate = 1e9 * static_cast<double>(published_.size() - 1) /
           static_cast<double>(std::max<std::int64_t>(published_.back() - published_.front(), 1));
  return {frame_, rate, diagnostics_, missing_};
}

std::string LiveView::session() const {
  const std::lock_guard lock(mutex_);
  SessionInfo info{.mode = "live", .input = input_, .links = links_};
  info.parts = {Part::color, Part::overlay, Part::labels, Part::vdi, Part::depth, Part::cloud};
  if (frame_) info.camera = frame_->scene().cameras.judged;
  std::string session =
      session_json(info, 0, std::nullopt, false, scene_ ? scene_->version : 0, missing_);
  session.pop_back();
  return session + ", \"diagnostics\": " + json_text(json_of(diagnostics_)) + "}";
}

Scene LiveView::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_ ? *scene_ : make_scene(links_);
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
