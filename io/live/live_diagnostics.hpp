// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <io/live/live_inbox.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// The state of a subscription, as the transport reports it.
struct LiveLink {
  bool is_open = false;  ///< subscribed
  int publishers = 0;
  std::uint64_t lost = 0;            ///< by the transport
  std::uint64_t overwritten = 0;     ///< replaced by newer messages before they were read
  std::string refused_because = {};  ///< the incompatible QoS policy; empty: none
  std::string other_type = {};       ///< the published type if it is not the expected one
  std::string other_topic = {};      ///< published with the images that this topic lacks
};

/// The time of a report.
struct LiveMoment {
  std::int64_t now = 0;         ///< on the inbox's clock
  std::int64_t system_now = 0;  ///< nanoseconds since 1970
};

/// The reason why results are missing or unreliable, in one line; empty if there is no fault.
struct LiveFault {
  std::uint8_t level = DiagnosticStatusMessage::ok;
  std::string why;
};

/// Returns the topic that has a topic's images with or without compression, or an empty name.
/// `is_published`: whether a topic has a publisher.
[[nodiscard]] std::string other_topic(const InputTopic& topic,
                                      const std::function<bool(const std::string&)>& is_published);

/// Names the sender of diagnostics, because one graph may have several.
struct DiagnosticSource {
  std::string name = "penumbra";  ///< the prefix of each status name
  std::string hardware_id = {};   ///< the name of the machine
  std::string how_to_forget = "start Penumbra again to forget the former";
  /// Names that replace those of options: time_offset for --time-offset.
  std::set<std::string> parameters = {};
};

/// Makes diagnostic_msgs: one status of the robot, one of each camera, then one of each sensor of
/// clouds. A status has the rates
/// since the last report and, if nothing is published, the reason.
class LiveDiagnostics {
 public:
  explicit LiveDiagnostics(std::int64_t started, DiagnosticSource source = {})
      : before_(started), source_(std::move(source)) {}

  /// Returns the diagnostics now. `links`: one for each of inbox.topics().
  [[nodiscard]] DiagnosticArrayMessage report(const LiveInbox& inbox,
                                              std::span<const LiveLink> links,
                                              const LiveMoment& moment);

 private:
  /// The time since the last report.
  struct Period {
    std::int64_t now;
    double seconds;
  };
  [[nodiscard]] DiagnosticStatusMessage robot_status(const LiveInbox& inbox,
                                                     std::span<const LiveLink> links,
                                                     const Period& period);
  [[nodiscard]] DiagnosticStatusMessage sensor_status(const LiveInbox& inbox, std::size_t sensor,
                                                      std::span<const LiveLink> links,
                                                      const Period& period) const;
  [[nodiscard]] double rate_of(const LiveInbox& inbox, std::size_t topic,
                               const Period& period) const;

  [[nodiscard]] std::string in_own_words(const std::string& text) const;
  [[nodiscard]] DiagnosticStatusMessage make_status(const std::string& subject,
                                                    const LiveFault& fault) const;

  std::int64_t before_;                // time of the last report
  std::vector<std::size_t> judged_;    // of each sensor, at the last report
  std::vector<std::size_t> received_;  // of each topic, at the last report
  std::size_t jumps_ = 0;              // of the clock, at the last report
  DiagnosticSource source_;
};

[[nodiscard]] LiveFault robot_fault(const LiveInbox& inbox, std::span<const LiveLink> links,
                                    std::int64_t now);
[[nodiscard]] LiveFault camera_fault(const LiveInbox& inbox, std::size_t camera,
                                     std::span<const LiveLink> links, std::int64_t now);
[[nodiscard]] LiveFault cloud_fault(const LiveInbox& inbox, std::size_t cloud,
                                    std::span<const LiveLink> links, std::int64_t now);

}  // namespace penumbra::io
