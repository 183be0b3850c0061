// SPDX-License-Identifier: Apache-2.0
// One joint with several publishers, asked as frames are: while messages arrive.
#include "../robot/urdf_text.hpp"

#include <penumbra/time/joint_buffer.hpp>

namespace penumbra::test {
namespace {

using Path = std::function<double(double)>;  // position at a time in seconds

Path rest(double at) {
  return [=](double) { return at; };
}
double swing(double t) { return 0.6 * std::sin(1.57 * t) + 0.1 * std::sin(2.9 * t); }
/// At rest until 2 s, then with 5 rad/s^2 up to 1 rad/s.
double start(double t) {
  const double s = std::max(0.0, t - 2.0);
  return s < 0.2 ? 2.5 * s * s : s - 0.1;
}

constexpr std::int64_t all_ends = 4000;  // ms

/// Publishes from `first` to before `end`, ms.
struct Publisher {
  std::string name;
  Path path;
  std::int64_t period = 10, first = 0, end = all_ends, latency = 0;

  [[nodiscard]] Publisher until(std::int64_t time) const {
    Publisher other = *this;
    other.end = time;
    return other;
  }
  [[nodiscard]] Publisher from(std::int64_t time, const std::string& as) const {
    Publisher other = *this;
    other.first = time;
    other.name = as;
    return other;
  }
};

/// Sends what a publisher, which starts at 0, sent last `lag` before.
Publisher relay(const Publisher& of, std::int64_t lag, std::int64_t period = 10) {
  const double step = 1e-3 * double(of.period);
  const double late = 1e-3 * double(lag), end = 1e-3 * double(of.end);
  const Path path = [=, path = of.path](double t) {
    return path(step * std::max(0.0, std::floor(std::min(t - late, end) / step + 1e-9)));
  };
  return {.name = "relay", .path = path, .period = period, .first = 5};
}

struct Message {
  std::int64_t arrival, stamp;
  double value;
  std::string source;
};

double seconds(std::int64_t stamp) { return 1e-9 * double(stamp); }

std::vector<Message> messages_of(const std::vector<Publisher>& publishers) {
  std::vector<Message> all;
  for (const auto& [name, path, period, first, end, latency] : publishers)
    for (std::int64_t t = first; t < end; t += period)
      all.push_back({(t + latency) * ms, t * ms, path(seconds(t * ms)), name});
  return all;
}

struct Frame {
  std::int64_t stamp;
  JointAnswer answer;
};

class OneJoint {
 public:
  explicit OneJoint(bool compares = true) : buffer_(robot_, {.compare_sources = compares}) {}

  void add(std::int64_t stamp, double value, const std::string& source) {
    buffer_.insert(stamp, std::vector<std::string>{"q"}, std::vector<double>{value}, source);
  }
  [[nodiscard]] JointAnswer at(std::int64_t stamp) const {
    JointAnswer answer;
    buffer_.at(stamp, answer);
    return answer;
  }
  /// A frame each 5 ms, which waits at most 200 ms for its pose.
  std::vector<Frame> frames(std::vector<Message> messages) {
    std::stable_sort(messages.begin(), messages.end(),
                     [](const Message& a, const Message& b) { return a.arrival < b.arrival; });
    std::vector<Frame> out;
    std::vector<std::int64_t> waiting;
    std::int64_t pushed = 0;
    for (const auto& [arrival, stamp, value, source] : messages) {
      add(stamp, value, source);
      for (; pushed <= arrival; pushed += 5 * ms) waiting.push_back(pushed);
      std::erase_if(waiting, [&, now = arrival](std::int64_t asked) {
        JointAnswer answer = at(asked);
        if (answer.status != JointStatus::ok && now < asked + 200 * ms) return false;
        out.push_back({asked, std::move(answer)});
        return true;
      });
    }
    return out;
  }

 private:
  Robot robot_ =
      parse(robot_xml(link_xml("a") + link_xml("b") + joint_xml("q", "continuous", "a", "b")));
  JointBuffer buffer_;
};

JointAnswer answer_at(std::int64_t time, const std::vector<Publisher>& publishers) {
  OneJoint joint;
  joint.frames(messages_of(publishers));
  return joint.at(time * ms);
}

/// What frames get from a time to another, ms.
struct Case {
  std::string what;
  std::vector<Publisher> publishers;
  std::int64_t from, to;
  JointStatus status;
  Path position = {};  ///< if ok
  double within = 1e-3;
  bool compares = true;
};

std::vector<Case> cases() {
  using enum JointStatus;
  const Publisher driver{"driver", swing}, slow{"driver", swing, 100};
  const Publisher seldom{"driver", rest(1), 900}, late{"driver", swing, 10, 0, all_ends, 400};
  const Publisher arm{"driver", start, 10, 6}, second = driver.from(7, "second");
  const Publisher sliders{"sliders", rest(-0.9), 10, 3}, zero{"sliders", rest(0)};
  const Publisher begun = sliders.from(2000, "sliders"), seldom_sliders{"s", rest(-0.9), 150};
  const Publisher soon = sliders.from(105, "sliders");
  const Publisher ended = driver.until(1200), again = driver.from(2000, "driver 2");
  const Path snap = [](double t) { return std::fmod(t, 0.2) < 0.1 ? 0.0 : 0.8; };
  constexpr std::int64_t end = 3700;
  return {
      {"one alone is not compared", {{"driver", snap}}, 50, end, ok, snap, 1.0},
      {"a relay", {driver, relay(driver, 4)}, 50, end, ok, swing},
      {"a late relay", {driver, relay(driver, 30)}, 50, end, ok, swing},
      {"a slow relay", {driver, relay(driver, 4, 100)}, 50, end, ok, swing},
      {"a relay of a slow driver", {slow, relay(slow, 4)}, 50, end, ok, swing, 3e-3},
      {"a relay heard first", {relay(driver, 12), second}, 50, end, ok, swing, 0.03},
      {"two rates of one driver", {slow, driver.from(20, "look 2")}, 100, end, ok, swing, 3e-3},
      {"the driver first", {driver, sliders}, 50, end, disputed},
      {"sliders first", {sliders, second}, 50, end, disputed},
      {"slow sliders", {driver, seldom_sliders}, 200, end, disputed},
      {"before sliders begin", {driver, begun}, 50, 1995, ok, swing},
      {"since sliders began", {driver, begun}, 2020, end, disputed},
      {"the arm is at the sliders' pose", {zero, arm}, 50, 2050, ok, start, 0.012},
      {"the arm has left the sliders' pose", {zero, arm}, 2100, end, disputed},
      {"sliders that ended", {driver, sliders.until(2000)}, 2800, end, ok, swing},
      {"sliders heard first that ended", {sliders.until(2000), second}, 2000, end, stale},
      {"a driver that ended, with sliders", {ended, sliders}, 1200, end, stale},
      {"a driver that ended, with a relay", {ended, relay(ended, 4)}, 1200, end, stale},
      {"a driver that started again", {ended, again}, 2000, end, ok, swing},
      {"a driver that started soon", {ended, driver.from(1300, "new")}, 1710, end, ok, swing},
      {"a driver that started elsewhere", {sliders.until(1200), again}, 2000, end, ok, swing},
      {"likewise, with a relay", {ended, relay(driver, 4), again}, 2000, end, ok, swing},
      {"likewise, with sliders", {ended, sliders, again}, 2020, end, disputed},
      {"sliders that begin, a late driver", {late, begun}, 1900, 3200, stale},
      {"sliders that begin, a seldom driver", {seldom, soon}, 1, 899, stale},
      {"not compared", {driver, sliders}, 50, end, ok, swing, 1e-3, false},
      {"not compared, started again", {ended, sliders, again}, 2000, end, ok, swing, 1e-3, false},
  };
}

TEST(JointSources, FramesGetWhatTheRuleSays) {
  for (const Case& each : cases()) {
    SCOPED_TRACE(each.what);
    OneJoint joint(each.compares);
    std::int64_t asked = 0;
    for (const auto& [stamp, answer] : joint.frames(messages_of(each.publishers))) {
      if (stamp < each.from * ms || stamp >= each.to * ms) continue;
      ++asked;
      ASSERT_EQ(answer.status, each.status) << stamp / ms << " ms";
      if (each.status != JointStatus::ok) continue;
      ASSERT_NEAR(answer.positions[0], each.position(seconds(stamp)), each.within) << stamp / ms;
    }
    EXPECT_GE(asked, (each.to - each.from) / 6);
  }
}

TEST(JointSources, MessagesNameThePublishers) {
  const Publisher driver{"driver", rest(0.3), 10, 0, 2000}, sliders{"sliders", rest(0.0), 10, 5};
  const JointAnswer disputed = answer_at(1500, {driver, sliders});
  const JointAnswer silent = answer_at(3500, {driver, sliders});
  ASSERT_EQ(disputed.disputes.size(), 1U);
  EXPECT_EQ(disputed.disputes[0].sources, (std::array<std::string, 2>{"driver", "sliders"}));
  EXPECT_EQ(disputed.disputes[0].values, (std::array{0.3, 0.0}));
  EXPECT_LE(std::abs(disputed.disputes[0].stamp - 1500 * ms), 200 * ms);
  ASSERT_EQ(silent.gaps.size(), 1U);
  EXPECT_EQ(silent.gaps[0].source, "driver");
  EXPECT_EQ(silent.gaps[0].last_seen, 1990 * ms);
}

TEST(JointSources, ASuccessorIsComparedSinceItBeganAndASilentOneComesBack) {
  const Publisher before{"driver", swing, 10, 0, 1000}, back{"driver", swing, 10, 2500};
  const Publisher next{"second", swing, 10, 1500}, other{"other", rest(3.0), 10, 1500};
  const Publisher driver{"driver", swing, 10, 0, 1200}, second{"second", swing, 10, 3};
  const Publisher again{"driver 2", swing, 10, 1300}, elsewhere{"driver 2", rest(3.0), 10, 1300};
  const std::tuple<std::int64_t, std::vector<Publisher>, JointStatus> asked[] = {
      {2000, {before, back}, JointStatus::stale},
      {3001, {before, back}, JointStatus::ok},
      {2000, {before, next, back}, JointStatus::ok},
      {3001, {before, next, back}, JointStatus::ok},
      {3001, {before, other, back}, JointStatus::disputed},
      {1400, {driver, second, again}, JointStatus::ok},
      {1400, {driver, second, elsewhere}, JointStatus::disputed}};
  for (const auto& [time, publishers, status] : asked)
    EXPECT_EQ(answer_at(time, publishers).status, status) << time << ' ' << publishers[1].name;
}

TEST(JointSources, WheelsAgreeWhetherTurnsAreCountedOrNot) {
  // 12 rad/s, from encoders that are read at half the rate.
  const auto read = [](double step) {
    return [=](double t) { return 12.0 * step * std::floor(t / step + 1e-9); };
  };
  const Path wrapped = [&](double t) { return std::remainder(read(0.05)(t), 2.0 * M_PI); };
  const Publisher driver{"driver", read(0.04), 20}, odometry{"odometry", wrapped, 25};
  for (const Frame& frame : OneJoint().frames(messages_of({driver, odometry})))
    EXPECT_NE(frame.answer.status, JointStatus::disputed) << frame.stamp / ms;
}

TEST(JointSources, RotationsOfFloatingJointsAreCompared) {
  const Robot robot =
      parse(robot_xml(link_xml("a") + link_xml("b") + joint_xml("f", "floating", "a", "b")));
  JointBuffer buffer(robot);
  const std::vector<std::string> names{"f/x", "f/y", "f/z", "f/qx", "f/qy", "f/qz", "f/qw"};
  JointAnswer answer;
  for (std::int64_t t = 0; t < 200 * ms; t += 10 * ms) {
    const double sign = t < 100 * ms ? -1.0 : 1.0;  // the same rotation, then another one
    buffer.insert(t, names, std::vector<double>{0, 0, 0, 0, 0, 0.6, 0.8}, "a");
    buffer.insert(t, names, std::vector<double>{0, 0, 0, 0, 0, -0.6, sign * 0.8}, "b");
    buffer.at(t, answer);
    ASSERT_EQ(answer.status, t < 100 * ms ? JointStatus::ok : JointStatus::disputed) << t / ms;
  }
  ASSERT_EQ(answer.disputes.size(), 1U);
  EXPECT_EQ(robot.variables()[answer.disputes[0].variable], "f/qz");
  EXPECT_EQ(answer.disputes[0].values, (std::array{0.6, -0.6}));
}

TEST(JointSources, NoPoseOffByMoreThanTheNoiseIsOk) {
  // An arm leaves the pose of sliders, and passes it again; either is heard first. A frame that is
  // ok has the arm's pose within the noise and what the arm moves until its next messages arrive.
  std::mt19937_64 random = seeded_random(23);
  const auto number = [&](double from, double to) { return uniform(random, from, to); };
  const auto whole = [&](std::int64_t from, std::int64_t to) {
    return std::uniform_int_distribution<std::int64_t>(from, to)(random);
  };
  int known = 0;
  for (int round = 0; round < samples(300); ++round) {
    Path path = rest(number(-2.0, 2.0));
    for (int i = 0; i < 3; ++i) {  // swings of up to 3 rad/s and 40 rad/s^2
      const double f = number(0.3, 12.0), phase = number(0.0, 6.28);
      const double size = number(0.2, 1.0) * std::min(3.0 / f, 40.0 / (f * f)) / 3.0;
      path = [=](double t) { return path(t) + size * std::sin(f * t + phase); };
    }
    const double leaves = number(0.5, 3.0);
    const Path arm = [=](double t) { return path(std::max(0.0, t - leaves)); };
    const std::int64_t period = whole(2, 20), latency = whole(0, 20);
    const Publisher driver{"driver", arm, period, 0, all_ends, latency};
    const Publisher sliders{"sliders", rest(path(0.0)), whole(2, 100), whole(0, 20)};
    const double unheard = 3.0 * 1e-3 * double(3 * period + latency);
    std::vector<Message> sent = messages_of({driver, sliders});
    std::erase_if(sent, [&](const Message&) { return whole(0, 19) == 0; });  // lost
    OneJoint joint;
    for (const auto& [stamp, answer] : joint.frames(std::move(sent)))
      if (stamp >= 150 * ms && answer.status == JointStatus::ok) {
        ASSERT_NEAR(answer.positions[0], arm(seconds(stamp)), JointRule::turn_noise + unheard);
      }
    for (std::int64_t stamp = 150 * ms; stamp < 3700 * ms; stamp += ms) {
      const JointAnswer later = joint.at(stamp);
      if (later.status != JointStatus::ok) continue;
      ++known;
      ASSERT_NEAR(later.positions[0], arm(seconds(stamp)), 1.5 * JointRule::turn_noise)
          << "round " << round << " at " << stamp / ms;
    }
  }
  std::cout << known << " known\n";
}

}  // namespace
}  // namespace penumbra::test
