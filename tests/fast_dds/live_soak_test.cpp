// SPDX-License-Identifier: Apache-2.0
// penumbra live for a long time among publishers and subscribers of another vendor, with images of
// a real camera's size: what comes of each sample, when labels are there, what it takes.
//   PENUMBRA_FULL=1 test_dds_soak --gtest_filter='LiveSoakFull.*'
// is 10 minutes without overlays, 10 with them and 5 of chaos; PENUMBRA_SOAK_SECONDS=N makes N s of
// each. LiveManyImagesFull is 100,000 small images.
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "../support/temporary_folder.hpp"
#include "label_watch.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"
#include "soak_publishers.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

constexpr auto patience = 20s;
constexpr double most_recovery = 1.0;  // s, where nothing else runs
/// What live may take more at the end than after its warm-up, MiB: all the images that may wait on
/// a busy machine, eight of depth (1.8 MiB) and of color (2.6 MiB) in DDS and as many in live.
constexpr double memory_slack = 72.0;

std::string fixed(double value, int digits = 1) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// Rows of a table for docs/ros2.md.
class Table {
 public:
  explicit Table(const std::string& title) { text_ << "| " << title << " | |\n|---|---:|\n"; }
  template <typename T>
  void add(const std::string& what, const T& value) {
    text_ << "| " << what << " | " << value << " |\n";
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

std::chrono::seconds length_or(int seconds) {
  const char* const given = std::getenv("PENUMBRA_SOAK_SECONDS");
  return std::chrono::seconds(given == nullptr ? seconds : std::atoi(given));
}

class LiveSoak : public testing::Test {
 protected:
  void SetUp() override {
    if (sanitized) GTEST_SKIP() << "the program is slow under sanitizers";
  }

  /// Begins all, and waits for the first labels that say something.
  void begin(const SoakScene& scene, bool with_overlay) {
    publishers_ = std::make_unique<SoakPublishers>(domain_.id(), scene);
    labels_ = std::make_unique<LabelWatch>(domain_.id(), scene.lens);
    std::vector<std::string> options = {"--domain",
                                        std::to_string(domain_.id()),
                                        "--reliable",
                                        "--depth-topic",
                                        topic_of(Part::depth),
                                        "--summary",
                                        folder_.path() / "live.json"};
    if (scene.with_color) options.insert(options.end(), {"--color-topic", topic_of(Part::color)});
    live_ = std::make_unique<LiveProgram>(options, folder_.path() / "live.log");
    if (with_overlay)
      overlay_ =
          make_peer(domain_.id(), {"count", "rt/penumbra/overlay/compressed",
                                   "sensor_msgs::msg::dds_::CompressedImage_", "reliable,depth=5"});
    publishers_->start_all();
    ASSERT_TRUE(labels_->known_after(0, 0, patience)) << read_bytes(folder_.path() / "live.log");
  }

  void run_steadily(std::chrono::seconds length) {
    std::this_thread::sleep_for(2s);
    before_ = live_->usage();
    const auto end = before_.when + length;
    while (std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_until(std::min(end, std::chrono::steady_clock::now() + 1s));
      note_memory();
    }
    after_ = live_->usage();
  }

  /// Once a minute.
  void note_memory() {
    if (std::chrono::steady_clock::now() - before_.when < 1min * (minutes_.size() + 1)) return;
    minutes_.push_back(live_->usage().memory.resident);
  }

  /// Ends all, publishers first; of what was written the count is kept.
  void finish() {
    written_ = publishers_->end(Part::depth);
    std::this_thread::sleep_for(500ms);
    EXPECT_EQ(live_->end(), 0) << read_bytes(folder_.path() / "live.log");
    summary_ = Json::parse(read_bytes(folder_.path() / "live.json"));
    const auto judged = camera()["judged"].get<std::uint64_t>();
    const auto end = std::chrono::steady_clock::now() + patience;
    while (labels_->newest_number() < judged && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(10ms);
    EXPECT_EQ(labels_->newest_number(), judged) << "published, the last of them heard";
    labels_->end();
    verdict_ = labels_->judge();
    EXPECT_TRUE(verdict_.in_order);
    // A writer keeps a few labels for a subscriber that has not acknowledged them.
    if (measures_in_full()) {
      EXPECT_EQ(verdict_.skipped, 0U);
    }
    EXPECT_EQ(verdict_.wrong, 0U) << "the first at " << verdict_.first_wrong;
    EXPECT_GT(verdict_.known, 0U);
    EXPECT_LT(after_.memory.resident - before_.memory.resident, memory_slack);
    expect_all_accounted();
  }

  [[nodiscard]] const Json& topic(Part part) const {
    for (const Json& one : summary_["topics"])
      if (one["name"] == topic_of(part)) return one;
    static const Json none = {{"received", 0}, {"lost", 0}, {"overwritten", 0}, {"unreadable", 0}};
    return none;
  }
  [[nodiscard]] const Json& camera() const { return summary_["cameras"][0]; }

  /// What DDS delivered is what became of the images.
  void expect_all_accounted() const {
    std::size_t all =
        camera()["judged"].get<std::size_t>() + camera()["failed"].get<std::size_t>() +
        camera()["waiting"].get<std::size_t>() + camera()["in_work"].get<std::size_t>();
    for (const auto& [reason, images] : camera()["dropped"].items())
      all += images.get<std::size_t>();
    EXPECT_EQ(all, camera()["received"]);
    EXPECT_EQ(topic(Part::depth)["received"], camera()["received"]);
    EXPECT_EQ(camera()["failed"], 0);
    for (const Part part : all_parts) EXPECT_EQ(topic(part)["unreadable"], 0) << topic_of(part);
  }
  /// What was written arrived, or is counted: newer ones replaced it before it was read or, where
  /// other work keeps the machine busy, before the publisher could send it.
  void expect_all_arrived() const {
    if (measures_in_full())
      for (const Part part : all_parts) EXPECT_EQ(topic(part)["lost"], 0) << topic_of(part);
    const Json& depth = topic(Part::depth);
    // What was first acknowledged may be the publisher's word that it is there.
    EXPECT_GE(depth["received"].get<std::size_t>() + depth["overwritten"].get<std::size_t>() +
                  depth["lost"].get<std::size_t>() + 1,
              written_);
  }

  [[nodiscard]] Table table(const std::string& title) const {
    Table table(title);
    const double length = std::chrono::duration<double>(after_.when - before_.when).count();
    table.add("measured for, s", fixed(length, 0));
    if (written_ > 0) table.add("depth images written since live acknowledged one", written_);
    for (const Part part : all_parts) {
      const Json& one = topic(part);
      table.add(
          topic_of(part) + ": delivered, lost, overwritten",
          one["received"].dump() + ", " + one["lost"].dump() + ", " + one["overwritten"].dump());
    }
    table.add("judged", camera()["judged"]);
    for (const auto& [reason, images] : camera()["dropped"].items())
      if (images > 0) table.add("dropped: " + reason, images);
    table.add("failed, still waiting",
              camera()["failed"].dump() + ", " + camera()["waiting"].dump());
    if (verdict_.known > 0)
      table.add("labels at the subscriber: true, unknown, of these after the first true, wrong",
                std::to_string(verdict_.known) + ", " + std::to_string(verdict_.unknown) + ", " +
                    std::to_string(verdict_.lost_again) + ", " + std::to_string(verdict_.wrong));
    table.add("published before the subscriber was found, skipped",
              std::to_string(verdict_.too_early) + ", " + std::to_string(verdict_.skipped));
    add_latencies(table);
    table.add("CPU of live, of one core",
              fixed(100 * (after_.cpu_seconds - before_.cpu_seconds) / length) + " %");
    std::string minutes;
    for (const double minute : minutes_) minutes += fixed(minute) + ", ";
    table.add("resident memory at start, after each minute, and at end, MiB",
              fixed(before_.memory.resident) + ", " + minutes + fixed(after_.memory.resident));
    table.add("open files at start and end", std::to_string(before_.memory.open_files) + ", " +
                                                 std::to_string(after_.memory.open_files));
    return table;
  }
  void add_latencies(Table& table) const {
    const io::LatencyHistogram heard = labels_->latency();
    table.add("stamp to labels at the subscriber: median, 99 %, ms",
              fixed(heard.quantile(0.5).value_or(NAN)) + ", " +
                  fixed(heard.quantile(0.99).value_or(NAN)));
    const Json& own = camera()["stamp_to_published_ms"];
    table.add("stamp to published, by live itself: median, 99 %, ms",
              fixed(own["median"]) + ", " + fixed(own["p99"]));
  }

  void soak_steadily(std::chrono::seconds length, bool with_overlay) {
    SoakScene scene;
    ASSERT_NO_FATAL_FAILURE(begin(scene, with_overlay));
    run_steadily(length);
    finish();
    // Nothing was missing once all publishers were found. Where other work keeps the machine busy,
    // joint states may come too late.
    if (measures_in_full())
      EXPECT_EQ(verdict_.lost_again, 0U);
    else
      EXPECT_LT(verdict_.lost_again, verdict_.known);
    expect_all_arrived();
    EXPECT_EQ(topic(Part::color)["received"] > 0, with_overlay);
    std::cout << table(with_overlay ? "steady, overlays subscribed to" : "steady").text();
  }

  void soak_in_chaos(std::chrono::seconds length);
  void break_and_mend(std::mt19937_64& random);

  LoneDomain domain_;
  TemporaryFolder folder_;
  std::unique_ptr<SoakPublishers> publishers_;
  std::unique_ptr<LabelWatch> labels_;
  std::unique_ptr<PeerProcess> overlay_;
  std::unique_ptr<LiveProgram> live_;
  ProcessUsage before_, after_;
  std::vector<double> minutes_;  // MiB after each
  std::size_t written_ = 0;
  Json summary_;
  LabelVerdict verdict_;
  std::vector<double> recoveries_, discoveries_;  // s
};

class LiveSoakFull : public LiveSoak {};

/// Kills some publishers, begins them again after a while, and takes the time until all is well.
void LiveSoak::break_and_mend(std::mt19937_64& random) {
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
  bool was_needed = false;
  for (const Part part : victims) {
    if (part == Part::color || part == Part::color_info) continue;  // labels need none
    const auto first = publishers_->heard(part);
    ASSERT_TRUE(first) << topic_of(part);
    heard = std::max(heard, *first);
    was_needed = true;
  }
  const auto known = labels_->known_after(std::max(heard, started), killed, patience);
  ASSERT_TRUE(known) << "no labels after a restart";
  if (was_needed) {
    recoveries_.push_back(1e-9 * static_cast<double>(*known - heard));
    discoveries_.push_back(1e-9 * static_cast<double>(heard - started));
  }
  std::this_thread::sleep_for(some_ms(200, 1000));
}

std::string quantiles(std::vector<double> all) {
  if (all.empty()) return "none";
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return fixed(all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))], 2);
  };
  return at(0) + ", " + at(0.5) + ", " + at(0.9) + ", " + at(1);
}

void LiveSoak::soak_in_chaos(std::chrono::seconds length) {
  auto random = seeded_random(static_cast<std::uint64_t>(system_now()));
  SoakScene scene;
  scene.troubles = {.lost = 0.2, .longest_delay = 60};
  scene.seed = random();
  ASSERT_NO_FATAL_FAILURE(begin(scene, true));
  std::this_thread::sleep_for(1s);
  before_ = live_->usage();
  while (std::chrono::steady_clock::now() - before_.when < length || recoveries_.empty()) {
    ASSERT_NO_FATAL_FAILURE(break_and_mend(random));
    note_memory();
  }
  after_ = live_->usage();
  finish();
  written_ = 0;  // of the last of several processes
  Table rows = table("chaos");
  rows.add("publishers killed so that labels ended, and restarted", recoveries_.size());
  rows.add("first sample to labels: least, median, 90 %, most, s", quantiles(recoveries_));
  rows.add("start of the process to its first sample, likewise", quantiles(discoveries_));
  std::cout << rows.text();
  EXPECT_FALSE(recoveries_.empty());
  if (!measures_in_full()) return;
  for (const double recovery : recoveries_) EXPECT_LT(recovery, most_recovery);
}

TEST_F(LiveSoak, EverySampleIsAccountedFor) { soak_steadily(3s, true); }

TEST_F(LiveSoak, NoLabelsAreOfAWrongPoseAmongKilledPublishers) { soak_in_chaos(5s); }

/// Small images as fast as they go, among robots, cameras and targets that change.
class LiveManyImagesFull : public LiveSoak {
 protected:
  void tell_changes(int round) {
    const bool other = round / 100 % 2 == 1;
    // Of no image's stamp: else all would wait for their own.
    info_->give(encoded(live_info(1, {.focal = other ? 61.0 : 60.0})));
    io::PoseStampedMessage target{.header = {system_now(), "optical"}};
    target.pose.translation() = Eigen::Vector3d(1.2, 0.0, 3.0);
    target_->give(encoded(target));
    if (round % 50 != 0) return;
    std::string urdf = live_urdf;
    urdf.insert(urdf.find("</robot>"), "<!-- " + std::to_string(round / 100) + " -->");
    publishers_->tell_robot(urdf);
  }
  /// Until so many labels were heard.
  void tell_until(std::size_t labels, int& round) {
    const auto end = std::chrono::steady_clock::now() + longest_;
    for (; labels_->count() < labels; ++round) {
      ASSERT_LT(std::chrono::steady_clock::now(), end) << labels_->count() << " labels";
      tell_changes(round);
      std::this_thread::sleep_for(100ms);
    }
  }

  static constexpr auto longest_ = 600s;
  std::unique_ptr<PeerProcess> info_, target_;
};

TEST_F(LiveManyImagesFull, TakeNoMemory) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  constexpr std::size_t warm_up = 50'000, images = 100'000;
  constexpr double slack = 4.0;  // MiB: of the allocator's caches; 100 bytes an image would be 9
  constexpr double most = 64.0;  // MiB: 45 are usual
  SoakScene scene{.lens = {}, .hertz = 1000, .joint_hertz = 1000};
  publishers_ = std::make_unique<SoakPublishers>(domain_.id(), scene);
  labels_ = std::make_unique<LabelWatch>(domain_.id(), scene.lens);
  info_ = make_peer(domain_.id(), {"publish", "rt" + topic_of(Part::depth_info),
                                   "sensor_msgs::msg::dds_::CameraInfo_", "reliable,depth=5"});
  target_ = make_peer(domain_.id(), {"publish", "rt/wrist",
                                     "geometry_msgs::msg::dds_::PoseStamped_", "reliable,depth=5"});
  live_ = std::make_unique<LiveProgram>(
      std::vector<std::string>{"--domain", std::to_string(domain_.id()), "--depth-topic",
                               topic_of(Part::depth), "--target-topic", "/wrist", "--summary",
                               folder_.path() / "live.json"},
      folder_.path() / "live.log");
  publishers_->start(Part::depth);
  publishers_->start(Part::joints);
  int round = 0;
  // Histories of 10 s fill first, and keep up to twice as much until they are pruned.
  ASSERT_NO_FATAL_FAILURE(tell_until(warm_up, round));
  before_ = live_->usage();
  ASSERT_NO_FATAL_FAILURE(tell_until(warm_up + images, round));
  after_ = live_->usage();
  EXPECT_EQ(live_->end(), 0) << read_bytes(folder_.path() / "live.log");
  labels_->end();
  summary_ = Json::parse(read_bytes(folder_.path() / "live.json"));
  expect_all_accounted();
  std::cout << table("100000 small images, behind 50000 others").text() << "| robots | "
            << summary_["robots"] << " |\n| changes of camera_info | "
            << camera()["camera_info_changes"] << " |\n";
  EXPECT_LT(after_.memory.resident - before_.memory.resident, slack);
  EXPECT_LT(after_.memory.resident, most);
  EXPECT_EQ(after_.memory.open_files, before_.memory.open_files);
}

TEST_F(LiveSoakFull, Steady) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  soak_steadily(length_or(600), false);
}

TEST_F(LiveSoakFull, SteadyWithOverlays) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  soak_steadily(length_or(600), true);
}

TEST_F(LiveSoakFull, Chaos) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  soak_in_chaos(length_or(300));
}

}  // namespace
}  // namespace penumbra::test
