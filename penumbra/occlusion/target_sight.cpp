// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/occlusion/target_sight-inl.hpp>

namespace penumbra {
namespace {

/// Networks draw masks at a quarter of the image's size, so that one of what the border cuts may
/// end so many pixels before it.
constexpr int border_margin = 4;

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

int width_of(const SpanBox& box) { return box.u1 - box.u0 + 1; }
int height_of(const SpanBox& box) { return box.v1 - box.v0 + 1; }

/// Nothing that was not seen is called visible, and nothing partial of which no pixel was.
bool is_seen_enough(const Sight& sight, Verdict level, const TargetThresholds& t) {
  if (level == Verdict::hidden) return true;
  const std::size_t least = level == Verdict::visible ? sight.pixels[Seen::unknown] : 0;
  if (sight.seen() <= least) return false;
  return !sight.is_expected ||
         !(sight.is_passed(t.past_limit) || sight.is_unmeasured(t.min_measured));
}

SpanBox grown(const SpanBox& box, int du, int dv) {
  return {box.u0 - du, box.u1 + du, box.v0 - dv, box.v1 + dv};
}

/// Whether some of the robot lies in a box, which may reach past the image.
bool holds_robot(const LabelledFrame& frame, const SpanBox& box) {
  const int u0 = std::max(box.u0, 0), u1 = std::min(box.u1, frame.width - 1);
  const int v0 = std::max(box.v0, 0), v1 = std::min(box.v1, frame.height - 1);
  if (!frame.robot_may_lie_in(u0, u1, v0, v1)) return false;
  for (int v = v0; v <= v1; ++v)
    if (frame.robot_lies_in(u0, u1, v)) return true;
  return false;
}

/// Whether a box reaches each border of the image that another one leaves it through.
bool follows_out(const LabelledFrame& frame, const SpanBox& box, const SpanBox& leaving) {
  return (leaving.u0 >= 0 || box.u0 == 0) && (leaving.v0 >= 0 || box.v0 == 0) &&
         (leaving.u1 < frame.width || box.u1 == frame.width - 1) &&
         (leaving.v1 < frame.height || box.v1 == frame.height - 1);
}

}  // namespace

double Sight::share(std::size_t count) const {
  return inside == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(inside);
}

double Sight::fraction(Seen seen) const { return share(pixels[seen]); }

void Sight::doubt(Seen seen, std::size_t& count) {
  const std::size_t some = std::min(count, pixels[seen]);
  pixels[seen] -= some;
  pixels[Seen::unknown] += some;
  count -= some;
}

void Sight::doubt_all() {
  pixels[Seen::unknown] += seen();
  pixels[Seen::clear] = pixels[Seen::front] = 0;
  measured = past = 0;
}

Sight Sights::look_at(const Look& at, const RegionSpans& extent, ExtentTally& tally) {
  tally_extent(at.frame, extent.spans(), at.expected, at.target.thresholds.beyond_hides, tally);
  Sight sight{.covered = extent.covered(),
              .inside = extent.inside(),
              .pixels = tally.pixels,
              .measured = tally.measured,
              .past = tally.past,
              .is_expected = at.expected.known(),
              .links = &tally.links};
  sight.unmeasured = sight.seen() - sight.measured;
  if (at.frame.images.is_blind) sight.doubt_all();
  return sight;
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
  if (is_out_of_view(now, at.target.thresholds)) return now;
  const SpanBox box = box_of_spans(seen_.spans());
  if (memory.extent.empty()) {
    Sight first = now;
    first.first_near_robot = holds_robot(at.frame, grown(box, at.reach, at.reach));
    return first;
  }
  Sight sight = compare(at, memory, now, box);
  if (memory.is_cut) {
    // There is more of it than was ever seen, perhaps as much again.
    const SpanBox last = box_of_spans(memory.extent);
    const int more =
        at.reach + std::max({width_of(box), height_of(box), width_of(last), height_of(last)});
    sight.is_cut = sight.first_near_robot = holds_robot(at.frame, grown(box, more, more));
  }
  return sight;
}

Sight Sights::compare(const Look& at, const TargetMemory& memory, const Sight& now,
                      const SpanBox& box) {
  const SpanBox whole_box = box_of_spans(memory.extent);
  may_replace_ = !holds_robot(
      at.frame, grown(box, at.reach + width_of(whole_box), at.reach + height_of(whole_box)));
  const bool has_place = place_last(at, memory, now, box);
  const std::size_t whole = has_place && at.target.motion ? last_.inside() : memory.extent_pixels;
  const auto least = (1 - at.target.thresholds.partial_enter) * static_cast<double>(whole);
  if (static_cast<double>(now.inside) >= least) return now;

  const bool is_near = lies_near_robot(at, box, whole_box);
  may_replace_ = may_replace_ && !is_near;
  const std::size_t missing = is_near ? whole - now.inside : 0;
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

/// Puts the last good extent where it is expected, and says whether it can be judged there. Motion
/// that carries it out of the image is believed where the mask goes with it: it lies at that
/// border, and is no larger than what is left.
bool Sights::place_last(const Look& at, const TargetMemory& memory, const Sight& now,
                        const SpanBox& box) {
  const std::optional<Eigen::Vector2d>& motion = at.target.motion;
  const Eigen::Vector2d by = memory.moved + motion.value_or(Eigen::Vector2d::Zero());
  last_.fill_moved(memory.extent, by);
  last_.keep(seen_pixels_);
  if (last_.inside() == 0) return false;
  if (!motion) return at.number - memory.extent_frame <= TargetJudge::extent_frames;
  if (last_.inside() == memory.extent_pixels) return true;
  SpanBox moved = box_of_spans(memory.extent);
  const int du = static_cast<int>(std::round(by.x())), dv = static_cast<int>(std::round(by.y()));
  moved = {moved.u0 + du, moved.u1 + du, moved.v0 + dv, moved.v1 + dv};
  const double most =
      (1 + at.target.thresholds.partial_enter) * static_cast<double>(last_.inside());
  return follows_out(at.frame, box, moved) && static_cast<double>(now.inside) <= most;
}

/// Whether the robot may hide what is missing in a mask: it lies near the last good extent, or as
/// near to the mask as what is missing can reach.
bool Sights::lies_near_robot(const Look& at, const SpanBox& box, const SpanBox& whole) const {
  const int du = std::max(width_of(whole) - width_of(box), 0);
  const int dv = std::max(height_of(whole) - height_of(box), 0);
  if (holds_robot(at.frame, grown(box, at.reach + du, at.reach + dv))) return true;
  return last_.inside() > 0 &&
         holds_robot(at.frame, grown(box_of_spans(last_.spans()), at.reach, at.reach));
}

Sight Sights::look_last(const Look& at, std::size_t missing) {
  Sight last = look_at(at, last_, last_tally_);
  const SeenCounts& pixels = last.pixels;
  const std::size_t known = pixels[Seen::occluded] + pixels[Seen::other] + pixels[Seen::unknown];
  std::size_t doubted = missing - std::min(missing, known);
  last.is_missing = missing > 0;
  last.doubt(Seen::clear, doubted);
  last.doubt(Seen::front, doubted);
  return last;
}

bool Sights::reaches_border() const {
  const std::span<const RowSpan> spans = seen_.spans();
  return std::any_of(spans.begin(), spans.end(), [&](const RowSpan& span) {
    for (const int dv : {-border_margin, 0, border_margin}) {
      const RowSpan around{span.v + dv, span.u0 - border_margin, span.u1 + border_margin};
      if (!seen_pixels_.hold(around, width_, height_)) return true;
    }
    return false;
  });
}

void Sights::remember(const std::optional<Eigen::Vector2d>& motion, std::uint64_t number,
                      TargetMemory& memory) const {
  if (seen_.inside() >= memory.extent_pixels || may_replace_) {
    memory.extent.assign(seen_.spans().begin(), seen_.spans().end());
    memory.extent_pixels = seen_.inside();
    memory.is_cut = reaches_border();
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
  // What its mask lacks is not seen: no limit passes over what else is unknown.
  const bool is_doubtful = sight.first_near_robot || sight.is_missing;
  const double limit =
      is_doubtful ? 0 : thresholds.unknown_limit.value_or(thresholds.partial_enter);
  const Verdict level = next_level(memory.level, hidden, thresholds);
  if (unknown > limit && next_level(memory.level, hidden + unknown, thresholds) != level)
    return Verdict::unknown;
  if (!is_seen_enough(sight, level, thresholds)) return Verdict::unknown;
  memory.level = level;
  return level;
}

}  // namespace penumbra
