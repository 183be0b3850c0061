// SPDX-License-Identifier: Apache-2.0
// Programs that tell one joint, and what a buffer makes of it.
#pragma once

#include "../support/nanoseconds.hpp"
#include "urdf_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/robot/joint_buffer.hpp>

namespace penumbra::test {

/// Of a driver's own track, interpolated along a straight way.
inline constexpr double of_straight_way = 1e-9;

/// rad or m at a time in nanoseconds.
using Way = std::function<double(std::int64_t)>;

/// At a constant speed through 0 at 1 s, per second.
inline Way moving(double speed) {
  return [=](std::int64_t t) { return speed * 1e-9 * static_cast<double>(t - 1000 * ms); };
}
/// Likewise, but for 1 mrad that no two of its steps are alike by, as of an arm.
inline Way moving_on(double speed) {
  return [=](std::int64_t t) {
    return moving(speed)(t) + 0.001 * std::sin(13e-9 * static_cast<double>(t));
  };
}
inline Way standing(double at) {
  return [=](std::int64_t) { return at; };
}

struct Told {
  std::int64_t arrival, stamp;
  double value;
  std::string source;
};

/// A program that publishes the joint every `period` from `first` to before `end`, and how late its
/// messages come.
struct Program {
  std::string source;
  Way way;
  std::int64_t period = 10 * ms, first = 0, end = 2000 * ms;
  std::int64_t latency = 0;
};

inline void tell(const Program& program, std::vector<Told>& all) {
  for (std::int64_t stamp = program.first; stamp < program.end; stamp += program.period)
    all.push_back({stamp + program.latency, stamp, program.way(stamp), program.source});
}

/// What a program told last, `late` before: as joint_state_publisher sends it on, or a relay.
inline Way copy_of(const Program& program, std::int64_t late) {
  return [=](std::int64_t t) {
    const std::int64_t heard = std::min(t - late - program.latency, program.end - 1);
    const std::int64_t whole = std::max<std::int64_t>(0, heard - program.first) / program.period;
    return program.way(program.first + whole * program.period);
  };
}

/// Without the messages of a program from after one stamp to before another.
inline std::vector<Told> without(std::vector<Told> all, const std::string& source,
                                 std::int64_t after, std::int64_t before) {
  std::erase_if(all, [&](const Told& told) {
    return told.source == source && told.stamp > after && told.stamp < before;
  });
  return all;
}

inline std::vector<Told> all_of(const std::vector<Program>& programs) {
  std::vector<Told> all;
  for (const Program& program : programs) tell(program, all);
  return all;
}

/// A buffer for one joint of a type, and its states as they arrive.
class OneJoint {
 public:
  explicit OneJoint(const std::string& type = "revolute", const JointBufferOptions& options = {})
      : robot_(parse(robot_xml(link_xml("a") + link_xml("b") + joint_xml("q", type, "a", "b")))),
        buffer_(robot_, options) {}

  void add(std::int64_t stamp, double value, const std::string& source) {
    const std::vector<std::string> names = {"q"};
    const std::vector<double> values = {value};
    buffer_.insert(stamp, names, values, source);
  }
  void hear(std::vector<Told> all) {
    sort(all);
    for (const Told& told : all) add(told.stamp, told.value, told.source);
  }
  void hear(const std::vector<Program>& programs) { hear(all_of(programs)); }

  const JointAnswer& at(std::int64_t stamp) {
    buffer_.at(stamp, answer_);
    if (answer_.gaps.empty()) {
      EXPECT_EQ(answer_.disputes.empty(), answer_.status == JointStatus::ok);
    }
    return answer_;
  }

  struct GivenOut {
    std::int64_t stamp;
    JointStatus status;
    double value;
  };

  /// What a queue of frames gives out: it asks for each 5 ms at every arrival, until the joint is
  /// known there, or `longest_wait` after it.
  std::vector<GivenOut> live(std::vector<Told> all) {
    constexpr std::int64_t every = 5 * ms, longest_wait = 200 * ms;
    sort(all);
    std::vector<GivenOut> out;
    std::int64_t pushed = 0;
    std::vector<std::int64_t> waiting;
    for (const Told& told : all) {
      add(told.stamp, told.value, told.source);
      for (; pushed <= told.arrival; pushed += every) waiting.push_back(pushed);
      std::erase_if(waiting, [&](std::int64_t stamp) {
        const JointStatus status = at(stamp).status;
        if (status != JointStatus::ok && told.arrival < stamp + longest_wait) return false;
        out.push_back({stamp, status, answer_.positions[0]});
        return true;
      });
    }
    return out;
  }
  std::vector<GivenOut> live(const std::vector<Program>& programs) {
    return live(all_of(programs));
  }

  /// How many of the milliseconds from `from` to before `to` have a status.
  std::int64_t count(JointStatus status, std::int64_t from, std::int64_t to) {
    std::int64_t found = 0;
    for (std::int64_t stamp = from; stamp < to; stamp += ms)
      if (at(stamp).status == status) ++found;
    return found;
  }

  JointBuffer& buffer() { return buffer_; }

 private:
  static void sort(std::vector<Told>& all) {
    std::stable_sort(all.begin(), all.end(),
                     [](const Told& a, const Told& b) { return a.arrival < b.arrival; });
  }

  Robot robot_;
  JointBuffer buffer_;
  JointAnswer answer_;
};

/// From 0 at `start` with 5 rad/s^2 up to 1 rad/s, where it swings by some percent, to `far`.
inline Way starting_at(std::int64_t start, double far = 2.0) {
  return [=](std::int64_t t) {
    const double s = std::max(0.0, 1e-9 * static_cast<double>(t - start));
    if (s < 0.2) return std::min(far, 2.5 * s * s);
    return std::min(far, 0.1 + (s - 0.2) + 0.002 * (1.0 - std::cos(11.0 * (s - 0.2))));
  };
}

/// Two programs that stand at one pose are believed to within the noise of a joint.
inline constexpr double tolerance = JointRule::turn_noise + 1e-9;

struct Frames {
  std::int64_t all = 0, known = 0, disputed = 0;
};

/// Every frame whose pose is known has the true one; counts those from `from` to before `to`.
inline Frames check(const std::vector<OneJoint::GivenOut>& out, const Way& truth, std::int64_t from,
                    std::int64_t to, double within = tolerance) {
  Frames frames;
  for (const auto& [stamp, status, value] : out) {
    if (stamp < from || stamp >= to) continue;
    ++frames.all;
    if (status == JointStatus::disputed) ++frames.disputed;
    if (status != JointStatus::ok) continue;
    ++frames.known;
    EXPECT_NEAR(value, truth(stamp), within) << stamp / ms << " ms";
  }
  return frames;
}

}  // namespace penumbra::test
