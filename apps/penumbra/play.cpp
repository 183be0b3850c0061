// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/graph_options.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/text.hpp>
#include <io/bag/bag_reader.hpp>
#include <io/dds/graph_names.hpp>
#include <io/dds/participant.hpp>
#include <io/files/printable.hpp>
#include <io/ros/restamp.hpp>

namespace penumbra::app {
namespace {

struct PlayArguments {
  std::filesystem::path bag;
  io::ParticipantOptions graph;
  double rate = 1.0;
  double start = 0.0;  ///< seconds after the first message
  double delay = 1.0;  ///< seconds before it is published
  bool loop = false;
  std::vector<std::string> topics;   ///< empty: all
  std::vector<std::string> latched;  ///< empty: by their names
  std::map<std::string, std::string> remaps;
  bool restamp = false;
};

using namespace std::chrono;

constexpr int depth = 10;           // as ROS 2's publishers by default
constexpr int latched_depth = 100;  // several publishers' messages of one topic
constexpr seconds longest_flush(2);

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns "; " and each fault of the bag so far.
std::string damage_of(const io::BagReader& bag) {
  std::string text;
  for (const std::string& fault : bag.faults()) text += "; " + fault;
  return text;
}

std::int64_t now_since_1970() {
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

/// A topic of a bag as it is published.
struct PlayedTopic {
  std::string name;  ///< after --remap
  std::string type;
  io::TopicQos qos;
  std::unique_ptr<io::Publication> publication;  ///< null if it is not played
  std::optional<io::Restamper> restamper;        ///< of types with headers, with --restamp
  std::uint64_t written = 0;
  std::uint64_t behind = 0;      ///< not written because reliable subscribers were behind
  std::uint64_t unreadable = 0;  ///< not written because their stamps could not be found
};

/// Publishes a bag's messages at the pace of their log times.
class BagPlayer {
 public:
  /// Throws InputError if there is nothing to play, and for topics that the bag does not have.
  BagPlayer(const PlayArguments& arguments, io::Participant& graph);

  /// Plays the bag once. Returns false if it was stopped.
  bool play(StopSignal& stop);

  /// Waits up to two seconds until reliable subscribers have everything.
  void finish();

  [[nodiscard]] const std::vector<PlayedTopic>& topics() const { return topics_; }
  [[nodiscard]] double most_late() const { return most_late_; }  ///< seconds behind the pace

  /// Returns what was left out and why, one line each.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Clock;

  void announce(std::size_t index);
  void note_kept_stamps(const std::string& type);
  bool is_wanted(const std::string& topic) const;
  bool is_latched(const io::BagTopic& topic);
  void check_names() const;
  void write(PlayedTopic& topic, const io::BagMessage& message, const Clock& clock);

  const PlayArguments& arguments_;
  io::Participant& graph_;
  std::unique_ptr<io::BagReader> reader_;
  std::vector<PlayedTopic> topics_;  // as the bag numbers them
  std::vector<std::string> notes_;
  std::vector<std::byte> changed_;
  double most_late_ = 0.0;
};

/// Maps the recording's time to ours, from the first message that is played.
struct BagPlayer::Clock {
  std::int64_t first_log = 0, first_wall = 0;  // nanoseconds
  steady_clock::time_point first_due;
  double rate = 1.0;

  [[nodiscard]] std::int64_t ahead(std::int64_t recorded) const {
    constexpr double most = 1e18;  // nanoseconds: 30 years
    std::int64_t difference = 0;
    if (__builtin_sub_overflow(recorded, first_log, &difference)) return 0;  // a damaged time
    return static_cast<std::int64_t>(
        std::clamp(static_cast<double>(difference) / rate, -most, most));
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
    notes_.push_back(io::printable(topic.name) + ": the bag's QoS cannot be read");
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
    played.publication = graph_.advertise(played.name, played.type, played.qos, topic.definition);
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

constexpr double reported_lateness = 0.1;  // s

void print_topics(const BagPlayer& player, int domain) {
  std::cout << "publishing on domain " << domain << ", until Ctrl-C or the bag's end\n";
  std::vector<std::vector<std::string>> rows = {{"TOPIC", "TYPE", "QOS"}};
  for (const PlayedTopic& topic : player.topics())
    if (topic.publication)
      rows.push_back(
          {topic.name, topic.type, topic.qos.latched ? "reliable, latched" : "reliable"});
  print_table(rows);
  std::cout << std::flush;
}

constexpr double longest_bag = 1e8;  // s: three years

void add_remaps(CLI::App& app, std::map<std::string, std::string>& remaps) {
  add_list(app, "--remap", "another name for a topic; may be given several times", "FROM:=TO",
           [&](const std::string& text) {
             const std::size_t middle = text.find(":=");
             if (middle == std::string::npos)
               refuse_option("--remap", text, "FROM:=TO, two full names of topics");
             const std::string from = text.substr(0, middle), to = text.substr(middle + 2);
             static_cast<void>(io::dds_topic(from));
             static_cast<void>(io::dds_topic(to));
             if (!remaps.emplace(from, to).second)
               throw InputError("--remap: " + from + " is given twice");
           });
}

void add_options(CLI::App& app, PlayArguments& play) {
  app.footer(play_examples);
  add_text(app, "BAG", "*.mcap, *.db3, or a folder with metadata.yaml", "", play.bag)->required();
  add_domain(app, play.graph);
  add_number(app, "--rate", "times as fast as recorded; default 1", "R", play.rate, 0.001, 1000.0);
  add_number(app, "--start", "begin so many seconds after the first message; default 0", "S",
             play.start, 0.0, longest_bag);
  add_number(app, "--delay", "wait before the first message, for others to find us; default 1", "S",
             play.delay, 0.0, longest_wait);
  app.add_flag("--loop", play.loop, "begin again at the end, until Ctrl-C");
  add_option(app, "--topics", "play only these, with commas between; default: all", "LIST",
             [&](const std::string& text) { play.topics = split(text, ','); });
  add_option(
      app, "--latched",
      "topics whose last messages late subscribers get, too; default: those that were recorded "
      "so, or tf_static and robot_description where the bag does not say it",
      "LIST", [&](const std::string& text) { play.latched = split(text, ','); });
  add_remaps(app, play.remaps);
  app.add_flag(
      "--restamp", play.restamp,
      "shift stamps to now: of headers at the beginning of messages, in TFMessage and detections");
}

int execute(const PlayArguments& arguments) {
  StopSignal stop;
  const auto graph = io::join_graph(arguments.graph);
  BagPlayer player(arguments, *graph);
  print_topics(player, graph->domain());
  bool goes_on = !stop.wait(to_duration(arguments.delay));
  while (goes_on) goes_on = player.play(stop) && arguments.loop;
  player.finish();
  const auto written = std::accumulate(
      player.topics().begin(), player.topics().end(), std::uint64_t{0},
      [](std::uint64_t sum, const PlayedTopic& topic) { return sum + topic.written; });
  std::cout << written << " messages published\n";
  print_notes(player.notes());
  if (player.most_late() > reported_lateness)
    print_notes(std::vector{"up to " + fixed(player.most_late(), 1) +
                            " s behind the recording's pace; lower --rate, or choose --topics"});
  print_notes(graph->take_warnings());
  return 0;
}

}  // namespace

Execute add_play(CLI::App& app) {
  return make_command<PlayArguments>(app, add_options, nullptr, execute);
}

}  // namespace penumbra::app
