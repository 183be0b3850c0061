// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace penumbra::io {

/// Counts unusable messages by topic and keeps the fault of the first one.
class MessageFaults {
 public:
  struct OfTopic {
    std::size_t messages = 0;
    std::int64_t first = 0;  ///< time of the first one, nanoseconds of the caller's clock
    std::string what;        ///< fault of the first one, one line
  };

  void add(const std::string& topic, std::int64_t time, const std::string& what);

  [[nodiscard]] const std::map<std::string, OfTopic>& all() const { return faults_; }
  [[nodiscard]] std::size_t of(const std::string& topic) const;

 private:
  std::map<std::string, OfTopic> faults_;
};

}  // namespace penumbra::io
