// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/target_stage-inl.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra {
namespace {

PoseResult poses_of_size(std::size_t links) {
  PoseResult poses;
  poses.T_root_link.resize(links);
  poses.T_camera_link.resize(links);
  return poses;
}

bool is_modal(const Target& target) {
  const auto* region = std::get_if<RegionTarget>(&target.shape);
  return region != nullptr && region->extent == Extent::modal;
}

/// Returns whether an estimate lies in the camera, as one computed from depth 0 does.
bool is_in_camera(const TargetEstimate& estimate, const Eigen::Isometry3d& T_camera_frame) {
  Eigen::Vector3d position;
  if (const auto* point = std::get_if<Eigen::Vector3d>(&estimate.value))
    position = *point;
  else if (const auto* pose = std::get_if<Eigen::Isometry3d>(&estimate.value))
    position = pose->translation();
  else
    return false;
  return (T_camera_frame * position).norm() < DepthRenderer::near_plane;
}

/// Returns whether the target counts as seen although hardly any of it was measured. (With an
/// expected depth it is unknown then.)
bool lacks_depth(const Judgement& judged, const TargetThresholds& thresholds) {
  if (judged.verdict != Verdict::visible && judged.verdict != Verdict::partial) return false;
  return judged.measured &&
         *judged.measured < thresholds.min_measured * (judged.clear + judged.front);
}

/// Returns when a target will be lost that its forecast hides for longer than its timeout. At the
/// end of a plan the robot stays where it is.
std::optional<double> lost_in(const TargetHandling& handling, const TargetReport& report) {
  const double timeout = std::visit(
      [](const auto& how) {
        if constexpr (requires { how.timeout; }) return how.timeout;
        return std::numeric_limits<double>::infinity();
      },
      handling);
  for (const VerdictInterval& each : report.forecast) {
    if (each.verdict != Verdict::hidden) continue;
    const double lost = timeout + (each.begin > 0.0 ? each.begin : -report.handled->age);
    if (lost < each.end) return std::max(lost, 0.0);
  }
  return std::nullopt;
}

double seen_fraction(const std::optional<Judgement>& judgement) {
  return judgement ? judgement->clear + judgement->front : 0.0;
}

/// Returns the estimate that replaces a missing one, of the target's stamp.
std::optional<TargetEstimate> own_estimate(const Target& target, const TargetReport& report) {
  if (const auto placement = placement_of(target.shape)) {
    TargetEstimate estimate{.value = placement->pose, .frame = placement->frame};
    if (!is_rendered(target.shape)) estimate.value.emplace<1>(placement->pose.translation());
    return estimate;
  }
  if (!report.point) return std::nullopt;
  return TargetEstimate{.value = *report.point, .frame = ReferenceFrame::root()};
}

}  // namespace

TargetStage::TargetStage(const Robot& robot, FrameJudge& judge,
                         std::optional<std::string> image_frame)
    : robot_(robot),
      judge_(judge),
      image_frame_(std::move(image_frame)),
      recent_poses_(poses_of_size(robot.links().size())) {}

void TargetStage::judge(std::span<const Target> targets, const LabelledFrame& frame,
                        std::span<const Forecast> forecasts) {
  const StageTimer timer(judge_ms_);
  begin(targets, frame, forecasts);
  for (std::size_t i = 0; i < targets.size(); ++i)
    judge(targets[i], frame, *given_[i], reports_[i]);
}

void TargetStage::track(std::span<const Target> targets, const LabelledFrame& frame) {
  const StageTimer timer(track_ms_);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Record& record = *given_[i];
    if (!record.track) continue;
    reports_[i].wants_stamp = !frame.stamp();
    if (!frame.stamp()) continue;
    track(targets[i], *frame.poses, record, reports_[i]);
    reports_[i].handled->lost_in = lost_in(targets[i].handling, reports_[i]);
  }
}

void TargetStage::begin(std::span<const Target> targets, const LabelledFrame& frame,
                        std::span<const Forecast> forecasts) {
  if (const auto stamp = frame.stamp()) {
    if (newest_stamp_ && is_clock_jump(*stamp, *newest_stamp_)) forget_all();
    newest_stamp_ = std::max(newest_stamp_.value_or(*stamp), *stamp);
    recent_poses_.at(*stamp) = *frame.poses;
  }
  judge_.begin(frame);
  std::erase_if(records_,
                [&](const auto& known) { return calls_ - known.second.call > forgotten_after; });
  nameless_.clear();
  ++calls_;
  given_.clear();
  reports_.assign(targets.size(), {});
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Record& record = targets[i].has_identity ? records_[targets[i].name] : nameless_.emplace_back();
    record.times = record.call == calls_ ? record.times + 1 : 1;
    record.call = calls_;
    given_.push_back(&record);
    reports_[i].name = targets[i].name;
    if (!forecasts.empty()) reports_[i].forecast = forecasts[i];
  }
}

void TargetStage::judge(const Target& target, const LabelledFrame& frame, Record& record,
                        TargetReport& report) {
  record.judged_poses = nullptr;
  report.stamp = target.stamp ? target.stamp : frame.stamp();
  bool is_reliable = false;
  try {
    check(target, record);
    const LabelledFrame& seen = frame_of(target, frame);
    check_distance(target, [&](const ReferenceFrame& of) {
      return seen.poses->T_root_camera.inverse() * pose_of(of, *seen.poses, robot_);
    });
    if (const PlacedBody* const body = find_body(*seen.poses, target.name)) {
      hold(*body, seen, record, report);
    } else {
      Judgement judgement = judge_on(seen, target, record);
      report.reason = judgement.reason;
      report.verdict = judgement.verdict;
      if (judgement.point) report.point = seen.poses->T_root_camera * *judgement.point;
      is_reliable = seen.status == FrameStatus::ok && !lacks_depth(judgement, target.thresholds);
      report.judgement = std::move(judgement);
    }
  } catch (const InputError& fault) {
    report.verdict = Verdict::unknown;
    report.judgement.reset();
    report.point.reset();
    report.reason = fault.what();
  }
  if (report.stamp && record.track)
    record.track->add(*report.stamp,
                      {report.verdict, is_reliable, seen_fraction(report.judgement)});
}

void TargetStage::check(const Target& target, Record& record) const {
  if (record.times > 1) throw InputError("its name is used twice in this frame");
  if (record.is_new && !std::holds_alternative<std::monostate>(target.handling))
    record.track.emplace(target.handling);
  record.is_new = false;
  if (!target.fault.empty()) throw InputError(std::string(target.fault));
  if (!target.frame_id.empty() && image_frame_ && target.frame_id != *image_frame_)
    throw InputError("belongs to image frame '" + target.frame_id + "', the camera's is '" +
                     *image_frame_ + "'");
  check_target(target);
  if (!target.estimate) return;
  const ReferenceFrame& frame = target.estimate->frame;
  if (frame.kind == ReferenceFrame::Kind::link && !robot_.find_link(frame.link))
    throw InputError("estimate is given in '" + frame.link + "', which is not a link of robot '" +
                     robot_.name() + "'");
}

const LabelledFrame& TargetStage::frame_of(const Target& target, const LabelledFrame& frame) {
  const bool is_late = target.stamp && target.stamp != frame.stamp();
  const LabelledFrame& seen =
      is_late ? judge_.earlier(*target.stamp, recent_poses_.find(*target.stamp)) : frame;
  if (!seen.poses->known()) throw InputError(seen.fault());
  return seen;
}

/// An attached body would hide itself. Afterwards the target is judged as a new one.
void TargetStage::hold(const PlacedBody& body, const LabelledFrame& frame, Record& record,
                       TargetReport& report) {
  report.verdict = Verdict::held;
  report.reason = "it is attached to link '" + body.carrier + "'";
  if (record.is_late(frame)) return;
  record.last_stamp = frame.stamp();
  record.memory = {};
  record.good_pixel.reset();
}

Judgement TargetStage::judge_on(const LabelledFrame& frame, const Target& target, Record& record) {
  if (record.is_late(frame)) {
    if (is_modal(target))
      throw InputError(
          "its stamp is before one that was judged: modal extents need stamps in order");
    return judge_.judge(frame, target, nullptr, {});  // the memory is of later frames
  }
  std::optional<Eigen::Vector2d> motion;
  if (is_modal(target) && record.good_pixel)
    if (const auto pixel = track_pixel(*frame.poses, record)) motion = *pixel - *record.good_pixel;
  Judgement judgement = judge_.judge(frame, target, &record.memory, motion);
  record.judged_poses = frame.poses;
  record.last_stamp = frame.stamp();
  return judgement;
}

std::optional<Eigen::Vector2d> TargetStage::track_pixel(const PoseResult& poses,
                                                        const Record& record) const {
  if (!record.track || !poses.stamp) return std::nullopt;
  const HandledTarget handled = record.track->at(*poses.stamp, false);
  if (!handled.position) return std::nullopt;
  return judge_.project(poses.T_root_camera.inverse() * *handled.position);
}

void TargetStage::track(const Target& target, const PoseResult& poses, Record& record,
                        TargetReport& report) {
  const std::int64_t stamp = *poses.stamp;
  const auto estimate = target.estimate ? target.estimate : own_estimate(target, report);
  const bool is_given = estimate && !std::holds_alternative<std::monostate>(estimate->value);
  if (const PlacedBody* const body = find_body(poses, target.name)) {
    record.last_held = std::max(record.last_held.value_or(stamp), stamp);
    if (is_given) report.estimate = Outcome::refused_verdict;
    report.handled = record.track->carry(stamp, poses.T_root_camera * body->T_camera_body);
    return;
  }
  bool is_measured = false;  // an estimate of an earlier call with this stamp does not count
  if (is_given && record.times == 1) {
    const std::int64_t of_image = estimate->stamp.value_or(target.stamp.value_or(stamp));
    const bool is_of_old_place = record.last_held && of_image <= *record.last_held;
    report.estimate =
        is_of_old_place ? Outcome::refused_late : feed(*estimate, of_image, *record.track);
    is_measured = *report.estimate == Outcome::accepted && of_image == stamp;
  }
  report.handled = record.track->at(stamp, is_measured);
  if (report.verdict == Verdict::visible && record.judged_poses != nullptr)
    record.good_pixel = track_pixel(*record.judged_poses, record);
}

Outcome TargetStage::feed(const TargetEstimate& estimate, std::int64_t stamp, TargetTrack& track) {
  const RecentVerdict* const verdict = track.reliable_verdict(stamp);
  const PoseResult* const poses = recent_poses_.find(stamp);
  if (verdict == nullptr || poses == nullptr || !poses->known()) return Outcome::refused_verdict;
  try {
    const Eigen::Isometry3d T_root_frame = pose_of(estimate.frame, *poses, robot_);
    if (is_in_camera(estimate, poses->T_root_camera.inverse() * T_root_frame))
      return Outcome::refused_invalid;
    return track.update(stamp, estimate, *verdict, T_root_frame);
  } catch (const InputError&) {
    return Outcome::refused_invalid;
  }
}

void TargetStage::forget(std::string_view name) { records_.erase(std::string(name)); }

void TargetStage::forget_all() {
  records_.clear();
  recent_poses_.clear();
  judge_.forget();
  newest_stamp_.reset();
}

}  // namespace penumbra
