// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <map>
#include <string>
#include <utility>

#include <io/dds/graph_endpoints.hpp>
#include <io/dds/graph_names.hpp>
#include <io/dds/graph_session.hpp>
#include <io/dds/qos.hpp>

namespace penumbra::io {
namespace {

using Guid = std::array<std::uint8_t, sizeof(dds_guid_t)>;
using Hosts = std::map<Guid, std::string>;  // by participant

Guid to_guid(const dds_guid_t& guid) { return std::to_array(guid.v); }

/// Calls `take` for each endpoint that is alive now.
template <typename T, typename Take>
void for_each_alive(dds_entity_t reader, Take take) {
  for (std::uint32_t room = 256;; room *= 2) {
    std::vector<void*> samples(room, nullptr);
    std::vector<dds_sample_info_t> infos(room);
    const std::uint32_t alive =
        DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE;
    const dds_return_t count =
        dds_read_mask(reader, samples.data(), infos.data(), room, room, alive);
    if (count <= 0) return;
    const auto got = static_cast<std::uint32_t>(count);
    if (got < room)
      for (std::uint32_t i = 0; i < got; ++i)
        if (infos[i].valid_data) take(*static_cast<const T*>(samples[i]));
    dds_return_loan(reader, samples.data(), count);
    if (got < room) return;
  }
}

/// Returns the host by a property of Cyclone DDS or of Fast DDS.
std::string host_of(const dds_qos_t* qos) {
  for (const char* const name : {"__Hostname", "fastdds.physical_data.host"}) {
    char* value = nullptr;
    if (!dds_qget_prop(qos, name, &value) || value == nullptr) continue;
    std::string host(value);
    dds_free(value);
    return host.substr(0, host.find(':'));  // Fast DDS adds a number
  }
  return {};
}

Hosts read_hosts(dds_entity_t reader) {
  Hosts hosts;
  for_each_alive<dds_builtintopic_participant_t>(reader, [&](const auto& participant) {
    hosts[to_guid(participant.key)] = host_of(participant.qos);
  });
  return hosts;
}

}  // namespace

GraphEndpoints::GraphEndpoints(dds_entity_t participant) {
  const auto reader = [&](dds_entity_t topic) {
    return checked(dds_create_reader(participant, topic, nullptr, nullptr), "discovery");
  };
  checked(dds_get_guid(participant, &own_), "discovery");
  participants_ = reader(DDS_BUILTIN_TOPIC_DCPSPARTICIPANT);
  publications_ = reader(DDS_BUILTIN_TOPIC_DCPSPUBLICATION);
  subscriptions_ = reader(DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION);
}

std::vector<GraphTopic> GraphEndpoints::topics() const {
  const Hosts hosts = read_hosts(participants_);
  std::map<std::pair<std::string, std::string>, GraphTopic> topics;
  const auto add = [&](const dds_builtintopic_endpoint_t& found,
                       std::vector<GraphEndpoint> GraphTopic::*side) {
    const auto name = ros_topic(found.topic_name), type = ros_type(found.type_name);
    if (!name || !type) return;
    GraphTopic& topic = topics[{*name, *type}];
    topic.name = *name;
    topic.type = *type;
    const auto host = hosts.find(to_guid(found.participant_key));
    (topic.*side)
        .push_back({read_qos(found.qos), host == hosts.end() ? "" : host->second,
                    to_guid(found.participant_key) == to_guid(own_)});
  };
  for_each_alive<dds_builtintopic_endpoint_t>(
      publications_, [&](const auto& found) { add(found, &GraphTopic::publishers); });
  for_each_alive<dds_builtintopic_endpoint_t>(
      subscriptions_, [&](const auto& found) { add(found, &GraphTopic::subscribers); });
  std::vector<GraphTopic> ordered;
  ordered.reserve(topics.size());
  for (auto& [key, topic] : topics) ordered.push_back(std::move(topic));
  return ordered;
}

}  // namespace penumbra::io
