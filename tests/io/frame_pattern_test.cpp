// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <gtest/gtest.h>

#include <io/frame_pattern.hpp>

namespace penumbra::io {
namespace {

std::string expand(const std::string& pattern, std::int64_t index) {
  return FramePattern(pattern, "/r").file(index).string();
}

TEST(FramePattern, PutsTheNumberIn) {
  EXPECT_EQ(expand("depth_%d.png", 0), "/r/depth_0.png");
  EXPECT_EQ(expand("depth_%d.png", 1234567890123), "/r/depth_1234567890123.png");
  EXPECT_EQ(expand("d/%06d.npy", 42), "/r/d/000042.npy");
  EXPECT_EQ(expand("d/%06d.npy", 12345678), "/r/d/12345678.npy");
  EXPECT_EQ(expand("%d/depth.png", 3), "/r/3/depth.png");
  EXPECT_EQ(expand("100%%_%d", 3), "/r/100%_3");
  EXPECT_EQ(expand("/abs/%d.png", 3), "/abs/3.png");
  EXPECT_EQ(FramePattern("%d.png", "/with%d/%s").file(1).string(), "/with%d/%s/1.png");
}

TEST(FramePattern, RefusesEverythingElse) {
  for (const char* pattern : {"depth.png", "", "%", "%d_%d.png", "%s.png", "%n", "%6d.png", "%00d",
                              "%0d", "%010d", "%x", "%06", "%d%", "%-5d", "%%d", "%ld"})
    EXPECT_HAS(test::input_error([&] { FramePattern(pattern, "/r"); }), "exactly one %d or %0Nd")
        << pattern;
}

TEST(FramePattern, KnowsItsExtension) {
  EXPECT_TRUE(FramePattern("%d.npy", "").has_extension(".npy"));
  EXPECT_TRUE(FramePattern("%d.NPY", "").has_extension(".npy"));
  EXPECT_FALSE(FramePattern("%d.npy.png", "").has_extension(".npy"));
  EXPECT_FALSE(FramePattern(".npy%d", "").has_extension(".npy"));
}

}  // namespace
}  // namespace penumbra::io
