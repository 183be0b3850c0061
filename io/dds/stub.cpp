// SPDX-License-Identifier: Apache-2.0
// Replaces DDS in builds without it.
#include <penumbra/base/error.hpp>

#include <io/dds/participant.hpp>

namespace penumbra::io {

bool has_dds() { return false; }

std::unique_ptr<Participant> join_graph(const ParticipantOptions&) {
  throw InputError(
      "this build has no DDS, and so no ROS 2 graph: install cyclonedds-dev and nettle-dev and "
      "build Penumbra "
      "again with -DPENUMBRA_WITH_DDS=ON");
}

}  // namespace penumbra::io
