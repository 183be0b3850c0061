// SPDX-License-Identifier: Apache-2.0
// Measures, on a real recording, how many points of the robot are left in a cloud without the robot
// and what the fringe removes of objects pasted beside it. Prints all tables; writes the first into
// docs/tuning.md, another into bench/results/points.txt.
#include "../tests/support/cloud_measure.hpp"
#include "../tests/support/pasted_objects.hpp"
#include "study_page.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>

#include <penumbra/labels/scene_memory.hpp>

namespace penumbra::study {
namespace {

using test::Outline;
using test::PastedObject;

constexpr std::uint64_t seed = 20230206;
constexpr std::array<double, 5> offsets = {-0.10, -0.05, 0.0, 0.05, 0.10};  // metres

struct NamedObject {
  std::string name;
  PastedObject object;
};
const std::array<NamedObject, 3> objects = {{{"plate 10 x 10 cm", {Outline::plate, 0.10}},
                                             {"disc 8 cm", {Outline::disc, 0.08}},
                                             {"hand", {Outline::hand, 0.085}}}};

struct Recorded {
  std::vector<test::RealFrame> frames;
  std::vector<tuning::NearestPixels> nearest;
};

std::string leftover(const Recorded& recorded) {
  std::vector<std::vector<std::string>> rows = {
      {"fringe_reach, px", "points of the arm left, %", "clear points removed, %"}};
  std::size_t all_clear = 0;
  for (const int reach : {0, 10, 20, 30, 40, 60}) {
    LabelRule rule;
    rule.fringe_reach = reach;
    const test::Leftover found = measure_leftover(recorded.frames, recorded.nearest, rule);
    if (reach == 0) all_clear = found.clear;
    rows.push_back({std::to_string(reach), number(found.percent(), 2),
                    number(test::percent(all_clear - found.clear, all_clear), 2)});
  }
  return table(rows);
}

/// What is kept of an object at each depth, touching the outline or 3 cm from it, and of those
/// placements that touch it at a true step of depth.
std::string beside(Recorded& recorded, const NamedObject& object, int placements) {
  const Image<float>& size = recorded.frames.front().robot;
  Classifier classifier(size.width(), size.height(), LabelRule{});
  test::Paster paster(seed);
  std::vector<std::vector<std::string>> rows = {
      {object.name + ", cm behind the outline", "touches it", "3 cm gap"}};
  test::Kept at_step;
  for (const double offset : offsets) {
    rows.push_back({number(100 * offset, 0)});
    for (const double gap : {0.0, 0.03}) {
      test::Kept kept;
      for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
        test::RealFrame& frame = recorded.frames[i];
        for (int n = 0; n < placements; ++n) {
          paster.paste_beside(frame, recorded.nearest[i], object.object, gap, offset);
          const LabelView labels = classifier.classify(frame.view(), frame.measured.view());
          kept.add(paster.beside(), labels);
          if (gap == 0.0 && paster.has_true_step(frame)) at_step.add(paster.beside(), labels);
          paster.undo(frame);
        }
      }
      rows.back().push_back(number(kept.percent(), 1));
    }
  }
  return table(rows) + "touching, with a step of 5 cm or more: " + number(at_step.percent(), 1) +
         " of " + std::to_string(at_step.placements) + " placements\n";
}

/// A memory of frames that are three seconds apart.
class Memory {
 public:
  explicit Memory(const Image<float>& size) : scene_(size.width(), size.height(), LabelRule{}) {}

  void update(const test::RealFrame& frame) {
    constexpr std::int64_t step = 3'000'000'000;
    scene_.update(Eigen::Isometry3d::Identity(), stamp_ += step, frame.view(),
                  frame.measured.view());
  }
  [[nodiscard]] ImageView<const std::uint16_t> depth() const { return scene_.depth(); }

 private:
  SceneMemory scene_;
  std::int64_t stamp_ = 0;
};

/// What is kept of an object next to the outline, by its distance and depth from it: without
/// memory, with one of the other frames, in which it stood already and in one of which it was away
/// from the robot, and of a new one.
std::string remembered(Recorded& recorded, int placements) {
  constexpr std::array<int, 4> gaps = {0, 5, 10, 20};  // pixels
  constexpr double away = 104.0;  // pixels from the robot, where all is seen: LabelRule and a tile
  const Image<float>& size = recorded.frames.front().robot;
  Classifier classifier(size.width(), size.height(), LabelRule{});
  test::Paster paster(seed);
  std::vector<std::vector<std::string>> rows = {{"cm behind the outline"}};
  for (const int gap : gaps)
    rows[0].push_back(gap == 0 ? "touches it" : std::to_string(gap) + " px away");
  for (const double offset : {-0.10, -0.05, -0.03, 0.0, 0.03, 0.05, 0.10}) {
    rows.push_back({number(100 * offset, 0)});
    for (const int gap : gaps) {
      test::Kept alone, known, fresh;
      for (std::size_t i = 0; i < recorded.frames.size(); ++i)
        for (int n = 0; n < placements; ++n) {
          test::RealFrame& frame = recorded.frames[i];
          paster.paste_beside(frame, recorded.nearest[i],
                              objects.at(static_cast<std::size_t>(n) % objects.size()).object,
                              gap / frame.intrinsics.fx(), offset);  // of what is a metre away
          const std::vector<int> here = paster.beside();
          paster.undo(frame);
          Memory with(size), without(size);
          bool is_seen = false;
          for (std::size_t k = 0; k < recorded.frames.size(); ++k) {
            test::RealFrame& other = recorded.frames[k];
            double distance = away;  // from the robot
            for (const int pixel : here)
              distance = std::min(distance, recorded.nearest[k].distance(pixel % size.width(),
                                                                         pixel / size.width()));
            if (k == i || distance < 1.0) continue;  // it stands where no robot goes
            without.update(other);
            paster.paste_again(other);
            with.update(other);
            paster.undo(other);
            is_seen = is_seen || distance >= away;
          }
          if (!is_seen) continue;
          paster.paste_again(frame);
          with.update(frame);
          without.update(frame);
          const auto add = [&](test::Kept& kept, ImageView<const std::uint16_t> depth) {
            kept.add(paster.beside(),
                     classifier.classify(frame.view(), frame.measured.view(), depth));
          };
          add(alone, {});
          add(known, with.depth());
          add(fresh, without.depth());
          paster.undo(frame);
        }
      rows.back().push_back(number(alone.percent(), 1) + " / " + number(known.percent(), 1));
      std::cout << rows.back()[0] << " cm, " << gap << " px, " << alone.placements
                << " placements: " << rows.back().back() << ", new ones "
                << number(fresh.percent(), 1) << std::endl;
    }
  }
  return '\n' + table(rows) + '\n';
}

/// Points of the arm that are left with a memory of the other frames, %.
double left_with_memory(const Recorded& recorded) {
  const Image<float>& size = recorded.frames.front().robot;
  Classifier classifier(size.width(), size.height(), LabelRule{});
  test::Leftover sum;
  for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
    Memory memory(size);
    for (std::size_t j = 1; j <= recorded.frames.size(); ++j)
      memory.update(recorded.frames[(i + j) % recorded.frames.size()]);
    const test::RealFrame& frame = recorded.frames[i];
    sum.add(frame.robot.view(), frame.measured.view(),
            classifier.classify(frame.view(), frame.measured.view(), memory.depth()).labels,
            recorded.nearest[i], frame.air_rows());
  }
  return sum.percent();
}

void run(const std::filesystem::path& recording, const std::filesystem::path& root,
         int placements) {
  Recorded recorded{test::load_real_frames(recording), {}};
  for (const test::RealFrame& frame : recorded.frames)
    recorded.nearest.push_back(test::nearest_robot(frame.robot.view()));
  const std::string page = '\n' + leftover(recorded) + '\n';
  std::cout << page << "Points of objects that are kept, %, seed " << seed << ":\n";
  for (const NamedObject& object : objects)
    std::cout << '\n' << beside(recorded, object, placements);
  std::cout << "with a memory of the other frames " << number(left_with_memory(recorded), 2)
            << " % of the arm's points are left\n";
  const std::string kept = remembered(recorded, placements);
  update_page(root / "docs/tuning.md", "cloud_study", page);
  update_page(root / "bench/results/points.txt", "memory_study", kept);
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  return penumbra::study::main_of("cloud_study", 10, penumbra::study::run, argc, argv);
}
