// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/target_stage-inl.hpp>

namespace penumbra {
namespace {

/// By this name targets are judged whose stamp is before one that was judged: what verdicts
/// remember is of later frames, and is left alone.
constexpr std::string_view out_of_order("\0 out of order", 14);

/// Before the names by which targets without identity are known, for one call.
constexpr char without_identity = '\1';

std::int64_t nanoseconds(double seconds) {
  if (seconds >= 0.0 && seconds <= PipelineConfig::max_target_history)
    return static_cast<std::int64_t>(std::llround(seconds * 1e9));
  throw InputError("target_history is " + std::to_string(seconds) + " s; 0 to " +
                   std::to_string(PipelineConfig::max_target_history) + " are possible");
}

bool is_modal(const Target& target) {
  const auto* region = std::get_if<RegionTarget>(&target.shape);
  return region != nullptr && region->extent == Extent::modal;
}

/// Whether it is known how far it is, whatever is measured.
bool is_expected(const Target& target) {
  if (const auto* region = std::get_if<RegionTarget>(&target.shape))
    return region->expected_depth.has_value();
  if (const auto* keypoint = std::get_if<KeypointTarget>(&target.shape))
    return keypoint->expected_depth.has_value();
  return !std::holds_alternative<std::monostate>(target.shape);
}

std::string fault_of(const LabelledFrame& frame) {
  if (frame.status == FrameStatus::ok) return std::string(frame.message);
  return std::string(to_string(frame.status)) + ": " + std::string(frame.message);
}

bool is_known(const LinkFrame& frame, const Robot& robot) {
  return !frame || frame->empty() || robot.find_link(*frame);
}

bool is_doubted(const LinkFrame& frame, const PoseResult& poses, const Robot& robot) {
  const auto link = frame ? robot.find_link(*frame) : std::nullopt;
  return link && poses.doubts.holds(*link);
}

void check_link(const LinkFrame& frame, const Robot& robot) {
  if (is_known(frame, robot)) return;
  throw InputError("estimate is given in '" + std::string(*frame) + "', no link of robot '" +
                   robot.name() + "'");
}

/// Where estimates lie that were made of depth 0.
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

/// Whether it counts as seen, though hardly any of that was measured: with an expected depth it is
/// unknown then.
bool lacks_depth(const Judgement& judged, const TargetThresholds& thresholds) {
  if (judged.verdict != Verdict::visible && judged.verdict != Verdict::partial) return false;
  return judged.measured.value_or(0.0) < thresholds.min_measured * (judged.clear + judged.front);
}

double seen_share(const std::optional<Judgement>& judgement) {
  return judgement ? judgement->clear + judgement->front : 0.0;
}

/// What stands for an estimate that was not given, of the target's stamp.
std::optional<TargetEstimate> own_estimate(const Target& target, const TargetReport& report) {
  if (const auto* point = std::get_if<PointTarget>(&target.shape))
    return TargetEstimate{.value = point->position, .frame = point->frame};
  if (const auto* box = std::get_if<BoxTarget>(&target.shape))
    return TargetEstimate{.value = box->pose, .frame = box->frame};
  if (const auto* mesh = std::get_if<MeshTarget>(&target.shape))
    return TargetEstimate{.value = mesh->pose, .frame = mesh->frame};
  if (!report.point) return std::nullopt;
  return TargetEstimate{.value = *report.point, .frame = ""};
}

}  // namespace

TargetStage::TargetStage(const Setup& setup)
    : robot_(setup.robot),
      camera_(setup.camera),
      judge_(setup.camera, setup.rule, setup.robot.links().size(), setup.unseen),
      renderers_(setup.render_intrinsics, setup.backend, setup.renderer, setup.rectification),
      views_(robot_, camera_, renderers_, setup.rule, setup.rectification),
      recent_frames_(robot_.links().size(), nanoseconds(setup.history)),
      late_labeller_(setup.late_labeller) {}

std::span<const TargetReport> TargetStage::process(std::span<const Target> targets,
                                                   const LabelledFrame& frame) {
  begin(targets, frame);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    judge(targets[i], frame, slots_[i], reports_[i]);
    handle(targets[i], frame, slots_[i], reports_[i]);
  }
  forget_unused(targets.size());
  return std::span(reports_).first(targets.size());
}

void TargetStage::begin(std::span<const Target> targets, const LabelledFrame& frame) {
  ++calls_;
  judged_ = nullptr;
  late_ = {};
  if (frame.stamp()) {
    if (newest_stamp_ && is_clock_jump(*frame.stamp(), *newest_stamp_)) forget_all();
    newest_stamp_ = std::max(newest_stamp_.value_or(*frame.stamp()), *frame.stamp());
    recent_frames_.keep(frame);
  }
  for (const std::string& name : without_identity_) forget(name);
  without_identity_.clear();
  if (reports_.size() < targets.size()) reports_.resize(targets.size());
  while (slots_.size() < targets.size()) slots_.emplace_back();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    std::string_view name = targets[i].name;
    if (!targets[i].has_identity)
      name = without_identity_.emplace_back(without_identity + std::string(name));
    Memories::value_type& known_target = known(name);
    TargetRecord& memory = known_target.second;
    memory.times = memory.call == calls_ ? memory.times + 1 : 1;
    memory.call = calls_;
    slots_[i].known = &known_target;
    slots_[i].seen = nullptr;
    reports_[i] = {};
    reports_[i].name = std::string_view(known_target.first).substr(targets[i].has_identity ? 0 : 1);
  }
}

TargetStage::Memories::value_type& TargetStage::known(std::string_view name) {
  const auto found = memories_.find(name);
  return found != memories_.end() ? *found : *memories_.try_emplace(std::string(name)).first;
}

void TargetStage::forget_unused(std::size_t given) {
  if (memories_.size() <= given) return;
  for (auto it = memories_.begin(); it != memories_.end();) {
    const bool unused = calls_ - it->second.call > forgotten_after;
    if (unused) judge_.forget(it->first);
    it = unused ? memories_.erase(it) : std::next(it);
  }
}

void TargetStage::judge(const Target& target, const LabelledFrame& frame, Slot& slot,
                        TargetReport& report) {
  TargetRecord& memory = slot.known->second;
  report.stamp = target.stamp ? target.stamp : frame.stamp();
  bool was_judged = false;
  try {
    check(target, memory);
    const LabelledFrame& seen = frame_of(target, frame);
    Judgement judgement = judge_on(seen, target, slot);
    slot.blame.assign(judgement.blame.begin(), judgement.blame.end());
    judgement.blame = slot.blame;
    slot.reason = judgement.reason;
    report.verdict = judgement.verdict;
    if (judgement.point) report.point = seen.poses.T_root_camera * *judgement.point;
    report.judgement = judgement;
    was_judged = seen.status == FrameStatus::ok && !lacks_depth(judgement, target.thresholds);
    doubt(seen, slot, report);
  } catch (const InputError& fault) {
    report.verdict = Verdict::unknown;
    report.judgement.reset();
    report.point.reset();
    slot.reason = fault.what();
  }
  report.reason = report.verdict == Verdict::unknown ? std::string_view(slot.reason) : "";
  if (report.judgement) report.judgement->reason = report.reason;
  if (report.stamp && memory.track && memory.track->handles())
    memory.log.add({*report.stamp, report.verdict, was_judged, seen_share(report.judgement)});
}

void TargetStage::check(const Target& target, TargetRecord& memory) const {
  if (!memory.track) memory.track.emplace(target.handling);
  if (memory.times > 1) throw InputError("its name is used twice in this frame");
  if (!target.fault.empty()) throw InputError(std::string(target.fault));
  if (!target.frame_id.empty() && target.frame_id != camera_.frame_id)
    throw InputError("is of image frame '" + std::string(target.frame_id) + "', the camera's is '" +
                     camera_.frame_id + "'");
  check_target(target);
  if (target.estimate) check_link(target.estimate->frame, robot_);
}

/// A link without geometry may hide whatever seems to be seen, and any depth may be its own.
/// Without depth, what the robot does not hide is unknown.
void TargetStage::doubt(const LabelledFrame& frame, Slot& slot, TargetReport& report) {
  if (frame.images.is_blind && report.verdict == Verdict::unknown) slot.reason = fault_of(frame);
  if (frame.status != FrameStatus::missing_link) return;
  Judgement& judgement = *report.judgement;
  report.point.reset();
  judgement.point.reset();
  judgement.unknown += judgement.clear + judgement.front;
  judgement.clear = judgement.front = 0.0;
  judgement.measured.reset();
  judgement.seen_past.reset();
  if (report.verdict != Verdict::visible && report.verdict != Verdict::partial) return;
  report.verdict = judgement.verdict = Verdict::unknown;
  slot.reason = frame.message;
}

const LabelledFrame& TargetStage::frame_of(const Target& target, const LabelledFrame& frame) {
  const bool is_late = target.stamp && target.stamp != frame.stamp();
  const LabelledFrame& seen = is_late ? late_frame(*target.stamp) : frame;
  const bool is_blind = seen.images.is_blind && !is_expected(target);
  if (!seen.poses.known() || is_blind) throw InputError(fault_of(seen));
  return seen;
}

/// A kept frame, labelled again.
const LabelledFrame& TargetStage::late_frame(std::int64_t stamp) {
  if (!recent_frames_.keeps_depth())
    throw InputError("its stamp is not the frame's, and no frames are kept (target_history)");
  if (late_.stamp() == stamp) return late_;
  const auto depth = recent_frames_.depth_at(stamp);
  const auto poses = recent_frames_.poses_at(stamp);
  if (!depth || !poses) throw InputError("no frame of its stamp is kept");
  judged_ = nullptr;
  StageTimes unreported;
  late_ = late_labeller_->label(*depth, *poses, unreported);
  return late_;
}

Judgement TargetStage::judge_on(const LabelledFrame& frame, const Target& target, Slot& slot) {
  TargetRecord& memory = slot.known->second;
  const bool is_late = frame.stamp() && memory.last_stamp && *frame.stamp() < *memory.last_stamp;
  if (is_late && is_modal(target))
    throw InputError("its stamp is before one that was judged: a modal extent needs their order");
  auto view = views_.view(target, frame);
  if (!view) {
    Judgement outside;
    outside.verdict = Verdict::out_of_view;
    return outside;
  }
  view->name = slot.known->first;
  if (judged_ != &frame) judge_.begin(frame.images);
  judged_ = &frame;
  if (is_late) {
    view->name = out_of_order;
    Judgement judgement = judge_.judge(*view);
    judge_.forget(out_of_order);
    return judgement;
  }
  slot.seen = &frame;
  memory.last_stamp = frame.stamp();
  expect_motion(frame, memory, *view);
  return judge_.judge(*view);
}

void TargetStage::expect_motion(const LabelledFrame& frame, const TargetRecord& memory,
                                TargetView& view) const {
  if (view.extent != Extent::modal || !memory.good_pixel) return;
  if (const auto pixel = track_pixel(frame, memory)) view.motion = *pixel - *memory.good_pixel;
}

std::optional<Eigen::Vector2d> TargetStage::track_pixel(const LabelledFrame& frame,
                                                        const TargetRecord& memory) const {
  if (!memory.track || !frame.stamp()) return std::nullopt;
  const auto handled = memory.track->at(*frame.stamp(), false);
  if (!handled || !handled->position) return std::nullopt;
  return views_.project(frame.poses.T_root_camera.inverse() * *handled->position);
}

void TargetStage::handle(const Target& target, const LabelledFrame& frame, const Slot& slot,
                         TargetReport& report) const {
  TargetRecord& memory = slot.known->second;
  if (!memory.track || !memory.track->handles()) return;
  report.wants_stamp = !frame.stamp();
  if (report.wants_stamp) return;
  const auto estimate = target.estimate ? target.estimate : own_estimate(target, report);
  const bool is_given = estimate && !std::holds_alternative<std::monostate>(estimate->value);
  bool is_measured = false;  // by this call: what an earlier one took of the same stamp is no news
  if (is_given && memory.times == 1) {
    const std::int64_t stamp = estimate->stamp.value_or(target.stamp.value_or(*frame.stamp()));
    report.estimate = feed(*estimate, stamp, memory);
    is_measured = *report.estimate == Outcome::accepted && stamp == *frame.stamp();
  }
  report.handled = memory.track->at(*frame.stamp(), is_measured);
  if (report.verdict == Verdict::visible && slot.seen != nullptr)
    memory.good_pixel = track_pixel(*slot.seen, memory);
}

Outcome TargetStage::feed(const TargetEstimate& estimate, std::int64_t stamp,
                          TargetRecord& memory) const {
  const auto verdict = memory.log.find(stamp);
  if (!verdict || !verdict->was_judged) return Outcome::refused_verdict;
  const auto poses = recent_frames_.poses_at(stamp);
  if (!poses || !poses->known()) return Outcome::refused_verdict;
  if (!is_known(estimate.frame, robot_) || is_doubted(estimate.frame, *poses, robot_))
    return Outcome::refused_invalid;
  const Eigen::Isometry3d T_root_frame = pose_of(estimate.frame, *poses, robot_);
  if (is_in_camera(estimate, poses->T_root_camera.inverse() * T_root_frame))
    return Outcome::refused_invalid;
  return memory.track->update(estimate, *verdict, T_root_frame);
}

void TargetStage::forget(std::string_view name) {
  const auto found = memories_.find(name);
  if (found != memories_.end()) memories_.erase(found);
  judge_.forget(name);
}

void TargetStage::forget_all() {
  for (const auto& [name, memory] : memories_) judge_.forget(name);
  memories_.clear();
  recent_frames_.clear();
  newest_stamp_.reset();
}

}  // namespace penumbra
