// SPDX-License-Identifier: Apache-2.0
// Programs that tell one joint, and what a buffer makes of it.
#pragma once

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

inline constexpr std::int64_t ms = 1'000'000;  // nanoseconds

/// rad or m at a time in nanoseconds.
using Way = std::function<double(std::int64_t)>;

/// At a constant speed through 0 at 1 s, per second.
inline Way moving(double speed) {
  return [=](std::int64_t t) { return speed * 1e-9 * static_cast<double>(t - 1000 * ms); };
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
  void hear(const std::vector<Program>& programs) {
    std::vector<Told> all;
    for (const Program& program : programs) tell(program, all);
    hear(std::move(all));
  }

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
    std::vector<Told> all;
    for (const Program& program : programs) tell(program, all);
    return live(std::move(all));
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

}  // namespace penumbra::test
