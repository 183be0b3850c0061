// SPDX-License-Identifier: Apache-2.0
#include "tolerance_study.hpp"

#include <algorithm>
#include <numeric>

namespace penumbra::study {
namespace {

std::vector<Classifier> classifiers_of(const test::RealFrame& frame,
                                       const std::vector<NamedRule>& rules) {
  std::vector<Classifier> classifiers;
  classifiers.reserve(rules.size());
  for (const NamedRule& named : rules)
    classifiers.emplace_back(frame.robot.width(), frame.robot.height(), named.rule);
  return classifiers;
}

std::size_t fronts(const ImageView<const std::uint8_t>& labels, const std::vector<int>& pixels) {
  return static_cast<std::size_t>(std::count_if(pixels.begin(), pixels.end(), [&](int pixel) {
    return labels(pixel % labels.width, pixel / labels.width) ==
           static_cast<std::uint8_t>(Label::front);
  }));
}

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::vector<Untouched> study_untouched(const std::vector<test::RealFrame>& frames,
                                       const std::vector<NamedRule>& rules) {
  std::vector<Untouched> results(rules.size());
  std::vector<Classifier> classifiers = classifiers_of(frames.front(), rules);
  for (const test::RealFrame& frame : frames) {
    for (std::size_t i = 0; i < rules.size(); ++i) {
      const auto pixels = classifiers[i].classify(frame.view(), frame.measured.view()).pixels;
      const auto share = [&](Label label) {
        return percent(pixels[static_cast<std::size_t>(label)], frame.mask_pixels);
      };
      results[i].front.push_back(share(Label::front));
      results[i].beyond.push_back(share(Label::beyond));
      results[i].unknown.push_back(share(Label::unknown));
    }
  }
  return results;
}

std::vector<Seen> study_objects(std::vector<test::RealFrame>& frames,
                                const std::vector<NamedRule>& rules, const test::ObjectKind& kind,
                                double gap, int placements, std::uint64_t seed) {
  struct Sums {
    std::size_t core_front = 0, band_front = 0;
  };
  std::vector<Sums> sums(rules.size());
  std::size_t core = 0, band = 0;
  std::vector<Classifier> classifiers = classifiers_of(frames.front(), rules);
  test::Paster paster({}, seed);
  for (test::RealFrame& frame : frames) {
    for (int n = 0; n < placements; ++n) {
      paster.paste(frame, kind, gap);
      core += paster.core().size();
      band += paster.band().size();
      for (std::size_t i = 0; i < rules.size(); ++i) {
        const auto labels = classifiers[i].classify(frame.view(), frame.measured.view()).labels;
        sums[i].core_front += fronts(labels, paster.core());
        sums[i].band_front += fronts(labels, paster.band());
      }
      paster.undo(frame);
    }
  }
  std::vector<Seen> seen;
  seen.reserve(sums.size());
  for (const Sums& sum : sums)
    seen.push_back({percent(sum.core_front, core), percent(sum.band_front, band)});
  return seen;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

}  // namespace penumbra::study
