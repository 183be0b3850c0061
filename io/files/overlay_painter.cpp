// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <io/files/bitmap_font.hpp>
#include <io/files/image_size.hpp>
#include <io/files/overlay_painter.hpp>

namespace penumbra::io {
namespace {

constexpr int label_weight = 128;  // of 256: how much of a pixel's colour is its label's
constexpr int panel_weight = 176;  // of 256: how dark the ground below text is
constexpr double white_depth =
    0.25;  // metres that are drawn white; grey falls with the square root
constexpr int lines_per_scale = 360;  // image rows for which letters grow by their own size
constexpr std::size_t max_message_lines = 3;
constexpr Rgb8 white{255, 255, 255};
constexpr Rgb8 black{0, 0, 0};

constexpr std::array<const char*, 4> label_names = {"front", "occluded", "unknown", "beyond"};

Rgb8 blend(Rgb8 below, Rgb8 above, int weight) {
  const auto mix = [weight](int a, int b) {
    return static_cast<std::uint8_t>((a * (256 - weight) + b * weight) / 256);
  };
  return {mix(below.r, above.r), mix(below.g, above.g), mix(below.b, above.b)};
}

std::uint8_t grey_of(double metres) {
  if (!(metres > 0.0) || std::isinf(metres)) return 0;
  return static_cast<std::uint8_t>(std::min(255.0, 255.0 * std::sqrt(white_depth / metres)));
}

std::uint8_t grey_of(std::uint16_t millimetres) { return grey_of(1e-3 * millimetres); }
std::uint8_t grey_of(float metres) { return grey_of(static_cast<double>(metres)); }

void draw_scene(const ShownImages& input, Image<Rgb8>& out) {
  for (int v = 0; v < out.height(); ++v) {
    if (!input.color.empty()) {
      std::copy_n(input.color.row(v), out.width(), &out(0, v));
      continue;
    }
    std::visit(
        [&](const auto& depth) {
          for (int u = 0; u < out.width(); ++u) {
            const std::uint8_t grey = depth.empty() ? std::uint8_t{0} : grey_of(depth(u, v));
            out(u, v) = {grey, grey, grey};
          }
        },
        input.depth);
  }
}

bool is_robot(std::uint8_t label) {
  return label != static_cast<std::uint8_t>(Label::clear) &&
         label != static_cast<std::uint8_t>(Label::fringe);
}

// Draws labels and a double line along the robot's outline, white inside and black outside, which
// is visible on any background.
void draw_labels(ImageView<const std::uint8_t> labels, Image<Rgb8>& out) {
  for (int v = 0; v < out.height(); ++v) {
    for (int u = 0; u < out.width(); ++u) {
      const std::uint8_t label = labels(u, v);
      const auto differs = [&](int du, int dv) {
        const int x = u + du, y = v + dv;
        return x >= 0 && y >= 0 && x < labels.width && y < labels.height &&
               is_robot(labels(x, y)) != is_robot(label);
      };
      if (differs(-1, 0) || differs(1, 0) || differs(0, -1) || differs(0, 1)) {
        out(u, v) = is_robot(label) ? white : black;
      } else if (label != static_cast<std::uint8_t>(Label::clear)) {
        out(u, v) = blend(out(u, v), label_color(static_cast<Label>(label)), label_weight);
      }
    }
  }
}

struct Line {
  std::string text;
  std::optional<Rgb8> swatch;
};

/// Formats a label's line of the legend. `share`: of the robot's pixels, or nothing.
Line counted(const char* name, std::size_t pixels, std::optional<double> share, Rgb8 color) {
  std::array<char, 64> text{};
  if (share)
    std::snprintf(text.data(), text.size(), "%-8s %7zu %5.1f%%", name, pixels, 100.0 * *share);
  else
    std::snprintf(text.data(), text.size(), "%-8s %7zu", name, pixels);
  return {text.data(), color};
}

/// Adds the number of robot pixels and of each label. Fringe pixels are not part of the robot.
void add_counts(const PixelCounts& pixels, std::vector<Line>& lines) {
  const std::array<std::size_t, 4> of_robot{pixels.front, pixels.occluded, pixels.unknown,
                                            pixels.beyond};
  const std::size_t robot = pixels.robot.value_or(0);
  lines.push_back({"robot " + std::to_string(robot) + " px", {}});
  for (std::size_t i = 0; i < of_robot.size(); ++i) {
    const auto label = static_cast<Label>(i + 1);
    std::optional<double> share =
        robot == 0 ? 0.0 : static_cast<double>(of_robot[i]) / static_cast<double>(robot);
    if (of_robot[i] > robot) share.reset();  // also pixels without robot
    lines.push_back(counted(label_names[i], of_robot[i], share, label_color(label)));
  }
  if (pixels.fringe > 0)
    lines.push_back(counted("fringe", pixels.fringe, {}, label_color(Label::fringe)));
  if (pixels.uncovered > 0)
    lines.push_back(counted("uncovered", pixels.uncovered, {}, label_color(Label::unknown)));
}

std::vector<Line> legend_lines(const FrameReport& report) {
  std::vector<Line> lines;
  lines.push_back({"frame " + std::to_string(report.index), {}});
  if (report.stamp) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.3f s", 1e-9 * static_cast<double>(*report.stamp));
    lines.push_back({text.data(), {}});
  }
  const bool is_posed = has_pose(report.status);
  if (!is_posed) lines.push_back({"robot: pose unknown", {}});
  if (report.labels.empty()) return lines;
  if (is_posed)
    add_counts(report.pixels, lines);
  else
    lines.push_back({"unknown  all pixels", label_color(Label::unknown)});
  return lines;
}

struct Box {
  int u, v, width, height;
};

void darken(const Box& box, Image<Rgb8>& out) {
  for (int v = std::max(box.v, 0); v < std::min(box.v + box.height, out.height()); ++v)
    for (int u = std::max(box.u, 0); u < std::min(box.u + box.width, out.width()); ++u)
      out(u, v) = blend(out(u, v), black, panel_weight);
}

std::size_t robot_pixels(const Box& box, ImageView<const std::uint8_t> labels) {
  std::size_t count = 0;
  for (int v = std::max(box.v, 0); v < std::min(box.v + box.height, labels.height); ++v)
    for (int u = std::max(box.u, 0); u < std::min(box.u + box.width, labels.width); ++u)
      count += is_robot(labels(u, v)) ? 1 : 0;
  return count;
}

// Returns the corner above `bottom` in which the box hides the fewest robot pixels.
Box place(int width, int height, int bottom, ImageView<const std::uint8_t> labels,
          const Image<Rgb8>& out) {
  const int right = out.width() - width, low = bottom - height;
  const std::array<Box, 4> corners = {{{0, 0, width, height},
                                       {right, 0, width, height},
                                       {0, low, width, height},
                                       {right, low, width, height}}};
  if (labels.empty()) return corners[0];
  return *std::min_element(corners.begin(), corners.end(), [&](const Box& a, const Box& b) {
    return robot_pixels(a, labels) < robot_pixels(b, labels);
  });
}

void draw_legend(const FrameReport& report, int scale, int bottom, Image<Rgb8>& out) {
  const std::vector<Line> lines = legend_lines(report);
  const int margin = 3 * scale;
  const int line_height = (BitmapFont::height + 1) * scale;
  const int swatch = BitmapFont::advance * scale;
  std::size_t letters = 0;
  for (const Line& line : lines)
    letters = std::max(letters, line.text.size() + (line.swatch ? 2 : 0));
  const int width = static_cast<int>(letters) * BitmapFont::advance * scale + 2 * margin;
  const int height = static_cast<int>(lines.size()) * line_height + 2 * margin;
  const Box box = place(width, height, bottom, report.labels, out);
  darken(box, out);
  int v = box.v + margin;
  for (const Line& line : lines) {
    const int u = box.u + margin;
    if (line.swatch) BitmapFont::fill(u, v, swatch, *line.swatch, out);
    BitmapFont::draw(line.text, u + (line.swatch ? 2 * swatch : 0), v, scale, white, out);
    v += line_height;
  }
}

// Draws the message at the lower edge in lines of the image's width. Returns its upper edge.
int draw_message(std::string_view message, int scale, Image<Rgb8>& out) {
  const int margin = 3 * scale;
  const int line_height = (BitmapFont::height + 1) * scale;
  const auto letters = static_cast<std::size_t>(
      std::max(1, (out.width() - 2 * margin) / (BitmapFont::advance * scale)));
  const auto count =
      static_cast<int>(std::min(max_message_lines, (message.size() + letters - 1) / letters));
  if (count == 0) return out.height();
  const int top = out.height() - count * line_height - 2 * margin;
  darken({0, top, out.width(), out.height() - top}, out);
  for (int i = 0; i < count; ++i)
    BitmapFont::draw(message.substr(static_cast<std::size_t>(i) * letters, letters), margin,
                     top + margin + i * line_height, scale, white, out);
  return top;
}

}  // namespace

std::span<const Rgb8> label_palette() {
  // Okabe and Ito's palette (2008): blue, vermilion, yellow, reddish purple, bluish green.
  static constexpr std::array<Rgb8, label_count> colors = {
      {{0, 0, 0}, {0, 114, 178}, {213, 94, 0}, {240, 228, 66}, {204, 121, 167}, {0, 158, 115}}};
  return colors;
}

Rgb8 label_color(Label label) { return label_palette()[static_cast<std::size_t>(label)]; }

void draw_overlay(const FrameReport& report, const ShownImages& images, Image<Rgb8>& out) {
  const ImageSize size = !images.color.empty() ? ImageSize{images.color.width, images.color.height}
                         : !report.labels.empty()
                             ? ImageSize{report.labels.width, report.labels.height}
                             : std::visit(
                                   [](const auto& depth) {
                                     return ImageSize{depth.width, depth.height};
                                   },
                                   images.depth);
  if (out.width() != size.width || out.height() != size.height)
    out = Image<Rgb8>(size.width, size.height);
  draw_scene(images, out);
  if (!report.labels.empty()) draw_labels(report.labels, out);
  const int scale = std::max(1, size.height / lines_per_scale);
  const int bottom = draw_message(report.message, scale, out);
  draw_legend(report, scale, bottom, out);
}

ImageView<const Rgb8> OverlayPainter::draw(const Frame& frame, const FrameReport& report) {
  ShownImages seen;
  if (!frame.color.view.empty())
    seen.color = seen_color(frame.color.view);
  else
    std::visit(
        [&](const auto& depth) { seen.depth = rectified(rectification_, depth, depth_of(depth)); },
        frame.depth.view);
  draw_overlay(report, seen, overlay_);
  target_overlay_.draw(frame.targets, report, robot_, camera_, overlay_);
  return std::as_const(overlay_).view();
}

ImageView<const Rgb8> OverlayPainter::seen_color(ImageView<const Rgb8> raw) {
  return rectified(rectification_, raw, color_);
}

}  // namespace penumbra::io
