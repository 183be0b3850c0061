// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <map>
#include <mutex>
#include <string_view>

#include <unistd.h>

#include <penumbra/base/error.hpp>

#include <io/dds/graph_domain-inl.hpp>
#include <io/dds/graph_log.hpp>
#include <io/dds/graph_session.hpp>
#include <io/dds/participant.hpp>

namespace penumbra::io {
namespace {

// Images of megabytes arrive as bursts of datagrams, which wait in the socket while others are
// read: the default buffer of 1 MiB loses some of them. The kernel limits the size to
// net.core.rmem_max. Lost datagrams are requested again after 10 ms instead of 100, because
// publishers of images keep few. Publishers ask for acknowledgements 10 ms after a message: with
// the default of 100 ms they never ask while messages of several datagrams come more often.
constexpr std::string_view our_settings =
    R"(<CycloneDDS><Domain id="any"><Internal><SocketReceiveBufferSize max="16MiB"/>)"
    R"(<NackDelay>10ms</NackDelay><HeartbeatInterval>10ms</HeartbeatInterval></Internal></Domain></CycloneDDS>)";

// Nodes of Humble listen on the loopback interface only, those of Jazzy on the default one. A
// machine may have no other than the loopback interface, which must not be named twice.
constexpr std::string_view both_interfaces =
    R"(<CycloneDDS><Domain id="any"><General><Interfaces><NetworkInterface autodetermine="true"/>)"
    R"(<NetworkInterface address="127.0.0.1"/></Interfaces></General></Domain></CycloneDDS>)";

// Shared memory is off: it needs a daemon, ends the process if there is none, and does not pass CDR
// bytes.
constexpr std::string_view last_settings =
    R"(<CycloneDDS><Domain id="any"><SharedMemory><Enable>false</Enable></SharedMemory></Domain></CycloneDDS>)";

/// Returns the settings of ROS 2 Jazzy for a discovery range. Without multicast, participants find
/// each other by the ports of their numbers.
std::string discovery_settings(const std::string& range) {
  if (range == "SYSTEM_DEFAULT") return {};
  std::string peers;
  if (range == "LOCALHOST") peers = R"(<Peer address="127.0.0.1"/>)";  // needs no /etc/hosts
  if (environment("ROS_LOCALHOST_ONLY") != "1")
    for (const std::string& peer : static_peers()) peers += "<Peer address=\"" + peer + "\"/>";
  std::string settings = R"(<CycloneDDS><Domain id="any">)";
  if (range != "SUBNET") settings += "<General><AllowMulticast>false</AllowMulticast></General>";
  if (range == "OFF")
    settings += "<Discovery><ParticipantIndex>none</ParticipantIndex><Tag>penumbra_" +
                std::to_string(::getpid()) + "</Tag></Discovery>";
  else
    settings +=
        "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>" +
        (peers.empty() ? "" : "<Peers>" + peers + "</Peers>") + "</Discovery>";
  return settings + "</Domain></CycloneDDS>";
}

/// Returns the settings, in XML or as file names, separated by commas. Later settings override
/// earlier ones.
std::string all_settings(std::string_view interfaces) {
  std::string all(our_settings);
  all += "," + discovery_settings(discovery_range());
  all.append(",").append(interfaces);
  const std::string users = environment("CYCLONEDDS_URI");
  if (!users.empty()) all += "," + users;
  return all + "," + std::string(last_settings);
}

/// Throws InputError with the first line that Cyclone DDS logged, or else `otherwise`.
[[noreturn]] void refuse_graph(int domain, const std::string& otherwise) {
  const auto lines = take_logged_lines();
  std::string message =
      "DDS, domain " + std::to_string(domain) + ": " + (lines.empty() ? otherwise : lines.front());
  if (!environment("CYCLONEDDS_URI").empty())
    message += "; see CYCLONEDDS_URI, or unset it";
  else
    message += "; is there a network interface that is up (ROS_LOCALHOST_ONLY=1 needs none)?";
  throw InputError(message);
}

}  // namespace

class GraphDomain {
 public:
  static std::shared_ptr<GraphDomain> enter(int id) {
    static std::mutex mutex;
    static auto* const domains = new std::map<int, std::weak_ptr<GraphDomain>>;
    const std::lock_guard lock(mutex);
    std::shared_ptr<GraphDomain> domain = (*domains)[id].lock();
    if (!domain) (*domains)[id] = domain = std::make_shared<GraphDomain>(id);
    return domain;
  }

  explicit GraphDomain(int id) {
    keep_logged_lines();
    static_cast<void>(take_logged_lines());
    const auto create = [id](std::string_view interfaces) {
      return dds_create_domain(static_cast<dds_domainid_t>(id), all_settings(interfaces).c_str());
    };
    entity_ = create(discovery_range() == "LOCALHOST" ? both_interfaces : "");
    if (entity_ < 0 && discovery_range() == "LOCALHOST") {
      static_cast<void>(take_logged_lines());
      entity_ = create("");
    }
    if (entity_ < 0) refuse_graph(id, dds_strretcode(entity_));
  }
  ~GraphDomain() { dds_delete(entity_); }
  GraphDomain(const GraphDomain&) = delete;
  GraphDomain& operator=(const GraphDomain&) = delete;

 private:
  dds_entity_t entity_ = 0;
};

GraphSession::GraphSession(int domain) : domain_(GraphDomain::enter(domain)) {
  participant_ = dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  if (participant_ < 0) refuse_graph(domain, dds_strretcode(participant_));
  waitset_ = dds_create_waitset(participant_);
  waker_ = dds_create_guardcondition(participant_);
  if (waitset_ < 0 || waker_ < 0 || dds_waitset_attach(waitset_, waker_, waker_) < 0) {
    dds_delete(participant_);
    refuse_graph(domain, "no memory for a waitset");
  }
}

GraphSession::~GraphSession() { dds_delete(participant_); }

dds_entity_t checked(dds_return_t result, const std::string& what) {
  if (result < 0) throw InputError(what + ": DDS refuses it: " + dds_strretcode(result));
  return result;
}

}  // namespace penumbra::io
