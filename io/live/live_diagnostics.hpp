// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <io/live/live_inbox.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// What the transport knows of a subscription.
struct LiveLink {
  bool is_open = false;  ///< it is subscribed to
  int publishers = 0;
  std::uint64_t lost = 0;            ///< by the transport
  std::uint64_t overwritten = 0;     ///< by newer ones, before they were read
  std::string refused_because = {};  ///< a publisher's QoS does not fit: the policy; empty: none
  std::string other_type =
      {};  ///< the topic's messages are of this type, which is not the one wanted
};

/// When a report is made.
struct LiveMoment {
  std::int64_t now = 0;         ///< of the inbox's clock
  std::int64_t system_now = 0;  ///< nanoseconds since 1970
};

/// Why a camera's results do not come, or cannot be trusted, in one line; empty: they do.
struct LiveTrouble {
  std::uint8_t level = DiagnosticStatusMessage::ok;
  std::string why;
};

/// Who says it: several may be on one graph.
struct LiveSpeaker {
  std::string name = "penumbra";  ///< begins each status's name
  std::string hardware_id = {};   ///< the machine
};

/// Tells how it goes, for diagnostic_msgs: one status of the robot, and one of each camera, with
/// rates since the last report and, where nothing is published, the reason.
class LiveDiagnostics {
 public:
  explicit LiveDiagnostics(std::int64_t started, LiveSpeaker speaker = {})
      : before_(started), speaker_(std::move(speaker)) {}

  /// `links`: one for each of inbox.topics().
  [[nodiscard]] DiagnosticArrayMessage report(const LiveInbox& inbox,
                                              std::span<const LiveLink> links,
                                              const LiveMoment& moment);

 private:
  /// Since the last report.
  struct Period {
    std::int64_t now;
    double seconds;
  };
  [[nodiscard]] DiagnosticStatusMessage robot_status(const LiveInbox& inbox,
                                                     std::span<const LiveLink> links,
                                                     const Period& period) const;
  [[nodiscard]] DiagnosticStatusMessage camera_status(const LiveInbox& inbox, std::size_t number,
                                                      std::span<const LiveLink> links,
                                                      const Period& period) const;
  [[nodiscard]] double rate_of(const LiveInbox& inbox, std::size_t topic,
                               const Period& period) const;

  [[nodiscard]] DiagnosticStatusMessage begun(const std::string& about,
                                              const LiveTrouble& trouble) const;

  std::int64_t before_;                // when the last report was made
  std::vector<std::size_t> judged_;    // of each camera, until then
  std::vector<std::size_t> received_;  // of each topic, until then
  LiveSpeaker speaker_;
};

[[nodiscard]] LiveTrouble trouble_of_robot(const LiveInbox& inbox, std::span<const LiveLink> links,
                                           std::int64_t now);
[[nodiscard]] LiveTrouble trouble_of_camera(const LiveInbox& inbox, std::size_t camera,
                                            std::span<const LiveLink> links, std::int64_t now);

}  // namespace penumbra::io
