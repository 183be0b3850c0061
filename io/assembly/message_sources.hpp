// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Names the publishers of joint states and transforms. A publisher is identified by its number,
/// which a graph has and a bag does not, and for joint states by the frame, the order of the
/// joints, and the presence of velocities and efforts.
class MessageSources {
 public:
  static constexpr std::size_t most = 1024;  ///< largest number of names kept

  /// `publisher`: a unique number on the topic, or 0 if not known. The name is valid until the next
  /// call.
  const std::string& of_joints(const std::string& topic, std::uint64_t publisher,
                               const JointStateMessage& state);
  const std::string& of_transforms(const std::string& topic, std::uint64_t publisher);

 private:
  std::string name_of(const std::string& topic, std::uint64_t publisher);
  const std::string& keep(const std::string& key, std::string name);

  std::map<std::string, std::string> names_;  // by the identifying fields
  std::set<std::string> used_;
  std::map<std::pair<std::string, std::uint64_t>, std::size_t> publishers_;  // in order
  std::map<std::string, std::size_t> counts_;                                // number of publishers
};

}  // namespace penumbra::io
