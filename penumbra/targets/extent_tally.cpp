// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/targets/extent_tally.hpp>
#include <penumbra/targets/trusted_depth.hpp>

namespace penumbra {
namespace {

/// Fringe hides nothing, and its depth is not a measurement.
bool is_fringe(std::uint8_t label) { return label == static_cast<std::uint8_t>(Label::fringe); }

PixelState state_without_depth(std::uint8_t label, bool beyond_hides) {
  switch (static_cast<Label>(label)) {
    case Label::clear:
    case Label::fringe:
      return PixelState::clear;
    case Label::front:
      return PixelState::front;
    case Label::occluded:
      return PixelState::occluded;
    case Label::beyond:
      return beyond_hides ? PixelState::occluded : PixelState::clear;
    case Label::unknown:
      break;
  }
  return PixelState::unknown;
}

/// The table of docs/targets.md. `d`: 0 without a measurement; `z`: the robot's, 0 without robot.
PixelState state_at_depth(std::uint8_t value, float z, float d, DepthLimits target,
                          bool beyond_hides) {
  const auto label = static_cast<Label>(value);
  const bool before = d > 0.0f && d < target.near;
  if (is_fringe(value)) return PixelState::clear;
  if (label == Label::clear || (label == Label::beyond && !beyond_hides))
    return before ? PixelState::other : PixelState::clear;
  if (!(z > 0.0f)) return PixelState::unknown;  // outside the lens model
  if (z < target.near) return PixelState::occluded;
  if (before) return label == Label::front ? PixelState::other : PixelState::occluded;
  if (label == Label::front) return PixelState::front;
  return z > target.far ? PixelState::clear : PixelState::unknown;
}

template <typename T>
int end_of_run(const T* row, int u, int end) {
  const T value = row[u];
  while (u < end && row[u] == value) ++u;
  return u;
}

constexpr double golden_ratio = 0.6180339887498949;

int next_multiple(int number, int step) { return (number + step - 1) / step * step; }

/// Returns whether only a link of unknown pose could be at a pixel. It hides nothing for sure.
bool is_unplaced(const LabelledImages& images, std::uint16_t link) {
  return std::ranges::find(images.unplaced, link) != images.unplaced.end();
}

/// Counts pixels where nothing is measured, by the robot's depth: run by run of a link, in loops
/// that vectorise.
template <typename Limits>
void count_robot(const LabelledImages& images, const RowSpan& span, const Limits& limits_of,
                 ExtentTally& tally) {
  const auto limits = limits_of(span.v);
  const float* const robot = images.virtual_depth.depth.row(span.v);
  const bool has_links = !images.virtual_depth.links.empty();
  const bool has_labels = !images.labels.labels.empty();
  const std::uint16_t* const links = has_links ? images.virtual_depth.links.row(span.v) : nullptr;
  const std::uint8_t* const labels = has_labels ? images.labels.labels.row(span.v) : nullptr;
  std::size_t all_hidden = 0, all_unknown = 0;
  for_each_part(images.labels.touched, span, [&](int u0, int u1, bool touched) {
    for (int u = u0, end = u0; touched && u < u1; u = end) {
      end = has_links ? end_of_run(links, u, u1) : u1;
      const std::uint16_t link = has_links ? links[u] : 0;
      std::int32_t hidden = 0, unknown = 0;  // as wide as a depth
      if (is_unplaced(images, link)) {
        unknown = end - u;
      } else if (link != 0 || !has_links) {
        for (int i = u; i < end; ++i) {
          const bool is_robot = robot[i] > 0.0F, hides = robot[i] < limits(i).near;
          hidden += is_robot & hides;
          unknown += is_robot & !hides & (robot[i] <= limits(i).far);
        }
      }
      if (link == 0 && has_labels)  // outside the lens model
        for (int i = u; i < end; ++i)
          unknown += !(robot[i] > 0.0F) & (labels[i] == static_cast<std::uint8_t>(Label::unknown));
      tally.links.add(hidden > 0 ? link : 0, static_cast<std::size_t>(hidden));
      all_hidden += static_cast<std::size_t>(hidden);
      all_unknown += static_cast<std::size_t>(unknown);
    }
  });
  tally.pixels[PixelState::occluded] += all_hidden;
  tally.pixels[PixelState::unknown] += all_unknown;
  tally.pixels[PixelState::clear] +=
      static_cast<std::size_t>(span.u1 - span.u0) - all_hidden - all_unknown;
}

/// Counts pixels and collects depths of a frame with measurements. `limits_of(v)` returns the
/// limits of a row's pixels by u.
template <typename Limits, typename Depth>
class ExtentReader {
 public:
  ExtentReader(const LabelledImages& images, bool has_depth, bool beyond_hides,
               const Limits& limits_of, const Measured<Depth>& depths, ExtentTally& tally)
      : images_(images),
        has_depth_(has_depth),
        beyond_hides_(beyond_hides),
        limits_of_(limits_of),
        depths_(depths),
        tally_(tally) {}

  void count(const RowSpan& span) {
    for_each_part(images_.labels.touched, span, [&](int u0, int u1, bool touched) {
      if (!touched)
        count_seen(PixelState::clear, span.v, u0, u1);
      else if (has_depth_)
        count_pixels(span.v, u0, u1);
      else
        count_labels(span.v, u0, u1);
    });
  }

  /// Samples one pixel in `step`, shifted from row to row so that no span width aliases with it.
  /// `robot`: null if it is not near.
  void sample(const RowSpan& span, int step, RobotSurroundings* robot) {
    const auto limits = limits_of_(span.v);
    const auto depths = depths_.row(span.v);
    const std::uint8_t* const labels = images_.labels.labels.row(span.v);
    const int shift = static_cast<int>(golden_ratio * step * span.v) % step;
    RobotSurroundings::Depths of_robot;
    int cell = -1;  // of of_robot
    for (int u = next_multiple(span.u0 + shift, step) - shift; u < span.u1; u += step) {
      const float d = depths[u];
      const DepthLimits within = limits(u);
      const bool is_of_target = d > 0.0f && within.near <= d && d <= within.far;
      if (!is_of_target || !is_trusted(static_cast<Label>(labels[u]))) continue;
      if (robot != nullptr && u / LabelRule::cell != cell) {
        cell = u / LabelRule::cell;
        of_robot = robot->around(cell, span.v / LabelRule::cell);
      }
      if (!of_robot.hold(d)) tally_.depths.push_back(d);
    }
  }

 private:
  static constexpr float nowhere = std::numeric_limits<float>::infinity();

  struct Run {
    PixelState state = PixelState::clear;
    std::uint16_t link = 0;  // of a link image
    std::size_t pixels = 0;
  };

  /// Counts pixels of one state, except those with a measurement in front of the target.
  void count_seen(PixelState state, int v, int u0, int u1) {
    const auto limits = limits_of_(v);
    const auto depths = depths_.row(v);
    std::int32_t all = 0, nearer = 0, farther = 0;  // as wide as a depth, to vectorise
    for (int u = u0; u < u1; ++u) all += depths.is_measured(u) ? 1 : 0;
    for (int u = u0; u < u1 && has_depth_; ++u) {
      const bool is_measured = depths.is_measured(u);  // without branches, to vectorise
      nearer += is_measured & (depths.raw(u) < limits(u).near);
      farther += is_measured & (depths.raw(u) > limits(u).far);
    }
    const auto before = static_cast<std::size_t>(nearer);
    tally_.measured += static_cast<std::size_t>(all - nearer);
    tally_.past += static_cast<std::size_t>(farther);
    tally_.pixels[PixelState::other] += before;
    tally_.pixels[state] += static_cast<std::size_t>(u1 - u0) - before;
  }

  /// Counts by labels alone, run by run.
  void count_labels(int v, int u0, int u1) {
    const std::uint8_t* const labels = images_.labels.labels.row(v);
    for (int u = u0; u < u1;) {
      const int end = end_of_run(labels, u, u1);
      const PixelState state = state_without_depth(labels[u], beyond_hides_);
      if (is_seen(state) && !is_fringe(labels[u])) {
        count_seen(state, v, u, end);
      } else {
        tally_.pixels[state] += static_cast<std::size_t>(end - u);
        if (state == PixelState::occluded) count_links(v, u, end);
      }
      u = end;
    }
  }

  void count_links(int v, int u0, int u1) {
    if (images_.virtual_depth.links.empty()) return;
    const std::uint16_t* const links = images_.virtual_depth.links.row(v);
    for (int u = u0; u < u1;) {
      const int end = end_of_run(links, u, u1);
      tally_.links.add(links[u], static_cast<std::size_t>(end - u));
      u = end;
    }
  }

  void count_pixels(int v, int u0, int u1) {
    const auto limits = limits_of_(v);
    const auto depths = depths_.row(v);
    const std::uint8_t* const labels = images_.labels.labels.row(v);
    const float* const robot = images_.virtual_depth.depth.row(v);
    const bool has_links = !images_.virtual_depth.links.empty();
    const std::uint16_t* const links = has_links ? images_.virtual_depth.links.row(v) : nullptr;
    const bool has_unplaced = has_links && !images_.unplaced.empty();
    std::size_t measured = 0, past = 0;
    Run run;  // of equal pixels: faster than counting them one by one in memory
    for (int u = u0; u < u1; ++u) {
      const DepthLimits target = limits(u);
      const float d = depths[u];
      const bool may_be_anywhere = has_unplaced && is_unplaced(images_, links[u]);
      const PixelState state =
          may_be_anywhere && labels[u] == static_cast<std::uint8_t>(Label::unknown)
              ? PixelState::unknown
              : state_at_depth(labels[u], may_be_anywhere ? nowhere : robot[u], d, target,
                               beyond_hides_);
      const bool counts = is_seen(state) && !is_fringe(labels[u]);
      measured += counts && d > 0.0f;
      past += counts && d > target.far;
      const std::uint16_t link = state == PixelState::occluded && has_links ? links[u] : 0;
      if (state != run.state || link != run.link) {
        add(run);
        run = {state, link, 0};
      }
      ++run.pixels;
    }
    add(run);
    tally_.measured += measured;
    tally_.past += past;
  }

  void add(const Run& run) {
    tally_.pixels[run.state] += run.pixels;
    if (run.pixels > 0) tally_.links.add(run.link, run.pixels);
  }

  const LabelledImages& images_;
  bool has_depth_;
  bool beyond_hides_;
  const Limits& limits_of_;
  const Measured<Depth>& depths_;
  ExtentTally& tally_;
};

/// Calls f(limits_of): limits_of(v)(u) are a pixel's limits, unbounded without an expected depth.
template <typename F>
void with_limits(const labelling::Rule& label_rule, const ExpectedDepth& expected, F&& f) {
  const LimitRule rule(label_rule, expected.margin);
  if (expected.image) {
    f([&expected, rule](int v) {
      return [z = expected.image->row(v - expected.v0), u0 = expected.u0, rule](int u) {
        return rule.at(z[u - u0]);
      };
    });
  } else {
    const DepthLimits limits = expected.constant
                                   ? rule.at(*expected.constant)
                                   : DepthLimits{0.0f, std::numeric_limits<float>::infinity()};
    f([limits](int) { return [limits](int) { return limits; }; });
  }
}

/// Returns null if the robot is too far from the spans to affect their depths.
RobotSurroundings* robot_near(const LabelledImages& images, std::span<const RowSpan> spans,
                              RobotSurroundings& robot) {
  const int reach = robot.reach();
  const bool is_near = robot_may_lie_in(images, grown(box_of_spans(spans), reach, reach));
  return is_near ? &robot : nullptr;
}

}  // namespace

bool robot_may_lie_in(const LabelledImages& images, const PixelRectangle& box) {
  const auto& labels = images.labels.labels;
  const auto [u0, v0, u1, v1] = overlap(box, {0, 0, labels.width, labels.height});
  if (u0 >= u1 || v0 >= v1) return false;
  const TileMask* const tiles = images.labels.touched;
  if (tiles == nullptr) return true;
  const std::uint64_t upto = ~std::uint64_t{0} >> (63 - (u1 - 1) / tiles->tile_width);
  const std::uint64_t columns = upto & (~std::uint64_t{0} << (u0 / tiles->tile_width));
  for (int j = v0 / TileMask::tile_height; j <= (v1 - 1) / TileMask::tile_height; ++j)
    if ((tiles->rows[static_cast<std::size_t>(j)] & columns) != 0) return true;
  return false;
}

void LinkCounts::clear() {
  for (const std::size_t link : touched_) counts_[link] = 0;
  touched_.clear();
}

std::vector<Blame> LinkCounts::blame(std::size_t pixels, std::span<const std::string> names) const {
  std::vector<Blame> blame;
  for (const std::size_t link : touched_)
    blame.push_back({link, static_cast<double>(counts_[link]) / static_cast<double>(pixels),
                     link < names.size() ? names[link] : std::string()});
  std::sort(blame.begin(), blame.end(), [](const Blame& a, const Blame& b) {
    return a.fraction != b.fraction ? a.fraction > b.fraction : a.link < b.link;
  });
  return blame;
}

void ExtentTally::count(const LabelledImages& images, const labelling::Rule& rule,
                        std::span<const RowSpan> spans, const ExpectedDepth& expected,
                        bool beyond_hides, RobotSurroundings* robot) {
  clear();
  is_expected = expected.known();
  for (const RowSpan& span : spans) inside += static_cast<std::size_t>(span.u1 - span.u0);
  if (spans.empty()) return;
  step = static_cast<int>((inside + max_depth_samples - 1) / max_depth_samples);
  RobotSurroundings* const near = robot != nullptr ? robot_near(images, spans, *robot) : nullptr;
  with_limits(rule, expected, [&](const auto& limits_of) {
    if (images.evidence != Evidence::measured) {
      for (const RowSpan& span : spans) count_robot(images, span, limits_of, *this);
      return;
    }
    std::visit(
        [&](const auto& image) {
          const Measured of_image(image, rule);
          ExtentReader reader(images, is_expected, beyond_hides, limits_of, of_image, *this);
          for (const RowSpan& span : spans) {
            reader.count(span);
            if (robot != nullptr) reader.sample(span, step, near);
          }
        },
        images.measured);
    unmeasured = seen() - measured;
  });
  if (std::size_t all = inside; images.evidence == Evidence::none)
    mark_unknown(PixelState::clear, all);
}

}  // namespace penumbra
