// SPDX-License-Identifier: Apache-2.0
// What belongs to one image: of its stamp, and of one program.
#include "../io/live_scene.hpp"

#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <io/web/live_matcher.hpp>

namespace penumbra::test {
namespace {

using nlohmann::json;

constexpr std::int64_t start = 10 * seconds;
constexpr std::uint64_t one = 71, other = 72;  // programs

class LiveMatcherTest : public testing::Test {
 protected:
  LiveMatcherTest() {
    bench_.tell_all();
    bench_.tell_joints(start - 10 * milliseconds);
    bench_.tell_joints(start + 10 * milliseconds);
    bench_.tell_depth(start);
    io::LiveJob job;
    EXPECT_TRUE(bench_.inbox.next(0, bench_.now, true, job));
    matcher_.add(std::move(job));
  }

  void add_targets(std::uint64_t program) {
    matcher_.add(io::TargetsMessage{.header = {start, "optical"}, .status = "ok"}, program);
  }
  /// All of one value; of an encoding that no labels have: they cannot be read.
  void add_labels(std::uint64_t program, std::uint8_t value, const char* encoding = "8UC1") {
    const Image<std::uint8_t> labels(64, 48, value);
    matcher_.add(io::Result::labels,
                 io::keep_image(io::image_message(io::MessageHeader{start, "optical"}, encoding,
                                                  labels.view())),
                 program);
  }
  std::shared_ptr<io::LiveFrame> take() { return matcher_.take({}, bench_.now); }

  LiveBench bench_;
  io::LiveMatcher matcher_;
};

TEST_F(LiveMatcherTest, LabelsOfOneProgramNeverComeWithTargetsOfAnother) {
  add_labels(one, 1);
  add_targets(other);
  EXPECT_EQ(take(), nullptr);
  add_labels(other, 2);
  const auto frame = take();
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->part(io::Part::labels)->bytes->front(), '\x02');
}

TEST_F(LiveMatcherTest, PixelsOfLabelsThatCannotBeReadAreNotKnown) {
  add_targets(one);
  add_labels(one, 2, "mono8");
  const auto frame = take();
  ASSERT_NE(frame, nullptr);
  const json report = json::parse(frame->report());
  for (const auto& [name, count] : report["pixels"].items()) EXPECT_EQ(count, nullptr) << name;
}

TEST_F(LiveMatcherTest, PixelsAreCounted) {
  add_targets(one);
  add_labels(one, 2);
  const json report = json::parse(take()->report());
  EXPECT_EQ(report["pixels"]["occluded"], 64 * 48);
  EXPECT_EQ(report["pixels"]["front"], 0);
}

}  // namespace
}  // namespace penumbra::test
