// SPDX-License-Identifier: Apache-2.0
#include "../robot/plain_robot.hpp"
#include "../robot/urdf_text.hpp"

#include <penumbra/time/joint_buffer.hpp>

namespace penumbra::test {
namespace {

Robot arm(const std::string& second_type = "revolute", const std::string& body = "") {
  return parse(robot_xml(link_xml("a") + link_xml("b") + link_xml("c") +
                         joint_xml("p", "prismatic", "a", "b") +
                         joint_xml("q", second_type, "b", "c", body)));
}

class Buffer : public ::testing::Test {
 protected:
  std::size_t insert(std::int64_t t, std::vector<std::string> names, std::vector<double> values) {
    return buffer_.insert(t * ms, names, values);
  }

  const JointAnswer& at(std::int64_t t) {
    buffer_.at(t * ms, answer_);
    return answer_;
  }

  Robot robot_ = arm();
  JointBuffer buffer_{robot_, {.max_gap = 0.1, .history = 1.0}};
  JointAnswer answer_;
};

TEST_F(Buffer, BadValuesAreCountedAndForeignNamesAreNotTaken) {
  EXPECT_EQ(insert(0, {"gripper", "p", "q", "q"}, {1.0, nan, -inf, 1e12}), 0u);
  EXPECT_EQ(insert(0, {"p", "q"}, {1.0}), 1u);
  EXPECT_EQ(insert(0, {"p", "q"}, {1.0, 2.0, 3.0}), 0u) << "nobody knows which is whose";
  EXPECT_EQ(buffer_.refused_values(), 6u);
  EXPECT_EQ(at(0).status, JointStatus::missing);
  EXPECT_FALSE(buffer_.complete_until());
}

TEST_F(Buffer, HistoryIsBoundedInTimeButTheLastStateIsRemembered) {
  insert(0, {"p", "q"}, {0.0, 0.0});
  for (std::int64_t t = 50; t <= 5000; t += 50) insert(t, {"p"}, {1.0});
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

TEST_F(Buffer, ANameTwiceInOneStateIsDisputedIfItsValuesDiffer) {
  insert(0, {"p", "p"}, {0.1, 0.1});
  EXPECT_TRUE(at(0).disputes.empty());
  insert(1, {"p", "p"}, {0.1, 0.5});
  EXPECT_EQ(at(1).disputes.size(), 1U);
}

const std::vector<std::string> kPose = {"p", "q/x", "q/y", "q/z", "q/qx", "q/qy", "q/qz", "q/qw"};

TEST(BufferKinds, PartsOfAQuaternionBelongToOneStamp) {
  const Robot robot = arm("floating");
  JointBuffer buffer(robot);
  EXPECT_EQ(JointBuffer(robot).insert(0, kPose, std::vector<double>(8, 0.0)), 4u) << "no rotation";
  buffer.insert(0, kPose, std::vector<double>{0, 0, 0, 0, 0, 0, 0, 1});
  const std::vector<std::string> some = {"p", "q/x", "q/y", "q/z", "q/qx", "q/qy"};
  buffer.insert(10 * ms, some, std::vector<double>(6, 0.0));
  EXPECT_EQ(buffer.complete_until(), 0);
  JointAnswer answer;
  buffer.at(5 * ms, answer);
  EXPECT_EQ(answer.status, JointStatus::stale);
  EXPECT_EQ(answer.gaps.size(), 4u);
  const std::vector<std::string> rest = {"q/qz", "q/qw"};
  buffer.insert(10 * ms, rest, std::vector<double>{0.6, 0.8});
  buffer.at(5 * ms, answer);
  EXPECT_EQ(answer.status, JointStatus::ok);
  EXPECT_EQ(buffer.complete_until(), 10 * ms);
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
    for (const std::int64_t stamp : {std::int64_t{0}, 100 * ms}) {
      buffer.insert(stamp, std::vector<std::string>{"p"}, std::vector<double>{0.0});
      buffer.insert(stamp, names, stamp == 0 ? each.before : each.after);
    }
    JointAnswer answer;
    buffer.at(50 * ms, answer);
    EXPECT_EQ(answer.status, each.ok ? JointStatus::ok : JointStatus::stale)
        << each.type << ' ' << each.after.back();
    EXPECT_EQ(!answer.gaps.empty() && answer.gaps.back().jump, !each.ok);
    buffer.at(100 * ms, answer);
    EXPECT_EQ(answer.status, JointStatus::ok) << "a state itself is no jump";
  }
}

// The joint buffer against a naive twin that keeps every state in a map.

// Positions of size 10, a handful of operations.
constexpr double kOracleTolerance = 1e-12;
constexpr std::int64_t kMaxGap = 50;

using States = std::map<std::string, std::map<std::int64_t, double>>;
using Known = std::map<std::int64_t, std::vector<double>>;

/// The stamps at which every one of the variables is known.
Known all_known(const States& states, const std::vector<std::string>& of) {
  Known out;
  for (const std::string& name : of) {
    const auto found = states.find(name);
    if (found == states.end()) return {};
    for (const auto& [stamp, value] : found->second) out[stamp].push_back(value);
  }
  std::erase_if(out, [&](const auto& each) { return each.second.size() != of.size(); });
  return out;
}

struct Between {
  bool ok = false;
  std::int64_t age = 0;
  double t = 0.0;
  std::vector<double> a, b;
};

Between between(const Known& of, std::int64_t stamp) {
  const auto after = of.lower_bound(stamp);
  if (after == of.end()) return {};
  if (after->first == stamp) return {true, 0, 0.0, after->second, after->second};
  if (after == of.begin()) return {};
  const auto before = std::prev(after);
  const std::int64_t gap = after->first - before->first;
  if (gap > kMaxGap) return {};
  const std::int64_t passed = stamp - before->first;
  return {true, std::max(passed, gap - passed), double(passed) / double(gap), before->second,
          after->second};
}

std::vector<double> slerp(std::vector<double> a, std::vector<double> b, double t) {
  double dot = 0.0;
  for (std::size_t i = 0; i < 4; ++i) dot += a[i] * b[i];
  const double sign = dot < 0.0 ? -1.0 : 1.0;
  const double angle = std::acos(std::min(1.0, std::abs(dot)));
  const double s = std::sin(angle);
  const double u = s < 1e-9 ? 1.0 - t : std::sin((1.0 - t) * angle) / s;
  const double v = s < 1e-9 ? t : std::sin(t * angle) / s;
  for (std::size_t i = 0; i < 4; ++i) a[i] = u * a[i] + sign * v * b[i];
  return a;
}

bool turns(const std::string& name) { return name == "j1" || name.ends_with("/yaw"); }

class Fuzz {
 public:
  Fuzz(Random& random, std::size_t& answered) : random_(random), answered_(answered) {}

  void insert_some() {
    const auto stamp = std::int64_t(below(random_, 600));
    std::vector<std::string> names;
    std::vector<double> values;
    const auto put = [&](const std::string& name, double value) {
      names.push_back(name);
      values.push_back(value);
      states_[name][stamp] = value;
    };
    for (const std::string& name : robot_.variables())
      if (name.find("/q") == std::string::npos && below(random_, 3) != 0)
        put(name, random_position(name));
    for (const char* joint : {"j2", "j5"})
      if (below(random_, 3) != 0) put_quaternion(joint, put);
    names.push_back("stranger");
    values.push_back(1.0);
    EXPECT_EQ(buffer_.insert(stamp, names, values), names.size() - 1);
  }

  void ask() {
    const auto stamp = std::int64_t(below(random_, 620)) - 10;
    JointAnswer answer;
    buffer_.at(stamp, answer);
    std::int64_t age = 0;
    std::size_t gaps = 0;
    bool any_missing = false;
    for (std::size_t i = 0; i < robot_.variables().size(); ++i) {
      const std::string& name = robot_.variables()[i];
      const Between found = between(all_known(states_, group_of(name)), stamp);
      if (found.ok && !jumps(name, found)) {
        age = std::max(age, found.age);
        if (answer.status == JointStatus::ok) {
          EXPECT_NEAR(answer.positions[i], expected(name, found), kOracleTolerance) << name;
        }
        continue;
      }
      ++gaps;
      any_missing |= expect_gap(answer, i, stamp);
    }
    ASSERT_EQ(answer.gaps.size(), gaps);
    const JointStatus bad = any_missing ? JointStatus::missing : JointStatus::stale;
    EXPECT_EQ(answer.status, gaps == 0 ? JointStatus::ok : bad);
    if (gaps > 0) return;
    EXPECT_EQ(answer.age, age);
    ++answered_;
  }

 private:
  // Of what turns, few of which lie more than a right angle apart.
  double random_position(const std::string& name) {
    const double turn = 2.0 * std::numbers::pi;
    if (turns(name)) return uniform(random_, -1.0, 1.0) + turn * double(below(random_, 4));
    return name == "j0" ? uniform(random_, -1.0, 1.0) : uniform(random_, -10.0, 10.0);
  }

  // Its parts in any order.
  template <typename Put>
  void put_quaternion(const std::string& joint, const Put& put) {
    Eigen::Vector4d q;
    for (int k = 0; k < 4; ++k) q[k] = uniform(random_, -0.4, 0.4);
    q[3] = q[3] < 0.0 ? -1.0 : 1.0;
    q.normalize();
    const std::size_t start = below(random_, 4);
    // A stamp's quaternion is given whole or not at all, so that no two are mixed.
    for (std::size_t i = start; i < start + 4; ++i)
      put(joint + "/q" + "xyzw"[i % 4], q[Eigen::Index(i % 4)]);
  }

  static std::vector<std::string> group_of(const std::string& name) {
    const std::size_t at = name.find("/q");
    if (at == std::string::npos) return {name};
    const std::string joint = name.substr(0, at);
    return {joint + "/qx", joint + "/qy", joint + "/qz", joint + "/qw"};
  }

  static double expected(const std::string& name, const Between& found) {
    if (found.a.size() == 4)
      return slerp(found.a, found.b, found.t)[std::string("xyzw").find(name.back())];
    return found.a[0] + found.t * way(name, found);
  }

  static double way(const std::string& name, const Between& found) {
    double way = found.b[0] - found.a[0];
    const double turn = 2.0 * std::numbers::pi;
    while (turns(name) && way > std::numbers::pi) way -= turn;
    while (turns(name) && way < -std::numbers::pi) way += turn;
    return way;
  }

  // Whether what turns does so by more than a right angle.
  static bool jumps(const std::string& name, const Between& found) {
    const double most = std::numbers::pi / 2.0;
    if (found.a.size() == 1)
      return (turns(name) || name == "j0") && std::abs(way(name, found)) > most;
    double dot = 0.0;
    for (std::size_t k = 0; k < 4; ++k) dot += found.a[k] * found.b[k];
    return 2.0 * std::acos(std::min(1.0, std::abs(dot))) > most;
  }

  // Whether the variable was never seen.
  bool expect_gap(const JointAnswer& answer, std::size_t i, std::int64_t stamp) const {
    const auto gap = std::find_if(answer.gaps.begin(), answer.gaps.end(),
                                  [&](const JointGap& g) { return g.variable == i; });
    EXPECT_NE(gap, answer.gaps.end()) << robot_.variables()[i] << " at " << stamp;
    if (gap == answer.gaps.end()) return false;
    const auto states = states_.find(robot_.variables()[i]);
    const bool missing = states == states_.end();
    EXPECT_EQ(gap->why, missing ? JointStatus::missing : JointStatus::stale);
    std::optional<std::int64_t> last, next;
    if (!missing) {
      const auto after = states->second.upper_bound(stamp);
      if (after != states->second.begin()) last = std::prev(after)->first;
      if (after != states->second.end()) next = after->first;
    }
    EXPECT_EQ(gap->last_seen, last);
    EXPECT_EQ(gap->next_seen, next);
    return missing;
  }

  Random& random_;
  Robot robot_ = every_kind();
  JointBuffer buffer_{robot_, {.max_gap = double(kMaxGap) * 1e-9, .history = 1.0}};
  States states_;
  std::size_t& answered_;
};

TEST(JointBufferOracle, AgreesOnRandomStates) {
  Random random = seeded_random(7);
  std::size_t answered = 0;
  for (int trial = 0; trial < samples(20); ++trial) {
    Fuzz fuzz(random, answered);
    for (int step = 0; step < 120; ++step) {
      fuzz.insert_some();
      fuzz.ask();
      ASSERT_FALSE(testing::Test::HasFailure()) << "trial " << trial << " step " << step;
    }
  }
  EXPECT_GT(answered, std::size_t(samples(50)));  // else the test would see gaps only
}

}  // namespace
}  // namespace penumbra::test
