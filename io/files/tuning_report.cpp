// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <penumbra/base/version.hpp>

#include <io/files/json.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/files/picture.hpp>
#include <io/files/tuning_report.hpp>

namespace penumbra::io {
namespace {

constexpr Rgb8 removed_color{0, 200, 80};
constexpr Rgb8 left_color{230, 30, 30};
constexpr Rgb8 outline_color{255, 255, 255};

Json fringe_json(const FringeFit& fringe) {
  Json left = Json::array();
  for (std::size_t i = 0; i < fringe.left_over.size(); ++i)
    left.push_back(
        {{"reach", static_cast<int>(i) * FringeFit::step}, {"share", fringe.left_over[i]}});
  return {{"reach", fringe.reach},
          {"distance_px",
           {{"median", fringe.median}, {"p90", fringe.percent_90}, {"p99", fringe.percent_99}}},
          {"pixels_checked", fringe.checked},
          {"pixels_found", fringe.found},
          {"left_over", std::move(left)}};
}

Json extra_json(const ExtraPart& part, const WrittenExtra& written) {
  Json boxes = Json::array();
  for (const Eigen::AlignedBox3d& box : part.boxes)
    boxes.push_back({{"min", {box.min().x(), box.min().y(), box.min().z()}},
                     {"max", {box.max().x(), box.max().y(), box.max().z()}}});
  return {{"link", written.link},
          {"mesh", or_null(written.file)},
          {"triangles", part.mesh.triangles.size()},
          {"boxes_m", std::move(boxes)}};
}

std::string percent(double share) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f %%", 100.0 * share);
  return text.data();
}

}  // namespace

std::string tuning_json(const Tuning& tuning, std::span<const KeptFrame> frames,
                        std::span<const WrittenExtra> extras) {
  Json indices = Json::array(), parts = Json::array();
  for (const KeptFrame& frame : frames) indices.push_back(frame.index);
  for (std::size_t i = 0; i < extras.size(); ++i)
    parts.push_back(extra_json(tuning.extras[i], extras[i]));
  const ToleranceFit& fit = tuning.tolerance;
  const Json json = {{"penumbra", PENUMBRA_VERSION},
                     {"frames", std::move(indices)},
                     {"tolerance",
                      {{"abc", {fit.tolerance.a, fit.tolerance.b, fit.tolerance.c}},
                       {"pixels", fit.pixels},
                       {"bias_m", fit.bias},
                       {"false_front_now", fit.false_front_now},
                       {"false_front_recommended", fit.false_front_then}}},
                     {"fringe", fringe_json(tuning.fringe)},
                     {"extra", std::move(parts)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

Image<Rgb8> draw_tuning(const Tuning& tuning, const KeptFrame& frame, ImageView<const Rgb8> color) {
  Image<Rgb8> image;
  const FringeFit& fringe = tuning.fringe;
  FrameReport report;
  report.index = frame.index;
  draw_overlay(report, {frame.depth.view(), color}, image);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u)
      if (fringe.shown(u, v) != FringeFit::nothing)
        image(u, v) = fringe.shown(u, v) == FringeFit::left ? left_color : removed_color;
  draw_outline(frame.virtual_depth.view(), outline_color, image);
  const std::string reach = std::to_string(fringe.reach);
  draw_legend("removed by fringe_reach " + reach + "; without it " +
                  percent(fringe.left_over.front()) + " of the arm's points stay",
              removed_color, 0, 3, image);
  const double left = fringe.left_over[static_cast<std::size_t>(fringe.reach / FringeFit::step)];
  draw_legend("stays with it: " + percent(left), left_color, 1, 3, image);
  draw_legend("outline of the URDF", outline_color, 2, 3, image);
  return image;
}

}  // namespace penumbra::io
