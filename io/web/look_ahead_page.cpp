// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include <io/web/html-inl.hpp>
#include <io/web/key_frames.hpp>
#include <io/web/look_ahead_page.hpp>
#include <io/web/verdict_bar-inl.hpp>

namespace penumbra::io {
namespace {

/// The verdicts of equal parts of the motion, each the least of what is seen in it.
std::string bar(const CameraForecast& forecast, double duration) {
  std::vector<std::size_t> ranks(duration > 0.0 ? most_columns : 1, rank_of(Verdict::visible));
  for (const VerdictInterval& each : forecast.intervals) {
    const auto column = [&](double time) {
      return duration > 0.0 ? static_cast<std::size_t>(time / duration * most_columns) : 0;
    };
    for (std::size_t i = column(each.begin); i <= column(each.end) && i < ranks.size(); ++i)
      ranks[i] = std::min(ranks[i], rank_of(each.verdict));
  }
  return verdict_bar(ranks);
}

std::string motion_section(const LookAheadResult& result, std::size_t index,
                           const std::vector<MomentPicture>& pictures) {
  const double duration = result.motions[index].trajectory.duration();
  const std::vector<TargetForecast>& targets = result.forecasts[index];
  std::string html = "<h2>" + escaped(result.motions[index].name) + "</h2>\n<p>" +
                     number(duration, 2) + " s, from left to right." + verdict_key() +
                     "</p>\n<table class=\"time\">\n";
  const bool has_several = result.cameras.size() > 1;
  for (const TargetForecast& target : targets) {
    html += "<tr><th>" + escaped(target.name) + (has_several ? ", any camera" : "") + "</th><td>" +
            bar(target.any, duration) + "</td></tr>\n";
    for (std::size_t c = 0; has_several && c < result.cameras.size(); ++c)
      html += "<tr><th>&nbsp; " + escaped(result.cameras[c].name) + "</th><td>" +
              bar(target.cameras[c], duration) + "</td></tr>\n";
  }
  html += "</table>\n";
  Rows rows = {{"target", "from", "to", "is", "most hidden", "by", "reason"}};
  for (const TargetForecast& target : targets)
    for (const VerdictInterval& each : target.any.intervals)
      rows.push_back({target.name, number(each.begin, 2) + " s", number(each.end, 2) + " s",
                      verdict_styles[rank_of(each.verdict)].name,
                      number(100.0 * each.hidden, 0) + " %", each.by, each.reason});
  html += table(rows) + "<p>Orange in the pictures: the robot as it will be.</p>\n";
  for (const MomentPicture& picture : pictures)
    html += "<figure><figcaption>" + escaped(picture.caption) + "</figcaption><img alt=\"" +
            escaped(picture.caption) + "\" src=\"" + picture_uri(picture.image.view()) +
            "\"></figure>\n";
  return html;
}

}  // namespace

std::string look_ahead_page(const LookAheadResult& result,
                            const std::vector<std::vector<MomentPicture>>& pictures) {
  std::string html = page_start("Look ahead: " + result.input) + verdict_bar_style +
                     "<style>figure { grid-template-columns: 1fr; max-width: 640px; }</style>\n" +
                     "<p>What planned motions of the robot will hide from frame " +
                     std::to_string(result.frame) +
                     " on, if nothing else moves. Times are seconds from the motion's start.</p>\n";
  for (const std::string& note : result.notes)
    html += "<p class=\"bad\">" + escaped(note) + "</p>\n";
  if (result.motions.size() > 1) {
    Rows rows = {{"motion", "targets seen", "what costs most"}};
    for (const RankedMotion& each : result.ranking)
      rows.push_back({result.motions[each.trajectory].name,
                      number(100.0 * each.seen, 1) + " % of the time", each.reason});
    html += "<h2>Ranking</h2>\n" + table(rows);
  }
  if (!result.now.empty()) {
    Rows rows = {{"target", "now", "hidden by other things", "reason"}};
    for (const TargetReport& report : result.now)
      rows.push_back({report.name, verdict_styles[rank_of(report.verdict)].name,
                      report.judgement && report.judgement->hidden_by_other
                          ? number(100.0 * *report.judgement->hidden_by_other, 0) + " %"
                          : "not known",
                      report.reason});
    html += "<h2>Now, as the camera measures</h2>\n" + table(rows);
  }
  for (std::size_t i = 0; i < result.motions.size(); ++i)
    html += motion_section(result, i, pictures[i]);
  return html;
}

}  // namespace penumbra::io
