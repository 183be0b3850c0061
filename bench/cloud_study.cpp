// SPDX-License-Identifier: Apache-2.0
// Measures, on a real recording, how many points of the robot are left in a cloud without the robot
// and what the fringe takes of objects pasted beside it. Prints all tables; writes the first into
// docs/cloud.md, and a CSV file.
#include "../tests/support/cloud_measure.hpp"
#include "../tests/support/pasted_object.hpp"
#include "study_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace penumbra::study {
namespace {

using test::Gap;
using test::Kept;
using test::label_at;
using test::Outline;
using test::SideObject;
using Rows = std::vector<std::vector<std::string>>;

constexpr std::uint64_t first_seed = 20230206;
constexpr double true_step = 0.05;         // metres
constexpr double true_step_margin = 12.0;  // pixels
constexpr std::array<double, 5> offsets = {-0.10, -0.05, 0.0, 0.05, 0.10};

struct NamedObject {
  std::string name;
  SideObject object;
};
const std::array<NamedObject, 4> objects = {
    {{"plate 10 x 10 cm", {Outline::plate, 0.10, 0.10}},
     {"disc 8 cm", {Outline::disc, 0.08, 0.08}},
     {"cylinder 7 x 12 cm", {Outline::cylinder, 0.07, 0.12}},
     {"hand", {Outline::hand, 0.085, 0.085}}}};
constexpr SideObject rod{Outline::rod, 0.01, 0.30};

struct NamedGap {
  std::string name;
  Gap gap;
};
const std::array<NamedGap, 4> gaps = {
    {{"0 px", {0, 0}}, {"10 px", {10, 0}}, {"3 cm", {0, 0.03}}, {"> 40 px", {42, 0}}}};

LabelRule rule_with_reach(int reach) {
  LabelRule rule;
  rule.fringe_reach = reach;
  return rule;
}

std::string shares(const Kept& kept) {
  if (kept.core + kept.band == 0) return "-";
  return number(kept.core_percent(), 1) + " (" + number(kept.band_percent(), 0) + ")";
}

std::string centimetres(double metres) {
  return metres == 0.0 ? "0" : (metres > 0.0 ? "+" : "") + number(100 * metres, 0);
}

/// What the fringe leaves and takes of a 3 cm gap's object at the robot's own depth.
struct Rim {
  std::size_t beyond_reach = 0, beyond_reach_kept = 0, placements = 0;
  double lost = 0.0, most_lost = 0.0;  // metres from the near edge, sum and largest

  void add(const std::vector<int>& pixels, const LabelView& labels,
           const test::NearestRobot& nearest, double clearance, double metres_per_pixel,
           int reach) {
    double farthest = clearance;
    for (const int pixel : pixels) {
      const double distance =
          nearest.distance(pixel % labels.labels.width, pixel / labels.labels.width);
      const bool is_fringe = label_at(labels, pixel) == Label::fringe;
      if (is_fringe) farthest = std::max(farthest, distance);
      if (distance <= reach) continue;
      ++beyond_reach;
      beyond_reach_kept += !is_fringe;
    }
    const double rim = (farthest - clearance) * metres_per_pixel;
    ++placements;
    lost += rim;
    most_lost = std::max(most_lost, rim);
  }
};

struct Study {
  std::vector<test::RealFrame> frames;
  int placements;  // in each frame
  std::vector<test::NearestRobot> nearest = {};
  std::ostringstream csv = {};
  std::array<std::array<Kept, gaps.size()>, objects.size()> stepped = {};
  std::array<Rim, objects.size()> rims = {};
  test::SidePaster paster = test::SidePaster(first_seed);
  Classifier classifier =
      Classifier(frames.front().robot.width(), frames.front().robot.height(), {});

  std::string leftover();
  std::string carried_by_distance();
  std::string beside(std::size_t object);
  Kept beside_at(std::size_t object, std::size_t gap, double offset);
  std::string with_true_step() const;
  std::string rim() const;
  std::string before_the_arm();
  std::string rods();
};

std::string Study::leftover() {
  Rows rows = {{"fringe_reach, px", "points of the arm left, %", "clear points removed, %"}};
  std::size_t all_clear = 0;
  for (const int reach : {0, 10, 20, 30, 40, 60}) {
    const test::Leftover found = measure_leftover(frames, nearest, rule_with_reach(reach));
    if (reach == 0) all_clear = found.clear;
    rows.push_back({std::to_string(reach), number(found.percent(), 2),
                    number(test::percent(all_clear - found.clear, all_clear), 2)});
    csv << "leftover," << reach << ',' << found.left << ',' << found.carried + found.on_robot << ','
        << number(found.percent(), 4) << ',' << number(found.front_percent(), 4) << ','
        << found.clear << '\n';
  }
  return table(rows);
}

/// Where past the outline the sensor carries depth, without and with the default.
std::string Study::carried_by_distance() {
  constexpr std::array<double, 6> upto = {2, 5, 10, 20, 30, 40};
  std::array<std::size_t, upto.size()> carried{}, left{};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LabelView labels = classifier.classify(frames[i].view(), frames[i].measured.view());
    for_each_carried(frames[i], nearest[i], [&](int u, int v, double distance) {
      const auto bin = static_cast<std::size_t>(
          std::lower_bound(upto.begin(), upto.end(), distance) - upto.begin());
      ++carried[bin];
      left[bin] += label_at(labels, v * labels.labels.width + u) != Label::fringe;
    });
  }
  Rows rows = {{"pixels from the outline"}, {"points carried there"}, {"left by the default"}};
  for (std::size_t bin = 0; bin < upto.size(); ++bin) {
    rows[0].push_back("to " + number(upto[bin], 0));
    rows[1].push_back(std::to_string(carried[bin]));
    rows[2].push_back(std::to_string(left[bin]));
    csv << "distance," << upto[bin] << ',' << carried[bin] << ',' << left[bin] << '\n';
  }
  return table(rows);
}

Kept Study::beside_at(std::size_t object, std::size_t gap, double offset) {
  Kept all;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    test::RealFrame& frame = frames[i];
    for (int n = 0; n < placements; ++n) {
      paster.paste(frame, nearest[i], objects[object].object, gaps[gap].gap, offset);
      const LabelView labels = classifier.classify(frame.view(), frame.measured.view());
      Kept kept;
      kept.add(paster.beside(), labels);
      all.add(kept);
      if (paster.has_true_step(frame, true_step, true_step_margin)) stepped[object][gap].add(kept);
      if (offset == 0.0 && gaps[gap].gap.metres > 0.0)
        rims[object].add(paster.beside().core, labels, nearest[i], paster.clearance(),
                         paster.depth() / frame.intrinsics.fx(), classifier.rule().fringe_reach);
      paster.undo(frame);
    }
  }
  return all;
}

std::string Study::beside(std::size_t object) {
  Rows rows = {{objects[object].name + ", cm behind the outline"}};
  for (const NamedGap& gap : gaps) rows[0].push_back("gap " + gap.name);
  for (const double offset : offsets) {
    rows.push_back({centimetres(offset)});
    for (std::size_t gap = 0; gap < gaps.size(); ++gap) {
      const Kept kept = beside_at(object, gap, offset);
      rows.back().push_back(shares(kept));
      csv << "beside," << objects[object].name << ',' << gaps[gap].name << ','
          << centimetres(offset) << ',' << number(kept.core_percent(), 3) << ','
          << number(kept.band_percent(), 3) << ',' << kept.placements << '\n';
    }
  }
  std::cerr << objects[object].name << '\n';
  return table(rows);
}

std::string Study::with_true_step() const {
  Rows rows = {{"a true step of 5 cm"}};
  for (const NamedGap& gap : gaps) rows[0].push_back("gap " + gap.name);
  for (std::size_t object = 0; object < objects.size(); ++object) {
    rows.push_back({objects[object].name});
    for (const Kept& kept : stepped[object])
      rows.back().push_back(shares(kept) + ", n = " + std::to_string(kept.placements));
  }
  return table(rows);
}

std::string Study::rim() const {
  Rows rows = {{"at the outline's depth, gap 3 cm", "points past the reach kept, %",
                "rim lost, mean, cm", "rim lost, most, cm"}};
  for (std::size_t object = 0; object < objects.size(); ++object) {
    const Rim& rim = rims[object];
    rows.push_back({objects[object].name,
                    number(test::percent(rim.beyond_reach_kept, rim.beyond_reach), 2),
                    number(100 * rim.lost / static_cast<double>(rim.placements), 2),
                    number(100 * rim.most_lost, 2)});
  }
  return table(rows);
}

std::string Study::before_the_arm() {
  Rows rows = {{"on the arm", "front without fringe, %", "front with fringe, %",
                "robot pixels labelled differently"}};
  Classifier without(frames.front().robot.width(), frames.front().robot.height(),
                     rule_with_reach(0));
  test::Paster before({}, first_seed);
  for (const double gap : {0.05, 0.10}) {
    std::size_t fronts = 0, fronts_without = 0, all = 0, different = 0;
    for (test::RealFrame& frame : frames)
      for (int n = 0; n < placements; ++n) {
        before.paste(frame, {test::Shape::disc, 0.08, 0.0}, gap);
        const LabelView with = classifier.classify(frame.view(), frame.measured.view());
        const LabelView plain = without.classify(frame.view(), frame.measured.view());
        for (const int pixel : before.core()) {
          fronts += label_at(with, pixel) == Label::front;
          fronts_without += label_at(plain, pixel) == Label::front;
        }
        all += before.core().size();
        for (const int pixel : frame.robot_indices)
          different += label_at(with, pixel) != label_at(plain, pixel);
        before.undo(frame);
      }
    rows.push_back({"disc 8 cm, " + number(100 * gap, 0) + " cm before it",
                    number(test::percent(fronts_without, all), 2),
                    number(test::percent(fronts, all), 2), std::to_string(different)});
  }
  return table(rows);
}

std::string Study::rods() {
  Rows rows = {{"rod 1 cm thick, 30 cm long", "kept, % (of its edge)"}};
  const auto add = [&](const std::string& name, auto paste) {
    Kept kept;
    for (std::size_t i = 0; i < frames.size(); ++i)
      for (int n = 0; n < placements; ++n) {
        paste(frames[i], nearest[i]);
        const LabelView labels = classifier.classify(frames[i].view(), frames[i].measured.view());
        kept.add(paster.beside(), labels);
        paster.undo(frames[i]);
      }
    rows.push_back({name, shares(kept)});
    csv << "rod," << name << ',' << number(kept.core_percent(), 3) << ','
        << number(kept.band_percent(), 3) << ',' << kept.placements << '\n';
  };
  for (const double offset : {0.10, -0.05})
    add("across the arm, " + centimetres(offset) + " cm",
        [&](auto& frame, auto&) { paster.paste_across(frame, rod, offset); });
  for (const double offset : {0.0, -0.05})
    for (const NamedGap& gap : {gaps[0], gaps[1]})
      add("beside it, " + centimetres(offset) + " cm, gap " + gap.name,
          [&](auto& frame, auto& near) { paster.paste(frame, near, rod, gap.gap, offset); });
  return table(rows);
}

void run(const std::filesystem::path& recording, const std::filesystem::path& root,
         int placements) {
  Study study{test::load_real_frames(recording), placements};
  for (const test::RealFrame& frame : study.frames)
    study.nearest.push_back(test::nearest_robot(frame.robot.view()));
  const std::string leftover = '\n' + study.leftover() + '\n';
  std::ostringstream out;
  out << leftover << study.carried_by_distance() << "\nObjects: seed " << first_seed << ", "
      << placements * static_cast<int>(study.frames.size())
      << " placements for every figure. Points of the object that are kept, % (in brackets: of the "
         "2-pixel band at its edge):\n";
  for (std::size_t object = 0; object < objects.size(); ++object)
    out << '\n' << study.beside(object);
  out << "\nOf those placements, the ones whose depth differs by 5 cm or more from every depth of "
         "the robot within 12 pixels:\n\n"
      << study.with_true_step() << '\n'
      << study.rim() << '\n'
      << study.before_the_arm() << '\n'
      << study.rods() << '\n';
  std::cout << out.str();
  write_file(root / "bench/results/cloud.csv", study.csv.str());
  update_page(root / "docs/cloud.md", "cloud_study", leftover);
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::cerr << "usage: cloud_study RECORDING REPOSITORY [PLACEMENTS IN EACH FRAME]\n";
    return 2;
  }
  try {
    penumbra::study::run(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 10);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}
