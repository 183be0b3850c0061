// SPDX-License-Identifier: Apache-2.0
// Joint states that are late, out of order or lost, and publishers that stop: each label image
// shows the true pose at its stamp, or is all unknown.
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "live_scene.hpp"

#include <functional>

#include <penumbra/mesh/primitives.hpp>

namespace penumbra::test {
namespace {

struct Event {
  std::int64_t time;  // when it arrives
  std::function<void(LiveBench&)> tell;
};

/// The messages of a camera at 30 Hz and a robot at 100 Hz in 10 s, in the order of arrival: late,
/// some lost, no joint states in the fourth second and no images in the seventh.
std::vector<Event> script(std::mt19937_64& random) {
  std::vector<Event> events;
  const auto add = [&](std::int64_t stamp, int least, int most, double lost, auto tell) {
    if (std::bernoulli_distribution(lost)(random)) return;
    const auto delay = std::uniform_int_distribution<std::int64_t>(least, most)(random);
    events.push_back(
        {stamp + delay * milliseconds, [stamp, tell](LiveBench& bench) { tell(bench, stamp); }});
  };
  for (std::int64_t t = start; t < start + 10 * seconds; t += 10 * milliseconds)
    if ((t - start) / seconds != 3)
      add(t, 0, 60, 0.2, [](LiveBench& bench, std::int64_t at) { bench.tell_joints(at); });
  for (std::int64_t t = start; t < start + 10 * seconds; t += image_period) {
    if ((t - start) / seconds == 6) continue;
    add(t, 10, 80, 0.0, [](LiveBench& bench, std::int64_t at) { bench.tell_depth(at); });
    add(t, 10, 80, 0.1, [](LiveBench& bench, std::int64_t at) { bench.tell_info(at); });
  }
  std::ranges::stable_sort(events, {}, &Event::time);
  return events;
}

void play(const std::vector<Event>& events, LiveBench& bench) {
  for (const Event& event : events) {
    for (auto wake = bench.inbox.wake_at(0); wake && *wake < event.time;
         wake = bench.inbox.wake_at(0)) {
      bench.now = std::max(bench.now, *wake);
      if (bench.work() == 0) break;
    }
    bench.now = event.time;
    event.tell(bench);
    bench.work();
  }
  bench.now += seconds;
  bench.work();
}

TEST(LiveChaos, NoLabelImageIsOfAWrongPose) {
  for (int round = 0; round < 3; ++round) {
    auto random = seeded_random(static_cast<std::uint64_t>(round));
    LiveBench bench;
    bench.results.wanted = {{io::Result::overlay, false}, {io::Result::points, false}};
    bench.tell_all();
    play(script(random), bench);
    LiveTruth truth;
    EXPECT_GT(expect_true_labels(bench.results.published, truth), 100U);
    const io::ImageCounts counts = bench.counts();
    std::size_t all = counts.judged + counts.failed + counts.waiting;
    for (const std::size_t dropped : counts.dropped) all += dropped;
    EXPECT_EQ(all, counts.received);
    EXPECT_EQ(counts.failed, 0U);
    // Results resume within a second after the joint states do.
    EXPECT_TRUE(std::ranges::any_of(bench.results.published, [](const auto& one) {
      return one.result == io::Result::virtual_depth && one.stamp > start + 4 * seconds &&
             one.stamp < start + 5 * seconds;
    }));
  }
}

// Two robots whose joint states stop, whose bases are published anew, and which pick and place:
// no label and no verdict is wrong; what is not known is unknown.

constexpr std::int64_t step = 10 * milliseconds, slow_period = 50 * milliseconds;
constexpr double part_size = 0.15, part_place = 0.3;  // metres; on a's board

Eigen::Isometry3d at_x(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); }

/// What is true: where the bases are, and whether a carries the part.
class World {
 public:
  std::array<double, 2> bases{-0.3, 0.3};
  bool is_carried = false;

  const FrameReport& judge(std::int64_t stamp, const std::vector<Target>& targets) {
    if (drawn_ != bases) {
      drawn_ = bases;
      const Robot board = Robot::parse(live_urdf, "/");
      const std::array robots{PlacedRobot{"a", board, at_x(bases[0])},
                              PlacedRobot{"b", board, at_x(bases[1])}};
      pipeline_ = std::make_unique<Pipeline>(Robot::join(robots), LiveLens().camera());
    }
    Frame frame{.stamp = stamp, .depth = wall_.view(), .targets = targets};
    frame.pose.positions = {spin_at(stamp), spin_at(stamp)};
    if (is_carried) frame.pose.attached = {{"a/part", "a/board", part_, at_x(part_place)}};
    return pipeline_->process(frame);
  }

 private:
  const Image<std::uint16_t> wall_{LiveLens().width, LiveLens().height, 3000};
  const std::shared_ptr<const PreparedMesh> part_ =
      std::make_shared<PreparedMesh>(make_box({part_size, part_size, part_size}));
  std::array<double, 2> drawn_{};
  std::unique_ptr<Pipeline> pipeline_;
};

class LiveRobotsChaos : public testing::Test {
 protected:
  LiveRobotsChaos() {
    bench_.results.wanted = {{io::Result::overlay, false}, {io::Result::points, false}};
    bench_.tell_transform("world", "optical");
    for (const std::size_t robot : {0U, 1U}) tell_base(robot);
    bench_.tell_robots({"a", "b"});
    bench_.tell_info(0);
    bench_.tell_depth(start - seconds);  // targets know the camera's frame
  }

  void tell_base(std::size_t robot) {
    bench_.tell_transform("world", names[robot] + "/base", world_.bases[robot]);
  }

  /// MoveIt's message with the stamp at which the part was made, whenever that was.
  void tell_part(bool is_attached) {
    using Object = io::CollisionObjectMessage;
    const auto operation = is_attached ? Object::add : Object::remove;
    bench_.publish("/a/attached_collision_object",
                   encoded(live_part(start - seconds, operation, "part", part_size, part_place)));
    world_.is_carried = is_attached;
  }

  /// Something happens, after a while again.
  void change(std::int64_t now) {
    if (now < next_change_) return;
    next_change_ =
        now + std::uniform_int_distribution<std::int64_t>(200, 1500)(random_) * milliseconds;
    last_change_ = now;
    const std::size_t robot = random_() % 2;
    switch (random_() % 3) {
      case 0:
        silent_until_[robot] = next_change_;
        break;
      case 1:
        world_.bases[robot] =
            std::uniform_real_distribution<double>(0.1, 0.5)(random_) * (robot == 0 ? -1.0 : 1.0);
        tell_base(robot);
        ++moved_;
        break;
      default:
        tell_part(!world_.is_carried);
    }
  }

  void tell_image(std::int64_t stamp) {
    const double x = std::uniform_real_distribution<double>(-1.2, 1.2)(random_);
    const double y = std::uniform_real_distribution<double>(-0.6, 0.6)(random_);
    balls_[stamp] = {x, y, 3.0};
    bench_.publish("/ball", live_target(stamp, balls_[stamp]));
    bench_.tell_depth(stamp);
  }

  void check() {
    const auto found = bench_.results.last<io::TargetsMessage>(io::Result::targets);
    const auto labels = bench_.pixels(io::Result::labels), mask = bench_.pixels(io::Result::mask);
    bench_.results.published.clear();
    const std::int64_t stamp = found.header.stamp;
    // Neither tf_static nor the part's messages say since when: not for images on their way.
    if (stamp <= last_change_) return;
    const std::vector<Target> targets{
        {.name = "ball", .shape = PointTarget{.position = balls_.at(stamp)}}};
    const FrameReport& truth = world_.judge(stamp, targets);
    ++images_;
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto label = static_cast<std::uint8_t>(labels[i]);
      const bool is_unknown = label == static_cast<std::uint8_t>(Label::unknown);
      unknown += is_unknown ? 1 : 0;
      if (!is_unknown && label != truth.labels.data[i]) ++wrong_labels_;
      const bool is_trusted_here = is_trusted(static_cast<Label>(truth.labels.data[i]));
      if (mask[i] == std::byte{0} && !is_trusted_here) ++wrong_masks_;
    }
    whole_ += unknown == 0 ? 1 : 0;
    if (found.targets.empty() || !truth.targets[0].judgement) return;
    using M = io::TargetMessage;
    const auto verdict = found.targets[0].verdict;
    const double hidden = truth.targets[0].judgement->occluded;
    const bool is_wrong = (verdict == M::hidden && hidden < 0.1) ||
                          ((verdict == M::visible || verdict == M::partial) && hidden > 0.9);
    wrong_verdicts_ += is_wrong ? 1 : 0;
    verdicts_ += verdict == M::unknown ? 0 : 1;
  }

  const std::array<std::string, 2> names{"a", "b"};
  std::mt19937_64 random_ = seeded_random(17);
  LiveBench bench_{LiveBench::of_robots({"a", "b"}, {"/ball"})};
  World world_;
  std::map<std::int64_t, Eigen::Vector3d> balls_;  // by stamp
  std::array<std::int64_t, 2> silent_until_{};
  std::int64_t next_change_ = start + seconds, last_change_ = 0;
  std::size_t images_ = 0, whole_ = 0, verdicts_ = 0, moved_ = 0;
  std::size_t wrong_labels_ = 0, wrong_masks_ = 0, wrong_verdicts_ = 0;
};

TEST_F(LiveRobotsChaos, NothingWrongIsSaid) {
  const std::int64_t length = (measures_in_full() ? 600 : 60) * seconds;
  for (std::int64_t now = start; now < start + length; now += step) {
    bench_.now = now;
    for (const std::size_t robot : {0U, 1U})
      if (now >= silent_until_[robot])
        bench_.publish("/" + names[robot] + "/joint_states", live_joints(now));
    change(now);
    if (now % slow_period == 0) tell_image(now);
    if (bench_.work() > 0) check();
  }
  std::cout << images_ << " images, " << whole_ << " without an unknown pixel, " << verdicts_
            << " verdicts, " << moved_ << " bases moved\n";
  EXPECT_EQ(wrong_labels_, 0U);
  EXPECT_EQ(wrong_masks_, 0U);
  EXPECT_EQ(wrong_verdicts_, 0U);
  EXPECT_GT(3 * whole_, images_);
  EXPECT_GT(4 * verdicts_, images_);
}

}  // namespace
}  // namespace penumbra::test
