// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <penumbra/targets/extent_tally.hpp>

namespace penumbra {
namespace {

Verdict next_level(Verdict level, double hidden, const TargetThresholds& t) {
  if (hidden > (level == Verdict::hidden ? t.hidden_leave : t.hidden_enter)) return Verdict::hidden;
  if (hidden > (level == Verdict::visible ? t.partial_enter : t.partial_leave))
    return Verdict::partial;
  return Verdict::visible;
}

/// Returns whether enough was seen for the verdicts visible and partial.
bool is_seen_enough(const ExtentTally& tally, Verdict level, const TargetThresholds& t) {
  if (level == Verdict::hidden) return true;
  const std::size_t least = level == Verdict::visible ? tally.pixels[PixelState::unknown] : 0;
  if (tally.seen() <= least) return false;
  return !tally.is_expected ||
         !(tally.is_passed(t.past_limit) || tally.is_unmeasured(t.min_measured));
}

Verdict decide(const ExtentTally& tally, const TargetThresholds& thresholds, TargetMemory& memory) {
  if (tally.inside < tally.needed) return Verdict::unknown;
  if (tally.is_out_of_view(thresholds)) return Verdict::out_of_view;
  if (!tally.has_pose) return Verdict::unknown;
  const double hidden = tally.hidden(thresholds.others_hide);
  const double unknown = tally.has_whole ? tally.fraction(PixelState::unknown) : 1 - hidden;
  // Missing pixels are not seen: unknown_limit does not apply then.
  const bool is_uncertain = !tally.has_whole || tally.is_missing;
  const double limit =
      is_uncertain ? 0 : thresholds.unknown_limit.value_or(thresholds.partial_enter);
  const Verdict level = next_level(memory.level, hidden, thresholds);
  if (unknown > limit && next_level(memory.level, hidden + unknown, thresholds) != level)
    return Verdict::unknown;
  if (!is_seen_enough(tally, level, thresholds)) return Verdict::unknown;
  memory.level = level;
  return level;
}

std::string reason_for_unknown(const ExtentTally& tally, const LabelledImages& images,
                               const TargetThresholds& thresholds) {
  if (!images.fault.empty()) return images.fault;
  if (tally.inside < tally.needed)
    return std::to_string(tally.inside) + " measured rays of the scan meet it";
  if (!tally.has_pose) return "the robot's pose is not known in this frame";
  if (!tally.has_whole)
    return "it was not seen whole away from the robot: how much of it the robot hides is not "
           "known; give its expected_depth or height, or the full extent as amodal";
  if (tally.is_missing)
    return "its mask is smaller than the whole target, and the robot is next to it";
  if (tally.is_expected && tally.is_passed(thresholds.past_limit))
    return "the sensor looks past where most of it is expected: it is absent or transparent, or "
           "its expected depth is wrong";
  if (tally.is_expected && tally.is_unmeasured(thresholds.min_measured))
    return "hardly anything is measured where it is expected; min_measured: 0 allows that";
  if (tally.is_uncovered) return "too much of it lies where the lens model does not reach";
  const bool is_assumed = images.evidence == Evidence::assumed_free;
  if (tally.is_expected)
    return is_assumed ? "too much of it is at the robot's own depth"
                      : "too much of it is robot without measurement, at the robot's own depth or "
                        "at its outline";
  return is_assumed
             ? "the robot is before or behind it: give its expected_depth, or its height"
             : "too much of it is robot without measurement; give expected_depth, or its height";
}

}  // namespace

void check_view(const TargetView& target) {
  const bool rendered = std::holds_alternative<RenderedRegion>(target.region);
  const std::optional<double>& depth = target.expected_depth;
  const double most = static_cast<double>(RenderedRegion::max_depth);
  if (rendered && target.extent == Extent::modal)
    region_fault("a rendered region is the full extent: amodal");
  if (rendered && depth) region_fault("a rendered region has its own expected depth: give none");
  if (rendered && target.thresholds.min_inside > 0)
    region_fault("min_inside ", target.thresholds.min_inside,
                 ": what of a rendered region lies outside of the image is not known: must be 0");
  if (depth && !(*depth > 0 && *depth <= most))
    region_fault("expected depth ", *depth, " m: must be above 0 and up to ", most);
  if (!(target.depth_margin >= 0 && target.depth_margin <= most))
    region_fault("depth margin ", target.depth_margin, " m: must be 0 to ", most);
  if (target.point_pixel && !target.point_pixel->allFinite())
    region_fault("point pixel: must be numbers");
  if (target.motion && !(target.motion->cwiseAbs().maxCoeff() <= max_coordinate))
    region_fault("motion: must be numbers up to ", max_coordinate, " pixels");
  target.thresholds.check();
}

void TargetThresholds::check() const {
  check_settings(*this);
  const auto check_order = [](const char* low_name, double low, const char* high_name,
                              double high) {
    if (low > high) region_fault(low_name, ' ', low, ": must not exceed ", high_name, ' ', high);
  };
  check_order("partial_leave", partial_leave, "partial_enter", partial_enter);
  check_order("hidden_leave", hidden_leave, "hidden_enter", hidden_enter);
  check_order("partial_enter", partial_enter, "hidden_enter", hidden_enter);
  check_order("partial_leave", partial_leave, "hidden_leave", hidden_leave);
}

void ExtentTally::clear() {
  covered = inside = measured = past = unmeasured = needed = 0;
  pixels = {};
  links.clear();
  depths.clear();
  is_expected = is_missing = is_uncovered = false;
  has_pose = has_whole = true;
}

void ExtentTally::mark_unknown(PixelState state, std::size_t& count) {
  const std::size_t some = std::min(count, pixels[state]);
  pixels[state] -= some;
  pixels[PixelState::unknown] += some;
  count -= some;
}

Judgement judgement_of(const ExtentTally& tally, const LabelledImages& images,
                       const TargetThresholds& thresholds, TargetMemory& memory) {
  Judgement judgement;
  judgement.verdict = decide(tally, thresholds, memory);
  if (judgement.verdict == Verdict::unknown)
    judgement.reason = reason_for_unknown(tally, images, thresholds);
  judgement.covered = tally.covered;
  judgement.inside = tally.inside;
  judgement.occluded = tally.fraction(PixelState::occluded);
  judgement.front = tally.fraction(PixelState::front);
  judgement.unknown = tally.fraction(PixelState::unknown);
  judgement.clear = tally.fraction(PixelState::clear);
  judgement.blame = tally.links.blame(tally.inside, images.link_names);
  if (images.evidence != Evidence::measured || !tally.has_pose) return judgement;
  judgement.measured = tally.share(tally.measured);
  if (!tally.is_expected) return judgement;
  judgement.hidden_by_other = tally.fraction(PixelState::other);
  judgement.seen_past = tally.share(tally.past);
  return judgement;
}

void distrust(const LabelledImages& images, Judgement& judgement) {
  if (images.undrawn.empty()) return;
  judgement.unknown += judgement.clear + judgement.front;
  judgement.clear = judgement.front = 0.0;
  judgement.measured.reset();
  judgement.seen_past.reset();
  if (judgement.verdict != Verdict::visible && judgement.verdict != Verdict::partial) return;
  judgement.verdict = Verdict::unknown;
  judgement.reason = images.undrawn;
}

}  // namespace penumbra
