// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <sstream>

#include <penumbra/base/error.hpp>

#include <io/dds/graph_domain-inl.hpp>
#include <io/dds/participant.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr const char* address_characters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.:-_[]%/";
constexpr int last_domain = 232;  // the ports of higher domains exceed 16 bits

[[noreturn]] void refuse_domain(const std::string& what) {
  throw InputError(what + ": is not a DDS domain; expected a whole number from 0 to " +
                   std::to_string(last_domain));
}

}  // namespace

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string discovery_range() {
  if (environment("ROS_LOCALHOST_ONLY") == "1") return "LOCALHOST";
  std::string range = environment("ROS_AUTOMATIC_DISCOVERY_RANGE");
  if (range.empty()) return "SUBNET";
  for (const char* known : {"SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT"})
    if (range == known) return range;
  throw InputError("ROS_AUTOMATIC_DISCOVERY_RANGE='" + printable(range) +
                   "': expected SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT");
}

std::vector<std::string> static_peers() {
  std::vector<std::string> peers;
  std::istringstream all(environment("ROS_STATIC_PEERS"));
  for (std::string peer; std::getline(all, peer, ';');) {
    if (peer.find_first_not_of(address_characters) != std::string::npos)
      throw InputError("ROS_STATIC_PEERS: '" + printable(peer) + "' is not an address");
    if (!peer.empty()) peers.push_back(peer);
  }
  return peers;
}

int graph_domain(const ParticipantOptions& options) {
  if (options.domain) {
    if (*options.domain < 0 || *options.domain > last_domain)
      refuse_domain("domain " + std::to_string(*options.domain));
    return *options.domain;
  }
  const char* const given = std::getenv("ROS_DOMAIN_ID");
  if (given == nullptr || *given == '\0') return 0;
  const auto domain = parse_number<int>(given);
  if (!domain || *domain < 0 || *domain > last_domain)
    refuse_domain("ROS_DOMAIN_ID='" + std::string(given) + "'");
  return *domain;
}

}  // namespace penumbra::io
