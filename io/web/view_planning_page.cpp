// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <io/web/html-inl.hpp>
#include <io/web/verdict_bar-inl.hpp>
#include <io/web/view_planning_page.hpp>

namespace penumbra::io {
namespace {

constexpr const char* heat_style = R"(<style>
.heat td { padding: .2em .8em; border: 1px solid #fff; text-align: right; color: #161b22; }
.heat th { padding: .2em .8em .2em 0; font-weight: normal; white-space: nowrap; }
.heat .set { font-weight: bold; }
</style>
)";

std::string percent(double share) { return number(100.0 * share, 1) + " %"; }

std::string sets_table(const ViewPlan& plan) {
  Rows rows = {{"cameras", "best set", "visible, mean"}};
  for (std::size_t t = 0; t < plan.views.targets(); ++t) rows[0].push_back(plan.target(t));
  for (const CameraSet& set : plan.best) {
    rows.push_back({std::to_string(set.candidates.size()), plan.names(set), percent(set.mean)});
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
  for (const Verdict verdict : all_verdicts)
    text += (text.empty() ? "" : ", ") + std::string(verdict_styles[rank_of(verdict)].name) + " " +
            percent(plan.views.share(candidate, target, verdict));
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

/// What the cameras together see in each frame.
std::vector<std::size_t> ranks_of(const ViewPlan& plan, const std::vector<std::size_t>& cameras,
                                  std::size_t target) {
  std::vector<std::size_t> ranks(plan.views.frames(), 0);
  for (std::size_t f = 0; f < ranks.size(); ++f)
    for (const std::size_t c : cameras)
      ranks[f] = std::max(ranks[f], rank_of(plan.views.at(c, f, target)));
  return ranks;
}

std::string over_time(const ViewPlan& plan) {
  const std::size_t each = frames_each(plan.views.frames());
  std::string html = "<h2>Over time</h2>\n<p>Frame " + std::to_string(plan.motion.front().index) +
                     " to " + std::to_string(plan.motion.back().index) +
                     ", from left to right. The best set shows the camera that "
                     "sees most.";
  if (each > 1)
    html += " Each step is " + std::to_string(each) +
            " frames, and shows the one in which least is seen.";
  html += verdict_key() + "</p>\n";
  for (std::size_t t = 0; t < plan.views.targets(); ++t) {
    html += "<h3>" + escaped(plan.target(t)) +
            "</h3>\n<table class=\"time heat\">\n<tr><th class=\"set\">best set</th><td>" +
            verdict_bar(ranks_of(plan, plan.best.back().candidates, t)) + "</td></tr>\n";
    for (std::size_t c = 0; c < plan.candidates.size(); ++c)
      html += "<tr>" + name_cell(plan, c) + "<td>" + verdict_bar(ranks_of(plan, {c}, t)) +
              "</td></tr>\n";
    html += "</table>\n";
  }
  return html;
}

}  // namespace

std::string view_planning_page(const ViewPlan& plan) {
  std::string html = page_start("View planning for " + plan.input) + verdict_bar_style + heat_style;
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
