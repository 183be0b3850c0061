// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/occlusion/target_sight-inl.hpp>

namespace penumbra {
namespace {

double bad_share(const Sight& sight, bool others_hide) {
  return sight.hidden(others_hide) + sight.fraction(Seen::unknown);
}

bool is_out_of_view(const Sight& sight, const TargetThresholds& thresholds) {
  return static_cast<double>(sight.inside) <=
         thresholds.min_inside * static_cast<double>(sight.covered);
}

Verdict next_level(Verdict level, double hidden, const TargetThresholds& t) {
  if (hidden > (level == Verdict::hidden ? t.hidden_leave : t.hidden_enter)) return Verdict::hidden;
  if (hidden > (level == Verdict::visible ? t.partial_enter : t.partial_leave))
    return Verdict::partial;
  return Verdict::visible;
}

/// Whether some of the robot lies at most `reach` pixels from the box around some spans.
bool lies_near_robot(const LabelledFrame& frame, std::span<const RowSpan> spans, int reach) {
  if (spans.empty()) return false;
  const SpanBox box = box_of_spans(spans);
  const int u0 = std::max(box.u0 - reach, 0), u1 = std::min(box.u1 + reach, frame.width - 1);
  const int v0 = std::max(box.v0 - reach, 0), v1 = std::min(box.v1 + reach, frame.height - 1);
  if (!frame.robot_may_lie_in(u0, u1, v0, v1)) return false;
  for (int v = v0; v <= v1; ++v) {
    const int count = u1 - u0 + 1;
    if (first_set(frame.images.labels.labels.row(v) + u0, count) < count) return true;
  }
  return false;
}

}  // namespace

double Sight::fraction(Seen seen) const {
  return inside == 0 ? 0.0 : static_cast<double>(pixels[seen]) / static_cast<double>(inside);
}

void Sight::doubt(Seen seen, std::size_t& count) {
  const std::size_t some = std::min(count, pixels[seen]);
  pixels[seen] -= some;
  pixels[Seen::unknown] += some;
  count -= some;
}

Sight Sights::look_at(const Look& at, const RegionSpans& extent, ExtentTally& tally) {
  tally_extent(at.frame, extent.spans(), at.expected, at.target.thresholds.beyond_hides, tally);
  return {.covered = extent.covered(),
          .inside = extent.inside(),
          .pixels = tally.pixels,
          .links = &tally.links};
}

Sight Sights::look(const Look& at, const TargetMemory& memory) {
  if (!at.frame.has_pose()) {
    seen_tally_.clear();
    Sight none{.covered = seen_.covered(),
               .inside = seen_.inside(),
               .links = &seen_tally_.links,
               .has_pose = false};
    none.pixels[Seen::unknown] = seen_.inside();
    return none;
  }
  const Sight now = look_at(at, seen_, seen_tally_);
  return at.target.extent == Extent::modal ? look_modal(at, memory, now) : now;
}

Sight Sights::look_modal(const Look& at, const TargetMemory& memory, const Sight& now) {
  near_robot_ = lies_near_robot(at.frame, seen_.spans(), at.reach);
  if (is_out_of_view(now, at.target.thresholds)) return now;
  if (memory.extent.empty()) {
    Sight first = now;
    first.first_near_robot = near_robot_;
    return first;
  }
  const std::optional<Eigen::Vector2d>& motion = at.target.motion;
  last_.fill_moved(memory.extent, memory.moved + motion.value_or(Eigen::Vector2d::Zero()));
  const bool is_recent = at.number - memory.extent_frame <= TargetJudge::extent_frames;
  const bool has_place = last_.inside() > 0 && (motion || is_recent);
  const std::size_t whole = motion && has_place ? last_.inside() : memory.extent_pixels;
  const auto least = (1 - at.target.thresholds.partial_enter) * static_cast<double>(whole);
  if (static_cast<double>(now.inside) >= least) return now;

  const std::size_t missing = near_robot_ ? whole - now.inside : 0;
  if (has_place) {
    const Sight last = look_last(at, missing);
    const bool others_hide = at.target.thresholds.others_hide;
    return bad_share(last, others_hide) >= bad_share(now, others_hide) ? last : now;
  }
  Sight shrunk = now;
  shrunk.covered += missing;
  shrunk.inside += missing;
  shrunk.pixels[Seen::unknown] += missing;
  shrunk.is_missing = missing > 0;
  return shrunk;
}

Sight Sights::look_last(const Look& at, std::size_t missing) {
  Sight last = look_at(at, last_, last_tally_);
  const SeenCounts& pixels = last.pixels;
  const std::size_t known = pixels[Seen::occluded] + pixels[Seen::other] + pixels[Seen::unknown];
  std::size_t doubted = missing - std::min(missing, known);
  last.is_missing = doubted > 0;
  last.doubt(Seen::clear, doubted);
  last.doubt(Seen::front, doubted);
  return last;
}

void Sights::remember(const std::optional<Eigen::Vector2d>& motion, std::uint64_t number,
                      TargetMemory& memory) const {
  if (seen_.inside() >= memory.extent_pixels || !near_robot_) {
    memory.extent.assign(seen_.spans().begin(), seen_.spans().end());
    memory.extent_pixels = seen_.inside();
    memory.moved.setZero();
    memory.extent_frame = number;
  } else if (motion) {
    memory.moved += *motion;
    memory.extent_frame = number;
  }
}

Verdict decide(const Sight& sight, const TargetThresholds& thresholds, TargetMemory& memory) {
  if (is_out_of_view(sight, thresholds)) return Verdict::out_of_view;
  if (!sight.has_pose) return Verdict::unknown;
  const double hidden = sight.hidden(thresholds.others_hide);
  const double unknown = sight.first_near_robot ? 1 - hidden : sight.fraction(Seen::unknown);
  const double limit =
      sight.first_near_robot ? 0 : thresholds.unknown_limit.value_or(thresholds.partial_enter);
  const Verdict level = next_level(memory.level, hidden, thresholds);
  if (unknown > limit && next_level(memory.level, hidden + unknown, thresholds) != level)
    return Verdict::unknown;
  memory.level = level;
  return level;
}

}  // namespace penumbra
