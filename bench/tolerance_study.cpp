// SPDX-License-Identifier: Apache-2.0
// Measures what label rules make of a real recording in which nothing stands before the robot, and
// of squares pasted into it. Writes the table of docs/tuning.md and its plot.
#include "../tests/support/cloud_measure.hpp"
#include "../tests/support/pasted_objects.hpp"
#include "study_page.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <sstream>

namespace penumbra::study {
namespace {

constexpr std::uint64_t seed = 20230206;
constexpr int gaps = 10;  // centimetres

struct NamedRule {
  std::string name;
  LabelRule rule;
};

LabelRule rule_of(const Tolerance& tolerance, int width, int margin) {
  LabelRule rule;
  rule.tolerance = tolerance;
  rule.front_min_width = width;
  rule.edge_margin = margin;
  return rule;
}

const std::array<NamedRule, 4> rules = {
    {{"default", LabelRule{}},
     {"paper: 0.01", LabelRule::paper()},
     {"0.015 + 0.006 z², opening 7", rule_of({0.015, 0, 0.006}, 7, 0)},
     {"0.02 + 0.012 z², no clean-up", rule_of({0.02, 0, 0.012}, 0, 0)}}};

Classifier classifier_of(const test::RealFrame& frame, const LabelRule& rule) {
  return {frame.robot.width(), frame.robot.height(), rule};
}

/// Nothing stands before the robot in the frames as they are.
std::string untouched(const std::vector<test::RealFrame>& frames) {
  std::vector<std::vector<std::string>> rows = {{"% of the robot mask", "mean", "worst frame"}};
  const auto add = [&](const std::string& name, const LabelRule& rule, Label label) {
    Classifier classifier = classifier_of(frames.front(), rule);
    std::vector<double> shares;
    for (const test::RealFrame& frame : frames)
      shares.push_back(test::percent(classifier.classify(frame.view(), frame.measured.view())
                                         .pixels[static_cast<std::size_t>(label)],
                                     frame.mask_pixels));
    const double mean =
        std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size());
    rows.push_back(
        {name, number(mean, 2), number(*std::max_element(shares.begin(), shares.end()), 2)});
  };
  for (const NamedRule& rule : rules) add("false front: " + rule.name, rule.rule, Label::front);
  add("false beyond: default", rules[0].rule, Label::beyond);
  add("unknown", rules[0].rule, Label::unknown);
  return table(rows);
}

/// Percent of the squares' pixels that each rule labels front.
using Seen = std::array<double, rules.size()>;

Seen see_squares(std::vector<test::RealFrame>& frames, double gap, int placements) {
  std::vector<Classifier> classifiers;
  for (const NamedRule& rule : rules)
    classifiers.push_back(classifier_of(frames.front(), rule.rule));
  std::array<std::size_t, rules.size()> fronts{};
  std::size_t all = 0;
  test::Paster paster(seed);
  for (test::RealFrame& frame : frames)
    for (int n = 0; n < placements; ++n) {
      paster.paste_before(frame, {test::Outline::plate, 0.05}, gap);
      all += paster.on_robot().size();
      for (std::size_t i = 0; i < rules.size(); ++i) {
        const LabelView labels = classifiers[i].classify(frame.view(), frame.measured.view());
        for (const int pixel : paster.on_robot())
          fronts[i] += test::label_at(labels, pixel) == Label::front;
      }
      paster.undo(frame);
    }
  Seen seen;
  for (std::size_t i = 0; i < rules.size(); ++i) seen[i] = test::percent(fronts[i], all);
  return seen;
}

/// An SVG line chart of percentages over the gap in centimetres.
std::string plot(const std::vector<Seen>& seen) {
  constexpr double left = 60, top = 40, across = 560, down = 300;  // the plot's area, pixels
  constexpr std::array colours = {"#1b6ca8", "#c0392b", "#2e8b57", "#8e44ad"};
  const auto x_of = [](double centimetres) { return left + across * centimetres / gaps; };
  const auto y_of = [](double percent) { return top + down * (1.0 - percent / 100); };
  std::ostringstream out;
  const auto text = [&](double x, double y, const char* anchor, const std::string& words) {
    out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << words
        << "</text>\n";
  };
  out << std::fixed << std::setprecision(1)
      << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 390\" "
         "font-family=\"sans-serif\" font-size=\"12\">\n"
         "<title>Square of 5 cm before the robot</title>\n"
         "<rect width=\"640\" height=\"390\" fill=\"#fff\"/>\n";
  for (int percent = 0; percent <= 100; percent += 20) {
    out << "<path d=\"M" << left << ' ' << y_of(percent) << 'h' << across
        << "\" stroke=\"#ddd\"/>\n";
    text(left - 8, y_of(percent) + 4, "end", std::to_string(percent));
  }
  for (int gap = 0; gap <= gaps; ++gap)
    text(x_of(gap), top + down + 18, "middle", std::to_string(gap));
  text(left + across / 2, top + down + 38, "middle", "object before the robot, cm");
  text(left, top - 8, "start", "labelled front, % of the object's measured pixels");
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const std::string stroke = std::string("stroke-width=\"2\" stroke=\"") + colours.at(i) + '"';
    out << "<polyline fill=\"none\" " << stroke << " points=\"";
    for (std::size_t gap = 0; gap < seen.size(); ++gap)
      out << x_of(static_cast<double>(gap + 1)) << ',' << y_of(seen[gap][i]) << ' ';
    const double y = top + down - 18.0 * static_cast<double>(i) - 16;
    out << "\"/>\n<path d=\"M" << left + across - 270 << ' ' << y << "h24\" " << stroke << "/>\n";
    text(left + across - 240, y + 4, "start", rules[i].name);
  }
  out << "</svg>\n";
  return out.str();
}

void run(const std::filesystem::path& recording, const std::filesystem::path& root,
         int placements) {
  std::vector<test::RealFrame> frames = test::load_real_frames(recording);
  const std::string page = '\n' + untouched(frames) + '\n';
  std::cout << page;
  std::vector<std::vector<std::string>> rows = {{"square 5 cm, cm before"}};
  for (const NamedRule& rule : rules) rows[0].push_back(rule.name);
  std::vector<Seen> seen;
  for (int gap = 1; gap <= gaps; ++gap) {
    seen.push_back(see_squares(frames, 0.01 * gap, placements));
    rows.push_back({std::to_string(gap)});
    for (const double percent : seen.back()) rows.back().push_back(number(percent, 1));
  }
  std::cout << table(rows);
  write_file(root / "docs/tolerance.svg", plot(seen));
  update_page(root / "docs/tuning.md", "tolerance_study", page);
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  return penumbra::study::main_of("tolerance_study", 100, penumbra::study::run, argc, argv);
}
