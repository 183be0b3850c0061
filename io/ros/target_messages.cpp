// SPDX-License-Identifier: Apache-2.0
#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

std::uint8_t verdict_value(Verdict verdict) {
  switch (verdict) {
    case Verdict::visible:
      return TargetMessage::visible;
    case Verdict::partial:
      return TargetMessage::partial;
    case Verdict::hidden:
      return TargetMessage::hidden;
    case Verdict::out_of_view:
      return TargetMessage::out_of_view;
    case Verdict::unknown:
      break;
  }
  return TargetMessage::unknown;
}

std::uint8_t source_value(Source source) {
  switch (source) {
    case Source::measured:
      return TargetMessage::measured;
    case Source::predicted:
      return TargetMessage::predicted;
    case Source::held:
      return TargetMessage::held;
    case Source::lost:
      break;
  }
  return TargetMessage::lost;
}

std::uint8_t estimate_value(Outcome outcome) {
  switch (outcome) {
    case Outcome::accepted:
      return TargetMessage::accepted;
    case Outcome::refused_verdict:
      return TargetMessage::refused_verdict;
    case Outcome::refused_gate:
      return TargetMessage::refused_gate;
    case Outcome::refused_late:
      return TargetMessage::refused_late;
    case Outcome::refused_invalid:
      break;
  }
  return TargetMessage::refused_invalid;
}

void put_judgement(const Judgement& judged, std::span<const std::string> links,
                   TargetMessage& message) {
  message.judged = true;
  message.covered = judged.covered;
  message.inside = judged.inside;
  for (const Blame& blame : judged.blame)
    message.blame.push_back({links[blame.link], blame.fraction});
  if (judged.inside == 0) return;
  message.occluded_fraction = judged.occluded;
  message.front_fraction = judged.front;
  message.clear_fraction = judged.clear;
  message.unknown_fraction = judged.unknown;
  message.hidden_by_other_fraction = judged.hidden_by_other.value_or(TargetMessage::none);
  message.measured_fraction = judged.measured.value_or(TargetMessage::none);
  message.seen_past_fraction = judged.seen_past.value_or(TargetMessage::none);
}

void put_handled(const HandledTarget& handled, TargetMessage& message) {
  message.source = source_value(handled.source);
  message.age = handled.age;
  message.sigma = handled.sigma;
  if (handled.position) message.pose.position = *handled.position;
  if (handled.orientation) message.pose.orientation = handled.orientation->coeffs();
}

TargetMessage target_message(const TargetReport& target, std::span<const std::string> links) {
  TargetMessage message{.name = std::string(target.name)};
  message.has_stamp = target.stamp.has_value();
  message.stamp = target.stamp.value_or(0);
  message.verdict = verdict_value(target.verdict);
  message.reason = target.reason;
  if (target.judgement) put_judgement(*target.judgement, links, message);
  if (target.point) {
    message.point = *target.point;
    if (target.judgement) {
      message.point_pixels = target.judgement->point_pixels;
      message.point_spread = target.judgement->point_spread;
    }
  }
  if (target.handled) put_handled(*target.handled, message);
  if (target.estimate) message.estimate = estimate_value(*target.estimate);
  return message;
}

}  // namespace

TargetsMessage targets_message(const FrameReport& report, std::string_view camera_frame,
                               std::string_view root_frame) {
  TargetsMessage message{.header = {report.stamp.value_or(0), std::string(camera_frame)},
                         .root_frame = std::string(root_frame),
                         .status = std::string(to_string(report.status)),
                         .message = report.message};
  for (const TargetReport& target : report.targets)
    message.targets.push_back(target_message(target, report.links));
  return message;
}

}  // namespace penumbra::io
