// SPDX-License-Identifier: Apache-2.0
#include "cloud_measure.hpp"

#include "pasted_objects.hpp"
#include "pixels.hpp"

namespace penumbra::test {

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * double(part) / double(whole);
}

Label label_at(const LabelView& labels, int pixel) {
  const int width = labels.labels.width;
  return static_cast<Label>(labels.labels(pixel % width, pixel / width));
}

tuning::NearestPixels nearest_robot(ImageView<const float> robot) {
  return {robot.width, robot.height, [&](int u, int v) { return robot(u, v) > 0.0f; }};
}

double Leftover::percent() const { return test::percent(left, carried + on_robot); }

void Leftover::add(ImageView<const float> robot, ImageView<const std::uint16_t> measured,
                   ImageView<const std::uint8_t> labels, const tuning::NearestPixels& nearest,
                   int air_rows) {
  for (const auto [u, v] : each_pixel(robot)) {
    if (measured(u, v) == 0) continue;
    const auto label = static_cast<Label>(labels(u, v));
    clear += label == Label::clear;
    if (v >= air_rows) continue;
    if (robot(u, v) > 0.0F) {
      ++on_robot;
    } else if (tuning::is_carried(nearest, robot, u, v, 0.001 * measured(u, v))) {
      ++carried;
      left += label != Label::fringe;
    }
  }
}

Leftover measure_leftover(const std::vector<RealFrame>& frames,
                          const std::vector<tuning::NearestPixels>& nearest,
                          const LabelRule& rule) {
  Leftover sum;
  Classifier classifier(frames.front().robot.width(), frames.front().robot.height(), rule);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RealFrame& frame = frames[i];
    const LabelView labels = classifier.classify(frame.view(), frame.measured.view());
    sum.add(frame.robot.view(), frame.measured.view(), labels.labels, nearest[i], frame.air_rows());
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
