// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <io/web/html-inl.hpp>
#include <io/web/view_planning_page.hpp>

namespace penumbra::io {
namespace {

constexpr const char* heat_style = R"(<style>
.heat td { padding: .2em .8em; border: 1px solid #fff; text-align: right; color: #161b22; }
.heat th { padding: .2em .8em .2em 0; font-weight: normal; white-space: nowrap; }
.heat .set { font-weight: bold; }
.time { width: 100%; }
.time th { padding: 0 .8em 0 0; font-weight: normal; white-space: nowrap; width: 1%; border: 0; }
.time td { padding: 1px 0; border: 0; }
.time svg { display: block; width: 100%; height: 16px; background: #009e73; }
.key { display: inline-block; width: 1em; height: 1em; margin: 0 .3em 0 1em; vertical-align: -.15em; }
</style>
)";

/// From the least to the most that is seen, with the viewer's colours. Visible is the background.
struct VerdictLook {
  Verdict verdict;
  const char* name;
  const char* color;
};
constexpr std::array verdict_looks = {VerdictLook{Verdict::unknown, "unknown", "#f0e442"},
                                      VerdictLook{Verdict::out_of_view, "out of view", "#8b949e"},
                                      VerdictLook{Verdict::held, "held", "#56b4e9"},
                                      VerdictLook{Verdict::hidden, "hidden", "#d55e00"},
                                      VerdictLook{Verdict::partial, "partly hidden", "#e69f00"},
                                      VerdictLook{Verdict::visible, "visible", "#009e73"}};

constexpr std::size_t most_columns = 500;  // of time

std::size_t rank_of(Verdict verdict) {
  return static_cast<std::size_t>(
      std::find_if(verdict_looks.begin(), verdict_looks.end(),
                   [&](const VerdictLook& look) { return look.verdict == verdict; }) -
      verdict_looks.begin());
}

std::string percent(double share) { return number(100.0 * share, 1) + " %"; }

std::string sets_table(const ViewPlan& plan) {
  Rows rows = {{"cameras", "best set", "visible, mean"}};
  for (std::size_t t = 0; t < plan.views.targets(); ++t) rows[0].push_back(plan.target(t));
  for (const CameraSet& set : plan.best) {
    rows.push_back({std::to_string(set.candidates.size()), plan.names(set),
                    percent(set.mean) +
                        (set.mean == set.at_most
                             ? ""
                             : " (greedy; no set has more than " + percent(set.at_most) + ")")});
    for (const double share : set.visible) rows.back().push_back(percent(share));
  }
  return "<h2>Best sets</h2>\n<p>The share of the frames in which at least one camera of the set "
         "sees the target: it is visible, not only in part.</p>\n" +
         table(rows);
}

/// White at 0, the green of "visible" at 1.
std::string heat_color(double share) {
  const auto mix = [&](int full) { return std::lround(255.0 + share * (full - 255.0)); };
  return "rgb(" + std::to_string(mix(0)) + "," + std::to_string(mix(0x9e)) + "," +
         std::to_string(mix(0x73)) + ")";
}

std::string shares_text(const ViewPlan& plan, std::size_t candidate, std::size_t target) {
  std::string text;
  for (auto look = verdict_looks.rbegin(); look != verdict_looks.rend(); ++look)
    text += (text.empty() ? "" : ", ") + std::string(look->name) + " " +
            percent(plan.views.share(candidate, target, look->verdict));
  return text;
}

bool is_chosen(const ViewPlan& plan, std::size_t candidate) {
  const std::vector<std::size_t>& set = plan.best.back().candidates;
  return std::find(set.begin(), set.end(), candidate) != set.end();
}

std::string name_cell(const ViewPlan& plan, std::size_t candidate) {
  return std::string("<th") + (is_chosen(plan, candidate) ? " class=\"set\">" : ">") +
         escaped(plan.candidates[candidate].name) + "</th>";
}

std::string heat_map(const ViewPlan& plan) {
  std::string html =
      "<h2>Share visible</h2>\n<p>Of the frames. Candidates of the largest set above are bold. "
      "Point at a cell for the other shares.</p>\n<table class=\"heat\">\n<tr><th></th>";
  for (std::size_t t = 0; t < plan.views.targets(); ++t)
    html += "<th>" + escaped(plan.target(t)) + "</th>";
  html += "</tr>\n";
  for (std::size_t c = 0; c < plan.candidates.size(); ++c) {
    html += "<tr>" + name_cell(plan, c);
    for (std::size_t t = 0; t < plan.views.targets(); ++t) {
      const double share = plan.views.share(c, t, Verdict::visible);
      html += "<td style=\"background:" + heat_color(share) + "\" title=\"" +
              shares_text(plan, c, t) + "\">" + percent(share) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

/// The least that the cameras together see in each column of time.
std::vector<std::size_t> ranks_of(const ViewPlan& plan, const std::vector<std::size_t>& cameras,
                                  std::size_t target, std::size_t frames_each) {
  std::vector<std::size_t> ranks;
  for (std::size_t f = 0; f < plan.views.frames(); ++f) {
    std::size_t most = 0;
    for (const std::size_t c : cameras) most = std::max(most, rank_of(plan.views.at(c, f, target)));
    if (f % frames_each == 0)
      ranks.push_back(most);
    else
      ranks.back() = std::min(ranks.back(), most);
  }
  return ranks;
}

std::string time_row(const std::vector<std::size_t>& ranks) {
  std::string svg = "<svg viewBox=\"0 0 " + std::to_string(ranks.size()) +
                    " 1\" preserveAspectRatio=\"none\" shape-rendering=\"crispEdges\">";
  for (std::size_t i = 0; i < ranks.size();) {
    std::size_t end = i;
    while (end < ranks.size() && ranks[end] == ranks[i]) ++end;
    const VerdictLook& look = verdict_looks[ranks[i]];
    if (look.verdict != Verdict::visible)
      svg += "<rect x=\"" + std::to_string(i) + "\" width=\"" + std::to_string(end - i) +
             "\" height=\"1\" fill=\"" + look.color + "\"/>";
    i = end;
  }
  return svg + "</svg>";
}

std::string over_time(const ViewPlan& plan) {
  const std::size_t frames_each = (plan.views.frames() + most_columns - 1) / most_columns;
  std::string html = "<h2>Over time</h2>\n<p>Frame " + std::to_string(plan.motion.front().index) +
                     " to " + std::to_string(plan.motion.back().index) +
                     ", from left to right. The best set shows the camera that "
                     "sees most.";
  if (frames_each > 1)
    html += " Each step is " + std::to_string(frames_each) +
            " frames, and shows the one in which least is seen.";
  for (auto look = verdict_looks.rbegin(); look != verdict_looks.rend(); ++look)
    html += std::string("<span class=\"key\" style=\"background:") + look->color + "\"></span>" +
            look->name;
  html += "</p>\n";
  for (std::size_t t = 0; t < plan.views.targets(); ++t) {
    html += "<h3>" + escaped(plan.target(t)) +
            "</h3>\n<table class=\"time heat\">\n<tr><th class=\"set\">best set</th><td>" +
            time_row(ranks_of(plan, plan.best.back().candidates, t, frames_each)) + "</td></tr>\n";
    for (std::size_t c = 0; c < plan.candidates.size(); ++c)
      html += "<tr>" + name_cell(plan, c) + "<td>" + time_row(ranks_of(plan, {c}, t, frames_each)) +
              "</td></tr>\n";
    html += "</table>\n";
  }
  return html;
}

}  // namespace

std::string view_planning_page(const ViewPlan& plan) {
  std::string html = page_start("View planning for " + plan.input) + heat_style;
  if (plan.seen > plan.motion.size())
    html += "<p class=\"bad\">" + std::to_string(plan.seen - plan.motion.size()) + " of " +
            std::to_string(plan.seen) +
            " frames are left out, because the robot's pose is not known.</p>\n";
  html += sets_table(plan) + heat_map(plan) + over_time(plan);
  Rows unknown = {{"candidate", "first unknown verdict"}};
  for (std::size_t c = 0; c < plan.candidates.size(); ++c)
    if (!plan.views.unknown(c).empty())
      unknown.push_back({plan.candidates[c].name, plan.views.unknown(c)});
  if (unknown.size() > 1) html += "<h2>Unknown</h2>\n" + table(unknown);
  return html;
}

}  // namespace penumbra::io
