// SPDX-License-Identifier: Apache-2.0
// Measures what labelling rules make of a real recording in which nothing stands before the robot,
// and of objects pasted into it. Writes docs/tuning.md's table, its plot and a CSV file.
#include "tolerance_study.hpp"

#include "study_page.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace penumbra::study {
namespace {

constexpr std::uint64_t first_seed = 20230206;

LabelRule rule_of(const Tolerance& tolerance, int width, int margin) {
  LabelRule rule;
  rule.tolerance = tolerance;
  rule.front_min_width = width;
  rule.edge_margin = margin;
  return rule;
}

std::vector<NamedRule> compared_rules() {
  return {{"default", LabelRule{}},
          {"paper: 0.01", LabelRule::paper()},
          {"0.015 + 0.006 z², opening 7", rule_of({0.015, 0, 0.006}, 7, 0)},
          {"0.02 + 0.012 z², no clean-up", rule_of({0.02, 0, 0.012}, 0, 0)}};
}

std::vector<NamedKind> kinds() {
  return {{"square 5 cm", {test::Shape::square, 0.05, 0.0}},
          {"disc 5 cm", {test::Shape::disc, 0.05, 0.0}},
          {"square 5 cm, tilted 35°", {test::Shape::square, 0.05, 0.61}},
          {"square 8 cm", {test::Shape::square, 0.08, 0.0}},
          {"disc 10 cm, tilted 20°", {test::Shape::disc, 0.10, 0.35}}};
}

/// The default with one thing changed.
std::vector<NamedRule> variants() {
  const LabelRule base;
  std::vector<NamedRule> rules = {{"default", base}};
  const auto add = [&](const std::string& name, auto change) {
    LabelRule rule = base;
    change(rule);
    rules.push_back({name, rule});
  };
  for (const double a : {0.005, 0.01, 0.02, 0.025})
    add("a = " + std::to_string(a).substr(0, 5), [&](LabelRule& r) { r.tolerance.a = a; });
  for (const double c : {0.0, 0.003, 0.009, 0.012})
    add("c = " + std::to_string(c).substr(0, 5), [&](LabelRule& r) { r.tolerance.c = c; });
  for (const int width : {3, 5, 9, 11})
    add("front_min_width = " + std::to_string(width),
        [&](LabelRule& r) { r.front_min_width = width; });
  for (const int margin : {0, 4, 12, 16})
    add("edge_margin = " + std::to_string(margin), [&](LabelRule& r) { r.edge_margin = margin; });
  return rules;
}

struct Study {
  std::vector<test::RealFrame> frames;
  int placements;
  std::ostringstream csv;
  std::vector<Curve> curves;

  std::string untouched() {
    std::vector<std::vector<std::string>> rows = {{"% of the robot mask", "mean", "worst frame"}};
    const auto rules = compared_rules();
    const auto results = study_untouched(frames, rules);
    const auto add = [&](const std::string& name, const std::vector<double>& values) {
      csv << "untouched," << name << ",,";
      for (const double value : values) csv << ',' << number(value, 4);
      csv << ',' << number(mean(values), 4) << '\n';
      rows.push_back({name, number(mean(values), 2), number(largest(values), 2)});
    };
    for (std::size_t i = 0; i < rules.size(); ++i)
      add("false front: " + rules[i].name, results[i].front);
    add("false beyond: default", results[0].beyond);
    add("unknown", results[0].unknown);
    return table(rows);
  }

  /// Returns a table of the gaps up to 5 cm and of 10 cm. The CSV file has all gaps, and
  /// the band at the edge.
  std::string objects(const NamedKind& named) {
    const auto rules = compared_rules();
    std::vector<std::vector<std::string>> rows = {{named.name + ", cm before"}};
    for (const NamedRule& rule : rules) rows[0].push_back(rule.name);
    const bool plotted = curves.empty();
    if (plotted)
      for (const NamedRule& rule : rules) curves.push_back({rule.name, {}, {}});
    for (int gap = 1; gap <= 10; ++gap) {
      const auto seen =
          study_objects(frames, rules, named.kind, 0.01 * gap, placements, first_seed);
      std::vector<std::string> row = {std::to_string(gap)};
      for (std::size_t i = 0; i < rules.size(); ++i) {
        row.push_back(number(seen[i].core, 1));
        csv << "object," << rules[i].name << ',' << named.name << ',' << gap << ','
            << number(seen[i].core, 3) << ',' << number(seen[i].band, 3) << '\n';
        if (!plotted) continue;
        curves[i].x.push_back(gap);
        curves[i].y.push_back(seen[i].core);
      }
      if (gap <= 5 || gap == 10) rows.push_back(row);
      std::cerr << named.name << ' ' << gap << " cm\n";
    }
    return table(rows);
  }

  void tuning() {
    const auto rules = variants();
    const auto untouched = study_untouched(frames, rules);
    const test::ObjectKind kind = kinds().front().kind;
    std::vector<std::vector<Seen>> seen;
    for (const double gap : {0.02, 0.03, 0.05})
      seen.push_back(study_objects(frames, rules, kind, gap, placements, first_seed));
    for (std::size_t i = 0; i < rules.size(); ++i) {
      csv << "tuning," << rules[i].name << ",," << number(mean(untouched[i].front), 4) << ','
          << number(largest(untouched[i].front), 4);
      for (const auto& at_gap : seen) csv << ',' << number(at_gap[i].core, 3);
      csv << '\n';
    }
  }
};

void run(const std::filesystem::path& recording, const std::filesystem::path& root,
         int placements) {
  Study study{test::load_real_frames(recording), placements, {}, {}};
  const std::string untouched = '\n' + study.untouched() + '\n';
  std::cout << untouched;
  for (const NamedKind& kind : kinds()) std::cout << study.objects(kind) << '\n';
  study.tuning();
  write_file(root / "bench/results/tolerance.csv", study.csv.str());
  write_file(root / "docs/tolerance.svg",
             svg_plot("Square of 5 cm before the robot", study.curves));
  update_page(root / "docs/tuning.md", "tolerance_study", untouched);
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::cerr << "usage: tolerance_study RECORDING REPOSITORY [PLACEMENTS]\n";
    return 2;
  }
  try {
    penumbra::study::run(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 100);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}
