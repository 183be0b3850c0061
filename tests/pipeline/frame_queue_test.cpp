// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra::test {
namespace {

/// Joint states and images are told by the milliseconds of their stamps.
class QueueTest : public testing::Test {
 protected:
  FrameQueue& make(const FrameQueueOptions& options, FrameQueue::Check check = {}) {
    return queue_.emplace(
        robot_, history_, options,
        [this](const auto&, DropReason reason) { dropped_.push_back(reason); }, std::move(check));
  }

  void joint(std::int64_t stamp_ms) {
    const std::string names[] = {"slide"};
    const double positions[] = {double(stamp_ms) * 1e-3};
    history_.add_joints(stamp_ms * ms, names, positions);
  }

  void image(std::int64_t stamp_ms, std::int64_t now_ms) {
    queue_->push({.stamp = stamp_ms * ms}, now_ms * ms);
  }

  /// The stamp of what comes out; -1: nothing.
  std::int64_t next(std::int64_t now_ms) {
    frame_ = queue_->next(now_ms * ms);
    return frame_ ? *frame_->stamp / ms : -1;
  }

  Robot robot_ = slab_robot();
  PoseHistory history_{robot_, {.joints = {.max_gap = 0.1}}};
  std::vector<DropReason> dropped_;
  std::optional<FrameQueue> queue_;
  std::shared_ptr<Frame> frame_;
};

TEST_F(QueueTest, TwoCamerasShareAHistory) {
  make({.policy = DropPolicy::newest});
  std::vector<DropReason> dropped;
  FrameQueue other(robot_, history_, {.policy = DropPolicy::every},
                   [&](const auto&, DropReason reason) { dropped.push_back(reason); });
  joint(5000);
  image(5010, 5015);
  other.push({.stamp = 5010 * ms}, 5015 * ms);
  image(1000, 5020);  // this camera's clock jumps back
  EXPECT_FALSE(other.next(5021 * ms));
  EXPECT_EQ(dropped, std::vector{DropReason::clock_jump});
  other.push({.stamp = 1000 * ms}, 5022 * ms);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  joint(1000);
  EXPECT_TRUE(other.next(5023 * ms));
  EXPECT_EQ(next(5023), 1000);
}

TEST_F(QueueTest, AJumpKeepsFramesThatAwaitOnlyTheirCompanions) {
  bool are_there = false;
  make({.policy = DropPolicy::every, .companion_wait = 1.0}, [&](const Frame&, bool over) {
    return are_there || over ? Companions::complete : Companions::awaited;
  });
  for (const std::int64_t stamp : {5000, 5050, 5100}) {
    joint(stamp);
    image(stamp, stamp);
    EXPECT_EQ(next(stamp), -1);
  }
  image(5150, 5150);  // its joint state has not come
  EXPECT_EQ(next(5150), -1);
  EXPECT_EQ(queue_->wake_at(), 5350 * ms);
  joint(1000);  // the clock is set back
  EXPECT_EQ(next(5160), -1);
  EXPECT_EQ(dropped_, std::vector{DropReason::clock_jump});
  are_there = true;
  for (const std::int64_t stamp : {5000, 5050, 5100}) {
    ASSERT_EQ(next(5170), stamp);
    EXPECT_EQ(frame_->pose.status, FrameStatus::ok) << frame_->pose.message;
  }
}

TEST_F(QueueTest, AFrameWithoutItsCompanionsIsDroppedOrGivenInTime) {
  make({.policy = DropPolicy::newest, .companion_wait = 0.1}, [](const Frame& frame, bool over) {
    if (!over) return Companions::awaited;
    return *frame.stamp == 5000 * ms ? Companions::missing : Companions::complete;
  });
  for (const std::int64_t stamp : {5000, 5050}) {
    joint(stamp);
    image(stamp, stamp);
  }
  EXPECT_EQ(next(5050), -1);
  EXPECT_EQ(next(5100), -1);
  EXPECT_EQ(dropped_, std::vector{DropReason::no_camera_info});
  EXPECT_EQ(next(5149), -1);
  EXPECT_EQ(next(5150), 5050);
}

TEST_F(QueueTest, RefusesFaultyOptions) {
  const auto refused = [&](const FrameQueueOptions& options, std::string_view part) {
    expect_refused([&] { make(options); }, {part});
  };
  refused({.time_offset = nan}, "time_offset");
  refused({.time_offset = -2e9}, "time_offset");
  refused({.max_wait = -0.1}, "max_wait");
  refused({.companion_wait = -0.1}, "companion_wait");
  refused({.max_frames = 0}, "max_frames");
  refused({.poses = {.camera_parent = "nowhere"}}, "nowhere");
}

// The frame queue against a brute-force model, under random stamps, delays, losses, reorderings and
// jumps of the clock. Every frame must come out exactly once, and only with a pose of its stamp.

constexpr std::int64_t jump = 1000 * ms, max_gap = 25 * ms;
constexpr double slide_tolerance = 1e-9;  // metres; positions are up to 100

/// Distinct before and after a jump of the clock, so that states of both cannot be mixed unseen.
double slide_at(std::int64_t stamp, int epoch) { return 1e-9 * double(stamp) + 37.0 * epoch; }

constexpr std::size_t queue_reasons = 5;
using Dropped = std::multiset<std::pair<std::uint64_t, DropReason>>;

struct Given {
  std::uint64_t key;
  bool known;
};

/// What the queue promises, by looking at everything every time.
class Model {
 public:
  explicit Model(const FrameQueueOptions& options)
      : options_(options),
        offset_(std::llround(options.time_offset * 1e9)),
        wait_(std::llround(options.max_wait * 1e9)) {}

  Dropped dropped;

  void joint(std::int64_t stamp) {
    if (stamp <= 0) return;
    if (!states_.empty() && *states_.rbegin() - stamp > jump) forget();
    states_.insert(stamp);
  }

  void push(std::uint64_t key, std::int64_t stamp, std::int64_t now) {
    restart_waits(now);
    if (stamp <= 0) return drop(key, DropReason::no_stamp);
    if (newest_ && *newest_ - stamp > jump) forget();
    newest_ = std::max(newest_.value_or(stamp), stamp);
    const bool every = options_.policy == DropPolicy::every;
    if (every && frames_.size() == options_.max_frames) return drop(key, DropReason::overflow);
    if (!every && last_ && stamp <= *last_) return drop(key, DropReason::late);
    frames_[key] = {stamp, now, {}};
    if (frames_.size() <= options_.max_frames) return;
    const auto oldest = in_order().front();
    frames_.erase(oldest);
    drop(oldest, DropReason::overflow);
  }

  std::optional<Given> next(std::int64_t now) {
    restart_waits(now);
    auto keys = in_order();
    const bool every = options_.policy == DropPolicy::every;
    for (const std::uint64_t key : keys) {
      Waiting& frame = frames_.at(key);
      const bool full = every && key == keys.front() && frames_.size() == options_.max_frames;
      const bool over = finished || full || now - frame.arrived >= wait_;
      const bool is_known = known(frame.stamp + offset_);
      if (!frame.has_pose && (over || is_known)) frame.has_pose = is_known;
    }
    if (!every) std::reverse(keys.begin(), keys.end());
    for (const std::uint64_t key : keys) {
      const auto [stamp, arrived, has_pose] = frames_.at(key);
      if (!has_pose && every) return std::nullopt;
      if (!has_pose) continue;
      frames_.erase(key);
      if (!every) supersede(keys, key);
      last_ = std::max(last_.value_or(stamp), stamp);
      return Given{key, *has_pose};
    }
    return std::nullopt;
  }

  bool finished = false;

 private:
  struct Waiting {
    std::int64_t stamp, arrived;
    std::optional<bool> has_pose;  // once that is decided
  };

  void drop(std::uint64_t key, DropReason reason) { dropped.emplace(key, reason); }

  void forget() {
    std::erase_if(frames_, [this](const auto& of) {
      const auto& [key, frame] = of;
      if (options_.policy == DropPolicy::every && frame.has_pose) return false;
      drop(key, DropReason::clock_jump);
      return true;
    });
    states_.clear();
    newest_.reset();
    last_.reset();
  }

  void restart_waits(std::int64_t now) {
    for (auto& [key, frame] : frames_) frame.arrived = std::min(frame.arrived, now);
  }

  /// Keys rise as frames come; of `newest` by stamp, and of equal ones as they came.
  std::vector<std::uint64_t> in_order() const {
    std::vector<std::uint64_t> keys;
    for (const auto& [key, frame] : frames_) keys.push_back(key);
    if (options_.policy == DropPolicy::newest)
      std::stable_sort(keys.begin(), keys.end(),
                       [&](auto a, auto b) { return frames_.at(a).stamp < frames_.at(b).stamp; });
    return keys;
  }

  void supersede(const std::vector<std::uint64_t>& newest_first, std::uint64_t key) {
    const auto at = std::find(newest_first.begin(), newest_first.end(), key);
    for (auto before = at + 1; before != newest_first.end(); ++before) {
      frames_.erase(*before);
      drop(*before, DropReason::superseded);
    }
  }

  bool known(std::int64_t stamp) const {
    const auto after = states_.lower_bound(stamp);
    if (after == states_.end()) return false;
    if (*after == stamp) return true;
    return after != states_.begin() && *after - *std::prev(after) <= max_gap;
  }

  FrameQueueOptions options_;
  std::int64_t offset_, wait_;
  std::map<std::uint64_t, Waiting> frames_;
  std::set<std::int64_t> states_;
  std::optional<std::int64_t> newest_, last_;
};

class Fuzz {
 public:
  Fuzz(std::mt19937_64& random, const Robot& robot)
      : random_(random),
        options_(random_options()),
        history_(robot, {.joints = {.max_gap = 1e-9 * max_gap, .history = 1000.0}}),
        model_(options_),
        queue_(robot, history_, options_,
               [this](const auto& frame, DropReason reason) { drop(*frame, reason); }) {}

  void step() {
    now_ += std::int64_t(below(12)) * ms;
    if (below(400) == 0) now_ -= std::int64_t(below(500)) * ms;
    if (below(150) == 0) {
      epoch_start_ -= 1500 * ms + std::int64_t(below(3000)) * ms;
      ++epoch_;
    }
    send_joint();
    if (below(3) == 0) push();
    if (below(2) == 0) ask();
    compare();
  }

  void finish() {
    queue_.finish();
    model_.finished = true;
    while (ask()) {
    }
    compare();
    EXPECT_EQ(queue_.waiting(), 0U);
    EXPECT_EQ(seen_.size(), key_) << "every frame exactly once";
  }

  std::array<std::size_t, queue_reasons> drops{};
  std::size_t with_pose = 0, without_pose = 0;

 private:
  std::size_t below(std::size_t end) { return random_() % end; }

  FrameQueueOptions random_options() {
    return {.policy = below(2) == 0 ? DropPolicy::newest : DropPolicy::every,
            .time_offset = 1e-3 * (double(below(60)) - 30.0),
            .max_wait = 1e-3 * double(below(150)),
            .max_frames = 1 + below(8)};
  }

  /// Stamps of now, or of a while ago.
  std::int64_t stamp(std::size_t most_delay_ms) {
    return epoch_start_ + now_ - std::int64_t(below(most_delay_ms * 1000)) * 1000;
  }

  void send_joint() {
    if (below(4) == 0) return;
    const std::int64_t at = below(200) == 0 ? 0 : stamp(60);
    const std::string names[] = {"slide"};
    const double positions[] = {slide_at(at, epoch_)};
    history_.add_joints(at, names, positions);
    model_.joint(at);
  }

  void push() {
    std::int64_t at = stamp(120);
    int epoch = epoch_;
    if (below(100) == 0) at = 0;
    if (below(20) == 0) std::tie(at, epoch) = last_pushed_;
    last_pushed_ = {at, epoch};
    epochs_.push_back(epoch);
    model_.push(key_, at, now_);
    queue_.push({.index = key_++, .stamp = at}, now_);
  }

  bool ask() {
    const std::optional<Given> expected = model_.next(now_);
    const auto frame = queue_.next(now_);
    EXPECT_EQ(frame != nullptr, expected.has_value());
    if (!frame || !expected) return false;
    EXPECT_EQ(frame->index, expected->key);
    const RobotPose& pose = frame->pose;
    EXPECT_EQ(pose.status == FrameStatus::ok, expected->known) << pose.message;
    if (pose.status == FrameStatus::ok) {
      EXPECT_NEAR(pose.positions[0],
                  slide_at(queue_.pose_stamp(*frame->stamp), epochs_[*frame->index]),
                  slide_tolerance);
    }
    ++(expected->known ? with_pose : without_pose);
    EXPECT_TRUE(seen_.insert(*frame->index).second) << *frame->index << " came twice";
    return true;
  }

  void drop(const Frame& frame, DropReason reason) {
    dropped_.emplace(*frame.index, reason);
    ++drops[std::size_t(reason)];
    EXPECT_TRUE(seen_.insert(*frame.index).second) << *frame.index << " came twice";
  }

  /// Drops after a jump of the joints' clock are told with the queue's next call.
  void compare() {
    ask();
    EXPECT_EQ(dropped_, model_.dropped);
  }

  std::mt19937_64& random_;
  FrameQueueOptions options_;
  PoseHistory history_;
  Model model_;
  FrameQueue queue_;
  Dropped dropped_;
  std::set<std::uint64_t> seen_;
  std::int64_t now_ = 5'000 * ms, epoch_start_ = 500'000 * ms;
  std::pair<std::int64_t, int> last_pushed_{1, 0};  // stamp and its epoch
  std::vector<int> epochs_;                         // of each key's stamp
  int epoch_ = 0;
  std::uint64_t key_ = 0;
};

TEST(FrameQueueFuzz, DoesWhatTheModelDoesAndLosesNoFrame) {
  auto random = seeded_random(5);
  const Robot robot = slab_robot();
  std::array<std::size_t, queue_reasons> drops{};
  std::size_t with_pose = 0, without_pose = 0;
  for (int trial = 0; trial < samples(150); ++trial) {
    Fuzz fuzz(random, robot);
    for (int step = 0; step < 400; ++step) {
      fuzz.step();
      ASSERT_FALSE(testing::Test::HasFailure()) << "trial " << trial << " step " << step;
    }
    fuzz.finish();
    ASSERT_FALSE(testing::Test::HasFailure()) << "trial " << trial;
    for (std::size_t i = 0; i < drops.size(); ++i) drops[i] += fuzz.drops[i];
    with_pose += fuzz.with_pose;
    without_pose += fuzz.without_pose;
  }
  const auto many = std::size_t(samples(50));
  for (std::size_t i = 0; i < drops.size(); ++i)
    EXPECT_GT(drops[i], many) << to_string(static_cast<DropReason>(i));
  EXPECT_GT(with_pose, 20 * many);
  EXPECT_GT(without_pose, 5 * many);
}

}  // namespace
}  // namespace penumbra::test
