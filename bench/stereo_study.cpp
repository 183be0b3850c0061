// SPDX-License-Identifier: Apache-2.0
// Measures against the simulator's truth what a stereo camera carries past the robot's outline, how
// much of it the fringe finds and what it takes of real things. Writes a table into docs/cloud.md.
#include "../tests/support/cloud_measure.hpp"
#include "stereo_cell.hpp"
#include "stereo_picture.hpp"
#include "study_page.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <sstream>
#include <thread>

#include <sim/simulation.hpp>

namespace penumbra::study {
namespace {

using test::label_at;

constexpr std::uint64_t first_seed = 20230206;
constexpr std::size_t frames_per_cell = 20;
constexpr int threads = 2;
constexpr std::array<int, 4> reaches = {0, 20, 40, 60};
constexpr double wrong = 0.03;        // metres: a depth farther from the truth than this
constexpr double right = 0.02;        // metres: a depth nearer to the truth than this
constexpr double robots_depth = 3.0;  // of e(z): how near to the robot's depth carried ones are

enum class Point { robot, carried, thing, room, other };

/// Whether something else than the robot, less than `distance` pixels away, has the measured depth:
/// then the point was carried from there.
bool is_others(const StereoImages& images, int u, int v, double distance) {
  const float measured = 0.001F * static_cast<float>(images.measured(u, v));
  const int reach = static_cast<int>(distance);
  for (int y = std::max(0, v - reach); y <= std::min(images.ids.height() - 1, v + reach); ++y)
    for (int x = std::max(0, u - reach); x <= std::min(images.ids.width() - 1, u + reach); ++x) {
      const bool is_robot = images.ids(x, y) > 0 && images.ids(x, y) < sim::first_object_id;
      if (!is_robot && std::hypot(x - u, y - v) < distance &&
          std::abs(images.depth(x, y) - measured) < static_cast<float>(wrong))
        return true;
    }
  return false;
}

/// What a measured point really is.
Point point_of(const StereoImages& images, const test::NearestRobot& nearest,
               const Tolerance& tolerance, int u, int v) {
  const std::int32_t id = images.ids(u, v);
  const bool is_object = id >= sim::first_object_id;
  if (id != 0 && !is_object) return Point::robot;
  const double measured = 0.001 * static_cast<double>(images.measured(u, v));
  const double off = std::abs(measured - static_cast<double>(images.depth(u, v)));
  const auto robot = static_cast<double>(nearest.depth(u, v));
  if (off > wrong && robot > 0.0 &&
      std::abs(measured - robot) < robots_depth * tolerance.at(robot) &&
      !is_others(images, u, v, nearest.distance(u, v)))
    return Point::carried;
  if (off >= right) return Point::other;
  return is_object ? Point::thing : Point::room;
}

/// Counts of points, and of those that each rule keeps.
struct Tally {
  std::size_t frames = 0, robot = 0, carried = 0, things = 0, room = 0;
  std::array<std::size_t, reaches.size()> carried_left{}, things_taken{}, room_taken{};
  std::array<std::size_t, 6> by_distance{};

  void add(const Tally& other);
};

constexpr std::array<double, 6> distances = {2, 5, 10, 20, 40, test::NearestRobot::reach};

template <typename A>
void add_each(A& to, const A& from) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
}

void Tally::add(const Tally& other) {
  frames += other.frames;
  robot += other.robot;
  carried += other.carried;
  things += other.things;
  room += other.room;
  add_each(carried_left, other.carried_left);
  add_each(things_taken, other.things_taken);
  add_each(room_taken, other.room_taken);
  add_each(by_distance, other.by_distance);
}

/// Labels by every reach.
class Rules {
 public:
  Rules() {
    for (const int reach : reaches) {
      LabelRule rule;
      rule.fringe_reach = reach;
      classifiers_.emplace_back(StereoCell::intrinsics().width(), StereoCell::intrinsics().height(),
                                rule);
    }
  }

  [[nodiscard]] std::array<LabelView, reaches.size()> classify(const VirtualDepthView& robot,
                                                               const StereoImages& images) {
    std::array<LabelView, reaches.size()> labels;
    for (std::size_t i = 0; i < reaches.size(); ++i)
      labels[i] = classifiers_[i].classify(robot, images.measured.view());
    return labels;
  }

 private:
  std::vector<Classifier> classifiers_;
};

/// Points that a cloud without the robot holds are the clear and front ones.
void tally(const StereoImages& images, const VirtualDepthView& robot, Rules& rules, Tally& sum) {
  const test::NearestRobot nearest = test::nearest_robot(robot.depth);
  const auto labels = rules.classify(robot, images);
  const Tolerance tolerance = LabelRule{}.tolerance;
  ++sum.frames;
  for (int v = 0; v < images.measured.height(); ++v)
    for (int u = 0; u < images.measured.width(); ++u) {
      if (images.measured(u, v) == 0) continue;
      const Point point = point_of(images, nearest, tolerance, u, v);
      const int pixel = v * images.measured.width() + u;
      const Label plain = label_at(labels[0], pixel);
      const bool is_in_cloud = plain == Label::clear || plain == Label::front;
      sum.robot += point == Point::robot;
      sum.things += point == Point::thing && is_in_cloud;
      sum.room += point == Point::room && is_in_cloud;
      if (point == Point::carried && is_in_cloud) {
        ++sum.carried;
        ++sum.by_distance[static_cast<std::size_t>(
            std::lower_bound(distances.begin(), distances.end() - 1, nearest.distance(u, v)) -
            distances.begin())];
      }
      if (!is_in_cloud) continue;
      for (std::size_t i = 0; i < reaches.size(); ++i) {
        const bool is_fringe = label_at(labels[i], pixel) == Label::fringe;
        sum.carried_left[i] += point == Point::carried && !is_fringe;
        sum.things_taken[i] += point == Point::thing && is_fringe;
        sum.room_taken[i] += point == Point::room && is_fringe;
      }
    }
}

Tally study(std::size_t frames) {
  Tally all;
  std::mutex mutex;
  std::atomic<std::size_t> next_cell = 0;
  const auto work = [&] {
    Rules rules;
    for (;;) {
      const std::size_t cell = next_cell++;
      if (cell * frames_per_cell >= frames) return;
      StereoCell place(first_seed + cell);
      Tally sum;
      for (std::size_t i = 0; i < std::min(frames_per_cell, frames - cell * frames_per_cell); ++i) {
        place.capture(i);
        tally(place.images(), place.virtual_depth(), rules, sum);
      }
      const std::lock_guard lock(mutex);
      all.add(sum);
      std::cerr << all.frames << " frames\n";
    }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return all;
}

std::string report(const Tally& sum) {
  std::vector<std::vector<std::string>> rows = {{"fringe_reach, px", "points of the robot left, %",
                                                 "points of things removed, %",
                                                 "points of the room removed, %"}};
  for (std::size_t i = 0; i < reaches.size(); ++i)
    rows.push_back({std::to_string(reaches[i]),
                    number(test::percent(sum.carried_left[i], sum.robot + sum.carried), 2),
                    number(test::percent(sum.things_taken[i], sum.things), 2),
                    number(test::percent(sum.room_taken[i], sum.room), 3)});
  return '\n' + table(rows) + '\n';
}

std::string counts(const Tally& sum) {
  std::vector<std::vector<std::string>> far = {{"pixels from the outline"},
                                               {"points carried there"}};
  for (std::size_t i = 0; i < distances.size(); ++i) {
    far[0].push_back("to " + number(distances[i], 0));
    far[1].push_back(std::to_string(sum.by_distance[i]));
  }
  std::ostringstream out;
  out << sum.frames << " frames, seeds from " << first_seed << ": " << sum.robot
      << " points on the robot, " << sum.things << " right ones on things and " << sum.room
      << " on the room\n\n"
      << table(far) << '\n';
  return out.str();
}

void draw(const std::filesystem::path& file, std::uint64_t cell, std::size_t frame) {
  StereoCell place(first_seed + cell);
  place.capture(frame);
  Rules rules;
  const StereoImages& images = place.images();
  const VirtualDepthView robot = place.virtual_depth();
  const test::NearestRobot nearest = test::nearest_robot(robot.depth);
  const LabelView labels = rules.classify(robot, images)[2];
  Image<io::Rgb8> out = picture(images, labels);
  for (int v = 0; v < images.ids.height(); ++v)
    for (int u = 0; u < images.ids.width(); ++u) {
      const Label label = label_at(labels, v * images.ids.width() + u);
      const bool is_in_cloud = label == Label::clear || label == Label::front;
      if (images.measured(u, v) != 0 && is_in_cloud &&
          point_of(images, nearest, LabelRule{}.tolerance, u, v) == Point::carried)
        out(images.ids.width() + u, images.ids.height() + v) = {255, 0, 255};  // left
    }
  io::write_png(file, out.view());
}

}  // namespace
}  // namespace penumbra::study

int main(int argc, char** argv) {
  using namespace penumbra::study;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 4 && arguments[0] == "--picture") {
      draw(arguments[1], std::stoul(arguments[2]), std::stoul(arguments[3]));
      return 0;
    }
    const bool has_count = arguments.size() == 3 && arguments[1] == "--frames";
    if (arguments.size() != 1 && !has_count) {
      std::cerr << "usage: stereo_study REPOSITORY [--frames N]\n"
                   "       stereo_study --picture FILE.png CELL FRAME\n";
      return 2;
    }
    const Tally sum = study(has_count ? std::stoul(arguments[2]) : 1000);
    const std::string text = report(sum);
    std::cout << text << counts(sum);
    if (!has_count)
      update_page(std::filesystem::path(arguments[0]) / "docs/cloud.md", "stereo_study", text);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}
