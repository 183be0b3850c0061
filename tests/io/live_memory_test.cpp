// SPDX-License-Identifier: Apache-2.0
// The memory of live does not grow with its input: robots and cameras that change, targets with new
// ids, unknown frames of TF, messages that cannot be decoded.
#include "../support/process_memory.hpp"
#include "../support/run_length.hpp"
#include "live_scene.hpp"

#include <iostream>

#include <sys/prctl.h>

namespace penumbra::test {
namespace {

/// The size of the allocator's caches that buffers of a larger robot or image leave behind, MiB. A
/// leak of 100 bytes for each image would be 9 MiB in the long run.
constexpr double memory_slack = 8.0;

class LiveMemory : public testing::Test {
 protected:
  LiveMemory() {
    prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);  // a page of 2 MiB counts whole, whatever is in it
    for (std::size_t i = 0; i < bench_.inbox.topics().size(); ++i)
      if (bench_.inbox.topics()[i].name == "/objects")
        bench_.inbox.set_type(i, "penumbra_msgs/msg/Keypoints");
    bench_.tell_all();
  }

  void judge(std::size_t i) {
    const std::int64_t stamp = start + static_cast<std::int64_t>(i) * image_period;
    if (i % 200 == 0) bench_.tell_robot(robot_);
    if (i % 500 == 499) {
      robot_ = live_urdf;
      robot_.insert(robot_.find("</robot>"), "<!-- " + std::to_string(i) + " -->");
      bench_.tell_robot(robot_);
    }
    if (i % 300 == 299) bench_.tell_info(stamp, i % 600 == 299 ? 61.0 : 60.0);
    if (i % 50 == 0) bench_.publish("/joint_states", std::vector<std::byte>(7));
    const std::string frame = "frame_" + std::to_string(i % names_);
    bench_.publish("/tf", encoded(io::TfMessage{{{{stamp, "base"}, frame}}}));
    bench_.publish("/wrist", live_target(stamp, {1.2, 0.0, 3.0}));
    io::KeypointsMessage points{.header = {stamp, "optical"}};
    points.keypoints.push_back({.name = std::to_string(i), .u = 10, .v = 10, .score = 1});
    bench_.publish("/objects", encoded(points));
    bench_.judge(stamp);
    bench_.results.published.clear();
  }

  LiveBench bench_{LiveBench::one_camera({"/wrist", "/objects"})};
  std::string robot_ = live_urdf;
  /// The number of frames of TF. The long run has more of them than are kept.
  const std::size_t names_ = measures_in_full() ? 2 * io::FrameTree::max_frames : 400;
};

TEST_F(LiveMemory, IsFlat) {
  if (sanitized) GTEST_SKIP() << "sanitizers keep what was freed";
  const std::size_t frames = measures_in_full() ? 100'000 : 5000;
  for (std::size_t i = 0; i < frames / 10; ++i) judge(i);
  const ProcessMemory before = memory_of();
  for (std::size_t i = frames / 10; i < frames; ++i) judge(i);
  const ProcessMemory after = memory_of();
  std::cout << frames << " images: " << before.resident << " MiB after a tenth, " << after.resident
            << " MiB at the end\n";
  EXPECT_LT(after.resident - before.resident, memory_slack);
  EXPECT_EQ(after.open_files, before.open_files);
  EXPECT_GT(bench_.counts().judged, frames * 9 / 10);
}

}  // namespace
}  // namespace penumbra::test
