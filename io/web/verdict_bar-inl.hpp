// SPDX-License-Identifier: Apache-2.0
// Verdicts over time as a bar of colours.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <penumbra/labels/labels.hpp>

namespace penumbra::io {

inline constexpr const char* verdict_bar_style = R"(<style>
.time { width: 100%; }
.time th { padding: 0 .8em 0 0; font-weight: normal; white-space: nowrap; width: 1%; border: 0; }
.time td { padding: 1px 0; border: 0; }
.time svg { display: block; width: 100%; height: 16px; background: #009e73; }
.key { display: inline-block; width: 1em; height: 1em; margin: 0 .3em 0 1em; vertical-align: -.15em; }
</style>
)";

/// From the least to the most that is seen, with the viewer's colours. Visible is the background.
struct VerdictStyle {
  Verdict verdict;
  const char* name;
  const char* color;
};
inline constexpr std::array verdict_styles = {
    VerdictStyle{Verdict::unknown, "unknown", "#f0e442"},
    VerdictStyle{Verdict::out_of_view, "out of view", "#8b949e"},
    VerdictStyle{Verdict::held, "held", "#56b4e9"},
    VerdictStyle{Verdict::hidden, "hidden", "#d55e00"},
    VerdictStyle{Verdict::partial, "partly hidden", "#e69f00"},
    VerdictStyle{Verdict::visible, "visible", "#009e73"}};

inline std::size_t rank_of(Verdict verdict) {
  return static_cast<std::size_t>(
      std::find_if(verdict_styles.begin(), verdict_styles.end(),
                   [&](const VerdictStyle& style) { return style.verdict == verdict; }) -
      verdict_styles.begin());
}

/// Returns what the colours mean.
inline std::string verdict_key() {
  std::string html;
  for (auto style = verdict_styles.rbegin(); style != verdict_styles.rend(); ++style)
    html += std::string("<span class=\"key\" style=\"background:") + style->color + "\"></span>" +
            style->name;
  return html;
}

/// Columns of a bar at most: each is of several frames then, and shows the least of them.
inline constexpr std::size_t most_columns = 500;

[[nodiscard]] inline std::size_t frames_each(std::size_t frames) {
  return (frames + most_columns - 1) / most_columns;
}

/// Returns the bar of each frame's rank.
inline std::string verdict_bar(const std::vector<std::size_t>& of_frames) {
  std::vector<std::size_t> ranks;
  for (std::size_t f = 0; f < of_frames.size(); ++f)
    if (f % frames_each(of_frames.size()) == 0)
      ranks.push_back(of_frames[f]);
    else
      ranks.back() = std::min(ranks.back(), of_frames[f]);
  std::string svg = "<svg viewBox=\"0 0 " + std::to_string(ranks.size()) +
                    " 1\" preserveAspectRatio=\"none\" shape-rendering=\"crispEdges\">";
  for (std::size_t i = 0; i < ranks.size();) {
    std::size_t end = i;
    while (end < ranks.size() && ranks[end] == ranks[i]) ++end;
    const VerdictStyle& style = verdict_styles[ranks[i]];
    if (style.verdict != Verdict::visible)
      svg += "<rect x=\"" + std::to_string(i) + "\" width=\"" + std::to_string(end - i) +
             "\" height=\"1\" fill=\"" + style.color + "\"/>";
    i = end;
  }
  return svg + "</svg>";
}

}  // namespace penumbra::io
