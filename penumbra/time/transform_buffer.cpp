// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/time/source_tracks.hpp>
#include <penumbra/time/transform_buffer.hpp>

namespace penumbra {
namespace {

std::string_view without_slash(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return name;
}

bool is_frame_name(std::string_view name) {
  return !name.empty() && name.size() <= TransformBuffer::max_name_length;
}

std::string frame_quoted(std::string_view name) {
  return "'" + std::string(name.substr(0, TransformBuffer::max_name_length)) + "'";
}

std::string stamp_text(std::int64_t stamp) { return std::to_string(stamp) + " ns"; }

std::string gap_text(std::int64_t a, std::int64_t b) {
  return std::to_string(stamp_distance(a, b) / 1'000'000) + " ms";
}

}  // namespace

struct TransformBuffer::Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

struct TransformBuffer::PoseRule {
  /// Accepted difference of sources at rest, metres, as for joint states and TF.
  static constexpr double noise_of_poses = 0.005;
  static constexpr double lever = 0.5;  ///< metres by which a rotation counts as an arc
  static constexpr bool one_value_of_a_stamp = true;

  [[nodiscard]] double distance(const Pose& a, const Pose& b) const;
  [[nodiscard]] Pose interpolate(const Pose& a, double fraction, const Pose& b) const;
  [[nodiscard]] double noise() const { return noise_of_poses; }
};

struct TransformBuffer::FrameNode {
  std::string name;
  std::size_t parent = none;
  bool is_static = false;
  Pose fixed;                           // if static
  SourceTracks<Pose, PoseRule> states;  // if not
};

TransformBuffer::~TransformBuffer() = default;
TransformBuffer::TransformBuffer(TransformBuffer&&) noexcept = default;
TransformBuffer& TransformBuffer::operator=(TransformBuffer&&) noexcept = default;

TransformBuffer::Pose TransformBuffer::pose_of(const Eigen::Isometry3d& T) {
  return {Eigen::Quaterniond(T.linear()).normalized(), T.translation()};
}

double TransformBuffer::PoseRule::distance(const Pose& a, const Pose& b) const {
  return std::max((a.translation - b.translation).norm(),
                  lever * a.rotation.angularDistance(b.rotation));
}

TransformBuffer::Pose TransformBuffer::PoseRule::interpolate(const Pose& a, double fraction,
                                                             const Pose& b) const {
  return {a.rotation.slerp(fraction, b.rotation),
          a.translation + fraction * (b.translation - a.translation)};
}

TransformBuffer::TransformBuffer(const TransformBufferOptions& options)
    : max_gap_(span_nanoseconds(options.max_gap, "transform buffer: max_gap")),
      history_(span_nanoseconds(options.history, "transform buffer: history")),
      options_(options) {
  if (options.max_states == 0 || options.max_frames == 0 || options.max_depth == 0)
    throw InputError(
        "transform buffer: max_states, max_frames and max_depth must each be at least 1");
}

TransformInsert TransformBuffer::insert(std::int64_t stamp, std::string_view parent,
                                        std::string_view child,
                                        const Eigen::Isometry3d& T_parent_child,
                                        std::string_view source) {
  TransformInsert outcome;
  FrameNode* const frame = place(stamp, parent, child, T_parent_child, outcome);
  if (frame == nullptr) return outcome;
  frame->states.put({stamp, pose_of(T_parent_child)}, source);
  frame->states.prune(stamp_after(*frame->states.newest(), -history_), options_.max_states);
  return outcome;
}

TransformInsert TransformBuffer::insert_static(std::string_view parent, std::string_view child,
                                               const Eigen::Isometry3d& T_parent_child) {
  TransformInsert outcome;
  if (FrameNode* const frame = place(std::nullopt, parent, child, T_parent_child, outcome))
    frame->fixed = pose_of(T_parent_child);
  return outcome;
}

TransformBuffer::FrameNode* TransformBuffer::place(std::optional<std::int64_t> stamp,
                                                   std::string_view parent, std::string_view child,
                                                   const Eigen::Isometry3d& T_parent_child,
                                                   TransformInsert& outcome) {
  parent = without_slash(parent);
  child = without_slash(child);
  outcome = judge(stamp, parent, child, T_parent_child);
  ++counts_[static_cast<std::size_t>(outcome)];
  if (outcome != TransformInsert::taken) {
    last_refusal_ = describe(outcome, parent, child);
    return nullptr;
  }
  const std::size_t above = find_or_add(parent);
  FrameNode& frame = frames_[find_or_add(child)];
  frame.parent = above;
  frame.is_static = !stamp;
  return &frame;
}

TransformInsert TransformBuffer::judge(std::optional<std::int64_t> stamp, std::string_view parent,
                                       std::string_view child, const Eigen::Isometry3d& T) const {
  if (!is_frame_name(parent) || !is_frame_name(child)) return TransformInsert::bad_name;
  if (stamp && *stamp <= 0) return TransformInsert::no_stamp;
  if (!is_rigid(T) || T.translation().cwiseAbs().maxCoeff() > max_translation)
    return TransformInsert::not_rigid;
  return judge_tree(!stamp, parent, child);
}

TransformInsert TransformBuffer::judge_tree(bool is_static, std::string_view parent,
                                            std::string_view child) const {
  if (parent == child) return TransformInsert::loop;
  const auto below = find(child);
  const auto above = find(parent);
  if (below && frames_[*below].parent != none) {
    if (frames_[*below].parent != above.value_or(none)) return TransformInsert::second_parent;
    return frames_[*below].is_static == is_static ? TransformInsert::taken
                                                  : TransformInsert::static_and_free;
  }
  for (std::size_t i = above.value_or(none); below && i != none; i = frames_[i].parent)
    if (i == *below) return TransformInsert::loop;
  const std::size_t added = (below ? 0 : 1) + (above ? 0 : 1);
  return frames_.size() + added > options_.max_frames ? TransformInsert::too_many_frames
                                                      : TransformInsert::taken;
}

std::string TransformBuffer::describe(TransformInsert why, std::string_view parent,
                                      std::string_view child) const {
  const std::string which =
      "transform of frame " + frame_quoted(child) + " in " + frame_quoted(parent) + " refused: ";
  switch (why) {
    case TransformInsert::taken:
      break;
    case TransformInsert::bad_name:
      return which + "a frame's name has 1 to 256 characters";
    case TransformInsert::no_stamp:
      return which + "it has no stamp";
    case TransformInsert::not_rigid:
      return which + "it is not a rotation with a finite translation";
    case TransformInsert::loop:
      return which + "the parent is a descendant of the child";
    case TransformInsert::second_parent:
      return which + "the child has the parent " +
             frame_quoted(frames_[frames_[*find(child)].parent].name) + " already";
    case TransformInsert::static_and_free:
      return which + "the child was published as " +
             (frames_[*find(child)].is_static ? "static" : "moving") + " before";
    case TransformInsert::too_many_frames:
      return which + "there are " + std::to_string(frames_.size()) + " frames already";
  }
  return {};
}

std::size_t TransformBuffer::find_or_add(std::string_view name) {
  if (const auto known = find(name)) return *known;
  frames_.push_back({std::string(name),
                     none,
                     false,
                     {},
                     SourceTracks<Pose, PoseRule>({}, max_gap_, options_.compare_sources)});
  index_.emplace(name, frames_.size() - 1);
  return frames_.size() - 1;
}

std::optional<std::size_t> TransformBuffer::find(std::string_view name) const {
  const auto at = index_.find(name);
  if (at == index_.end()) return std::nullopt;
  return at->second;
}

std::size_t TransformBuffer::depth_of(std::size_t frame) const {
  std::size_t depth = 0;
  for (; frames_[frame].parent != none; frame = frames_[frame].parent) ++depth;
  return depth;
}

std::optional<TransformBuffer::Chain> TransformBuffer::find_chain(std::string_view target,
                                                                  std::string_view source) const {
  const auto to = find(target);
  const auto from = find(source);
  if (!to || !from) return std::nullopt;
  Chain chain{*to, *from, *from, 0, 0};
  std::size_t other = *to;
  const std::size_t from_depth = depth_of(*from);
  const std::size_t to_depth = depth_of(*to);
  const auto up = [&](std::size_t& frame, std::size_t& steps) {
    frame = frames_[frame].parent;
    ++steps;
  };
  while (chain.source_depth + to_depth < from_depth) up(chain.meeting, chain.source_depth);
  while (chain.target_depth + from_depth < to_depth) up(other, chain.target_depth);
  while (chain.meeting != other) {
    up(chain.meeting, chain.source_depth);
    up(other, chain.target_depth);
    if (chain.meeting == none || other == none) return std::nullopt;
  }
  if (chain.source_depth + chain.target_depth > options_.max_depth) return std::nullopt;
  return chain;
}

std::string TransformBuffer::no_chain(std::string_view target, std::string_view source) const {
  const std::string which =
      "no transform from frame " + frame_quoted(source) + " to " + frame_quoted(target) + ": ";
  const auto root_of = [&](std::string_view name) -> const FrameNode& {
    std::size_t frame = *find(name);
    while (frames_[frame].parent != none) frame = frames_[frame].parent;
    return frames_[frame];
  };
  for (const std::string_view name : {source, target})
    if (!find(name)) {
      const std::string prefixed = "/" + std::string(name);
      const auto is_prefixed = [&](const FrameNode& frame) {
        return frame.name.ends_with(prefixed);
      };
      const auto other = std::ranges::find_if(frames_, is_prefixed);
      return which + frame_quoted(name) + " was never seen" +
             (other == frames_.end() ? ""
                                     : ", but " + frame_quoted(other->name) +
                                           " was: set frame_prefix, or camera_frame");
    }
  const FrameNode& above = root_of(source);
  const FrameNode& other = root_of(target);
  if (&above == &other)
    return which + "more than " + std::to_string(options_.max_depth) + " frames lie between";
  return which + "their roots are " + frame_quoted(above.name) + " and " +
         frame_quoted(other.name) + ", which are not connected";
}

void TransformBuffer::at(std::int64_t stamp, std::string_view target, std::string_view source,
                         TransformAnswer& answer) const {
  target = without_slash(target);
  source = without_slash(source);
  answer.status = TransformStatus::missing;
  answer.age = 0;
  answer.is_static = true;
  answer.message.clear();
  const auto found = find_chain(target, source);
  if (!found) {
    answer.message = no_chain(target, source);
    return;
  }
  Pose from_source, from_target;  // to the frame where they meet
  answer.status = TransformStatus::stale;
  if (!climb(found->source, found->meeting, stamp, from_source, answer)) return;
  if (!climb(found->target, found->meeting, stamp, from_target, answer)) return;
  answer.status = TransformStatus::ok;
  const Eigen::Quaterniond back = from_target.rotation.conjugate();
  answer.T_target_source.linear() = (back * from_source.rotation).toRotationMatrix();
  answer.T_target_source.translation() = back * (from_source.translation - from_target.translation);
}

bool TransformBuffer::climb(std::size_t from, std::size_t to, std::int64_t stamp, Pose& T_to_from,
                            TransformAnswer& answer) const {
  for (; from != to; from = frames_[from].parent) {
    Pose step;
    if (!interpolate(frames_[from], stamp, step, answer)) {
      explain_stale(frames_[from], stamp, answer);
      return false;
    }
    if (frames_[from].states.disagreement_near(stamp) != nullptr) {
      explain_disputed(frames_[from], stamp, answer);
      return false;
    }
    T_to_from.translation = step.rotation * T_to_from.translation + step.translation;
    T_to_from.rotation = step.rotation * T_to_from.rotation;
  }
  return true;
}

bool TransformBuffer::interpolate(const FrameNode& frame, std::int64_t stamp, Pose& pose,
                                  TransformAnswer& answer) const {
  if (frame.is_static) {
    pose = frame.fixed;
    return true;
  }
  answer.is_static = false;
  const auto around = frame.states.around(stamp);
  if (!around) return false;
  const auto &a = *around.before, &b = *around.after;
  if (a.value.rotation.angularDistance(b.value.rotation) > max_turn) return false;
  pose = frame.states.interpolate(around, stamp);
  answer.age = std::max({answer.age, stamp - a.stamp, b.stamp - stamp});
  return true;
}

void TransformBuffer::explain_stale(const FrameNode& frame, std::int64_t stamp,
                                    TransformAnswer& answer) const {
  answer.message = "transform of frame " + frame_quoted(frame.name) + " in " +
                   frame_quoted(frames_[frame.parent].name) + " is not known at " +
                   stamp_text(stamp) + ": ";
  const auto* const believed = frame.states.believed_at(stamp);
  if (believed == nullptr) {
    answer.message += "its publisher's states were dropped";
    return;
  }
  const auto all = believed->track.states();
  const auto before = believed->track.up_to(stamp);
  if (before.empty())
    answer.message += "its first state is " + gap_text(stamp, all.front().stamp) + " later";
  else if (before.size() == all.size())
    answer.message += "its last state is " + gap_text(stamp, all.back().stamp) + " older";
  else if (const auto& next = all[before.size()];
           stamp_distance(before.back().stamp, next.stamp) > static_cast<std::uint64_t>(max_gap_))
    answer.message +=
        "the states around it are " + gap_text(before.back().stamp, next.stamp) + " apart";
  else
    answer.message += "it turns by more than a right angle between two states";
  if (frame.states.has_several_sources())
    answer.message += ", by " + *believed->name + std::string(others_unused);
}

void TransformBuffer::explain_disputed(const FrameNode& frame, std::int64_t stamp,
                                       TransformAnswer& answer) const {
  const auto& found = *frame.states.disagreement_near(stamp);
  const auto& sources = found.value.sources;
  const auto& values = found.value.values;
  answer.status = TransformStatus::disputed;
  std::ostringstream text;
  text.precision(3);
  text << "transform of frame " << frame_quoted(frame.name) << " in "
       << frame_quoted(frames_[frame.parent].name) << " is published twice, "
       << 1e3 * PoseRule().distance(values[0], values[1]) << " mm apart, at "
       << stamp_text(found.stamp) << " by " << *sources[0];
  if (sources[0] != sources[1]) text << " and by " << *sources[1];
  answer.message = text.str();
}

bool TransformBuffer::knows(std::string_view frame) const {
  return find(without_slash(frame)).has_value();
}

std::optional<std::int64_t> TransformBuffer::newest_of(std::string_view child) const {
  const auto frame = find(without_slash(child));
  return frame ? frames_[*frame].states.newest() : std::nullopt;
}

void TransformBuffer::clear() {
  for (FrameNode& frame : frames_) {
    if (frame.is_static) continue;
    frame.parent = none;
    frame.states.clear();
  }
}

std::size_t TransformBuffer::count(TransformInsert outcome) const {
  return counts_[static_cast<std::size_t>(outcome)];
}

std::size_t TransformBuffer::refused() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0}) -
         count(TransformInsert::taken);
}

}  // namespace penumbra
