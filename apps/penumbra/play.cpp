// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/bag_player.hpp>
#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

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

}  // namespace

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
  tell_notes(player.notes());
  if (player.most_late() > reported_lateness)
    tell_notes(std::vector{"up to " + fixed(player.most_late(), 1) +
                           " s behind the recording's pace; lower --rate, or choose --topics"});
  tell_notes(graph->take_complaints());
  return 0;
}

}  // namespace penumbra::app
