// SPDX-License-Identifier: Apache-2.0
#include "../support/test.hpp"

#include <penumbra/base/simd_target.hpp>

namespace penumbra::test {
namespace {

TEST(SimdTarget, NamesAreDistinctAndLeadBackToThemselves) {
  auto names = simd_target_names();
  ASSERT_FALSE(names.empty());
  for (const auto& name : names) EXPECT_EQ(simd_target_name(simd_target(name)), name);
  EXPECT_EQ(simd_target(""), simd_target(names.front()));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

TEST(SimdTarget, UnknownNameIsAnErrorThatListsTheTargets) {
  const std::string message = message_of([] { (void)simd_target("AVX9"); });
  EXPECT_TRUE(holds(message, "'AVX9'"));
  for (const auto& name : simd_target_names()) EXPECT_TRUE(holds(message, name));
}

}  // namespace
}  // namespace penumbra::test
