// SPDX-License-Identifier: Apache-2.0
// Several cameras in one penumbra live, of another vendor's publishers: one of them compressed, the
// robot where TF says.
#include "../io/live_scene.hpp"
#include "../io/ros_images.hpp"
#include "../support/run_length.hpp"
#include "../support/temporary_folder.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"
#include "soak_publishers.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

/// What another vendor's subscriber hears of a camera's labels.
class HeardCamera {
 public:
  HeardCamera(int domain, const std::string& name)
      : process_(make_peer(domain, {"subscribe", "rt/penumbra/" + name + "/labels",
                                    "sensor_msgs::msg::dds_::Image_", "reliable,depth=50"})),
        thread_([this] { read(); }) {}
  ~HeardCamera() { end(); }
  HeardCamera(const HeardCamera&) = delete;
  HeardCamera& operator=(const HeardCamera&) = delete;

  void end() {
    if (!thread_.joinable()) return;
    ends_ = true;
    process_->kill();
    thread_.join();
  }
  std::vector<KeptResults::Published> published() {
    const std::lock_guard lock(mutex_);
    return published_;
  }

 private:
  void read() {
    while (!ends_) {
      auto message = process_->message();
      io::ImageMessage image;
      if (!message || io::Decoder<io::ImageMessage>().decode(*message, image)) continue;
      const std::lock_guard lock(mutex_);
      published_.push_back({io::Result::labels, image.header.stamp, std::move(*message)});
    }
  }

  std::unique_ptr<PeerProcess> process_;
  std::mutex mutex_;
  std::vector<KeptResults::Published> published_;  // guarded by mutex_
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

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
  HeardCamera left(domain_.id(), "left"), right(domain_.id(), "right");
  LiveProgram live({"--domain", std::to_string(domain_.id()), "--camera", "left=/left/depth",
                    "--camera", "right=/right/depth/compressedDepth", "--poses", "tf"},
                   folder_.path() / "live.log");
  constexpr std::size_t enough = 15;  // true labels; until all topics are found they are unknown
  LiveTruth truth;
  std::array<std::size_t, 2> known{};
  auto next = std::chrono::steady_clock::now();
  const auto end = next + 20s;
  for (int tick = 0; next < end && (known[0] < enough || known[1] < enough); ++tick, next += 10ms) {
    std::this_thread::sleep_until(next);
    tell_at(system_now(), tick);
    if (tick % 50 == 0)
      known = {expect_true_labels(left.published(), truth),
               expect_true_labels(right.published(), truth)};
  }
  EXPECT_EQ(live.end(), 0) << read_bytes(folder_.path() / "live.log");
  left.end();
  right.end();
  EXPECT_GE(expect_true_labels(left.published(), truth), enough);
  EXPECT_GE(expect_true_labels(right.published(), truth), enough);
}

}  // namespace
}  // namespace penumbra::test
