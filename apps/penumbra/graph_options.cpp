// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <apps/penumbra/graph_options.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/dds/graph_names.hpp>

namespace penumbra::app {
namespace {

constexpr int last_domain = 232;
constexpr double longest_wait = 3600.0;  // s
constexpr double longest_bag = 1e8;      // s: three years
constexpr double least_rate = 0.001, most_rate = 1000.0;

double to_rate(const std::string& text) {
  const auto rate = io::parse_number<double>(text);
  if (!rate || *rate < least_rate || *rate > most_rate)
    refuse_option("--rate", text, "a number from 0.001 to 1000: 2 is twice as fast");
  return *rate;
}

}  // namespace

double to_seconds(const std::string& option, const std::string& text, double most) {
  const auto seconds = io::parse_number<double>(text);
  if (!seconds || *seconds < 0.0 || *seconds > most)
    refuse_option(option, text, "a number of seconds from 0 to " + fixed(most, 0));
  return *seconds;
}

void add_domain(CLI::App& app, io::ParticipantOptions& graph) {
  add_option(
      app, "--domain", "DDS's domain; default: ROS_DOMAIN_ID, else 0", "N",
      [&](const std::string& text) { graph.domain = to_count("--domain", text, 0, last_domain); });
}

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
               refuse_option("--remap", text, "the only one from " + from);
           });
}

void add_topics(CLI::App& app, TopicsArguments& topics) {
  app.footer(topics_examples);
  add_domain(app, topics.graph);
  add_option(
      app, "--wait", "how long to listen for others; default 2", "S",
      [&](const std::string& text) { topics.wait = to_seconds("--wait", text, longest_wait); });
  app.add_flag("--json", topics.json, "print JSON instead of a table");
}

void add_play(CLI::App& app, PlayArguments& play) {
  app.footer(play_examples);
  add_path(app, "BAG", "*.mcap, *.db3, or a folder with metadata.yaml", "", play.bag)->required();
  add_domain(app, play.graph);
  add_option(app, "--rate", "times as fast as recorded; default 1", "R",
             [&](const std::string& text) { play.rate = to_rate(text); });
  add_option(
      app, "--start", "begin so many seconds after the first message; default 0", "S",
      [&](const std::string& text) { play.start = to_seconds("--start", text, longest_bag); });
  add_option(
      app, "--delay", "wait before the first message, for others to find us; default 1", "S",
      [&](const std::string& text) { play.delay = to_seconds("--delay", text, longest_wait); });
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

}  // namespace penumbra::app
