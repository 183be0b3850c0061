// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>

#include <io/inputs/read_ahead.hpp>

namespace penumbra::io::test {
namespace {

/// Frames 0 to 4, then a file that cannot be read. Alternates between two images, as bags do.
class FiveFrames final : public FrameSource {
 public:
  bool read(std::size_t /*number*/, Frame& frame) override {
    if (count_ == ends_at_) return false;
    if (count_ == 5) throw InputError("frame 5 cannot be read");
    Image<float>& image = images_[count_ % 2];
    image = Image<float>(4, 3, static_cast<float>(count_));
    frame.index = count_++;
    frame.depth = DepthView(std::as_const(image).view());
    return true;
  }
  [[nodiscard]] std::optional<std::size_t> size() const override { return 6; }
  [[nodiscard]] std::vector<std::string> notes() const override {
    return {std::to_string(count_) + " frames read"};
  }
  explicit FiveFrames(std::size_t ends_at) : ends_at_(ends_at) {}

 private:
  std::size_t count_ = 0, ends_at_;
  std::array<Image<float>, 2> images_;
};

TEST(ReadAhead, GivesFramesInOrderWithTheirImages) {
  ReadAhead source(std::make_unique<FiveFrames>(5));
  Frame frame;
  for (std::size_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(source.next(frame));
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(std::get<ImageView<const float>>(frame.depth.view)(3, 2), static_cast<float>(i));
  }
  EXPECT_FALSE(source.next(frame));
  EXPECT_EQ(source.notes(), std::vector<std::string>{"5 frames read"});
}

TEST(ReadAhead, ThrowsAFaultAfterTheFramesBeforeIt) {
  ReadAhead source(std::make_unique<FiveFrames>(9));
  Frame frame;
  for (std::size_t i = 0; i < 5; ++i) ASSERT_TRUE(source.next(frame));
  EXPECT_THROW(source.next(frame), InputError);
}

TEST(ReadAhead, CanBeLeftWhileItReads) {
  ReadAhead source(std::make_unique<FiveFrames>(9));
  Frame frame;
  ASSERT_TRUE(source.next(frame));
  EXPECT_EQ(source.notes(), std::vector<std::string>{"2 frames read"});
}

}  // namespace
}  // namespace penumbra::io::test
