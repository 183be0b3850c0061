// SPDX-License-Identifier: Apache-2.0
#include <hwy/targets.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>

namespace penumbra {

namespace {

/// Of this build and this machine, the best first: Highway gives better targets lower bits.
std::vector<std::int64_t> usable_targets() {
  auto targets = hwy::SupportedAndGeneratedTargets();
  // Highway misses NEON on processors without AES (Raspberry Pi 4), which nothing here needs.
  if (HWY_ARCH_ARM && targets.empty()) targets.push_back(HWY_STATIC_TARGET);
  return targets;
}

}  // namespace

std::vector<std::string> simd_target_names() {
  std::vector<std::string> names;
  for (const std::int64_t target : usable_targets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

std::int64_t simd_target(std::string_view name) {
  const auto targets = usable_targets();
  for (const std::int64_t target : targets)
    if (name.empty() || name == hwy::TargetName(target)) return target;
  std::string message = "unknown isa '" + std::string(name) + "'; this machine has";
  for (const std::int64_t target : targets) message += std::string(" ") + hwy::TargetName(target);
  throw InputError(message);
}

std::string simd_target_name(std::int64_t target) { return hwy::TargetName(target); }

}  // namespace penumbra
