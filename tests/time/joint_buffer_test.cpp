// SPDX-License-Identifier: Apache-2.0
#include "../robot/urdf_text.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <penumbra/time/joint_buffer.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;

Robot arm(const std::string& second_type = "revolute", const std::string& body = "") {
  return parse(robot_xml(link_xml("a") + link_xml("b") + link_xml("c") +
                         joint_xml("p", "prismatic", "a", "b") +
                         joint_xml("q", second_type, "b", "c", body)));
}

class Buffer : public ::testing::Test {
 protected:
  std::size_t insert(std::int64_t ms, std::vector<std::string> names, std::vector<double> values) {
    return buffer_.insert(ms * kMs, names, values);
  }

  const JointAnswer& at(std::int64_t ms) {
    buffer_.at(ms * kMs, answer_);
    return answer_;
  }

  Robot robot_ = arm();
  JointBuffer buffer_{robot_, {.max_gap = 0.1, .history = 1.0}};
  JointAnswer answer_;
};

TEST_F(Buffer, BadValuesAreCountedAndForeignNamesAreNotTaken) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(insert(0, {"gripper", "p", "q", "q"}, {1.0, nan, -inf, 1e12}), 0u);
  EXPECT_EQ(insert(0, {"p", "q"}, {1.0}), 1u);
  EXPECT_EQ(buffer_.refused_values(), 4u);
  EXPECT_EQ(at(0).status, JointStatus::missing);
  EXPECT_FALSE(buffer_.complete_until());
}

TEST_F(Buffer, HistoryIsBoundedInTimeButTheLastStateIsRemembered) {
  insert(0, {"p", "q"}, {0.0, 0.0});
  for (std::int64_t ms = 50; ms <= 5000; ms += 50) insert(ms, {"p"}, {1.0});
  EXPECT_EQ(at(4990).gaps.size(), 1u);
  EXPECT_EQ(answer_.gaps[0].variable, 1u);
  EXPECT_EQ(answer_.gaps[0].last_seen, 0);
  at(2000);
  ASSERT_EQ(answer_.gaps.size(), 2u);
  EXPECT_EQ(answer_.gaps[0].why, JointStatus::stale);
  EXPECT_FALSE(answer_.gaps[0].last_seen);
  insert(2000, {"p"}, {9.0});  // too old to be kept
  EXPECT_EQ(at(2000).gaps.size(), 2u);
}

const std::vector<std::string> kPose = {"p", "q/x", "q/y", "q/z", "q/qx", "q/qy", "q/qz", "q/qw"};

TEST(BufferKinds, PartsOfAQuaternionBelongToOneStamp) {
  const Robot robot = arm("floating");
  JointBuffer buffer(robot);
  buffer.insert(0, kPose, std::vector<double>{0, 0, 0, 0, 0, 0, 0, 1});
  const std::vector<std::string> some = {"p", "q/x", "q/y", "q/z", "q/qx", "q/qy"};
  buffer.insert(10 * kMs, some, std::vector<double>(6, 0.0));
  EXPECT_EQ(buffer.complete_until(), 0);
  JointAnswer answer;
  buffer.at(5 * kMs, answer);
  EXPECT_EQ(answer.status, JointStatus::stale);
  EXPECT_EQ(answer.gaps.size(), 4u);
  const std::vector<std::string> rest = {"q/qz", "q/qw"};
  buffer.insert(10 * kMs, rest, std::vector<double>{0.6, 0.8});
  buffer.at(5 * kMs, answer);
  EXPECT_EQ(answer.status, JointStatus::ok);
  EXPECT_EQ(buffer.complete_until(), 10 * kMs);
}

TEST(BufferJumps, AreNeverInterpolated) {
  const double slow = 0.5, half = 0.9;  // rad/s; of a rotation by more than a right angle
  struct Case {
    std::string type, body;
    std::vector<double> before, after;
    bool ok;
  };
  const std::vector<double> no_turn = {0, 0, 0, 0, 0, 0, 1};
  const std::vector<double> turned = {0, 0, 0, 0, 0, std::sin(half), std::cos(half)};
  const std::string limit = "<limit velocity=\"" + std::to_string(slow) + "\"/>";
  const Case cases[] = {
      {"revolute", "", {3.1}, {-3.1}, false},  // an encoder that wraps
      {"revolute", "", {0.0}, {1.5}, true},
      {"revolute", limit, {0.0}, {0.1}, false},  // 0.1 s at 0.5 rad/s, and 20 ms of jitter
      {"revolute", limit, {0.0}, {0.05}, true},
      {"continuous", "", {3.1}, {-3.1}, true},  // 0.08 rad the short way
      {"continuous", "", {0.0}, {1.7}, false},
      {"prismatic", "", {0.0}, {1.0}, true},  // nothing says how fast a slide is
      {"prismatic", limit, {0.0}, {0.1}, false},
      {"floating", "", no_turn, turned, false},
  };
  for (const Case& each : cases) {
    const Robot robot = arm(each.type, each.body);
    std::vector<std::string> names(robot.variables().begin() + 1, robot.variables().end());
    JointBuffer buffer(robot);
    for (const std::int64_t stamp : {std::int64_t{0}, 100 * kMs}) {
      buffer.insert(stamp, std::vector<std::string>{"p"}, std::vector<double>{0.0});
      buffer.insert(stamp, names, stamp == 0 ? each.before : each.after);
    }
    JointAnswer answer;
    buffer.at(50 * kMs, answer);
    EXPECT_EQ(answer.status, each.ok ? JointStatus::ok : JointStatus::stale)
        << each.type << ' ' << each.after.back();
    EXPECT_EQ(!answer.gaps.empty() && answer.gaps.back().jump, !each.ok);
    buffer.at(100 * kMs, answer);
    EXPECT_EQ(answer.status, JointStatus::ok) << "a state itself is no jump";
  }
}

TEST(BufferKinds, QuaternionsThatAreNoneAreRefused) {
  const Robot robot = arm("floating");
  JointBuffer buffer(robot);
  EXPECT_EQ(buffer.insert(0, kPose, std::vector<double>(8, 0.0)), 4u);
  EXPECT_EQ(buffer.refused_values(), 4u);
  EXPECT_FALSE(buffer.complete_until());
}

}  // namespace
}  // namespace penumbra::test
