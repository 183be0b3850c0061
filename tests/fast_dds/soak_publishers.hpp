// SPDX-License-Identifier: Apache-2.0
// The publishers of a scene, each a process of another vendor's DDS that may be killed.
#pragma once

#include "../io/live_scene.hpp"
#include "pattern.hpp"
#include "peer_process.hpp"

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace penumbra::test {

/// A process on a domain. `words`: of fast_dds_peer, from the mode on; publishers are ready.
[[nodiscard]] std::unique_ptr<PeerProcess> make_peer(int domain,
                                                     const std::vector<std::string>& words);

/// What happens to joint states on the way.
struct JointFaults {
  double lost = 0.0;      ///< share
  int longest_delay = 0;  ///< ms, each one's own: they overtake one another
  std::uint64_t seed = 0;
};

/// Tells joint states at 100 Hz, by a process that may be killed and replaced.
class JointFeed {
 public:
  explicit JointFeed(const JointFaults& faults);
  ~JointFeed();
  JointFeed(const JointFeed&) = delete;
  JointFeed& operator=(const JointFeed&) = delete;

  void begin(std::unique_ptr<PeerProcess> process);
  void kill();
  [[nodiscard]] PeerProcess* process() { return process_.get(); }

 private:
  void feed();

  JointFaults faults_;
  std::mutex mutex_;
  std::unique_ptr<PeerProcess> process_;  // guarded by mutex_; changed by its owner's thread alone
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// What is published.
enum class Part { depth, depth_info, color, color_info, joints };
inline constexpr std::array all_parts = {Part::depth, Part::depth_info, Part::color,
                                         Part::color_info, Part::joints};
[[nodiscard]] std::string topic_of(Part part);

/// Its camera is that of large_lens, at 30 Hz.
class SoakPublishers {
 public:
  /// A robot_description and where the camera is are published; start() is for the rest.
  SoakPublishers(int domain, const JointFaults& faults);

  void start(Part part);
  void kill(Part part);

  /// When what a part's process said was heard first, nanoseconds since 1970; nothing: nobody heard
  /// it within 120 s.
  [[nodiscard]] std::optional<std::int64_t> heard(Part part);

  /// Ends a camera's part; how many messages were written since somebody heard one.
  [[nodiscard]] std::size_t end(Part part);

 private:
  PeerProcess* process(Part part);

  int domain_;
  std::unique_ptr<PeerProcess> description_, mount_;
  std::array<std::unique_ptr<PeerProcess>, 4> camera_;
  JointFeed joints_;
};

}  // namespace penumbra::test
