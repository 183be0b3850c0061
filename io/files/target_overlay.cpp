// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/targets/target_views.hpp>

#include <io/files/bitmap_font.hpp>
#include <io/files/target_overlay.hpp>

namespace penumbra::io {
namespace {

constexpr int rows_per_width = 360;  // image rows for which lines grow by a pixel
constexpr Rgb8 rim{0, 0, 0};         // around lines and names, visible on any background
constexpr Rgb8 marker_colour{255, 255, 255};

/// Draws on an image with lines of a width.
struct Pen {
  Image<Rgb8>& out;
  int width;

  void dot(const Eigen::Vector2d& p, int size, Rgb8 color) const {
    // Pixel numbers far outside do not fit an int.
    if (!(std::abs(p.x()) < 1e6 && std::abs(p.y()) < 1e6)) return;
    const int u = static_cast<int>(std::lround(p.x())), v = static_cast<int>(std::lround(p.y()));
    BitmapFont::fill(u - (size - 1) / 2, v - (size - 1) / 2, size, color, out);
  }

  /// The part of a line inside the image, in steps of at most a pixel.
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, int size, Rgb8 color) const {
    double from = 0.0, to = 1.0;
    const Eigen::Vector2d d = b - a;
    const Eigen::Vector2d end(out.width() + width, out.height() + width);
    for (int axis = 0; axis < 2; ++axis) {
      const double low = (-width - a[axis]) / d[axis], high = (end[axis] - a[axis]) / d[axis];
      if (d[axis] == 0.0 && (a[axis] < -width || a[axis] > end[axis])) return;
      if (d[axis] == 0.0) continue;
      from = std::max(from, std::min(low, high));
      to = std::min(to, std::max(low, high));
    }
    if (!(from <= to)) return;
    const int steps =
        static_cast<int>(std::ceil((to - from) * std::max(std::abs(d.x()), std::abs(d.y()))));
    for (int i = 0; i <= steps; ++i)
      dot(a + (from + (to - from) * i / std::max(steps, 1)) * d, size, color);
  }

  void path(const PixelPath& path, int size, Rgb8 color) const {
    if (path.size() == 1) dot(path.front(), size, color);
    for (std::size_t i = 1; i < path.size(); ++i) line(path[i - 1], path[i], size, color);
  }

  void paths(const std::vector<PixelPath>& paths, Rgb8 color) const {
    for (const PixelPath& one : paths) path(one, width + 2, rim);
    for (const PixelPath& one : paths) path(one, width, color);
  }

  void cross(const Eigen::Vector2d& p) const {
    const double arm = 4.0 * width;
    const Eigen::Vector2d a(arm, arm), b(arm, -arm);
    paths({{p - a, p + a}, {p - b, p + b}}, marker_colour);
  }

  /// A line of text on a dark ground after a square of the colour.
  void text(std::string_view text, int u, int v, Rgb8 color) const {
    const int line = (BitmapFont::height + 1) * width, letter = BitmapFont::advance * width;
    const int end = u + (static_cast<int>(text.size()) + 2) * letter;
    for (int y = std::max(v, 0); y < std::min(v + line, out.height()); ++y)
      for (int x = std::max(u, 0); x < std::min(end, out.width()); ++x) out(x, y) = rim;
    BitmapFont::fill(u + width, v + width, letter, color, out);
    BitmapFont::draw(text, u + 2 * letter, v + width, width, marker_colour, out);
  }
};

/// In double, because stamps may be farther apart than int64 holds.
double seconds_from(std::int64_t first, std::int64_t second) {
  return 1e-9 * (static_cast<double>(second) - static_cast<double>(first));
}

/// Returns the age of a target of an earlier frame, seconds.
std::optional<double> lateness(const TargetReport& target, const FrameReport& report) {
  if (!target.stamp || !report.stamp || *target.stamp == *report.stamp) return std::nullopt;
  return seconds_from(*target.stamp, *report.stamp);
}

/// The caption of a target: "crate hidden 97%, 0.20 s ago, predicted"; "crate visible, 0% hidden";
/// "crate unknown, at least 57% hidden".
std::string caption(const TargetReport& target, const std::optional<double>& late) {
  std::string text(target.name);
  text += " " + std::string(to_string(target.verdict));
  if (target.judgement && target.judgement->inside > 0) {
    const double hidden =
        target.judgement->occluded + target.judgement->hidden_by_other.value_or(0);
    const long percent = std::lround(100.0 * hidden);
    const bool is_known = target.verdict != Verdict::unknown;
    const std::string share = std::to_string(percent) + "%";
    if (target.verdict == Verdict::hidden)
      text += " " + share;
    else if (is_known || percent > 0)
      text += (is_known ? ", " : ", at least ") + share + " hidden";
  }
  if (late) {
    std::array<char, 32> ago{};
    std::snprintf(ago.data(), ago.size(), ", %.2f s ago", *late);
    text += ago.data();
  }
  if (target.handled && target.handled->source != Source::measured)
    text += ", " + std::string(to_string(target.handled->source));
  return text;
}

/// Finds places for captions in an image so that none covers another.
class CaptionPlaces {
 public:
  /// Returns the nearest free place above or below `at` inside the image, else `at`.
  Eigen::Vector2i find(const Eigen::Vector2i& at, const Eigen::Vector2i& size, int image_height) {
    Eigen::AlignedBox2i best(at, at + size);
    for (int step = 1; !is_free(best) && step <= 2 * image_height / size.y(); ++step) {
      const int lines = step % 2 == 1 ? -(step + 1) / 2 : step / 2;
      const Eigen::Vector2i moved(at.x(), at.y() + lines * size.y());
      if (moved.y() < 0 || moved.y() + size.y() > image_height) continue;
      const Eigen::AlignedBox2i box(moved, moved + size);
      if (is_free(box)) best = box;
    }
    taken_.push_back(best);
    return best.min();
  }

 private:
  [[nodiscard]] bool is_free(const Eigen::AlignedBox2i& box) const {
    return std::none_of(taken_.begin(), taken_.end(), [&](const Eigen::AlignedBox2i& other) {
      return (box.min().array() < other.max().array()).all() &&
             (other.min().array() < box.max().array()).all();
    });
  }

  std::vector<Eigen::AlignedBox2i> taken_;
};

/// Above the outline's upper left corner, inside the image.
void draw_caption(const std::vector<PixelPath>& paths, const std::string& text, Rgb8 color,
                  const Pen& pen, CaptionPlaces& places) {
  Eigen::Vector2d corner = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  for (const PixelPath& path : paths)
    for (const Eigen::Vector2d& p : path) corner = corner.cwiseMin(p);
  if (!corner.allFinite()) return;
  const int line = (BitmapFont::height + 1) * pen.width;
  const int width = static_cast<int>(text.size() + 2) * BitmapFont::advance * pen.width;
  const double u = std::clamp(corner.x(), 0.0, std::max(0.0, 1.0 * pen.out.width() - width));
  const double v = std::clamp(corner.y() - line, 0.0, 1.0 * pen.out.height() - line);
  const Eigen::Vector2i at =
      places.find({static_cast<int>(u), static_cast<int>(v)}, {width, line}, pen.out.height());
  pen.text(text, at.x(), at.y(), color);
}

}  // namespace

Rgb8 verdict_color(Verdict verdict) {
  // Okabe and Ito's palette (2008): bluish green, orange, vermilion, yellow; grey; sky blue.
  constexpr std::array<Rgb8, 6> colors = {{{0, 158, 115},
                                           {230, 159, 0},
                                           {213, 94, 0},
                                           {240, 228, 66},
                                           {160, 160, 160},
                                           {86, 180, 233}}};
  return colors[static_cast<std::size_t>(verdict)];
}

std::vector<TargetMark> TargetOverlay::marks(std::span<const Target> targets,
                                             const FrameReport& report, const Robot& robot,
                                             const Camera& camera) {
  std::vector<TargetMark> marks(std::min(targets.size(), report.targets.size()));
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const TargetReport& target = report.targets[i];
    marks[i].outline = outline_of(targets[i].shape, poses_of(target, report), robot, camera);
    if (!target.handled || !target.handled->position || !report.T_root_camera) continue;
    marks[i].place = pixel_of(camera, report.T_root_camera->inverse() * *target.handled->position);
  }
  remember(report);
  return marks;
}

void TargetOverlay::draw(std::span<const Target> targets, const FrameReport& report,
                         const Robot& robot, const Camera& camera, Image<Rgb8>& out) {
  const Pen pen{out, std::max(1, out.height() / rows_per_width)};
  CaptionPlaces places;
  const std::vector<TargetMark> all = marks(targets, report, robot, camera);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TargetReport& target = report.targets[i];
    const Rgb8 color = verdict_color(target.verdict);
    pen.paths(all[i].outline, color);
    if (i < max_target_names)
      draw_caption(all[i].outline, caption(target, lateness(target, report)), color, pen, places);
    if (all[i].place) pen.cross(*all[i].place);
  }
}

void TargetOverlay::remember(const FrameReport& report) {
  if (!report.stamp) return;
  recent_[*report.stamp] = {report.T_root_camera,
                            {report.T_root_link.begin(), report.T_root_link.end()}};
  recent_.erase(recent_.upper_bound(*report.stamp), recent_.end());  // a clock that was set back
  while (seconds_from(recent_.begin()->first, *report.stamp) > PipelineConfig::max_target_history)
    recent_.erase(recent_.begin());
}

TargetPoses TargetOverlay::poses_of(const TargetReport& target, const FrameReport& report) const {
  if (!lateness(target, report))
    return {report.T_root_camera, report.T_root_camera, report.T_root_link, false};
  const auto then = recent_.find(*target.stamp);
  if (then == recent_.end()) return {report.T_root_camera, std::nullopt, {}, true};
  return {report.T_root_camera, then->second.T_root_camera, then->second.T_root_link, true};
}

}  // namespace penumbra::io
