// SPDX-License-Identifier: Apache-2.0
#include "cloud_measure.hpp"

#include <algorithm>

namespace penumbra::test {

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

Label label_at(const LabelView& labels, int pixel) {
  const int width = labels.labels.width;
  return static_cast<Label>(labels.labels(pixel % width, pixel / width));
}

double Leftover::percent() const { return test::percent(left, carried + on_robot); }
double Leftover::front_percent() const { return test::percent(front, mask); }

Leftover measure_leftover(const std::vector<RealFrame>& frames,
                          const std::vector<NearestRobot>& nearest, const LabelRule& rule) {
  Leftover sum;
  const int width = frames.front().robot.width();
  Classifier classifier(width, frames.front().robot.height(), rule);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RealFrame& frame = frames[i];
    const LabelView labels = classifier.classify(frame.view(), frame.measured.view());
    for_each_carried(frame, nearest[i], [&](int u, int v, double) {
      ++sum.carried;
      sum.left += label_at(labels, v * width + u) != Label::fringe;
    });
    for (const int pixel : frame.robot_indices)
      sum.on_robot += pixel / width < SidePaster::air_rows && frame.measured.data()[pixel] != 0;
    for (int pixel = 0; pixel < static_cast<int>(frame.measured.size()); ++pixel)
      sum.clear += frame.measured.data()[pixel] != 0 && label_at(labels, pixel) == Label::clear;
    sum.front += labels.pixels[static_cast<std::size_t>(Label::front)];
    sum.mask += frame.mask_pixels;
  }
  return sum;
}

void Kept::add(const MeasuredPaste::Pixels& pixels, const LabelView& labels) {
  const auto kept = [&](const std::vector<int>& of) {
    return static_cast<std::size_t>(std::count_if(
        of.begin(), of.end(), [&](int pixel) { return label_at(labels, pixel) != Label::fringe; }));
  };
  ++placements;
  core += pixels.core.size();
  band += pixels.band.size();
  core_kept += kept(pixels.core);
  band_kept += kept(pixels.band);
}

void Kept::add(const Kept& other) {
  placements += other.placements;
  core += other.core;
  band += other.band;
  core_kept += other.core_kept;
  band_kept += other.band_kept;
}

double Kept::core_percent() const { return percent(core_kept, core); }
double Kept::band_percent() const { return percent(band_kept, band); }

}  // namespace penumbra::test
