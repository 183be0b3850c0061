// SPDX-License-Identifier: Apache-2.0
// The transform buffer against a naive twin: every state in a map, 4x4 matrices to the root.
#include "../support/random.hpp"
#include "../support/run_length.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <penumbra/time/transform_buffer.hpp>

namespace penumbra::test {
namespace {

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
    const double share = static_cast<double>(stamp - before->first) /
                         static_cast<double>(after->first - before->first);
    const Matrix &p = before->second, &q = after->second;
    const Eigen::Matrix3d R = p.topLeftCorner<3, 3>();
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(R.transpose() * q.topLeftCorner<3, 3>()));
    if (turn.angle() > TransformBuffer::max_turn) return false;
    Matrix step = Matrix::Identity();
    step.topLeftCorner<3, 3>() =
        R * Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
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
  explicit Fuzz(std::mt19937_64& random) : random_(random) {}

  void insert_some() {
    const auto child = static_cast<std::size_t>(below(kFrames));
    // Mostly the tree that has a frame hang below a lower number; now and then anything.
    const std::size_t usual = child == 0 ? below(kFrames) : (child * 7) % child;
    const std::size_t parent = below(12) == 0 ? below(kFrames) : usual;
    const bool is_static = below(30) == 0 ? child % 3 != 0 : child % 3 == 0;
    const auto stamp = static_cast<std::int64_t>(1 + below(400));
    const Eigen::Isometry3d T = random_pose();
    const TransformInsert outcome = is_static
                                        ? buffer_.insert_static(name_of(parent), name_of(child), T)
                                        : buffer_.insert(stamp, name_of(parent), name_of(child), T);
    const bool taken = oracle_.insert(stamp, parent, child, is_static, T.matrix());
    EXPECT_EQ(outcome == TransformInsert::taken, taken) << buffer_.last_refusal();
  }

  void ask() {
    const std::size_t target = below(kFrames), source = below(kFrames);
    const auto stamp = static_cast<std::int64_t>(below(420));
    TransformAnswer answer;
    buffer_.at(stamp, name_of(target), name_of(source), answer);
    Matrix T;
    const TransformStatus expected = oracle_.at(stamp, target, source, T);
    ASSERT_EQ(answer.status, expected) << answer.message;
    ++seen[static_cast<std::size_t>(expected)];
    if (expected == TransformStatus::ok) {
      EXPECT_LT((answer.T_target_source.matrix() - T).cwiseAbs().maxCoeff(), kOracleTolerance);
    }
  }

  std::array<std::size_t, 3> seen{};  // answers of each status

 private:
  std::size_t below(std::size_t end) { return random_() % end; }

  Eigen::Isometry3d random_pose() {
    std::uniform_real_distribution<double> unit(-1, 1);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(unit(random_), unit(random_), unit(random_));
    const Eigen::Vector3d axis(unit(random_), unit(random_), unit(random_));
    T.linear() = Eigen::AngleAxisd(unit(random_), axis.normalized()).toRotationMatrix();
    return T;
  }

  std::mt19937_64& random_;
  // Poses at random contradict each other.
  TransformBuffer buffer_{
      {.max_gap = static_cast<double>(kMaxGap) * 1e-9, .history = 1.0, .compare_sources = false}};
  Oracle oracle_;
};

TEST(TransformBufferOracle, AgreesOnRandomTrees) {
  auto random = seeded_random(11);
  std::array<std::size_t, 3> seen{};
  for (int trial = 0; trial < samples(40); ++trial) {
    Fuzz fuzz(random);
    for (int step = 0; step < 200; ++step) {
      fuzz.insert_some();
      fuzz.ask();
      ASSERT_FALSE(testing::Test::HasFailure()) << "trial " << trial << " step " << step;
    }
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += fuzz.seen[i];
  }
  for (const std::size_t count : seen) EXPECT_GT(count, static_cast<std::size_t>(samples(300)));
}

}  // namespace
}  // namespace penumbra::test
