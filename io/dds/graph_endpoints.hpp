// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <dds/dds.h>

#include <io/dds/participant.hpp>

namespace penumbra::io {

/// Reads the endpoints of all participants from discovery.
class GraphEndpoints {
 public:
  explicit GraphEndpoints(dds_entity_t participant);

  [[nodiscard]] std::vector<GraphTopic> topics() const;

 private:
  dds_guid_t own_{};
  dds_entity_t participants_ = 0, publications_ = 0, subscriptions_ = 0;  // readers
};

}  // namespace penumbra::io
