// SPDX-License-Identifier: Apache-2.0
// Bags whose camera_info changes on the way, comes late or not at all.
#include "fixtures.hpp"

#include <cstdint>

namespace penumbra::test {
namespace {

using BagInfosTest = BagTest;

/// Also where it is recorded 120 ms after the image, when the image's pose has long been known.
TEST_F(BagInfosTest, AnotherCamerasInfoIsNotTaken) {
  int info = 0;
  bag_.edit<io::CameraInfoMessage>("/camera/depth/camera_info", [&](auto& camera) {
    if (++info == 2) camera.k[0] = 61;
  });
  for (const std::int64_t delay : {0, 120'000'000}) {
    for (TinyBag::Message& message : bag_.messages)
      if (message.topic == "/camera/depth/camera_info") message.log_time += delay;
    succeed(run());
    EXPECT_EQ(statuses(), (Words{"ok", "bad_depth", "ok"}));
  }
}

struct DriverCase {
  const char* why;
  std::string script, statuses;  ///< `o`: ok, `b`: bad_depth; `x`: anything but ok
};

/// A bag whose images come quickly, with what their driver says of the camera.
class BagDrivers : public BagTest, public testing::WithParamInterface<DriverCase> {
 protected:
  static constexpr std::int64_t period = 50'000'000;

  BagDrivers() {
    for (const TinyBag::Message& message : bag_.messages) {
      if (message.topic == depth && depth_.empty()) depth_ = message.data;
      if (message.topic == info && info_.empty()) info_ = message.data;
    }
    for (const char* const topic : {depth, info, "/camera/color/image_raw/compressed"})
      bag_.remove(topic);
  }

  /// Each letter is an image: `f` comes with the first camera's info, `o` with another's, `-` with
  /// none; `<` sets the clock back.
  void play(const std::string& script) {
    for (const char letter : script) letter == '<' ? jump_back(1'100'000'000) : add(letter);
  }

  /// One image, `period` after the one before.
  void add(char driver) {
    stamp_ += period;
    auto camera = decoded<io::CameraInfoMessage>(info_);
    camera.header.stamp = stamp_;
    if (driver == 'o') camera.k[0] = 61;
    if (driver != '-') bag_.add(info, stamp_ + lap_, camera);
    auto image = decoded<io::ImageMessage>(depth_);
    image.header.stamp = stamp_;
    bag_.add(depth, stamp_ + lap_, image);
  }

  /// The clock of all is set back, once; the recorder's goes on.
  void jump_back(std::int64_t by) {
    const std::int64_t end = stamp_ + 40'000'000;  // of the joint states around the last image
    std::vector<TinyBag::Message> later = bag_.messages;
    std::erase_if(bag_.messages, [&](const TinyBag::Message& message) {
      return message.topic == "/joint_states" && message.log_time > end;
    });
    for (TinyBag::Message& message : later) {
      message.log_time += by;
      if (message.topic == "/joint_states" && message.log_time > end)
        bag_.messages.push_back(std::move(message));
    }
    stamp_ -= by;
    lap_ = by;
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

TEST_P(BagDrivers, EachImageIsJudgedByItsOwnCameraOrNot) {
  play(GetParam().script);
  bag_.sort();
  succeed(run());
  std::string all;
  for (const std::string& status : statuses()) all += status.at(0);
  ASSERT_EQ(all.size(), GetParam().statuses.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const char wanted = GetParam().statuses[i];
    const bool is_right = wanted == '?' || (wanted == 'x' ? all[i] != 'o' : all[i] == wanted);
    EXPECT_TRUE(is_right) << GetParam().why << ": image " << i << " of " << all;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BagDrivers,
    testing::Values(
        DriverCase{"a recorder hears another camera's topic some images late", "ffff--ooo",
                   "oooobbbbb"},
        DriverCase{"the first camera comes again", "ffffooo--fff", "oooobbbbbooo"},
        DriverCase{"infos come seldom: the last holds until the next", "f---------o----",
                   "oooooobbbbbbbbb"},  // 0.2 s is what an image waits for its own
        DriverCase{"another camera behind a jump", std::string(18, 'f') + "oooo<ooooffff",
                   std::string(18, '?') + "bbbbxxxxoooo"},
        DriverCase{"an info that was told once holds behind a jump",
                   "f" + std::string(20, '-') + "o<--------", std::string(22, '?') + "xxxxxxxx"},
        DriverCase{"between two cameras, over a jump", std::string(20, 'f') + "oooo<---ffff",
                   std::string(24, '?') + "xxxoooo"}),
    [](const auto& test) { return "case" + std::to_string(test.index); });

}  // namespace
}  // namespace penumbra::test
