// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>

namespace penumbra {
namespace {

TEST(SimdTarget, NamesAreDistinctAndLeadBackToThemselves) {
  auto names = simd_target_names();
  ASSERT_FALSE(names.empty());
  for (const auto& name : names) EXPECT_EQ(simd_target_name(simd_target(name)), name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

TEST(SimdTarget, NoNameIsTheFirst) {
  EXPECT_EQ(simd_target(""), simd_target(simd_target_names().front()));
}

TEST(SimdTarget, UnknownNameIsAnErrorThatListsTheTargets) {
  try {
    static_cast<void>(simd_target("AVX9"));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'AVX9'"), std::string::npos) << error.what();
    for (const auto& name : simd_target_names())
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace penumbra
