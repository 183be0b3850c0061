// SPDX-License-Identifier: Apache-2.0
// penumbra live among publishers and a subscriber of another vendor: what it publishes is the truth
// of the stamps, whatever stops and returns.
#include "../io/live_scene.hpp"
#include "../support/run_length.hpp"
#include "../support/temporary_folder.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"
#include "peer_process.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

class LiveAmongVendors : public testing::Test {
 protected:
  LiveAmongVendors() {
    description_->give(encoded(io::StringMessage{live_urdf}));
    mount_->give(encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
  }

  [[nodiscard]] std::unique_ptr<PeerProcess> peer(const std::string& mode, const std::string& topic,
                                                  const std::string& type,
                                                  const std::string& qos) const {
    auto process = std::make_unique<PeerProcess>(
        std::vector<std::string>{std::to_string(domain_.id()), mode, topic, type, qos});
    EXPECT_TRUE(mode != "publish" || process->says("ready"));
    return process;
  }
  [[nodiscard]] std::unique_ptr<PeerProcess> joints() const {
    return peer("publish", "rt/joint_states", "sensor_msgs::msg::dds_::JointState_",
                "reliable,depth=10");
  }

  static std::int64_t now() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  }

  /// A camera at 30 Hz and a robot at 100 Hz, for so long. A robot of null is silent.
  void tell(std::chrono::nanoseconds length, PeerProcess* robot) {
    const auto end = std::chrono::steady_clock::now() + length;
    auto next = std::chrono::steady_clock::now();
    for (int tick = 0; next < end; ++tick, next += 10ms) {
      std::this_thread::sleep_until(next);
      const std::int64_t stamp = now();
      if (robot != nullptr) robot->give(live_joints(stamp));
      if (tick % 3 != 0) continue;
      info_->give(encoded(live_info(stamp - 5 * milliseconds)));
      depth_->give(live_depth(stamp - 5 * milliseconds));
    }
  }

  /// Reads what is published until it ends.
  void listen() {
    reading_ = std::thread([this] {
      while (!ends_)
        if (const auto message = labels_->message()) {
          io::ImageMessage image;
          if (io::Decoder<io::ImageMessage>().decode(*message, image)) continue;
          const std::lock_guard lock(mutex_);
          published_.push_back({io::Result::labels, image.header.stamp, *message});
        }
    });
  }
  void stop_listening() {
    ends_ = true;
    labels_->kill();
    reading_.join();
  }
  std::size_t heard() {
    const std::lock_guard lock(mutex_);
    return published_.size();
  }

  LoneDomain domain_;
  std::unique_ptr<PeerProcess> description_ =
      peer("publish", "rt/robot_description", "std_msgs::msg::dds_::String_",
           "reliable,latched,depth=1");
  std::unique_ptr<PeerProcess> mount_ = peer(
      "publish", "rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", "reliable,latched,depth=1");
  std::unique_ptr<PeerProcess> info_ = peer("publish", "rt/camera/camera_info",
                                            "sensor_msgs::msg::dds_::CameraInfo_", "best_effort");
  std::unique_ptr<PeerProcess> depth_ =
      peer("publish", "rt/camera/depth", "sensor_msgs::msg::dds_::Image_", "best_effort");
  std::unique_ptr<PeerProcess> labels_ = peer(
      "subscribe", "rt/penumbra/labels", "sensor_msgs::msg::dds_::Image_", "reliable,depth=50");
  TemporaryFolder folder_;
  std::thread reading_;
  std::atomic<bool> ends_ = false;
  std::mutex mutex_;
  std::vector<KeptResults::Published> published_;  // guarded by mutex_
};

TEST_F(LiveAmongVendors, PublishesTheTruthThoughTheRobotIsKilledAndReturns) {
  LiveProgram live({"--domain", std::to_string(domain_.id()), "--depth-topic", "/camera/depth",
                    "--summary", folder_.path() / "live.json"});
  listen();
  auto robot = joints();
  // Fast DDS tells of its latched messages every 3 s.
  for (int i = 0; i < 20 && heard() == 0; ++i) tell(500ms, robot.get());
  const std::size_t before = heard();
  tell(2s, robot.get());
  EXPECT_GT(heard(), before + 30);
  robot->kill();
  tell(1500ms, nullptr);
  robot = joints();
  const std::int64_t returned = now();
  // An announcement may get lost, and the next is 3 s later.
  constexpr std::int64_t longest_return = 4 * seconds;
  tell(std::chrono::nanoseconds(longest_return), robot.get());
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(live.end(), 0);
  stop_listening();
  LiveTruth truth;
  EXPECT_GT(expect_true_labels(published_, truth), 60U);
  const auto known =
      std::find_if(published_.begin(), published_.end(), [&](const KeptResults::Published& one) {
        return one.stamp > returned && expect_true_labels({one}, truth) == 1;
      });
  ASSERT_NE(known, published_.end());
  EXPECT_LT(known->stamp - returned, longest_return);
  std::cout << "known again after " << (known->stamp - returned) / milliseconds << " ms\n";
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "live.json"));
}

}  // namespace
}  // namespace penumbra::test
