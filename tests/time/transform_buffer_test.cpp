// SPDX-License-Identifier: Apache-2.0
#include "../robot/urdf_text.hpp"
#include "../support/test.hpp"

#include <penumbra/time/transform_buffer.hpp>

namespace penumbra::test {
namespace {

constexpr double kTolerance = 1e-12;  // lengths of 1, a handful of operations

Isometry3d shift(double x) { return at(x, 0, 0); }

class Transforms : public testing::Test {
 protected:
  const TransformAnswer& at(std::int64_t stamp, const char* target, const char* source) {
    buffer_.at(stamp, target, source, answer_);
    EXPECT_EQ(answer_.message.empty(), answer_.status == TransformStatus::ok);
    EXPECT_EQ(answer_.message.find('\n'), std::string::npos);
    return answer_;
  }

  void expect_refused(TransformInsert outcome, TransformInsert why, const std::string& names) {
    EXPECT_EQ(outcome, why);
    EXPECT_TRUE(holds(buffer_.last_refusal(), names));
  }

  TransformBuffer buffer_{{.max_gap = 0.1, .history = 1.0}};
  TransformAnswer answer_;
};

TEST_F(Transforms, WhatIsMissingIsNamed) {
  buffer_.insert_static("base", "arm", shift(1));
  buffer_.insert_static("world", "camera", shift(1));
  EXPECT_EQ(at(1, "base", "camera").status, TransformStatus::missing);
  EXPECT_TRUE(holds(answer_.message, {"'camera'", "'world'", "'base'"}));
  EXPECT_EQ(at(1, "base", "hand").status, TransformStatus::missing);
  EXPECT_TRUE(holds(answer_.message, "'hand'"));
}

TEST_F(Transforms, WhatIsNoTreeIsRefusedAndChangesNothing) {
  buffer_.insert(1, "a", "b", shift(1));
  buffer_.insert_static("b", "c", shift(1));
  expect_refused(buffer_.insert(2, "c", "a", shift(5)), TransformInsert::loop, "'a' in 'c'");
  expect_refused(buffer_.insert(2, "c", "c", shift(5)), TransformInsert::loop, "'c' in 'c'");
  expect_refused(buffer_.insert(2, "d", "b", shift(5)), TransformInsert::second_parent, "'a'");
  expect_refused(buffer_.insert_static("a", "b", shift(5)), TransformInsert::static_and_free,
                 "moving before");
  expect_refused(buffer_.insert(2, "b", "c", shift(5)), TransformInsert::static_and_free,
                 "static before");
  EXPECT_EQ(buffer_.refused(), 5U);
  EXPECT_EQ(buffer_.count(TransformInsert::loop), 2U);
  EXPECT_EQ(buffer_.count(TransformInsert::taken), 2U);
  EXPECT_FALSE(buffer_.knows("d"));
  EXPECT_TRUE(at(1, "a", "c").T_target_source.isApprox(shift(2), kTolerance));
  EXPECT_EQ(at(2, "a", "b").status, TransformStatus::stale);
}

TEST_F(Transforms, WhatIsNoTransformIsRefused) {
  Isometry3d bad = shift(nan);
  expect_refused(buffer_.insert(1, "a", "b", bad), TransformInsert::not_rigid, "'b' in 'a'");
  bad = shift(1);
  bad.linear() *= 1.001;
  EXPECT_EQ(buffer_.insert_static("a", "b", bad), TransformInsert::not_rigid);
  bad.linear() = Vector3d(1, 1, -1).asDiagonal();
  EXPECT_EQ(buffer_.insert(1, "a", "b", bad), TransformInsert::not_rigid);
  EXPECT_EQ(buffer_.insert(1, "a", "b", shift(1.1e9)), TransformInsert::not_rigid);
  EXPECT_EQ(buffer_.insert(0, "a", "b", shift(1)), TransformInsert::no_stamp);
  EXPECT_EQ(buffer_.insert(-5, "a", "b", shift(1)), TransformInsert::no_stamp);
  EXPECT_EQ(buffer_.insert(1, "", "b", shift(1)), TransformInsert::bad_name);
  EXPECT_EQ(buffer_.insert(1, "a", "/", shift(1)), TransformInsert::bad_name);
  EXPECT_EQ(buffer_.insert(1, "a", std::string(257, 'b'), shift(1)), TransformInsert::bad_name);
  EXPECT_FALSE(buffer_.knows("a"));
  EXPECT_EQ(buffer_.refused(), 9U);
}

TEST_F(Transforms, TwoPublishersOfOneFrameThatDifferAreDisputed) {
  for (std::int64_t t = 100; t < 500; t += 10) {
    buffer_.insert(t * ms, "base", "arm", shift(0.5), "publisher 1 of /tf");
    buffer_.insert((t + 3) * ms, "base", "arm", Isometry3d(AngleAxisd(0.03, Vector3d::UnitZ())),
                   "publisher 2 of /tf");
    buffer_.insert(t * ms, "arm", "tool", shift(0.1), "publisher 1 of /tf");
  }
  EXPECT_EQ(at(305 * ms, "base", "tool").status, TransformStatus::disputed);
  EXPECT_TRUE(holds(answer_.message, {"'arm' in 'base'", "500 mm", "publisher 1", "publisher 2"}));
  EXPECT_EQ(at(305 * ms, "arm", "tool").status, TransformStatus::ok) << "it is not in this chain";
}

TEST_F(Transforms, TwoPosesOfOneStampAreDisputedAsABagDoesNotSayWhose) {
  for (std::int64_t t = 100; t < 500; t += 10) {
    buffer_.insert(t * ms, "base", "arm", shift(0.5), "/tf");
    if (t < 250 || t > 350) buffer_.insert(t * ms, "base", "arm", shift(0.5), "/tf");
    if (t >= 250 && t <= 350) buffer_.insert(t * ms, "base", "arm", shift(0.6), "/tf");
  }
  EXPECT_EQ(at(145 * ms, "base", "arm").status, TransformStatus::ok) << "a frame published twice";
  EXPECT_EQ(at(303 * ms, "base", "arm").status, TransformStatus::disputed);
  EXPECT_TRUE(holds(answer_.message, {"100 mm", "300000000 ns by /tf"}));
}

// The transform buffer against a naive twin: every state in a map, 4x4 matrices to the root.

constexpr double kOracleTolerance = 1e-10;  // lengths up to 20, chains of up to 12
constexpr std::int64_t kMaxGap = 40;
constexpr std::size_t kFrames = 12;

using Matrix = Eigen::Matrix4d;

std::string name_of(std::size_t frame) { return "f" + std::to_string(frame); }

class Oracle {
 public:
  /// Whether a tree stays one.
  bool insert(std::int64_t stamp, std::size_t parent, std::size_t child, bool is_static,
              const Matrix& T) {
    for (std::size_t f = parent;;) {
      if (f == child) return false;
      if (!parents_.contains(f)) break;
      f = parents_.at(f);
    }
    if (parents_.contains(child) && parents_.at(child) != parent) return false;
    if (parents_.contains(child) && statics_.contains(child) != is_static) return false;
    parents_[child] = parent;
    if (is_static) statics_.insert(child);
    states_[child][is_static ? 0 : stamp] = T;
    return true;
  }

  TransformStatus at(std::int64_t stamp, std::size_t target, std::size_t source, Matrix& T) const {
    const auto up = [&](std::size_t f) {
      std::vector<std::size_t> way{f};
      while (parents_.contains(way.back())) way.push_back(parents_.at(way.back()));
      return way;
    };
    std::vector<std::size_t> a = up(source), b = up(target);
    if (!known(source) || !known(target) || a.back() != b.back()) return TransformStatus::missing;
    while (a.size() > 1 && b.size() > 1 && a[a.size() - 2] == b[b.size() - 2]) {
      a.pop_back();
      b.pop_back();
    }
    Matrix from_source = Matrix::Identity(), from_target = Matrix::Identity();
    for (std::size_t i = 0; i + 1 < a.size(); ++i)
      if (!climb(a[i], stamp, from_source)) return TransformStatus::stale;
    for (std::size_t i = 0; i + 1 < b.size(); ++i)
      if (!climb(b[i], stamp, from_target)) return TransformStatus::stale;
    T = from_target.inverse() * from_source;
    return TransformStatus::ok;
  }

 private:
  bool known(std::size_t f) const {
    return parents_.contains(f) ||
           std::any_of(parents_.begin(), parents_.end(), [&](auto& p) { return p.second == f; });
  }

  bool climb(std::size_t frame, std::int64_t stamp, Matrix& T) const {
    const auto& states = states_.at(frame);
    if (statics_.contains(frame)) return T = states.at(0) * T, true;
    const auto after = states.lower_bound(stamp);
    if (after == states.end()) return false;
    if (after->first == stamp) return T = after->second * T, true;
    if (after == states.begin()) return false;
    const auto before = std::prev(after);
    if (after->first - before->first > kMaxGap) return false;
    const double share = double(stamp - before->first) / double(after->first - before->first);
    const Matrix &p = before->second, &q = after->second;
    const Matrix3d R = p.topLeftCorner<3, 3>();
    const AngleAxisd turn(Matrix3d(R.transpose() * q.topLeftCorner<3, 3>()));
    if (turn.angle() > TransformBuffer::max_turn) return false;
    Matrix step = Matrix::Identity();
    step.topLeftCorner<3, 3>() =
        R * AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
    step.topRightCorner<3, 1>() =
        (1 - share) * p.topRightCorner<3, 1>() + share * q.topRightCorner<3, 1>();
    T = step * T;
    return true;
  }

  std::map<std::size_t, std::size_t> parents_;
  std::set<std::size_t> statics_;
  std::map<std::size_t, std::map<std::int64_t, Matrix>> states_;
};

class Fuzz {
 public:
  Fuzz(std::mt19937_64& random, std::array<std::size_t, 3>& seen) : random_(random), seen_(seen) {}

  void insert_some() {
    const auto child = std::size_t(below(kFrames));
    // Mostly the tree that has a frame hang below a lower number; now and then anything.
    const std::size_t usual = child == 0 ? below(kFrames) : (child * 7) % child;
    const std::size_t parent = below(12) == 0 ? below(kFrames) : usual;
    const bool is_static = below(30) == 0 ? child % 3 != 0 : child % 3 == 0;
    const auto stamp = std::int64_t(1 + below(400));
    const Isometry3d T = random_pose();
    const TransformInsert outcome = is_static
                                        ? buffer_.insert_static(name_of(parent), name_of(child), T)
                                        : buffer_.insert(stamp, name_of(parent), name_of(child), T);
    const bool taken = oracle_.insert(stamp, parent, child, is_static, T.matrix());
    EXPECT_EQ(outcome == TransformInsert::taken, taken) << buffer_.last_refusal();
  }

  void ask() {
    const std::size_t target = below(kFrames), source = below(kFrames);
    const auto stamp = std::int64_t(below(420));
    TransformAnswer answer;
    buffer_.at(stamp, name_of(target), name_of(source), answer);
    Matrix T;
    const TransformStatus expected = oracle_.at(stamp, target, source, T);
    ASSERT_EQ(answer.status, expected) << answer.message;
    ++seen_[std::size_t(expected)];
    if (expected == TransformStatus::ok) {
      EXPECT_LT((answer.T_target_source.matrix() - T).cwiseAbs().maxCoeff(), kOracleTolerance);
    }
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }

  Isometry3d random_pose() {
    const Vector3d position = random_direction(random_);
    return at(position) * AngleAxisd(uniform(random_, -1, 1), random_direction(random_));
  }

  std::mt19937_64& random_;
  std::array<std::size_t, 3>& seen_;  // answers of each status
  // Poses at random contradict each other.
  TransformBuffer buffer_{
      {.max_gap = double(kMaxGap) * 1e-9, .history = 1.0, .compare_sources = false}};
  Oracle oracle_;
};

TEST(TransformBufferOracle, AgreesOnRandomTrees) {
  auto random = seeded_random(11);
  std::array<std::size_t, 3> seen{};
  for (int trial = 0; trial < samples(40); ++trial) {
    Fuzz fuzz(random, seen);
    for (int step = 0; step < 200; ++step) {
      fuzz.insert_some();
      fuzz.ask();
      ASSERT_FALSE(testing::Test::HasFailure()) << "trial " << trial << " step " << step;
    }
  }
  for (const std::size_t count : seen) EXPECT_GT(count, std::size_t(samples(300)));
}

}  // namespace
}  // namespace penumbra::test
