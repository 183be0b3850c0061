// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

// Constants of penumbra_msgs/Target, in the order of our enumerations.
constexpr std::array<std::uint8_t, 6> verdict_values{
    TargetMessage::visible, TargetMessage::partial,     TargetMessage::hidden,
    TargetMessage::unknown, TargetMessage::out_of_view, TargetMessage::held_by_link};
constexpr std::array<std::uint8_t, 4> source_values{
    TargetMessage::measured, TargetMessage::predicted, TargetMessage::held, TargetMessage::lost};
constexpr std::array<std::uint8_t, 5> estimate_values{
    TargetMessage::accepted, TargetMessage::refused_verdict, TargetMessage::refused_gate,
    TargetMessage::refused_late, TargetMessage::refused_invalid};

constexpr double never = std::numeric_limits<double>::infinity();

template <typename Enum, std::size_t count>
std::uint8_t value_of(Enum value, const std::array<std::uint8_t, count>& values) {
  return values.at(static_cast<std::size_t>(value));
}

/// `M`: TargetMessage, TargetViewMessage or CameraViewMessage.
template <typename M>
void put_verdict(Verdict verdict, const std::string& reason, M& message) {
  message.verdict = value_of(verdict, verdict_values);
  message.verdict_name = to_string(verdict);
  message.reason = reason;
}

void put_judgement(const Judgement& judged, TargetMessage& message) {
  message.judged = true;
  message.covered = judged.covered;
  message.inside = judged.inside;
  for (const Blame& blame : judged.blame) message.blame.push_back({blame.name, blame.fraction});
  if (judged.inside == 0) return;
  message.occluded_fraction = judged.occluded;
  message.front_fraction = judged.front;
  message.clear_fraction = judged.clear;
  message.unknown_fraction = judged.unknown;
  message.hidden_by_other_fraction = judged.hidden_by_other.value_or(0.0);
  message.measured_fraction = judged.measured.value_or(0.0);
  message.seen_past_fraction = judged.seen_past.value_or(0.0);
}

void put_handled(const HandledTarget& handled, TargetMessage& message) {
  message.source = value_of(handled.source, source_values);
  message.age = handled.age;
  message.sigma = handled.sigma;
  message.lost_in = handled.lost_in.value_or(never);
  if (handled.position) message.pose.position = *handled.position;
  if (handled.orientation) message.pose.orientation = handled.orientation->coeffs();
}

void put_forecast(std::span<const VerdictInterval> forecast, TargetMessage& message) {
  const auto unknown = std::ranges::find(forecast, Verdict::unknown, &VerdictInterval::verdict);
  const auto hidden = std::ranges::find(forecast, Verdict::hidden, &VerdictInterval::verdict);
  message.forecast_seconds = forecast.back().end;
  if (unknown != forecast.end()) message.forecast_reason = unknown->reason;
  if (unknown < hidden) return;  // it may be hidden before
  const bool is_hidden = hidden != forecast.end();
  message.hidden_in = is_hidden ? hidden->begin : never;
  message.hidden_for =
      is_hidden && hidden + 1 != forecast.end() ? hidden->end - hidden->begin : never;
  if (is_hidden) message.hidden_by = hidden->by;
}

TargetMessage target_message(const TargetReport& target) {
  TargetMessage message{.name = target.name};
  message.has_stamp = target.stamp.has_value();
  message.stamp = target.stamp.value_or(0);
  put_verdict(target.verdict, target.reason, message);
  if (target.judgement) put_judgement(*target.judgement, message);
  if (target.point) {
    message.point = *target.point;
    if (target.judgement) {
      message.point_pixels = target.judgement->point_pixels;
      message.point_spread = target.judgement->point_spread;
    }
  }
  if (target.handled) put_handled(*target.handled, message);
  if (!target.forecast.empty()) put_forecast(target.forecast, message);
  if (target.estimate) message.estimate = value_of(*target.estimate, estimate_values);
  return message;
}

}  // namespace

TargetViewMessage target_view_message(const FusedTarget& target,
                                      std::span<const ViewCamera> cameras) {
  TargetViewMessage message{.name = target.name};
  put_verdict(target.verdict, target.reason, message);
  if (target.best) message.best = cameras[*target.best].name;
  if (target.point) {
    message.point = *target.point;
    Eigen::Map<Eigen::Matrix3d>(message.covariance.data()) = target.covariance;  // symmetric
  }
  if (const auto& pair = target.contradiction) {
    message.contradicting = {cameras[pair->first].name, cameras[pair->second].name};
    message.contradiction_distance = pair->distance;
    message.contradiction_chi_square = pair->chi_square;
  }
  for (const CameraView& view : target.views) {
    CameraViewMessage& sent = message.views.emplace_back();
    sent.camera = cameras[view.camera].name;
    put_verdict(view.verdict, view.reason, sent);
    if (view.stamp) {
      sent.has_stamp = true;
      sent.stamp = *view.stamp;
      sent.visible_fraction = view.visible_fraction;
    }
    if (!view.point) continue;
    sent.point = *view.point;
    sent.distance = view.distance;
    sent.angle = view.angle;
  }
  return message;
}

TargetsMessage targets_message(const FrameReport& report, std::string_view camera_frame,
                               std::string_view root_frame) {
  TargetsMessage message{.header = {report.stamp.value_or(0), std::string(camera_frame)},
                         .root_frame = std::string(root_frame),
                         .status = std::string(to_string(report.status)),
                         .message = report.message};
  for (const TargetReport& target : report.targets)
    message.targets.push_back(target_message(target));
  return message;
}

}  // namespace penumbra::io
