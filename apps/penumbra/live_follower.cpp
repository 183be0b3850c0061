// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <apps/penumbra/live_follower.hpp>
#include <apps/penumbra/live_graph.hpp>
#include <apps/penumbra/live_setup.hpp>
#include <io/live/live_runner.hpp>
#include <io/printable.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::app {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int shown_depth = 2, said_depth = 10;  // of messages that wait
constexpr auto silence = 5s;                     // after which penumbra live is called silent

const char* level_of(std::uint8_t level) {
  constexpr std::array names{"ok", "warn", "error", "stale"};
  return names[level < names.size() ? level : io::DiagnosticStatusMessage::stale];
}

const io::ResultTopic& topic_of(io::Result result) {
  return *std::find_if(io::result_topics.begin(), io::result_topics.end(),
                       [&](const io::ResultTopic& topic) { return topic.result == result; });
}

}  // namespace

LiveFollower::LiveFollower(io::Participant& graph, const io::LiveOptions& options,
                           const io::NameResolver& names, bool reliable, io::LiveView& view)
    : graph_(graph), inbox_(options), reliable_(reliable), view_(view), told_at_(Clock::now()) {
  inputs_.resize(inbox_.topics().size());
  const std::string& camera = options.cameras.front().name;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const io::ResultTopic& topic = topic_of(results[i]);
    result_names_[i] = names.resolve(result_name(camera, topic));
    result_types_[i] = topic.type;
  }
  speaker_ = live_speaker(names).name + ": ";
  diagnostics_ = graph_.subscribe(names.resolve(diagnostics_topic),
                                  io::message_type<io::DiagnosticArrayMessage>(),
                                  {.reliable = true, .depth = said_depth});
}

bool LiveFollower::is_wanted(io::LiveRole role) const {
  const bool has_clients = view_.clients() > 0;
  if (role == io::LiveRole::depth) return has_clients;
  if (role == io::LiveRole::color)
    return view_.is_wanted(io::Part::color) || view_.is_wanted(io::Part::cloud);
  return role != io::LiveRole::targets;
}

bool LiveFollower::is_wanted(io::Result result) const {
  if (result == io::Result::virtual_depth) return view_.is_wanted(io::Part::vdi);
  if (result == io::Result::overlay) return view_.is_wanted(io::Part::overlay);
  return view_.clients() > 0;
}

void LiveFollower::follow() {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const io::LiveTopic& topic = inbox_.topics()[i];
    if (!is_wanted(topic.role))
      inputs_[i].reset();
    else if (!inputs_[i])
      inputs_[i] = graph_.subscribe(topic.name, topic.type, live_qos(topic, reliable_));
  }
  follow_results();
  if (Clock::now() >= retry_at_) {
    inbox_.retry_robot();
    retry_at_ = Clock::now() + io::LiveRunner::default_robot_retry;
  }
  auto told = told_;
  if (Clock::now() - told_at_ > silence)
    told = {{"stale", "nothing is heard of penumbra live on /diagnostics"}};
  tell_rivals(told);
  view_.tell(std::move(told), missing());
}

void LiveFollower::follow_results() {
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!is_wanted(results[i]))
      results_[i].reset();
    else if (!results_[i])
      results_[i] = graph_.subscribe(result_names_[i], result_types_[i],
                                     {.reliable = true, .depth = shown_depth});
  }
}

bool LiveFollower::receive(std::chrono::nanoseconds at_most) {
  graph_.wait(at_most);
  take_inputs();
  take_results();
  take_diagnostics();
  take_jobs();
  const std::int64_t now = io::LiveRunner::steady_now();
  auto frame = matcher_.take({.virtual_depth = is_wanted(io::Result::virtual_depth),
                              .overlay = is_wanted(io::Result::overlay)},
                             now);
  if (!frame) return false;
  const Robot& robot = frame->robot();
  view_.publish(std::move(frame), robot, now);
  return true;
}

void LiveFollower::take_inputs() {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (!inputs_[i]) continue;
    for (io::Sample sample; inputs_[i]->take(sample);)
      inbox_.receive(i, {sample.data, sample.owner, sample.publisher},
                     io::LiveRunner::steady_now());
  }
}

void LiveFollower::take_results() {
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results_[i]) continue;
    for (io::Sample sample; results_[i]->take(sample);) take_result(results[i], sample);
  }
}

void LiveFollower::take_result(io::Result result, const io::Sample& sample) {
  static const io::Decoder<io::ImageMessage> images;
  static const io::Decoder<io::CompressedImageMessage> compressed;
  static const io::Decoder<io::TargetsMessage> targets;
  if (result == io::Result::targets) {
    io::TargetsMessage message;
    if (!targets.decode(sample.data, message)) matcher_.add(std::move(message), sample.participant);
  } else if (result == io::Result::overlay) {
    io::CompressedImageMessage message;
    if (!compressed.decode(sample.data, message))
      matcher_.add(result, io::keep_image(message, sample.owner), sample.participant);
  } else {
    io::ImageMessage message;
    if (!images.decode(sample.data, message))
      matcher_.add(result, io::keep_image(message, sample.owner), sample.participant);
  }
}

void LiveFollower::take_diagnostics() {
  static const io::Decoder<io::DiagnosticArrayMessage> decoder;
  for (io::Sample sample; diagnostics_->take(sample);) {
    io::DiagnosticArrayMessage message;
    if (decoder.decode(sample.data, message)) continue;
    std::vector<io::LiveView::Diagnostic> told;
    for (const io::DiagnosticStatusMessage& status : message.status)
      if (status.name.starts_with(speaker_))
        told.push_back({level_of(status.level), status.name + ": " + status.message});
    if (told.empty()) continue;
    told_ = std::move(told);
    told_at_ = Clock::now();
  }
}

void LiveFollower::take_jobs() {
  // Nothing can be shown before there is a robot: messages wait for it.
  if (const auto order = inbox_.take_order()) inbox_.place(io::make_robot(*order));
  for (io::LiveJob job; inbox_.next(0, io::LiveRunner::steady_now(), true, job); job = {}) {
    io::LiveOutcome outcome;
    outcome.is_published = true;
    outcome.stamp = job.pose.stamp;
    outcome.arrived = job.arrived;
    inbox_.done(0, outcome, io::LiveRunner::steady_now(), io::LiveRunner::system_now());
    matcher_.add(std::move(job));
  }
}

/// Frames are of one program each, but which one's is chance.
void LiveFollower::tell_rivals(std::vector<io::LiveView::Diagnostic>& told) const {
  if (!results_[0]) return;
  const int publishers = results_[0]->status().publishers;
  if (publishers < 2) return;
  told.push_back({"error", std::to_string(publishers) + " programs publish " + result_names_[0] +
                               ": what is shown is of any of them; end all penumbra live but " +
                               "one, or give each a --namespace"});
}

std::string LiveFollower::nobody_publishes(io::LiveRole role) const {
  std::string names;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (inbox_.topics()[i].role != role || !inputs_[i]) continue;
    if (inputs_[i]->status().publishers > 0) return {};
    names += (names.empty() ? "" : ", ") + inbox_.topics()[i].name;
  }
  return names.empty() ? names : "nobody publishes " + names;
}

std::vector<std::string> LiveFollower::missing() const {
  std::vector<std::string> lines;
  const io::LiveCamera& camera = inbox_.camera(0);
  if (results_[0] && results_[0]->status().publishers == 0)
    lines.push_back("labels: nobody publishes " + result_names_[0] +
                    "; penumbra live does, with the same options of topics");
  if (const auto nobody = nobody_publishes(io::LiveRole::depth); !nobody.empty())
    lines.push_back("depth: " + nobody);
  if (const auto nobody = nobody_publishes(io::LiveRole::joints);
      inbox_.options().poses == PoseSource::joints && !nobody.empty())
    lines.push_back("robot: " + nobody);
  if (!inbox_.robot().fault().empty())
    lines.push_back("robot: " + inbox_.robot().fault());
  else if (!inbox_.robot().posed())
    lines.push_back("robot: nothing was heard on " + inbox_.options().description_topic +
                    " yet; --robot names a URDF in its place");
  else
    for (const LinkReport& link : inbox_.robot().posed()->robot.report())
      if (link.missing)
        lines.push_back("link " + link.link + " is drawn without its geometry: " + link.reason);
  if (!camera.setup_fault().empty()) lines.push_back("camera: " + camera.setup_fault());
  if (camera.options().color_topic.empty())
    lines.push_back("color: no color images were found; --color-topic names them");
  return lines;
}

}  // namespace penumbra::app
