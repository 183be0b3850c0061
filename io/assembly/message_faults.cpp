// SPDX-License-Identifier: Apache-2.0
#include <io/assembly/message_faults.hpp>

namespace penumbra::io {

void MessageFaults::add(const std::string& topic, std::int64_t time, const std::string& what) {
  OfTopic& faults = faults_[topic];
  if (faults.messages++ > 0) return;
  faults.first = time;
  faults.what = what;
}

std::size_t MessageFaults::of(const std::string& topic) const {
  const auto found = faults_.find(topic);
  return found == faults_.end() ? 0 : found->second.messages;
}

}  // namespace penumbra::io
