// SPDX-License-Identifier: Apache-2.0
#include "label_watch.hpp"

#include "pattern.hpp"
#include "soak_publishers.hpp"

#include <algorithm>
#include <functional>
#include <sstream>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

std::vector<std::byte> labels_message(std::int64_t stamp, ImageView<const std::uint8_t> labels) {
  return encoded(io::image_message(io::MessageHeader{stamp, "optical"}, "8UC1", labels));
}

}  // namespace

LabelWatch::LabelWatch(int domain, const LiveLens& lens, const std::string& topic)
    : lens_(lens),
      process_(make_peer(
          domain, {"watch", "rt" + topic, "sensor_msgs::msg::dds_::Image_", "reliable,depth=50"})),
      thread_([this] { read(); }) {}

void LabelWatch::read() {
  const Image<std::uint8_t> nothing(lens_.width, lens_.height,
                                    static_cast<std::uint8_t>(Label::unknown));
  std::vector<std::byte> unknown = labels_message(1, nothing.view());
  while (!ends_) {
    const auto line = process_->line();
    if (!line) {
      std::this_thread::sleep_for(20ms);  // it ended, or is silent
      continue;
    }
    HeardLabels heard;
    std::istringstream(*line) >> heard.number >> heard.stamp >> heard.arrival >> heard.digest;
    set_stamp(unknown, heard.stamp);
    heard.is_known = heard.digest != digest_of(unknown);
    const std::lock_guard lock(mutex_);
    heard_.push_back(heard);
  }
}

std::optional<std::int64_t> LabelWatch::known_after(std::int64_t arrival, std::int64_t stamp,
                                                    std::chrono::seconds at_most) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  do {
    {
      const std::lock_guard lock(mutex_);
      const auto found = std::ranges::find_if(heard_, [&](const HeardLabels& one) {
        return one.is_known && one.arrival > arrival && one.stamp > stamp;
      });
      if (found != heard_.end()) return found->arrival;
    }
    std::this_thread::sleep_for(5ms);
  } while (std::chrono::steady_clock::now() < end);
  return std::nullopt;
}

std::size_t LabelWatch::known_count() {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(
      std::count_if(heard_.begin(), heard_.end(), std::mem_fn(&HeardLabels::is_known)));
}

std::uint64_t LabelWatch::newest_number() {
  const std::lock_guard lock(mutex_);
  return heard_.empty() ? 0 : heard_.back().number;
}

void LabelWatch::end() {
  if (!thread_.joinable()) return;
  ends_ = true;
  process_->end();
  thread_.join();
}

io::LatencyHistogram LabelWatch::latency() const {
  io::LatencyHistogram all;
  for (const HeardLabels& one : heard_)
    all.add(1e-6 * static_cast<double>(one.arrival - one.stamp));
  return all;
}

LabelVerdict LabelWatch::judge() const {
  LabelVerdict all;
  LiveTruth truth(lens_);
  for (const HeardLabels& one : heard_) {
    ++(one.is_known ? all.known : all.unknown);
    if (!one.is_known ||
        digest_of(labels_message(one.stamp, truth.judge(one.stamp).labels)) == one.digest)
      continue;
    ++all.wrong;
    all.first_wrong = one.stamp;
  }
  const auto is_known = [](const HeardLabels& one) { return one.is_known; };
  const auto first = std::find_if(heard_.begin(), heard_.end(), is_known);
  all.lost_again =
      static_cast<std::size_t>(heard_.end() - first - std::count_if(first, heard_.end(), is_known));
  all.newest_number = heard_.empty() ? 0 : heard_.back().number;
  const auto is_behind = [](const HeardLabels& before, const HeardLabels& one) {
    return one.number <= before.number;
  };
  all.in_order = std::adjacent_find(heard_.begin(), heard_.end(), is_behind) == heard_.end();
  return all;
}

}  // namespace penumbra::test
