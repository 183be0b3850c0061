// SPDX-License-Identifier: Apache-2.0
// Several cameras in one penumbra live, of another vendor's publishers: one of them compressed, the
// robot where TF says.
#include "../io/live_scene.hpp"
#include "../io/ros_images.hpp"
#include "../support/run_length.hpp"
#include "../support/running_program.hpp"
#include "../support/temporary_folder.hpp"
#include "label_watch.hpp"
#include "listening.hpp"
#include "lone_domain.hpp"
#include "soak_publishers.hpp"

#include <array>
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

class LiveCameras : public testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<PeerProcess> publisher(const std::string& topic,
                                                       const std::string& type,
                                                       bool latched = false) const {
    return make_peer(domain_.id(), {"publish", "rt" + topic, type,
                                    latched ? "reliable,latched,depth=1" : "best_effort"});
  }

  void tell_at(std::int64_t stamp, int tick) {
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(0, 0, 1) * Eigen::AngleAxisd(spin_at(stamp), Eigen::Vector3d::UnitZ());
    tf_->give(encoded(io::TfMessage{{{{stamp, "base"}, "board", pose}}}));
    if (tick % 5 != 0) return;
    const std::int64_t taken = stamp - 5 * milliseconds;
    for (auto& info : infos_) info->give(encoded(live_info(taken)));
    left_->give(live_depth(taken));
    right_->give(encoded(io::CompressedImageMessage{
        {taken, "optical"}, "16UC1; compressedDepth rvl", compressed_wall_}));
  }

  LoneDomain domain_;
  TemporaryFolder folder_;
  const Image<std::uint16_t> wall_{64, 48, 3000};
  const std::vector<std::byte> compressed_wall_ = compressed_depth(wall_, true, 0, 0);
  std::unique_ptr<PeerProcess> description_ =
      publisher("/robot_description", "std_msgs::msg::dds_::String_", true);
  std::unique_ptr<PeerProcess> mount_ =
      publisher("/tf_static", "tf2_msgs::msg::dds_::TFMessage_", true);
  std::unique_ptr<PeerProcess> tf_ = publisher("/tf", "tf2_msgs::msg::dds_::TFMessage_");
  std::array<std::unique_ptr<PeerProcess>, 2> infos_ = {
      publisher("/left/camera_info", "sensor_msgs::msg::dds_::CameraInfo_"),
      publisher("/right/camera_info", "sensor_msgs::msg::dds_::CameraInfo_")};
  std::unique_ptr<PeerProcess> left_ = publisher("/left/depth", "sensor_msgs::msg::dds_::Image_");
  std::unique_ptr<PeerProcess> right_ =
      publisher("/right/depth/compressedDepth", "sensor_msgs::msg::dds_::CompressedImage_");
};

TEST_F(LiveCameras, TwoOfOneRobotByTf) {
  description_->give(encoded(io::StringMessage{live_urdf}));
  mount_->give(encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
  LabelWatch left(domain_.id(), {}, "/penumbra/left/labels");
  LabelWatch right(domain_.id(), {}, "/penumbra/right/labels");
  RunningProgram live(
      {"live", "--domain", std::to_string(domain_.id()), "--camera", "left=/left/depth", "--camera",
       "right=/right/depth/compressedDepth", "--poses", "tf"},
      folder_.path() / "live.log");
  constexpr std::size_t enough = 20;  // known labels; until all topics are found they are unknown
  auto next = std::chrono::steady_clock::now();
  const auto end = next + dds_patience;
  for (int tick = 0; next < end && (left.known_count() < enough || right.known_count() < enough);
       ++tick, next += 10ms) {
    std::this_thread::sleep_until(next);
    tell_at(system_now(), tick);
  }
  EXPECT_EQ(live.end(), 0) << read_bytes(folder_.path() / "live.log");
  for (LabelWatch* watch : {&left, &right}) {
    watch->end();
    const LabelVerdict verdict = watch->judge();
    EXPECT_EQ(verdict.wrong, 0U) << "the first at " << verdict.first_wrong;
    EXPECT_GE(verdict.known, enough);
  }
}

}  // namespace
}  // namespace penumbra::test
