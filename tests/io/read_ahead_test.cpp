// SPDX-License-Identifier: Apache-2.0
#include "../support/test.hpp"

#include <io/inputs/read_ahead.hpp>

namespace penumbra::io {
namespace {

/// Frames 0 to 4, then a file that cannot be read. Alternates between two images, as bags do.
class FiveFrames final : public FrameSource {
 public:
  bool read(std::size_t /*number*/, Frame& frame) override {
    if (count_ == 5) throw InputError("frame 5 cannot be read");
    Image<float>& image = images_[count_ % 2];
    image = Image<float>(4, 3, static_cast<float>(count_));
    frame.index = count_++;
    frame.depth = DepthView(std::as_const(image).view());
    return true;
  }
  [[nodiscard]] std::optional<std::size_t> size() const override { return 6; }
  [[nodiscard]] std::vector<std::string> notes() const override { return {}; }

 private:
  std::size_t count_ = 0;
  std::array<Image<float>, 2> images_;
};

TEST(ReadAhead, ThrowsAFaultAfterTheFramesBeforeIt) {
  ReadAhead source(std::make_unique<FiveFrames>());
  Frame frame;
  for (std::size_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(source.next(frame));
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(std::get<ImageView<const float>>(frame.depth.view)(3, 2), static_cast<float>(i));
  }
  EXPECT_THROW(source.next(frame), InputError);
}

}  // namespace
}  // namespace penumbra::io
