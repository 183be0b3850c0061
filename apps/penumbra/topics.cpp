// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include <apps/penumbra/graph_options.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/text.hpp>
#include <io/dds/graph_json.hpp>
#include <io/dds/participant.hpp>

namespace penumbra::app {
namespace {

struct TopicsArguments {
  io::ParticipantOptions graph;
  double wait = 2.0;  ///< seconds
  bool json = false;
};

std::string joined(const std::set<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : " | ") + word;
  return all.empty() ? "-" : all;
}

std::string qos_of(const std::vector<io::GraphEndpoint>& endpoints) {
  std::set<std::string> words;
  for (const io::GraphEndpoint& endpoint : endpoints)
    words.insert(std::string(endpoint.qos.reliable ? "reliable" : "best effort") +
                 (endpoint.qos.latched ? ", latched" : ""));
  return joined(words);
}

std::string hosts_of(const io::GraphTopic& topic) {
  std::set<std::string> hosts;
  for (const auto* const side : {&topic.publishers, &topic.subscribers})
    for (const io::GraphEndpoint& endpoint : *side)
      if (!endpoint.host.empty()) hosts.insert(endpoint.host);
  return joined(hosts);
}

void print_topics(int domain, const std::vector<io::GraphTopic>& topics) {
  if (topics.empty()) {
    std::cout << "nobody publishes or subscribes on domain " << domain << ", discovery range "
              << io::discovery_range() << '\n';
    return;
  }
  std::vector<std::vector<std::string>> rows = {
      {"TOPIC", "TYPE", "PUBLISHERS", "THEIR QOS", "SUBSCRIBERS", "THEIR QOS", "HOSTS"}};
  for (const io::GraphTopic& topic : topics)
    rows.push_back({topic.name, topic.type, std::to_string(topic.publishers.size()),
                    qos_of(topic.publishers), std::to_string(topic.subscribers.size()),
                    qos_of(topic.subscribers), hosts_of(topic)});
  print_table(rows);
}

void add_options(CLI::App& app, TopicsArguments& topics) {
  app.footer(topics_examples);
  add_domain(app, topics.graph);
  add_number(app, "--wait", "how long to listen for others; default 2", "S", topics.wait, 0.0,
             longest_wait);
  app.add_flag("--json", topics.json, "print JSON instead of a table");
}

int execute(const TopicsArguments& arguments) {
  StopSignal stop;
  const auto graph = io::join_graph(arguments.graph);
  static_cast<void>(stop.wait(to_duration(arguments.wait)));
  const std::vector<io::GraphTopic> topics = graph->graph();
  print_notes(graph->take_warnings());
  if (arguments.json)
    std::cout << io::graph_json(graph->domain(), topics) << '\n';
  else
    print_topics(graph->domain(), topics);
  return 0;
}

}  // namespace

Execute add_topics(CLI::App& app) {
  return make_command<TopicsArguments>(app, add_options, nullptr, execute);
}

}  // namespace penumbra::app
