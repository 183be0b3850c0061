// SPDX-License-Identifier: Apache-2.0
// penumbra live for a while among publishers and subscribers of another vendor, with images of a
// real camera's size and nothing else on the machine: what comes of each sample, when labels are
// there, what it takes.
//   PENUMBRA_FULL=1 test_dds_live --gtest_filter='LiveSoakFull.*'
// is 10 minutes without overlays, 10 with them and 5 of chaos; PENUMBRA_SOAK_SECONDS=N makes N s of
// each.
#include "../support/process_memory.hpp"
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "../support/running_program.hpp"
#include "../support/temporary_folder.hpp"
#include "label_watch.hpp"
#include "lone_domain.hpp"
#include "soak_publishers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr auto patience = 120s;
/// What live may take more at the end than after its warm-up, MiB: all the images that may wait,
/// eight of depth (1.8 MiB) and of color (2.6 MiB) in DDS and as many in live.
constexpr double memory_slack = 72.0;

std::chrono::seconds length_or(int seconds) {
  const char* const given = std::getenv("PENUMBRA_SOAK_SECONDS");
  return std::chrono::seconds(given == nullptr ? seconds : std::atoi(given));
}

/// What the kernel says of a process.
struct ProcessUsage {
  explicit ProcessUsage(const RunningProgram& program)
      : memory(memory_of(std::to_string(program.pid()))) {
    std::ifstream stat("/proc/" + std::to_string(program.pid()) + "/stat");
    std::string word;
    while (stat >> word && !word.ends_with(')')) continue;
    for (int field = 3; field < 14; ++field) stat >> word;  // proc(5)
    double user = 0, system = 0;
    stat >> user >> system;
    cpu_seconds = (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

  std::chrono::steady_clock::time_point when = std::chrono::steady_clock::now();
  ProcessMemory memory;
  double cpu_seconds = 0.0;  // of all threads
};

class LiveSoakFull : public testing::Test {
 protected:
  /// Skips the test unless PENUMBRA_FULL is set.
  void SetUp() override {
    if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  }

  void soak_steadily(bool with_overlay);
  /// Begins all, and waits for the first labels that say something.
  void begin(const JointFaults& faults, bool with_overlay);
  /// Kills some publishers, begins them again after a while, and waits until all is well.
  void break_and_mend(std::mt19937_64& random);
  /// Ends all, publishers first, and expects that all labels were heard and true.
  void finish();

  [[nodiscard]] const json& topic(Part part) const;
  [[nodiscard]] const json& camera() const { return summary_["cameras"][0]; }

  void print(const std::string& title) const;

  LoneDomain domain_;
  TemporaryFolder folder_;
  std::unique_ptr<SoakPublishers> publishers_;
  std::unique_ptr<LabelWatch> labels_;
  std::unique_ptr<PeerProcess> overlay_;
  std::unique_ptr<RunningProgram> live_;
  std::optional<ProcessUsage> before_, after_;
  std::size_t written_ = 0;
  json summary_;
  LabelVerdict verdict_;
  std::vector<double> recoveries_;  // s
};

void LiveSoakFull::begin(const JointFaults& faults, bool with_overlay) {
  publishers_ = std::make_unique<SoakPublishers>(domain_.id(), faults);
  labels_ = std::make_unique<LabelWatch>(domain_.id(), large_lens);
  live_ = std::make_unique<RunningProgram>(
      std::vector<std::string>{"live", "--domain", std::to_string(domain_.id()), "--reliable",
                               "--depth-topic", topic_of(Part::depth), "--color-topic",
                               topic_of(Part::color), "--summary", folder_.path() / "live.json"},
      folder_.path() / "live.log");
  if (with_overlay)
    overlay_ =
        make_peer(domain_.id(), {"count", "rt/penumbra/overlay/compressed",
                                 "sensor_msgs::msg::dds_::CompressedImage_", "reliable,depth=5"});
  for (const Part part : all_parts) publishers_->start(part);
  ASSERT_TRUE(labels_->known_after(0, 0, patience)) << read_bytes(folder_.path() / "live.log");
  std::this_thread::sleep_for(2s);
  before_.emplace(*live_);
}

void LiveSoakFull::finish() {
  after_.emplace(*live_);
  written_ = publishers_->end(Part::depth);
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(live_->end(), 0) << read_bytes(folder_.path() / "live.log");
  summary_ = json::parse(read_bytes(folder_.path() / "live.json"));
  const auto published = camera()["results_written"]["labels"].get<std::uint64_t>();
  const auto end = std::chrono::steady_clock::now() + patience;
  while (labels_->newest_number() < published && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(10ms);
  labels_->end();
  verdict_ = labels_->judge();
  EXPECT_TRUE(verdict_.in_order);
  EXPECT_EQ(verdict_.newest_number, published);
  EXPECT_EQ(verdict_.known + verdict_.unknown, published);
  EXPECT_EQ(camera()["judged"], published) << "the subscriber is there before the robot is known";
  EXPECT_EQ(summary_["results_not_written"], 0);
  EXPECT_EQ(verdict_.wrong, 0U) << "the first at " << verdict_.first_wrong;
  EXPECT_GT(verdict_.known, 0U);
  EXPECT_LT(after_->memory.resident - before_->memory.resident, memory_slack);
  // What DDS delivered is what became of the images.
  std::size_t all = 0;
  for (const char* fate : {"judged", "failed", "waiting", "in_work"})
    all += camera()[fate].get<std::size_t>();
  for (const auto& [reason, images] : camera()["dropped"].items()) all += images.get<std::size_t>();
  EXPECT_EQ(all, camera()["received"]);
  EXPECT_EQ(topic(Part::depth)["received"], camera()["received"]);
  EXPECT_EQ(camera()["failed"], 0);
  for (const Part part : all_parts) EXPECT_EQ(topic(part)["unreadable"], 0) << topic_of(part);
}

const json& LiveSoakFull::topic(Part part) const {
  for (const json& one : summary_["topics"])
    if (one["name"] == topic_of(part)) return one;
  static const json none = {{"received", 0}, {"lost", 0}, {"overwritten", 0}, {"unreadable", 0}};
  return none;
}

void LiveSoakFull::print(const std::string& title) const {
  const double length = std::chrono::duration<double>(after_->when - before_->when).count();
  const io::LatencyHistogram heard = labels_->latency();
  std::cout << title << ", " << length << " s: " << written_ << " depth images written, "
            << verdict_.known << " label images true, " << verdict_.unknown << " unknown, "
            << verdict_.wrong << " wrong; dropped " << camera()["dropped"] << "; published "
            << camera()["results_written"] << "; stamp to labels at the subscriber: median "
            << heard.quantile(0.5).value_or(NAN) << " ms, 99 % "
            << heard.quantile(0.99).value_or(NAN) << " ms; CPU of one core "
            << 100 * (after_->cpu_seconds - before_->cpu_seconds) / length << " %; resident MiB "
            << before_->memory.resident << " to " << after_->memory.resident << "; open files "
            << before_->memory.open_files << " to " << after_->memory.open_files << '\n';
  for (const Part part : all_parts) std::cout << topic(part) << '\n';
}

void LiveSoakFull::soak_steadily(bool with_overlay) {
  ASSERT_NO_FATAL_FAILURE(begin({}, with_overlay));
  std::this_thread::sleep_for(length_or(600));
  finish();
  // Nothing was missing once all publishers were found.
  EXPECT_EQ(verdict_.lost_again, 0U);
  // What was written arrived, or is counted: newer ones replaced it before it was read.
  for (const Part part : all_parts) EXPECT_EQ(topic(part)["lost"], 0) << topic_of(part);
  const json& depth = topic(Part::depth);
  // What was first acknowledged may be the publisher's word that it is there; what it replaced
  // before its first image arrived DDS does not tell.
  EXPECT_GE(depth["received"].get<std::size_t>() + depth["overwritten"].get<std::size_t>() + 1,
            written_);
  EXPECT_EQ(topic(Part::color)["received"] > 0, with_overlay);
  print(with_overlay ? "steady, overlays subscribed to" : "steady");
}

void LiveSoakFull::break_and_mend(std::mt19937_64& random) {
  const auto some_ms = [&](int least, int most) {
    return std::chrono::milliseconds(std::uniform_int_distribution(least, most)(random));
  };
  std::vector<Part> victims;
  while (victims.empty())
    for (const Part part : all_parts)
      if (std::bernoulli_distribution(0.35)(random)) victims.push_back(part);
  std::shuffle(victims.begin(), victims.end(), random);
  for (const Part part : victims) {
    std::this_thread::sleep_for(some_ms(0, 300));
    publishers_->kill(part);
  }
  const std::int64_t killed = system_now();
  std::this_thread::sleep_for(some_ms(50, 1500));
  for (const Part part : victims) publishers_->start(part);
  const std::int64_t started = system_now();
  std::int64_t heard = 0;
  for (const Part part : victims) {
    if (part == Part::color || part == Part::color_info) continue;  // labels need none
    const auto first = publishers_->heard(part);
    ASSERT_TRUE(first) << topic_of(part);
    heard = std::max(heard, *first);
  }
  const auto known = labels_->known_after(std::max(heard, started), killed, patience);
  ASSERT_TRUE(known) << "no labels after a restart";
  if (heard > 0) recoveries_.push_back(1e-9 * static_cast<double>(*known - heard));
  std::this_thread::sleep_for(some_ms(200, 1000));
}

TEST_F(LiveSoakFull, Steady) { soak_steadily(false); }

TEST_F(LiveSoakFull, SteadyWithOverlays) { soak_steadily(true); }

TEST_F(LiveSoakFull, NoLabelsAreOfAWrongPoseAmongKilledPublishers) {
  auto random = seeded_random(static_cast<std::uint64_t>(system_now()));
  ASSERT_NO_FATAL_FAILURE(begin({.lost = 0.2, .longest_delay = 60, .seed = random()}, true));
  const auto end = before_->when + length_or(300);
  while (std::chrono::steady_clock::now() < end || recoveries_.empty())
    ASSERT_NO_FATAL_FAILURE(break_and_mend(random));
  finish();
  print("chaos");
  std::sort(recoveries_.begin(), recoveries_.end());
  std::cout << recoveries_.size() << " times labels ended and came back: from the first sample to "
            << "labels " << recoveries_[recoveries_.size() / 2] << " s in the median, "
            << recoveries_.back() << " s at most\n";
}

}  // namespace
}  // namespace penumbra::test
