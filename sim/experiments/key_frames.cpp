// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <io/bitmap_font.hpp>
#include <sim/experiments/detector.hpp>
#include <sim/experiments/key_frames.hpp>

namespace penumbra::sim {
namespace {

// Okabe and Ito's vermilion and bluish green: told apart with any common colour blindness.
constexpr io::Rgb8 red{213, 94, 0}, green{0, 158, 115}, black{0, 0, 0};
constexpr int text_scale = 2, letter_width = text_scale * io::BitmapFont::advance;
constexpr double wrist_box = 0.12;  // metres: edge of the box about a wrist

constexpr int largest_width = 800;  // pixels of an image that is kept as it is

Image<io::Rgb8> halved(const Image<io::Rgb8>& image) {
  Image<io::Rgb8> half(image.width() / 2, image.height() / 2);
  const auto mean = [](int a, int b, int c, int d) {
    return static_cast<std::uint8_t>((a + b + c + d + 2) / 4);
  };
  for (int v = 0; v < half.height(); ++v)
    for (int u = 0; u < half.width(); ++u) {
      const io::Rgb8 &a = image(2 * u, 2 * v), &b = image(2 * u + 1, 2 * v);
      const io::Rgb8 &c = image(2 * u, 2 * v + 1), &d = image(2 * u + 1, 2 * v + 1);
      half(u, v) = {mean(a.r, b.r, c.r, d.r), mean(a.g, b.g, c.g, d.g), mean(a.b, b.b, c.b, d.b)};
    }
  return half;
}

void draw_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Look& look,
               Image<io::Rgb8>& image) {
  constexpr int width = 3, dash = 8;  // pixels
  const double length = (to - from).norm();
  if (!(length < 4.0 * image.width())) return;  // a pose that is far off need not be drawn
  for (int i = 0; i <= static_cast<int>(length); ++i) {
    if (look.dashed && (i / dash) % 2 == 1) continue;
    const Eigen::Vector2d at = from + (to - from) * (length > 0 ? i / length : 0.0);
    io::BitmapFont::fill(static_cast<int>(std::lround(at.x())) - 1,
                         static_cast<int>(std::lround(at.y())) - 1, width, look.color, image);
  }
}

/// Black on a plate of the colour: read on any ground.
void write_on(std::string_view text, int u, int v, io::Rgb8 color, Image<io::Rgb8>& image) {
  constexpr int margin = 4, height = text_scale * io::BitmapFont::height + margin;
  const int width = letter_width * static_cast<int>(text.size()) + margin;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      io::BitmapFont::fill(u + x - margin, v + y - margin, 1, color, image);
  io::BitmapFont::draw(text, u, v, text_scale, black, image);
}

std::string error_text(const Sample& sample) {
  if (!sample.known()) return "no pose";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f cm off", 100 * sample.translation_error);
  return text.data();
}

/// The frame of the largest hidden share in the first span of some length, the middle one of
/// several.
std::size_t most_hidden(const SeedRun& run) {
  constexpr double least_seconds = 0.4;
  std::vector<std::size_t> span, best;
  for (std::size_t i = 0; i <= run.frames.size(); ++i) {
    if (i < run.frames.size() && run.frames[i].hidden > occluded_share) {
      span.push_back(i);
      continue;
    }
    if (span.size() > best.size()) best = span;
    if (static_cast<double>(best.size()) * run.frame_seconds >= least_seconds) break;
    span.clear();
  }
  if (best.empty()) return run.goal.value_or(run.frames.size() - 1);
  double most = 0;
  for (const std::size_t i : best) most = std::max(most, run.frames[i].hidden);
  std::erase_if(best, [&](std::size_t i) { return run.frames[i].hidden < most; });
  return best[best.size() / 2];
}

constexpr Look raw_look{"raw", red, true, false}, handled_look{"handled", green, false, true};

}  // namespace

KeyFrames::KeyFrames(std::string experiment, const Cell& cell)
    : experiment_(std::move(experiment)), cell_(cell) {}

void KeyFrames::see(const SimFrame& frame) {
  const bool large = frame.color.width() > largest_width;
  scale_ = large ? 0.5 : 1.0;
  images_.push_back(large ? halved(frame.color) : frame.color);
}

std::vector<Picture> KeyFrames::choose(const SeedRun& run) const {
  const std::size_t hidden = most_hidden(run);
  std::vector<std::pair<const char*, std::size_t>> story;
  std::size_t before = hidden;
  while (before > 0 && run.frames[before].hidden > 0) --before;
  story.emplace_back("Seen", before);
  for (std::size_t i = before; i < hidden; ++i)
    if (run.frames[i].hidden > 0.5 * run.frames[hidden].hidden) {
      story.emplace_back("Partly hidden", i);
      break;
    }
  story.emplace_back("Most hidden", hidden);
  std::vector<std::size_t> front;
  front.reserve(run.frames.size());
  for (std::size_t i = 0; i < run.frames.size(); ++i)
    if (run.frames[i].before_robot) front.push_back(i);
  if (!front.empty()) story.emplace_back("Hand before the arm", front[front.size() / 2]);
  const bool grasps = experiment_ == "conveyor" && run.goal;
  story.emplace_back(grasps ? "Grasp" : "End", run.goal.value_or(run.frames.size() - 1));
  std::stable_sort(story.begin(), story.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<Picture> pictures;
  pictures.reserve(story.size());
  for (const auto& [what, i] : story) pictures.push_back({i, draw(run, i), what});
  return pictures;
}

Image<io::Rgb8> KeyFrames::draw(const SeedRun& run, std::size_t i) const {
  Image<io::Rgb8> image = images_.at(i);
  const std::vector<MethodRun>& methods = run.lanes.front().methods;
  draw_target(methods.back().samples[i], handled_look, image);
  draw_target(methods.front().samples[i], raw_look, image);
  for (const auto& [look, v] : {std::pair(raw_look, 18), {handled_look, 40}}) {
    draw_line({10, v}, {66, v}, look, image);
    write_on(look.name, 78, v - 8, look.color, image);
  }
  return image;
}

void KeyFrames::draw_target(const Sample& sample, const Look& look, Image<io::Rgb8>& image) const {
  const Eigen::Isometry3d pose = cell_.T_base_camera.inverse() * sample.pose;
  if (!sample.known() || pose.translation().z() <= 0) return;
  Eigen::AlignedBox2d extent;
  for (const auto& [from, to] : edges_of(pose)) {
    draw_line(from, to, look, image);
    extent.extend(from).extend(to);
  }
  if (!extent.min().allFinite() || !extent.max().allFinite()) return;
  const std::string text = error_text(sample);
  const double most_u = image.width() - letter_width * static_cast<double>(text.size() + 1);
  const double v = look.is_below ? extent.max().y() + 8 : extent.min().y() - 24;
  write_on(text, static_cast<int>(std::clamp(extent.min().x(), 4.0, std::max(4.0, most_u))),
           static_cast<int>(std::clamp(v, 56.0, image.height() - 22.0)), look.color, image);
}

std::vector<KeyFrames::Edge> KeyFrames::edges_of(const Eigen::Isometry3d& pose) const {
  std::vector<Edge> edges;
  if (experiment_ != "conveyor") {
    const Eigen::Vector2d at = scale_ * cell_.camera.intrinsics.project(pose.translation());
    const double r =
        0.5 * scale_ * cell_.camera.intrinsics.fx() * wrist_box / pose.translation().z();
    const std::array<Eigen::Vector2d, 4> corners{
        at + Eigen::Vector2d(-r, -r), at + Eigen::Vector2d(r, -r), at + Eigen::Vector2d(r, r),
        at + Eigen::Vector2d(-r, r)};
    for (std::size_t k = 0; k < corners.size(); ++k)
      edges.emplace_back(corners[k], corners[(k + 1) % corners.size()]);
    return edges;
  }
  const auto corners = project_box(cell_.camera, pose, cell_.object_size);
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}, std::size_t{4}})
      if ((a & axis) == 0) edges.emplace_back(scale_ * corners[a], scale_ * corners[a | axis]);
  return edges;
}

}  // namespace penumbra::sim
