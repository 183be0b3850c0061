// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <optional>

#include <penumbra/base/version.hpp>

#include <sim/experiments/picture_data.hpp>
#include <sim/experiments/plots.hpp>
#include <sim/experiments/report.hpp>
#include <sim/experiments/report_text.hpp>
#include <sim/experiments/statistics.hpp>

namespace penumbra::sim {
namespace {

std::string rounded(double value, int digits) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string cell_of(const Measure& measure, const Interval& interval) {
  if (!interval.value) return "<td>-</td>";
  const auto& confidence = interval.confidence;
  return "<td>" + rounded(*interval.value, measure.digits) + "<small>" +
         (confidence ? rounded(confidence->low, measure.digits) + " to " +
                           rounded(confidence->high, measure.digits)
                     : "-") +
         "</small></td>";
}

std::string header_of(const Measure& measure) {
  return "<th>" + measure.name + (measure.unit.empty() ? "" : ", " + measure.unit) + "</th>";
}

/// How many times our p95 of the position error a method's is.
std::string ratio_cell(const std::optional<double>& theirs, const std::optional<double>& ours) {
  if (!theirs || !ours || *ours <= 0) return "<td>-</td>";
  return "<td>" + rounded(*theirs / *ours, 1) + "</td>";
}

constexpr std::size_t p95_measure = 1;  // in both experiments' measures

std::string swatch(const MethodInfo& method) {
  const LineStyle style = line_style(method.key);
  return std::string(
             "<svg class='swatch' viewBox='0 0 28 8'><line x1='0' x2='28' y1='4' y2='4' "
             "stroke-width='3' stroke='") +
         style.color + "' stroke-dasharray='" + style.dash + "'/></svg>";
}

std::string lane_section(const ExperimentResult& result, std::size_t lane) {
  const std::vector<Measure> measures = measures_of(result.experiment);
  const SeedRun& first = result.seeds.front();
  std::vector<std::vector<Interval>> rows;
  std::vector<Interval> p95;
  for (std::size_t method = 0; method < first.methods.size(); ++method) {
    const auto runs = watched(result, lane, method);
    rows.emplace_back();
    for (const Measure& measure : measures) rows.back().push_back(interval_of(measure, runs));
    p95.push_back(rows.back()[p95_measure]);
  }
  std::string html = "<h2>" + first.lanes[lane].name + "</h2><div class='wide'><table><thead><tr>" +
                     "<th>Method</th>";
  for (const Measure& measure : measures) html += header_of(measure);
  html += "<th>p95 as a multiple of ours</th></tr></thead><tbody>";
  for (std::size_t method = 0; method < rows.size(); ++method) {
    html += method + 1 == rows.size() ? "<tr class='ours'>" : "<tr>";
    html += "<th>" + swatch(first.methods[method]) + first.methods[method].name + "</th>";
    for (std::size_t i = 0; i < measures.size(); ++i) html += cell_of(measures[i], rows[method][i]);
    html += ratio_cell(p95[method].value, p95.back().value) + "</tr>";
  }
  html += "</tbody></table></div><div class='pair'><figure>" +
          interval_chart(first.methods, p95, measures[p95_measure].name) + "<figcaption>" +
          measures[p95_measure].name + ", with 95 % confidence over seeds.</figcaption></figure>";
  html += "<figure>" + error_plot(first, lane, result.experiment == "conveyor" ? "grasp" : "end") +
          "<figcaption>Position error of seed " + std::to_string(first.seed) +
          ". Shaded: the robot hides more than 5 %. A gap: no pose.</figcaption></figure></div>";
  return html;
}

std::string pictures_section(const ExperimentResult& result) {
  std::string html = "<h2>Key frames</h2><p>Seed " + std::to_string(result.seeds.front().seed) +
                     ". Red, dashed: the raw estimate. Green: handled by Penumbra.</p>"
                     "<div class='pictures'>";
  for (const Picture& picture : result.pictures)
    html += "<figure><img alt='" + picture.caption + "' src='" + data_uri(picture.image) +
            "'><figcaption>" + picture.caption + "</figcaption></figure>";
  return html + "</div>";
}

std::string methods_section(const SeedRun& run) {
  std::string html = "<h2>What was compared</h2><dl>";
  for (std::size_t i = 0; i < run.methods.size(); ++i)
    html += "<dt>" + swatch(run.methods[i]) + run.methods[i].name + "</dt><dd>" +
            run.methods[i].idea + "</dd>";
  return html + "</dl>";
}

std::string settings_line(const ExperimentResult& result) {
  const RunSettings& s = result.settings;
  const SeedRun& first = result.seeds.front();
  std::string text = std::to_string(result.seeds.size()) +
                     (result.seeds.size() == 1 ? " seed, " : " seeds from ") +
                     std::to_string(first.seed) + ", " + rounded(first.frames.back().time, 1) +
                     " s each at " + rounded(1 / first.frame_seconds, 0) +
                     " frames/s. Perception works on every " + std::to_string(s.perception_every) +
                     "rd frame and answers " + rounded(1e3 * s.latency.least, 0) + " to " +
                     rounded(1e3 * s.latency.most, 0) + " ms late. Joints are off by " +
                     rounded(1e3 * s.joint_sigma, 1) + " mrad and " +
                     rounded(1e3 * s.joint_latency, 0) + " ms late.";
  return text;
}

}  // namespace

std::string report_html(const ExperimentResult& result) {
  const bool conveyor = result.experiment == "conveyor";
  std::string html =
      "<!doctype html><html lang='en'><head><meta charset='utf-8'>"
      "<meta name='viewport' content='width=device-width, initial-scale=1'><title>";
  html += conveyor ? conveyor_title : handover_title;
  html += std::string("</title><style>") + report_style + "</style></head><body><main><h1>" +
          (conveyor ? conveyor_title : handover_title) + "</h1><p class='lead'>" +
          (conveyor ? conveyor_story : handover_story) + "</p><p>" + settings_line(result) +
          " Values are over all seeds; small: 95 % confidence, by a bootstrap over seeds; of "
          "counts below 10 "
          "and of shares of seeds, exact; of a single seed, none.</p>";
  html += pictures_section(result);
  for (std::size_t lane = 0; lane < result.seeds.front().lanes.size(); ++lane)
    html += lane_section(result, lane);
  html += methods_section(result.seeds.front());
  html += std::string("<h2>Limits</h2>") + (conveyor ? conveyor_limits : handover_limits) +
          left_out + "<footer>penumbra " + PENUMBRA_VERSION + ", penumbra experiment " +
          result.experiment + " --seeds " + std::to_string(result.seeds.front().seed) + ":" +
          std::to_string(result.seeds.back().seed + 1) + "</footer></main></body></html>\n";
  return html;
}

}  // namespace penumbra::sim
