// SPDX-License-Identifier: Apache-2.0
#include "live_soak.hpp"

#include "../support/random.hpp"
#include "../support/run_length.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <thread>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

constexpr auto patience = 20s;
constexpr double most_recovery = 1.0;  // s
/// Messages that a publisher keeps for who has not acknowledged them: of labels live's, of images
/// the peer's.
constexpr std::size_t kept_labels = 2, kept_images = 5;
/// What live may take more at the end than after its warm-up, MiB: all the images that may wait on
/// a busy machine, eight of depth (1.8 MiB) and of color (2.6 MiB) in DDS and as many in live.
constexpr double memory_slack = 72.0;

std::string quantiles(std::vector<double> all) {
  if (all.empty()) return "none";
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return fixed(all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))], 2);
  };
  return at(0) + ", " + at(0.5) + ", " + at(0.9) + ", " + at(1);
}

}  // namespace

void LiveSoak::SetUp() {
  if (sanitized) GTEST_SKIP() << "the program is slow under sanitizers";
}

void LiveSoak::begin(const SoakScene& scene, bool with_overlay) {
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

void LiveSoak::run_steadily(std::chrono::seconds length) {
  std::this_thread::sleep_for(2s);
  before_ = live_->usage();
  const auto end = before_.when + length;
  while (std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_until(std::min(end, std::chrono::steady_clock::now() + 1s));
    note_memory();
  }
  after_ = live_->usage();
}

void LiveSoak::note_memory() {
  if (std::chrono::steady_clock::now() - before_.when < 1min * (minutes_.size() + 1)) return;
  minutes_.push_back(live_->usage().memory.resident);
}

void LiveSoak::finish() {
  written_ = publishers_->end(Part::depth);
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(live_->end(), 0) << read_bytes(folder_.path() / "live.log");
  summary_ = Json::parse(read_bytes(folder_.path() / "live.json"));
  const auto published = camera()["results_written"]["labels"].get<std::uint64_t>();
  const auto end = std::chrono::steady_clock::now() + patience;
  while (labels_->newest_number() < published && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(10ms);
  labels_->end();
  verdict_ = labels_->judge();
  expect_all_heard(published);
  EXPECT_EQ(verdict_.wrong, 0U) << "the first at " << verdict_.first_wrong;
  EXPECT_GT(verdict_.known, 0U);
  EXPECT_LT(after_.memory.resident - before_.memory.resident, memory_slack);
  expect_all_accounted();
}

void LiveSoak::expect_all_heard(std::uint64_t published) const {
  EXPECT_TRUE(verdict_.in_order);
  EXPECT_LE(verdict_.newest_number, published);
  EXPECT_GE(verdict_.newest_number + (is_alone() ? 0 : kept_labels), published);
  const std::uint64_t heard = verdict_.known + verdict_.unknown;
  EXPECT_GT(10 * heard, published);
  if (!is_alone()) return;
  EXPECT_EQ(heard, published);
  EXPECT_EQ(camera()["judged"], published) << "the subscriber is there before the robot is known";
  EXPECT_EQ(summary_["results_not_written"], 0);
}

const nlohmann::json& LiveSoak::topic(Part part) const {
  for (const Json& one : summary_["topics"])
    if (one["name"] == topic_of(part)) return one;
  static const Json none = {{"received", 0}, {"lost", 0}, {"overwritten", 0}, {"unreadable", 0}};
  return none;
}

void LiveSoak::expect_all_accounted() const {
  std::size_t all = camera()["judged"].get<std::size_t>() + camera()["failed"].get<std::size_t>() +
                    camera()["waiting"].get<std::size_t>() + camera()["in_work"].get<std::size_t>();
  for (const auto& [reason, images] : camera()["dropped"].items()) all += images.get<std::size_t>();
  EXPECT_EQ(all, camera()["received"]);
  EXPECT_EQ(topic(Part::depth)["received"], camera()["received"]);
  EXPECT_EQ(camera()["failed"], 0);
  for (const Part part : all_parts) EXPECT_EQ(topic(part)["unreadable"], 0) << topic_of(part);
}

void LiveSoak::expect_all_arrived() const {
  if (is_alone()) {
    for (const Part part : all_parts) EXPECT_EQ(topic(part)["lost"], 0) << topic_of(part);
  }
  const Json& depth = topic(Part::depth);
  // What was first acknowledged may be the publisher's word that it is there; what it replaced
  // before its first image arrived DDS does not tell.
  EXPECT_GE(depth["received"].get<std::size_t>() + depth["overwritten"].get<std::size_t>() +
                depth["lost"].get<std::size_t>() + (is_alone() ? 1 : kept_images),
            written_);
}

SoakTable LiveSoak::table(const std::string& title) const {
  SoakTable table(title);
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
  table.add("failed, still waiting", camera()["failed"].dump() + ", " + camera()["waiting"].dump());
  if (verdict_.known > 0)
    table.add("labels at the subscriber: true, unknown, of these after the first true, wrong",
              std::to_string(verdict_.known) + ", " + std::to_string(verdict_.unknown) + ", " +
                  std::to_string(verdict_.lost_again) + ", " + std::to_string(verdict_.wrong));
  table.add("results published", camera()["results_written"].dump());
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

void LiveSoak::add_latencies(SoakTable& table) const {
  const io::LatencyHistogram heard = labels_->latency();
  table.add(
      "stamp to labels at the subscriber: median, 99 %, ms",
      fixed(heard.quantile(0.5).value_or(NAN)) + ", " + fixed(heard.quantile(0.99).value_or(NAN)));
  const Json& own = camera()["stamp_to_published_ms"];
  table.add("stamp to published, by live itself: median, 99 %, ms",
            fixed(own["median"]) + ", " + fixed(own["p99"]));
}

void LiveSoak::soak_steadily(std::chrono::seconds length, bool with_overlay) {
  SoakScene scene;
  ASSERT_NO_FATAL_FAILURE(begin(scene, with_overlay));
  run_steadily(length);
  finish();
  // Nothing was missing once all publishers were found. Where other work keeps the machine busy,
  // joint states may come too late.
  if (is_alone())
    EXPECT_EQ(verdict_.lost_again, 0U);
  else
    EXPECT_LT(verdict_.lost_again, verdict_.known);
  expect_all_arrived();
  EXPECT_EQ(topic(Part::color)["received"] > 0, with_overlay);
  std::cout << table(with_overlay ? "steady, overlays subscribed to" : "steady").text();
}

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

void LiveSoak::soak_in_chaos(std::chrono::seconds length) {
  auto random = seeded_random(static_cast<std::uint64_t>(system_now()));
  SoakScene scene;
  scene.joint_faults = {.lost = 0.2, .longest_delay = 60};
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
  SoakTable rows = table("chaos");
  rows.add("publishers killed so that labels ended, and restarted", recoveries_.size());
  rows.add("first sample to labels: least, median, 90 %, most, s", quantiles(recoveries_));
  rows.add("start of the process to its first sample, likewise", quantiles(discoveries_));
  std::cout << rows.text();
  EXPECT_FALSE(recoveries_.empty());
  if (!is_alone()) return;
  for (const double recovery : recoveries_) EXPECT_LT(recovery, most_recovery);
}

}  // namespace penumbra::test
