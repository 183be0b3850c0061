// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include <sim/experiments/plots.hpp>

namespace penumbra::sim {
namespace {

constexpr double plot_width = 560, plot_height = 320;  // of the view box
constexpr double margin_left = 58, margin_right = 12, margin_top = 14, margin_bottom = 40;
constexpr double least_error = 1e-3, most_error = 1.0;  // metres

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

/// Places of values on a plot's axes.
struct Axes {
  double end = 1;  // seconds
  [[nodiscard]] double x(double time) const {
    return margin_left + time / end * (plot_width - margin_left - margin_right);
  }
  [[nodiscard]] static double y(double error) {
    const double share = std::log(std::clamp(error, least_error, most_error) / least_error) /
                         std::log(most_error / least_error);
    return plot_height - margin_bottom - share * (plot_height - margin_top - margin_bottom);
  }
};

std::string shaded_spans(const SeedRun& run, const Axes& axes) {
  std::string svg;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    if (run.frames[i].hidden <= occluded_share) continue;
    const std::size_t first = i;
    while (i + 1 < run.frames.size() && run.frames[i + 1].hidden > occluded_share) ++i;
    const double from = axes.x(run.frames[first].time);
    const double to = axes.x(run.frames[i].time + run.frame_seconds);
    svg += format("<rect class='hid' x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>", from,
                  margin_top, to - from, plot_height - margin_top - margin_bottom);
  }
  return svg;
}

std::string grid(const Axes& axes) {
  constexpr std::array<std::pair<double, const char*>, 6> errors{{{0.001, "1 mm"},
                                                                  {0.003, "3 mm"},
                                                                  {0.01, "1 cm"},
                                                                  {0.03, "3 cm"},
                                                                  {0.1, "10 cm"},
                                                                  {1.0, "1 m"}}};
  std::string svg;
  for (const auto& [error, name] : errors) {
    const double y = Axes::y(error);
    svg += format("<line class='grid' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", margin_left,
                  plot_width - margin_right, y, y);
    svg +=
        format("<text x='%.1f' y='%.1f' text-anchor='end'>%s</text>", margin_left - 6, y + 4, name);
  }
  const double step = axes.end > 8 ? 2 : 1;
  for (double time = 0; time <= axes.end; time += step)
    svg += format("<text x='%.1f' y='%.1f' text-anchor='middle'>%.0f s</text>", axes.x(time),
                  plot_height - margin_bottom + 18, time);
  return svg;
}

/// A whisker; none where nothing is known of the confidence.
Confidence span_of(const Interval& interval) {
  return interval.confidence.value_or(Confidence{*interval.value, *interval.value});
}

std::string goal_mark(double x, const std::string& name) {
  return format("<line class='goal' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", x, x, margin_top,
                plot_height - margin_bottom) +
         format("<text x='%.1f' y='%.1f' text-anchor='%s'>%s</text>", x, plot_height - 6,
                x > 0.8 * plot_width ? "end" : "middle", name.c_str());
}

std::string error_line(const SeedRun& run, const MethodRun& method, const Axes& axes,
                       const std::string& key) {
  std::string path;
  bool drawing = false;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const Sample& sample = method.samples[i];
    if (sample.known)
      path += format("%c%.1f %.1f", drawing ? 'L' : 'M', axes.x(run.frames[i].time),
                     Axes::y(sample.translation_error));
    drawing = sample.known;
  }
  const LineStyle style = line_style(key);
  return format("<path fill='none' stroke='%s' stroke-dasharray='%s' stroke-width='%s' d='",
                style.color, style.dash, key == "penumbra" ? "3.2" : "1.6") +
         path + "'/>";
}

}  // namespace

LineStyle line_style(const std::string& key) {
  static const std::map<std::string, LineStyle> styles{{"raw", {"#d55e00", "7 4"}},
                                                       {"tracker", {"#e69f00", ""}},
                                                       {"height_raw", {"#cc79a7", "2 4"}},
                                                       {"height", {"#cc79a7", ""}},
                                                       {"silhouette_raw", {"#8b5a2b", "2 4"}},
                                                       {"silhouette", {"#8b5a2b", ""}},
                                                       {"urdf_filter_raw", {"#56b4e9", "2 4"}},
                                                       {"urdf_filter", {"#56b4e9", ""}},
                                                       {"own_model", {"#0072b2", "9 3 2 3"}},
                                                       {"two_cameras", {"#8c8c8c", ""}},
                                                       {"penumbra_partial", {"#009e73", "4 3"}},
                                                       {"penumbra", {"#009e73", ""}}};
  return styles.at(key);
}

std::string error_plot(const SeedRun& run, std::size_t lane, std::string_view goal_name) {
  const Axes axes{run.frames.back().time + run.frame_seconds};
  std::string svg =
      format("<svg class='plot' role='img' viewBox='0 0 %.0f %.0f'>", plot_width, plot_height);
  svg += "<title>Position error against time</title>" + shaded_spans(run, axes) + grid(axes);
  if (run.goal) svg += goal_mark(axes.x(run.frames[*run.goal].time), std::string(goal_name));
  const std::vector<MethodRun>& methods = run.lanes[lane].methods;
  for (std::size_t i = 0; i < methods.size(); ++i)
    svg += error_line(run, methods[i], axes, run.methods[i].key);
  return svg + "</svg>";
}

std::string interval_chart(const std::vector<MethodInfo>& methods,
                           const std::vector<Interval>& intervals, std::string_view title) {
  constexpr double row = 30, top = 12, left = 226, right = 40;
  double least = 1e9, most = 0;
  for (const Interval& interval : intervals) {
    if (!interval.value) continue;
    const Confidence span = span_of(interval);
    least = std::min({least, *interval.value, std::max(span.low, 1e-3)});
    most = std::max({most, *interval.value, span.high});
  }
  if (most <= 0) return "<p>Nothing to show: in no frame that counts is the target hidden.</p>";
  const double low = std::pow(10.0, std::floor(std::log10(least)));
  const double high = std::max(std::pow(10.0, std::ceil(std::log10(most))), 10 * low);
  const auto x = [&](double value) {
    return left + std::log(std::clamp(value, low, high) / low) / std::log(high / low) *
                      (plot_width - left - right);
  };
  const double bottom = top + row * static_cast<double>(methods.size());
  std::string svg = format("<svg class='plot' role='img' viewBox='0 0 %.0f %.0f'><title>",
                           plot_width, bottom + 30);
  svg += std::string(title) + "</title>";
  for (double tick = low; tick <= high * 1.001; tick *= 10) {
    svg += format("<line class='grid' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", x(tick), x(tick),
                  top, bottom);
    svg += format("<text x='%.1f' y='%.1f' text-anchor='middle'>%g mm</text>", x(tick), bottom + 20,
                  tick);
  }
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const double y = top + row * (static_cast<double>(i) + 0.5);
    svg += format("<text x='%.1f' y='%.1f' text-anchor='end'>%s</text>", left - 10, y + 4,
                  methods[i].name.c_str());
    if (!intervals[i].value) continue;
    const char* const color = line_style(methods[i].key).color;
    const Confidence span = span_of(intervals[i]);
    svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f' stroke='%s' stroke-width='3'/>",
                  x(span.low), x(span.high), y, y, color);
    svg +=
        format("<circle cx='%.1f' cy='%.1f' r='6' fill='%s'/>", x(*intervals[i].value), y, color);
  }
  return svg + "</svg>";
}

}  // namespace penumbra::sim
