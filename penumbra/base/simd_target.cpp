// SPDX-License-Identifier: Apache-2.0
#include <hwy/targets.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>

namespace penumbra {

std::vector<std::string> simd_target_names() {
  std::vector<std::string> names;  // Highway gives better targets lower bits
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

std::int64_t simd_target(std::string_view name) {
  const auto targets = hwy::SupportedAndGeneratedTargets();
  for (const std::int64_t target : targets)
    if (name.empty() || name == hwy::TargetName(target)) return target;
  std::string message = "unknown isa '" + std::string(name) + "'; this machine has";
  for (const std::int64_t target : targets) message += std::string(" ") + hwy::TargetName(target);
  throw InputError(message);
}

std::string simd_target_name(std::int64_t target) { return hwy::TargetName(target); }

}  // namespace penumbra
