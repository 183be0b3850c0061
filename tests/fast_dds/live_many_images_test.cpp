// SPDX-License-Identifier: Apache-2.0
#include "../support/run_length.hpp"
#include "live_soak.hpp"

#include <iostream>
#include <thread>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

/// Small images as fast as they go, among robots, cameras and targets that change.
class LiveManyImagesFull : public LiveSoak {
 protected:
  void tell_changes(int round) {
    const bool other = round / 100 % 2 == 1;
    // Of no image's stamp: else all would wait for their own.
    info_->give(encoded(live_info(1, {.focal = other ? 61.0 : 60.0})));
    io::PoseStampedMessage target{.header = {system_now(), "optical"}};
    target.pose.translation() = Eigen::Vector3d(1.2, 0.0, 3.0);
    target_->give(encoded(target));
    if (round % 50 != 0) return;
    std::string urdf = live_urdf;
    urdf.insert(urdf.find("</robot>"), "<!-- " + std::to_string(round / 100) + " -->");
    publishers_->tell_robot(urdf);
  }
  /// Until so many labels were heard.
  void tell_until(std::size_t labels, int& round) {
    const auto end = std::chrono::steady_clock::now() + longest_;
    for (; labels_->count() < labels; ++round) {
      ASSERT_LT(std::chrono::steady_clock::now(), end) << labels_->count() << " labels";
      tell_changes(round);
      std::this_thread::sleep_for(100ms);
    }
  }

  static constexpr auto longest_ = 600s;
  std::unique_ptr<PeerProcess> info_, target_;
};

TEST_F(LiveManyImagesFull, TakeNoMemory) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  constexpr std::size_t warm_up = 50'000, images = 100'000;
  constexpr double slack = 4.0;  // MiB: of the allocator's caches; 100 bytes an image would be 9
  constexpr double most = 64.0;  // MiB: 45 are usual
  SoakScene scene{.lens = {}, .hertz = 1000, .joint_hertz = 1000};
  publishers_ = std::make_unique<SoakPublishers>(domain_.id(), scene);
  labels_ = std::make_unique<LabelWatch>(domain_.id(), scene.lens);
  info_ = make_peer(domain_.id(), {"publish", "rt" + topic_of(Part::depth_info),
                                   "sensor_msgs::msg::dds_::CameraInfo_", "reliable,depth=5"});
  target_ = make_peer(domain_.id(), {"publish", "rt/wrist",
                                     "geometry_msgs::msg::dds_::PoseStamped_", "reliable,depth=5"});
  live_ = std::make_unique<LiveProgram>(
      std::vector<std::string>{"--domain", std::to_string(domain_.id()), "--depth-topic",
                               topic_of(Part::depth), "--target-topic", "/wrist", "--summary",
                               folder_.path() / "live.json"},
      folder_.path() / "live.log");
  publishers_->start(Part::depth);
  publishers_->start(Part::joints);
  int round = 0;
  // Histories of 10 s fill first, and keep up to twice as much until they are pruned.
  ASSERT_NO_FATAL_FAILURE(tell_until(warm_up, round));
  before_ = live_->usage();
  ASSERT_NO_FATAL_FAILURE(tell_until(warm_up + images, round));
  after_ = live_->usage();
  EXPECT_EQ(live_->end(), 0) << read_bytes(folder_.path() / "live.log");
  labels_->end();
  summary_ = Json::parse(read_bytes(folder_.path() / "live.json"));
  expect_all_accounted();
  std::cout << table("100000 small images, behind 50000 others").text() << "| robots | "
            << summary_["robots"] << " |\n| changes of camera_info | "
            << camera()["camera_info_changes"] << " |\n";
  EXPECT_LT(after_.memory.resident - before_.memory.resident, slack);
  EXPECT_LT(after_.memory.resident, most);
  EXPECT_EQ(after_.memory.open_files, before_.memory.open_files);
}

}  // namespace
}  // namespace penumbra::test
