// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/dds/graph_json.hpp>
#include <io/files/json.hpp>

namespace penumbra::io {
namespace {

Json endpoints_json(const std::vector<GraphEndpoint>& endpoints) {
  Json all = Json::array();
  for (const GraphEndpoint& endpoint : endpoints)
    all.push_back({{"reliable", endpoint.qos.reliable},
                   {"latched", endpoint.qos.latched},
                   {"host", or_null(endpoint.host)}});
  return all;
}

}  // namespace

std::string graph_json(int domain, std::span<const GraphTopic> topics) {
  Json all = Json::array();
  for (const GraphTopic& topic : topics)
    all.push_back({{"name", topic.name},
                   {"type", topic.type},
                   {"publishers", endpoints_json(topic.publishers)},
                   {"subscribers", endpoints_json(topic.subscribers)}});
  const Json json = {{"domain", domain}, {"topics", std::move(all)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace penumbra::io
