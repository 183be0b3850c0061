// SPDX-License-Identifier: Apache-2.0
// A bag that the reference library wrote, against the recording folder that holds the same frames.
// The arm moves through every frame, and images are recorded 30 ms after their stamps.
#include "../support/data.hpp"
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

constexpr int bag_frames = 10;

/// Share of the robot's pixels whose labels may differ: the contract of `run`. Positions are
/// interpolated between states of a smooth path.
constexpr double differing_share = 1e-3;

/// Of each frame, how many labels differ, by the robot's pixels in `wanted`.
std::vector<double> differing(const fs::path& labels, const fs::path& wanted) {
  std::vector<double> shares;
  for (int i = 0; i < bag_frames; ++i) {
    const std::string file = "labels/00000" + std::to_string(i) + ".png";
    Image<std::uint8_t> a, b;
    io::read_png(labels / file, a).require();
    io::read_png(wanted / file, b).require();
    if (a.size() != b.size()) return {};
    std::size_t robot = 0, differ = 0;
    for (std::size_t p = 0; p < b.size(); ++p) {
      if (b.data()[p] != 0) ++robot;
      if (a.data()[p] != b.data()[p]) ++differ;
    }
    shares.push_back(static_cast<double>(differ) / static_cast<double>(robot));
  }
  return shares;
}

class RealBag : public testing::Test {
 protected:
  void run(const fs::path& input, const std::string& name, std::vector<std::string> options = {}) {
    options.insert(options.begin(),
                   {"run", input, "-o", folder_.path() / name, "--save", "labels"});
    const Outcome outcome = penumbra(options);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
  }
  [[nodiscard]] std::vector<std::string> package() const {
    return {"--package",
            "xarm_description=" + (data_folder() / "robots/xarm7/xarm_description").string()};
  }

  TemporaryFolder folder_;
  fs::path recording_ = data_folder() / "xarm7_realsense";
};

TEST_F(RealBag, GivesTheLabelsOfTheRecording) {
  PENUMBRA_REQUIRE_DATA();
  ASSERT_NO_FATAL_FAILURE(run(recording_, "wanted"));
  ASSERT_NO_FATAL_FAILURE(run(recording_ / "xarm7.mcap", "bag", package()));
  const auto shares = differing(folder_.path() / "bag", folder_.path() / "wanted");
  ASSERT_EQ(shares.size(), 10U);
  for (const double share : shares) EXPECT_LT(share, differing_share);
}

}  // namespace
}  // namespace penumbra::test
