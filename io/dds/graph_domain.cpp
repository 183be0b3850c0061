// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include <penumbra/base/error.hpp>

#include <io/dds/participant.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::io {
namespace {

constexpr int last_domain = 232;  // the ports of higher domains exceed 16 bits

[[noreturn]] void refuse_domain(const std::string& what) {
  throw InputError(what + ": is not a DDS domain; expected a whole number from 0 to " +
                   std::to_string(last_domain));
}

}  // namespace

int graph_domain(const ParticipantOptions& options) {
  if (options.domain) {
    if (*options.domain < 0 || *options.domain > last_domain)
      refuse_domain("domain " + std::to_string(*options.domain));
    return *options.domain;
  }
  const char* const given = std::getenv("ROS_DOMAIN_ID");
  if (given == nullptr || *given == '\0') return 0;
  const auto domain = parse_number<int>(given);
  if (!domain || *domain < 0 || *domain > last_domain)
    refuse_domain("ROS_DOMAIN_ID='" + std::string(given) + "'");
  return *domain;
}

}  // namespace penumbra::io
