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

/// Names for the publishers of joint states and transforms, as far as messages identify them: by
/// the publisher's number, which a graph knows and a bag does not, and for joint states by the
/// frame, the joints in their order, and whether there are velocities and efforts.
class MessageSources {
 public:
  static constexpr std::size_t most = 1024;  ///< that are remembered

  /// `publisher`: a number that is no other one's on the topic; 0: not known. The name is valid
  /// until the next call.
  const std::string& of_joints(const std::string& topic, std::uint64_t publisher,
                               const JointStateMessage& state);
  const std::string& of_transforms(const std::string& topic, std::uint64_t publisher);

 private:
  std::string name_of(const std::string& topic, std::uint64_t publisher);
  const std::string& keep(std::uint64_t key, std::string name);

  std::map<std::uint64_t, std::string> names_;  // by what sets them apart
  std::set<std::string> used_;
  std::map<std::pair<std::string, std::uint64_t>, std::size_t> publishers_;  // as they came
  std::map<std::string, std::size_t> counts_;                                // of publishers
};

}  // namespace penumbra::io
