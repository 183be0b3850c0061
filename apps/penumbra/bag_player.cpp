// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/bag_player.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/printable.hpp>

namespace penumbra::app {

using namespace std::chrono;

namespace {

constexpr int depth = 10;           // as ROS 2's publishers by default
constexpr int latched_depth = 100;  // several publishers' messages of one topic
constexpr seconds longest_flush(2);

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// "; " and what is wrong with the bag, so far as it is known.
std::string damage_of(const io::BagReader& bag) {
  std::string text;
  for (const std::string& fault : bag.faults()) text += "; " + fault;
  return text;
}

std::int64_t now_since_1970() {
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

/// Where the recording's time lies in ours: from the first message that is played on.
struct BagPlayer::Clock {
  std::int64_t first_log = 0, first_wall = 0;  // nanoseconds
  steady_clock::time_point first_due;
  double rate = 1.0;

  [[nodiscard]] std::int64_t ahead(std::int64_t recorded) const {
    return static_cast<std::int64_t>(static_cast<double>(recorded - first_log) / rate);
  }
};

BagPlayer::BagPlayer(const PlayArguments& arguments, io::Participant& graph)
    : arguments_(arguments), graph_(graph), reader_(io::open_bag(arguments.bag)) {
  check_names();
  for (std::size_t i = 0; i < reader_->topics().size(); ++i) announce(i);
  if (std::none_of(topics_.begin(), topics_.end(),
                   [](const auto& topic) { return topic.publication != nullptr; }))
    throw InputError(arguments_.bag.string() + ": there is nothing to play: no messages in CDR" +
                     (arguments_.topics.empty() ? "" : " on the topics of --topics") +
                     damage_of(*reader_));
}

void BagPlayer::check_names() const {
  const auto check = [&](const std::string& option, const std::string& name) {
    const auto topics = reader_->topics();
    if (std::none_of(topics.begin(), topics.end(),
                     [&](const auto& topic) { return topic.name == name; }))
      throw InputError(option + ": " + arguments_.bag.string() + " has no topic '" + name + "'");
  };
  for (const std::string& name : arguments_.topics) check("--topics", name);
  for (const std::string& name : arguments_.latched) check("--latched", name);
  for (const auto& [from, to] : arguments_.remaps) check("--remap", from);
}

bool BagPlayer::is_wanted(const std::string& topic) const {
  return arguments_.topics.empty() || contains(arguments_.topics, topic);
}

bool BagPlayer::is_latched(const io::BagTopic& topic) {
  if (!arguments_.latched.empty()) return contains(arguments_.latched, topic.name);
  if (topic.qos.is_unreadable)
    notes_.push_back(io::printable(topic.name) + ": the QoS that the bag tells cannot be read");
  const bool by_name =
      topic.name.ends_with("/tf_static") || topic.name.ends_with("/robot_description");
  return topic.qos.latched.value_or(by_name);
}

void BagPlayer::announce(std::size_t index) {
  const io::BagTopic& topic = reader_->topics()[index];
  PlayedTopic& played = topics_.emplace_back();
  const auto renamed = arguments_.remaps.find(topic.name);
  played.name = renamed == arguments_.remaps.end() ? topic.name : renamed->second;
  played.type = topic.type;
  if (!is_wanted(topic.name) || topic.messages == 0) return;
  if (topic.encoding != "cdr") {
    notes_.push_back(io::printable(topic.name) + " is not played: its messages are " +
                     io::printable(topic.encoding) + ", not cdr");
    return;
  }
  played.qos.reliable = true;
  played.qos.latched = is_latched(topic);
  played.qos.depth = played.qos.latched ? latched_depth : depth;
  try {
    if (arguments_.restamp) {
      const io::Restamper restamper(topic.type, topic.definition);
      if (restamper.leaves_headers()) note_kept_stamps(topic.type);
      if (restamper.has_headers()) played.restamper = restamper;
    }
    played.publication = graph_.advertise(played.name, played.type, played.qos);
  } catch (const InputError& error) {
    if (contains(arguments_.topics, topic.name)) throw;
    notes_.push_back(io::printable(topic.name) + " is not played: " + error.what());
  }
}

void BagPlayer::note_kept_stamps(const std::string& type) {
  const std::string note = "--restamp: " + io::printable(type) +
                           " may keep recorded stamps in headers that are not at its beginning";
  if (!contains(notes_, note)) notes_.push_back(note);
}

void BagPlayer::write(PlayedTopic& topic, const io::BagMessage& message, const Clock& clock) {
  std::span<const std::byte> data = message.data;
  if (topic.restamper) {
    changed_.assign(data.begin(), data.end());
    const auto fault = topic.restamper->apply(
        changed_, [&](std::int64_t stamp) { return clock.first_wall + clock.ahead(stamp); });
    if (fault) {
      ++topic.unreadable;
      return;
    }
    data = changed_;
  }
  ++(topic.publication->write(data) ? topic.written : topic.behind);
}

bool BagPlayer::play(StopSignal& stop) {
  if (!reader_) reader_ = io::open_bag(arguments_.bag);
  io::BagMessage message;
  Clock clock{0, now_since_1970(), steady_clock::now(), arguments_.rate};
  const auto skipped = static_cast<std::int64_t>(arguments_.start * 1e9);
  bool begun = false, stopped = false, reached = false;
  while (!stopped && reader_->next(message)) {
    if (!std::exchange(begun, true)) clock.first_log = message.log_time + skipped;
    while (topics_.size() < reader_->topics().size()) announce(topics_.size());
    PlayedTopic& topic = topics_[message.topic];
    if (!topic.publication) continue;
    const bool early = message.log_time < clock.first_log;
    if (early && !topic.qos.latched) continue;
    if (!early) {
      reached = true;
      const auto due = clock.first_due + nanoseconds(clock.ahead(message.log_time));
      stopped = stop.wait_until(due);
      most_late_ = std::max(most_late_, duration<double>(steady_clock::now() - due).count());
    }
    if (!stopped) write(topic, message, clock);
  }
  if (!reached && !stopped && arguments_.start > 0.0)
    notes_.push_back(
        "no message is later than --start; of those before, latched ones were published");
  for (const std::string& fault : reader_->faults())
    if (!contains(notes_, fault)) notes_.push_back(fault);
  reader_.reset();
  return !stopped;
}

void BagPlayer::finish() {
  const auto end = steady_clock::now() + longest_flush;
  for (const PlayedTopic& topic : topics_)
    if (topic.publication)
      topic.publication->flush(std::max<nanoseconds>(end - steady_clock::now(), nanoseconds(0)));
}

std::vector<std::string> BagPlayer::notes() const {
  std::vector<std::string> all = notes_;
  for (const PlayedTopic& topic : topics_) {
    if (topic.behind > 0)
      all.push_back(topic.name + ": " + std::to_string(topic.behind) +
                    " messages not published: subscribers with QoS reliable are behind");
    if (topic.unreadable > 0)
      all.push_back(topic.name + ": " + std::to_string(topic.unreadable) +
                    " messages not published: their stamps cannot be read");
  }
  return all;
}

}  // namespace penumbra::app
