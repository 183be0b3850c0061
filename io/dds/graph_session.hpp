// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <dds/dds.h>

namespace penumbra::io {

class GraphDomain;

/// A participant of Cyclone DDS and its wait set. Its entities are deleted with it.
class GraphSession {
 public:
  /// Throws InputError if Cyclone DDS refuses its settings or there is no network.
  explicit GraphSession(int domain);
  ~GraphSession();
  GraphSession(const GraphSession&) = delete;
  GraphSession& operator=(const GraphSession&) = delete;

  [[nodiscard]] dds_entity_t participant() const { return participant_; }
  [[nodiscard]] dds_entity_t waitset() const { return waitset_; }
  [[nodiscard]] dds_entity_t waker() const { return waker_; }

 private:
  std::shared_ptr<GraphDomain> domain_;  // shared by all participants of this process
  dds_entity_t participant_ = 0, waitset_ = 0, waker_ = 0;
};

/// Returns the result of a Cyclone DDS function. Throws InputError "WHAT: WHY" if it failed.
dds_entity_t checked(dds_return_t result, const std::string& what);

}  // namespace penumbra::io
