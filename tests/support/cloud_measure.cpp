// SPDX-License-Identifier: Apache-2.0
#include "cloud_measure.hpp"

#include "pasted_objects.hpp"

#include <cmath>

namespace penumbra::test {

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

Label label_at(const LabelView& labels, int pixel) {
  const int width = labels.labels.width;
  return static_cast<Label>(labels.labels(pixel % width, pixel / width));
}

tuning::NearestPixels nearest_robot(ImageView<const float> robot) {
  Image<std::uint8_t> marked(robot.width, robot.height);
  for (int v = 0; v < robot.height; ++v)
    for (int u = 0; u < robot.width; ++u) marked(u, v) = robot(u, v) > 0.0F;
  return tuning::NearestPixels(marked);
}

double Leftover::percent() const { return test::percent(left, carried + on_robot); }

Leftover measure_leftover(const std::vector<RealFrame>& frames,
                          const std::vector<tuning::NearestPixels>& nearest,
                          const LabelRule& rule) {
  constexpr double most_pixels = 40.0, most_depth = 0.10;  // metres
  Leftover sum;
  const int width = frames.front().robot.width();
  Classifier classifier(width, frames.front().robot.height(), rule);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RealFrame& frame = frames[i];
    const LabelView labels = classifier.classify(frame.view(), frame.measured.view());
    for (int pixel = 0; pixel < static_cast<int>(frame.measured.size()); ++pixel) {
      const int u = pixel % width, v = pixel / width;
      const double z = 0.001 * static_cast<double>(frame.measured(u, v));
      if (z == 0.0) continue;
      sum.clear += label_at(labels, pixel) == Label::clear;
      if (v >= Paster::air_rows) continue;
      if (frame.robot(u, v) > 0.0F) {
        ++sum.on_robot;
        continue;
      }
      if (nearest[i].distance(u, v) > most_pixels) continue;
      const auto at = nearest[i].at(u, v);
      if (std::abs(z - static_cast<double>(frame.robot(at.u, at.v))) > most_depth) continue;
      ++sum.carried;
      sum.left += label_at(labels, pixel) != Label::fringe;
    }
  }
  return sum;
}

void Kept::add(const std::vector<int>& pixels, const LabelView& labels) {
  ++placements;
  all += pixels.size();
  for (const int pixel : pixels) kept += label_at(labels, pixel) != Label::fringe;
}

double Kept::percent() const { return test::percent(kept, all); }

}  // namespace penumbra::test
