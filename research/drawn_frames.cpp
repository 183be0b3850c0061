// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <io/files/bitmap_font.hpp>
#include <research/detectors.hpp>
#include <research/drawn_frames.hpp>

namespace penumbra::research {
namespace {

// Okabe and Ito's vermilion and bluish green: distinct with any common color blindness.
constexpr Rgb8 red{213, 94, 0}, green{0, 158, 115}, black{0, 0, 0};
constexpr int text_scale = 2, letter_width = text_scale * io::BitmapFont::advance;
constexpr double wrist_box = 0.12;  // metres: edge of the box around a wrist

void draw_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const LineStyle& style,
               Image<Rgb8>& image) {
  constexpr int width = 3, dash = 8;  // pixels
  const double length = (to - from).norm();
  if (!(length < 4.0 * image.width())) return;  // a pose far outside of the image
  for (int i = 0; i <= static_cast<int>(length); ++i) {
    if (style.dashed && (i / dash) % 2 == 1) continue;
    const Eigen::Vector2d at = from + (to - from) * (length > 0 ? i / length : 0.0);
    io::BitmapFont::fill(static_cast<int>(std::lround(at.x())) - 1,
                         static_cast<int>(std::lround(at.y())) - 1, width, style.color, image);
  }
}

/// Writes black text on a plate of the color.
void write_on(std::string_view text, int u, int v, Rgb8 color, Image<Rgb8>& image) {
  constexpr int margin = 4, height = text_scale * io::BitmapFont::height + margin;
  const int width = letter_width * static_cast<int>(text.size()) + margin;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      io::BitmapFont::fill(u + x - margin, v + y - margin, 1, color, image);
  io::BitmapFont::draw(text, u, v, text_scale, black, image);
}

std::string error_text(const Sample& sample) {
  if (!sample.known) return "no pose";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f cm off", 100 * sample.translation_error);
  return text.data();
}

constexpr LineStyle raw_style{"raw", red, true, false},
    handled_style{"handled", green, false, true};

}  // namespace

DrawnFrames::DrawnFrames(const sim::Simulation& simulation)
    : camera_(simulation.camera()),
      T_base_camera_(simulation.T_base_camera()),
      object_size_(simulation.object_size()) {}

void DrawnFrames::add(const sim::SimFrame& frame) { images_.push_back(frame.color); }

void DrawnFrames::write(const std::filesystem::path& folder, const SeedRun& run) const {
  for (std::size_t i = 0; i < images_.size(); ++i) {
    std::string name = std::to_string(i);
    name.insert(0, 6 - std::min<std::size_t>(name.size(), 6), '0');
    io::write_png(folder / (name + ".png"), draw(run.lanes.front(), i).view());
  }
}

Image<Rgb8> DrawnFrames::draw(const LaneRun& lane, std::size_t i) const {
  Image<Rgb8> image = images_[i];
  draw_target(lane.methods.back().samples[i], handled_style, image);
  draw_target(lane.methods.front().samples[i], raw_style, image);
  for (const auto& [style, v] : {std::pair(raw_style, 18), {handled_style, 40}}) {
    draw_line({10, v}, {66, v}, style, image);
    write_on(style.name, 78, v - 8, style.color, image);
  }
  return image;
}

void DrawnFrames::draw_target(const Sample& sample, const LineStyle& style,
                              Image<Rgb8>& image) const {
  const Eigen::Isometry3d pose = T_base_camera_.inverse() * sample.pose;
  if (!sample.known || pose.translation().z() <= 0) return;
  Eigen::AlignedBox2d extent;
  for (const auto& [from, to] : edges_of(pose)) {
    draw_line(from, to, style, image);
    extent.extend(from).extend(to);
  }
  if (!extent.min().allFinite() || !extent.max().allFinite()) return;
  const std::string text = error_text(sample);
  const double most_u = image.width() - letter_width * static_cast<double>(text.size() + 1);
  const double v = style.is_below ? extent.max().y() + 8 : extent.min().y() - 24;
  write_on(text, static_cast<int>(std::clamp(extent.min().x(), 4.0, std::max(4.0, most_u))),
           static_cast<int>(std::clamp(v, 56.0, image.height() - 22.0)), style.color, image);
}

std::vector<DrawnFrames::Edge> DrawnFrames::edges_of(
    const Eigen::Isometry3d& T_camera_target) const {
  std::vector<Edge> edges;
  if (object_size_.isZero()) {
    const Eigen::Vector2d at = camera_.intrinsics.project(T_camera_target.translation());
    const double r = 0.5 * camera_.intrinsics.fx() * wrist_box / T_camera_target.translation().z();
    const std::array<Eigen::Vector2d, 4> corners{
        at + Eigen::Vector2d(-r, -r), at + Eigen::Vector2d(r, -r), at + Eigen::Vector2d(r, r),
        at + Eigen::Vector2d(-r, r)};
    for (std::size_t k = 0; k < corners.size(); ++k)
      edges.emplace_back(corners[k], corners[(k + 1) % corners.size()]);
    return edges;
  }
  const auto corners = project_box(camera_, T_camera_target, object_size_);
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}, std::size_t{4}})
      if ((a & axis) == 0) edges.emplace_back(corners[a], corners[a | axis]);
  return edges;
}

}  // namespace penumbra::research
