// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include <penumbra/occlusion/extent_tally-inl.hpp>

namespace penumbra {
namespace {

/// Fringe hides nothing, and its depth measures nothing.
bool is_fringe(std::uint8_t label) { return label == static_cast<std::uint8_t>(Label::fringe); }

bool is_seen(Seen seen) { return seen == Seen::clear || seen == Seen::front; }

Seen seen_without_depth(std::uint8_t label, bool beyond_hides) {
  switch (static_cast<Label>(label)) {
    case Label::clear:
    case Label::fringe:
      return Seen::clear;
    case Label::front:
      return Seen::front;
    case Label::occluded:
      return Seen::occluded;
    case Label::beyond:
      return beyond_hides ? Seen::occluded : Seen::clear;
    case Label::unknown:
      break;
  }
  return Seen::unknown;
}

/// The table of docs/targets-judging.md. `d`: 0 without a measurement; `z`: of the robot, 0 where
/// it is not on the ray.
Seen seen_at_depth(std::uint8_t value, float z, float d, DepthLimits target, bool beyond_hides) {
  const auto label = static_cast<Label>(value);
  const bool before = d > 0.0f && d < target.near;
  if (is_fringe(value)) return Seen::clear;
  if (label == Label::clear || (label == Label::beyond && !beyond_hides))
    return before ? Seen::other : Seen::clear;
  if (!(z > 0.0f)) return Seen::unknown;  // where the lens model does not reach
  if (z < target.near) return Seen::occluded;
  if (before) return label == Label::front ? Seen::other : Seen::occluded;
  if (label == Label::front) return Seen::front;
  return z > target.far ? Seen::clear : Seen::unknown;
}

/// Calls f(u0, u1, touched) for the parts of a span inside and outside of some tiles.
template <typename F>
void for_each_part(const TileMask* tiles, const RowSpan& span, F&& f) {
  if (tiles == nullptr) return f(span.u0, span.u1, true);
  const int shift = std::countr_zero(static_cast<unsigned>(tiles->tile_width));
  const std::uint64_t row = tiles->rows[static_cast<std::size_t>(span.v / TileMask::tile_height)];
  for (int u = span.u0; u < span.u1;) {
    const int tile = u >> shift;
    const std::uint64_t bits = row >> tile;
    const bool touched = (bits & 1) != 0;
    const int count = touched ? std::countr_one(bits) : std::countr_zero(bits);
    const int end = tile + count >= 64 ? span.u1 : std::min(span.u1, (tile + count) << shift);
    f(u, end, touched);
    u = end;
  }
}

/// Goes by labels alone. `measured(v)` gives a row's depths.
template <typename Depths>
class LabelTally {
 public:
  LabelTally(const LabelledFrame& frame, bool beyond_hides, ExtentTally& tally,
             const Depths& measured)
      : images_(frame.images), beyond_hides_(beyond_hides), tally_(tally), measured_(measured) {}

  void add(const RowSpan& span) {
    for_each_part(images_.labels.touched, span, [&](int u0, int u1, bool touched) {
      if (touched)
        add_runs(span.v, u0, u1);
      else
        add_seen(Seen::clear, span.v, u0, u1);
    });
  }

 private:
  void add_seen(Seen seen, int v, int u0, int u1) {
    const auto measured = measured_(v);
    std::int32_t count = 0;  // as wide as a depth: so the compiler takes vectors
    for (int u = u0; u < u1; ++u) count += measured.is_measured(u) ? 1 : 0;
    tally_.measured += static_cast<std::size_t>(count);
    tally_.pixels[seen] += static_cast<std::size_t>(u1 - u0);
  }

  void add_runs(int v, int u0, int u1) {
    const std::uint8_t* const row = images_.labels.labels.row(v);
    for (const std::uint8_t *p = row + u0, *end = row + u1; p < end;) {
      const std::uint8_t* const next = end_of_run(p, end);
      const Seen seen = seen_without_depth(*p, beyond_hides_);
      const int u0_run = static_cast<int>(p - row), u1_run = static_cast<int>(next - row);
      if (is_seen(seen) && !is_fringe(*p))
        add_seen(seen, v, u0_run, u1_run);
      else
        tally_.pixels[seen] += static_cast<std::size_t>(next - p);
      if (seen == Seen::occluded) blame(v, u0_run, u1_run);
      p = next;
    }
  }

  void blame(int v, int u0, int u1) {
    const ImageView<const std::uint16_t>& links = images_.virtual_depth.links;
    if (links.empty()) return;
    for (const std::uint16_t *p = links.row(v) + u0, *end = links.row(v) + u1; p < end;) {
      const std::uint16_t* const next = end_of_run(p, end);
      tally_.links.add(*p, static_cast<std::size_t>(next - p));
      p = next;
    }
  }

  const JudgedImages& images_;
  bool beyond_hides_;
  ExtentTally& tally_;
  const Depths& measured_;
};

/// As LabelTally, where the target's depth is known: `limits(v)` gives, by u, a row's limits and
/// `measured(v)` its depths.
template <typename Limits, typename Depths>
class DepthTally {
 public:
  DepthTally(const LabelledFrame& frame, bool beyond_hides, ExtentTally& tally,
             const Limits& limits, const Depths& measured)
      : images_(frame.images),
        beyond_hides_(beyond_hides),
        tally_(tally),
        limits_(limits),
        measured_(measured) {}

  void add(const RowSpan& span) {
    for_each_part(images_.labels.touched, span, [&](int u0, int u1, bool touched) {
      if (touched)
        add_pixels(span.v, u0, u1);
      else
        add_clear(span.v, u0, u1);
    });
  }

 private:
  void add_clear(int v, int u0, int u1) {
    const auto limits = limits_(v);
    const auto measured = measured_(v);
    std::int32_t all = 0, nearer = 0, farther = 0;  // as wide as a depth: for vectors
    for (int u = u0; u < u1; ++u) {
      all += measured.is_measured(u) ? 1 : 0;
      nearer += measured.is_before(u, limits(u).near) ? 1 : 0;
      farther += measured.is_past(u, limits(u).far) ? 1 : 0;
    }
    const auto before = static_cast<std::size_t>(nearer);
    tally_.measured += static_cast<std::size_t>(all - nearer);
    tally_.past += static_cast<std::size_t>(farther);
    tally_.pixels[Seen::other] += before;
    tally_.pixels[Seen::clear] += static_cast<std::size_t>(u1 - u0) - before;
  }

  void add_pixels(int v, int u0, int u1) {
    const auto limits = limits_(v);
    const auto measured = measured_(v);
    const std::uint8_t* const labels = images_.labels.labels.row(v);
    const float* const robot = images_.virtual_depth.depth.row(v);
    const bool has_links = !images_.virtual_depth.links.empty();
    const std::uint16_t* const links = has_links ? images_.virtual_depth.links.row(v) : nullptr;
    std::size_t measured_count = 0, past = 0;
    Run run;  // of pixels seen alike: counting them one by one in memory costs more
    for (int u = u0; u < u1; ++u) {
      const DepthLimits target = limits(u);
      const Seen seen = seen_at_depth(labels[u], robot[u], measured[u], target, beyond_hides_);
      const bool is_measured = is_seen(seen) && !is_fringe(labels[u]);
      measured_count += is_measured && measured.is_measured(u);
      past += is_measured && measured.is_past(u, target.far);
      const std::uint16_t link = seen == Seen::occluded && has_links ? links[u] : 0;
      if (seen != run.seen || link != run.link) {
        add(run);
        run = {seen, link, 0};
      }
      ++run.pixels;
    }
    add(run);
    tally_.measured += measured_count;
    tally_.past += past;
  }

  struct Run {
    Seen seen = Seen::clear;
    std::uint16_t link = 0;  // of a link image
    std::size_t pixels = 0;
  };

  void add(const Run& run) {
    tally_.pixels[run.seen] += run.pixels;
    if (run.pixels > 0) tally_.links.add(run.link, run.pixels);
  }

  const JudgedImages& images_;
  bool beyond_hides_;
  ExtentTally& tally_;
  const Limits& limits_;
  const Depths& measured_;
};

struct NoDepths {
  float operator[](int /*u*/) const { return 0.0f; }
  [[nodiscard]] bool is_before(int /*u*/, float /*limit*/) const { return false; }
  [[nodiscard]] bool is_past(int /*u*/, float /*limit*/) const { return false; }
  [[nodiscard]] bool is_measured(int /*u*/) const { return false; }
};

/// Calls f(measured): `measured(v)` gives, by u, a row's depths.
template <typename F>
void with_depths(const LabelledFrame& frame, F&& f) {
  if (!frame.is_measured()) return f([](int /*v*/) { return NoDepths{}; });
  std::visit(
      [&](const auto& image) {
        const Measured measured(image, *frame.rule);
        f([&](int v) { return measured.row(v); });
      },
      frame.images.measured);
}

}  // namespace

LabelledFrame::LabelledFrame(const JudgedImages& judged, const labelling::Rule& label_rule,
                             bool has_outside)
    : images(judged),
      rule(&label_rule),
      width(judged.labels.labels.width),
      height(judged.labels.labels.height),
      is_outside_undrawn(has_outside) {}

bool LabelledFrame::robot_may_lie_in(int u0, int u1, int v0, int v1) const {
  u0 = std::max(u0, 0), v0 = std::max(v0, 0);
  u1 = std::min(u1, width - 1), v1 = std::min(v1, height - 1);
  if (u0 > u1 || v0 > v1) return false;
  const TileMask* const tiles = images.labels.touched;
  if (tiles == nullptr) return true;
  const std::uint64_t upto = ~std::uint64_t{0} >> (63 - u1 / tiles->tile_width);
  const std::uint64_t columns = upto & (~std::uint64_t{0} << (u0 / tiles->tile_width));
  for (int j = v0 / TileMask::tile_height; j <= v1 / TileMask::tile_height; ++j)
    if ((tiles->rows[static_cast<std::size_t>(j)] & columns) != 0) return true;
  return false;
}

bool LabelledFrame::robot_lies_in(int u0, int u1, int v) const {
  const std::uint8_t* const labels = images.labels.labels.row(v);
  const float* const z = is_outside_undrawn ? images.virtual_depth.depth.row(v) : nullptr;
  for (int u = u0; u <= u1; ++u) {
    u += first_set(labels + u, u1 + 1 - u);
    if (u <= u1 && !is_fringe(labels[u]) && (z == nullptr || z[u] > 0.0f)) return true;
  }
  return false;
}

void LinkCounts::clear() {
  for (const std::size_t link : touched_) counts_[link] = 0;
  touched_.clear();
}

std::span<const Blame> LinkCounts::write(std::size_t pixels, std::vector<Blame>& blame) const {
  blame.clear();
  for (const std::size_t link : touched_)
    blame.push_back({link, static_cast<double>(counts_[link]) / static_cast<double>(pixels)});
  std::sort(blame.begin(), blame.end(), [](const Blame& a, const Blame& b) {
    return a.fraction != b.fraction ? a.fraction > b.fraction : a.link < b.link;
  });
  return blame;
}

void tally_extent(const LabelledFrame& frame, std::span<const RowSpan> spans,
                  const ExpectedDepth& expected, bool beyond_hides, ExtentTally& tally) {
  tally.clear();
  with_depths(frame, [&](const auto& measured) {
    if (!expected.known()) {
      LabelTally adder(frame, beyond_hides, tally, measured);
      for (const RowSpan& span : spans) adder.add(span);
      return;
    }
    with_limits(*frame.rule, expected, [&](const auto& limits) {
      DepthTally adder(frame, beyond_hides, tally, limits, measured);
      for (const RowSpan& span : spans) adder.add(span);
    });
  });
}

}  // namespace penumbra
