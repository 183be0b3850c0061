// SPDX-License-Identifier: Apache-2.0
// Bags whose camera_info changes on the way, comes late or not at all.
#include "bag_fixture.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

class BagInfosTest : public BagTest {};

TEST_F(BagInfosTest, AnotherCamerasInfoIsNotTaken) {
  int info = 0;
  bag_.edit<io::CameraInfoMessage>("/camera/depth/camera_info", [&](auto& camera) {
    if (++info == 2) camera.k[0] = 61;
  });
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(status(0), "ok");
  EXPECT_EQ(status(1), "bad_depth");
  EXPECT_EQ(status(2), "ok");
}

/// Recorded 120 ms after the image, when the image's pose has long been known.
TEST_F(BagInfosTest, AnotherCamerasInfoIsNotTakenWhenItComesLate) {
  int info = 0;
  bag_.edit<io::CameraInfoMessage>("/camera/depth/camera_info", [&](auto& camera) {
    if (++info == 2) camera.k[0] = 61;
  });
  for (TinyBag::Message& message : bag_.messages)
    if (message.topic == "/camera/depth/camera_info") message.log_time += 120'000'000;
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(status(0), "ok");
  EXPECT_EQ(status(1), "bad_depth");
  EXPECT_EQ(status(2), "ok");
}

/// Where camera_infos come with images, one whose own is not there may be of another camera.
TEST_F(BagInfosTest, AnImageWithoutItsOwnCameraInfoIsNotJudgedByAnotherOnes) {
  std::vector<TinyBag::Message> kept;
  int info = 0;
  for (TinyBag::Message& message : bag_.messages)
    if (message.topic != "/camera/depth/camera_info" || ++info <= 2) kept.push_back(message);
  bag_.messages = std::move(kept);
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(status(0), "ok");
  EXPECT_EQ(status(1), "ok");
  EXPECT_EQ(status(2), "bad_depth");
  EXPECT_NE(report()["frames"][2]["message"].get<std::string>().find("its camera_info did not"),
            std::string::npos);
}

/// One for all, as of a driver that latches it.
TEST_F(BagInfosTest, OneCameraInfoHoldsForAllImages) {
  std::vector<TinyBag::Message> kept;
  int info = 0;
  for (TinyBag::Message& message : bag_.messages)
    if (message.topic != "/camera/depth/camera_info" || ++info <= 1) kept.push_back(message);
  bag_.messages = std::move(kept);
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const std::size_t frame : {0U, 1U, 2U}) EXPECT_EQ(status(frame), "ok");
}

/// A bag whose images come quickly, with what their driver says of the camera.
class BagDriversTest : public BagTest {
 protected:
  enum class Driver { silent, first, other };
  static constexpr std::int64_t period = 50'000'000;

  BagDriversTest() {
    for (const TinyBag::Message& message : bag_.messages) {
      if (message.topic == depth && depth_.empty()) depth_ = message.data;
      if (message.topic == info && info_.empty()) info_ = message.data;
    }
    for (const char* const topic : {depth, info, "/camera/color/image_raw/compressed"})
      bag_.remove(topic);
  }

  /// One image, `period` after the one before.
  void add(Driver driver) {
    stamp_ += period;
    tell(driver);
    auto image = decoded<io::ImageMessage>(depth_);
    image.header.stamp = stamp_;
    bag_.add(depth, stamp_ + lap_, image);
  }
  void tell(Driver driver) {
    if (driver == Driver::silent) return;
    auto camera = decoded<io::CameraInfoMessage>(info_);
    camera.header.stamp = stamp_;
    if (driver == Driver::other) camera.k[0] = 61;
    bag_.add(info, stamp_ + lap_, camera);
  }
  void add(Driver driver, int images) {
    for (int i = 0; i < images; ++i) add(driver);
  }

  /// The clock of all is set back, once; the recorder's goes on.
  void jump_back(std::int64_t by) {
    const std::int64_t end = stamp_ + 40'000'000;  // of the joint states around the last image
    std::vector<TinyBag::Message> kept;
    for (const bool again : {false, true})
      for (TinyBag::Message message : bag_.messages) {
        const bool is_joints = message.topic == "/joint_states";
        if (again) message.log_time += by;
        const bool is_kept =
            again ? is_joints && message.log_time > end : !is_joints || message.log_time <= end;
        if (is_kept) kept.push_back(std::move(message));
      }
    bag_.messages = std::move(kept);
    stamp_ -= by;
    lap_ = by;
  }

  /// The first letter of each frame's status.
  std::string statuses() {
    std::stable_sort(bag_.messages.begin(), bag_.messages.end(),
                     [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
    const Outcome outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::string all;
    const Json told = report();
    for (const Json& frame : told["frames"]) all += std::string(frame["status"]).at(0);
    return all;
  }

 private:
  template <typename M>
  static M decoded(const std::vector<std::byte>& data) {
    M message;
    const auto fault = io::Decoder<M>().decode(data, message);
    EXPECT_FALSE(fault) << *fault;
    return message;
  }

  static constexpr const char* depth = "/camera/depth/image_rect_raw";
  static constexpr const char* info = "/camera/depth/camera_info";
  std::vector<std::byte> depth_, info_;
  std::int64_t stamp_ = tiny_stamp(0) - period;
  std::int64_t lap_ = 0;  // by how much the recorder's clock is ahead
};

/// A recorder hears a topic that appears anew some images late.
TEST_F(BagDriversTest, ImagesBeforeTheFirstInfoOfAnotherCameraAreItsImages) {
  add(Driver::first, 4);
  add(Driver::silent, 2);
  add(Driver::other, 3);
  EXPECT_EQ(statuses(), "oooobbbbb");
}

TEST_F(BagDriversTest, ImagesBeforeTheFirstCamerasInfoAgainMayBeOfTheOther) {
  add(Driver::first, 4);
  add(Driver::other, 3);
  add(Driver::silent, 2);
  add(Driver::first, 3);
  EXPECT_EQ(statuses(), "oooobbbbbooo");
}

TEST_F(BagDriversTest, WhereInfosComeSeldomTheLastHoldsUntilTheNext) {
  add(Driver::first, 1);
  add(Driver::silent, 9);
  add(Driver::other, 1);
  add(Driver::silent, 4);
  EXPECT_EQ(statuses(),
            "oooooo"
            "bbbb"
            "bbbbb")
      << "0.2 s is what an image waits for its own";
}

TEST_F(BagDriversTest, AnotherCameraIsAnotherAfterAJumpOfTheClockToo) {
  add(Driver::first, 18);
  add(Driver::other, 4);
  jump_back(1'100'000'000);
  add(Driver::other, 4);
  add(Driver::first, 4);
  const std::string all = statuses();
  EXPECT_EQ(all.substr(18, 4), "bbbb");
  EXPECT_EQ(all.substr(22, 4).find('o'), std::string::npos) << all;
  EXPECT_EQ(all.substr(26), "oooo") << all;
}

TEST_F(BagDriversTest, AnInfoThatIsToldOnceHoldsAfterAJumpOfTheClock) {
  add(Driver::first, 1);
  add(Driver::silent, 20);
  add(Driver::other, 1);
  jump_back(1'100'000'000);
  add(Driver::silent, 8);
  EXPECT_EQ(statuses().substr(22).find('o'), std::string::npos);
}

TEST_F(BagDriversTest, InfosFromBeforeAJumpOfTheClockAreNotOfImagesAfterIt) {
  add(Driver::first, 24);
  jump_back(1'100'000'000);
  add(Driver::silent, 6);
  add(Driver::other, 4);
  EXPECT_EQ(statuses().substr(24).find('o'), std::string::npos);
}

TEST_F(BagDriversTest, ImagesBetweenTwoCamerasMayBeOfTheOtherOverAJumpOfTheClockToo) {
  add(Driver::first, 20);
  add(Driver::other, 4);
  jump_back(1'100'000'000);
  add(Driver::silent, 3);
  add(Driver::first, 4);
  const std::string all = statuses();
  EXPECT_EQ(all.substr(24, 3).find('o'), std::string::npos) << all;
  EXPECT_EQ(all.substr(27), "oooo") << all;
}

}  // namespace
}  // namespace penumbra::test
