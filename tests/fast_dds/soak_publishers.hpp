// SPDX-License-Identifier: Apache-2.0
// The publishers of a scene, each a process of another vendor's DDS that may be killed.
#pragma once

#include "../io/live_scene.hpp"
#include "peer_process.hpp"

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace penumbra::test {

/// A process on a domain. `mode`: as fast_dds_peer has it; publishers have said that they are
/// ready.
[[nodiscard]] std::unique_ptr<PeerProcess> make_peer(int domain,
                                                     const std::vector<std::string>& words);

/// Nanoseconds since 1970.
[[nodiscard]] std::int64_t system_now();

/// What happens to joint states on the way.
struct JointFaults {
  double lost = 0.0;      ///< share
  int longest_delay = 0;  ///< ms, each one's own: they overtake one another
};

/// Tells joint states evenly, by a process that may be killed and replaced.
class JointFeed {
 public:
  JointFeed(int hertz, const JointFaults& faults, std::uint64_t seed);
  ~JointFeed();
  JointFeed(const JointFeed&) = delete;
  JointFeed& operator=(const JointFeed&) = delete;

  void begin(std::unique_ptr<PeerProcess> process);
  void kill();
  [[nodiscard]] PeerProcess* process() { return process_.get(); }

 private:
  struct Due {
    std::int64_t time, stamp;
    bool operator<(const Due& other) const { return time < other.time; }
  };
  void feed();
  void tell_until(std::int64_t time);

  int hertz_;
  JointFaults faults_;
  std::mt19937_64 random_;
  std::mutex mutex_;
  std::unique_ptr<PeerProcess> process_;  // guarded by mutex_; changed by its owner's thread alone
  std::vector<Due> waiting_;              // the feeding thread's
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// What is published.
enum class Part { depth, depth_info, color, color_info, joints };
inline constexpr std::array all_parts = {Part::depth, Part::depth_info, Part::color,
                                         Part::color_info, Part::joints};
[[nodiscard]] std::string topic_of(Part part);

struct SoakScene {
  LiveLens lens = large_lens;
  int hertz = 30;
  int joint_hertz = 100;
  JointFaults joint_faults = {};
  std::uint64_t seed = 0;
};

class SoakPublishers {
 public:
  /// A robot_description and where the camera is are published; start() is for the rest.
  SoakPublishers(int domain, const SoakScene& scene);

  void start(Part part);
  void kill(Part part);

  /// When what a part's process said was heard first, nanoseconds since 1970; nothing: nobody heard
  /// it within 120 s.
  [[nodiscard]] std::optional<std::int64_t> heard(Part part);

  /// Ends a camera's part; how many messages were written since somebody heard one.
  [[nodiscard]] std::size_t end(Part part);

 private:
  [[nodiscard]] std::vector<std::byte> message_of(Part part) const;
  PeerProcess* process(Part part);

  int domain_;
  SoakScene scene_;
  std::unique_ptr<PeerProcess> description_, mount_;
  std::array<std::unique_ptr<PeerProcess>, 4> camera_;
  JointFeed joints_;
};

}  // namespace penumbra::test
