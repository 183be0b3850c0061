// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <io/web/camera_views_page.hpp>
#include <io/web/html-inl.hpp>
#include <io/web/verdict_bar-inl.hpp>

namespace penumbra::io {
namespace {

std::string counts_table(const CameraViews& views) {
  Rows rows = {{"target", "visible", "partly hidden", "hidden", "unknown", "out of view", "held",
                "contradictions"}};
  for (const FusedCounts& target : counts_of(views)) {
    rows.push_back({target.name});
    for (const std::size_t times : target.verdicts) rows.back().push_back(std::to_string(times));
    rows.back().push_back(std::to_string(target.contradictions));
  }
  return table(rows);
}

/// What is said of a target at each instant in which it is judged: over all cameras, and by each.
struct Ranks {
  std::vector<std::size_t> fused;
  std::vector<std::vector<std::size_t>> cameras;
};

Ranks ranks_of(const CameraViews& views, const std::string& name) {
  Ranks ranks{{}, std::vector<std::vector<std::size_t>>(views.cameras.size())};
  for (const FusedFrame& frame : views.frames)
    for (const FusedTarget& target : frame.targets) {
      if (target.name != name) continue;
      ranks.fused.push_back(rank_of(target.verdict));
      for (auto& camera : ranks.cameras) camera.push_back(rank_of(Verdict::unknown));
      for (const CameraView& view : target.views)
        ranks.cameras[view.camera].back() = rank_of(view.verdict);
    }
  return ranks;
}

std::string row(const std::string& heading, const std::vector<std::size_t>& ranks) {
  return "<tr><th>" + heading + "</th><td>" + verdict_bar(ranks) + "</td></tr>\n";
}

}  // namespace

std::string camera_views_page(const CameraViews& views) {
  std::string html = page_start("Targets over " + std::to_string(views.cameras.size()) +
                                " cameras of " + views.input) +
                     verdict_bar_style + counts_table(views) +
                     "<h2>Over time</h2>\n<p>The images of all cameras, from left to right." +
                     verdict_key() + "</p>\n";
  for (const FusedCounts& target : counts_of(views)) {
    const Ranks ranks = ranks_of(views, target.name);
    html += "<h3>" + escaped(target.name) + "</h3>\n<table class=\"time\">\n" +
            row("<b>all cameras</b>", ranks.fused);
    for (std::size_t c = 0; c < views.cameras.size(); ++c) {
      const std::string& name = views.cameras[c];
      html += row("<a href=\"" + url_of(name) + "/report.html\">" + escaped(name) + "</a>",
                  ranks.cameras[c]);
    }
    html += "</table>\n";
  }
  return html;
}

}  // namespace penumbra::io
