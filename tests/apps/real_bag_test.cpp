// SPDX-License-Identifier: Apache-2.0
// A bag that the reference library wrote, against the recording folder that holds the same frames.
// The arm moves through every frame, and images are recorded 30 ms after their stamps.
#include "../support/data.hpp"
#include "program.hpp"

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <io/bag/bag_reader.hpp>
#include <io/files/png.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

constexpr int frames = 10;

/// Share of the robot's pixels whose labels may differ: the contract of `run`. Positions are
/// interpolated between states of a smooth path.
constexpr double differing_share = 1e-3;

/// Of each frame, how many labels differ, by the robot's pixels in `wanted`.
std::vector<double> differing(const fs::path& labels, const fs::path& wanted) {
  std::vector<double> shares;
  for (int i = 0; i < frames; ++i) {
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

  /// joint_states.csv of a reader that takes, as each depth image comes, the latest joint state.
  [[nodiscard]] std::string latest_joint_states() const {
    const auto bag = io::open_bag(recording_ / "xarm7.mcap");
    const io::Decoder<io::JointStateMessage> decoder;
    io::JointStateMessage latest;
    std::ostringstream csv;
    csv.precision(17);
    int frame = 0;
    for (io::BagMessage message; bag->next(message);) {
      const std::string& topic = bag->topics()[message.topic].name;
      if (topic == "/joint_states" && decoder.decode(message.data, latest)) return "";
      if (topic != "/camera/aligned_depth_to_color/image_raw") continue;
      if (frame == 0) {
        csv << "frame";
        for (const std::string& name : latest.names) csv << ',' << name;
        csv << '\n';
      }
      csv << frame++;
      for (const double position : latest.positions) csv << ',' << position;
      csv << '\n';
    }
    return csv.str();
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

TEST_F(RealBag, TheLatestJointStateWouldNot) {
  PENUMBRA_REQUIRE_DATA();
  const fs::path late = folder_.path() / "late";
  fs::create_directory(late);
  for (const auto& entry : fs::directory_iterator(recording_))
    if (entry.path().extension() != ".mcap")
      fs::create_symlink(fs::absolute(entry.path()), late / entry.path().filename());
  for (const char* const own : {"joint_states.csv", "recording.yaml"}) fs::remove(late / own);
  const fs::path robots = fs::absolute(data_folder() / "robots");
  fs::create_symlink(robots, folder_.path() / "robots");
  write_file(late / "recording.yaml", read_file(recording_ / "recording.yaml"));
  const std::string states = latest_joint_states();
  ASSERT_EQ(count_lines(states), 11U);
  write_file(late / "joint_states.csv", states);

  ASSERT_NO_FATAL_FAILURE(run(recording_, "wanted"));
  ASSERT_NO_FATAL_FAILURE(run(late, "latest"));
  const auto shares = differing(folder_.path() / "latest", folder_.path() / "wanted");
  ASSERT_EQ(shares.size(), 10U);
  for (const double share : shares) EXPECT_GT(share, differing_share);
}

}  // namespace
}  // namespace penumbra::test
