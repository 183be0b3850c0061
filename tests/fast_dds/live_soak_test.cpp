// SPDX-License-Identifier: Apache-2.0
// penumbra live for a while among publishers and subscribers of another vendor, with images of a
// real camera's size and nothing else on the machine: what comes of each sample.
//   PENUMBRA_FULL=1 test_dds_live --gtest_filter='LiveSoakFull.*'
// is 10 minutes without overlays and 5 of chaos with them.
#include "../io/ros_images.hpp"
#include "../support/pixels.hpp"
#include "../support/process_memory.hpp"
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "../support/running_program.hpp"
#include "../support/temporary_folder.hpp"
#include "label_watch.hpp"
#include "listening.hpp"
#include "lone_domain.hpp"

#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

/// What live may take more at the end than after its warm-up, MiB: all the images that may wait,
/// eight of depth (1.8 MiB) and of color (2.6 MiB) in DDS and as many in live.
constexpr double memory_slack = 72.0;

/// Shades with a sensor's noise: an even image would be compressed in no time.
std::vector<std::byte> color_image() {
  Image<Rgb8> picture(large_lens.width, large_lens.height);
  std::minstd_rand noise(1);
  const auto shade = [&](int at, int end) {
    return static_cast<std::uint8_t>(200 * at / end + static_cast<int>(noise() % 8));
  };
  for (const auto [u, v] : each_pixel(picture))
    picture(u, v) = {shade(u, large_lens.width), shade(v, large_lens.height),
                     shade(u + v, 4 * large_lens.width)};
  return encoded(
      io::image_message(io::MessageHeader{1, "optical"}, "rgb8", std::as_const(picture).view()));
}

/// Tells joint states at 100 Hz, by a process that may be killed and replaced.
class JointFeed {
 public:
  ~JointFeed() {
    ends_ = true;
    thread_.join();
  }

  void begin(std::unique_ptr<PeerProcess> process) {
    const std::lock_guard lock(mutex_);
    process_ = std::move(process);
  }

 private:
  void feed() {
    for (std::int64_t tick = system_now(); !ends_;) {
      tick = next_tick(std::max(tick, system_now()), 100);
      std::this_thread::sleep_for(std::chrono::nanoseconds(tick - system_now()));
      const std::lock_guard lock(mutex_);
      if (process_) process_->give(live_joints(tick));
    }
  }

  std::mutex mutex_;
  std::unique_ptr<PeerProcess> process_;  // guarded by mutex_
  std::atomic<bool> ends_ = false;
  std::thread thread_{[this] { feed(); }};
};

/// What is published.
enum class Part { depth, depth_info, color, color_info, joints };
constexpr std::array all_parts = {Part::depth, Part::depth_info, Part::color, Part::color_info,
                                  Part::joints};
std::string topic_of(Part part) {
  static const std::array<std::string, all_parts.size()> topics = {
      "/camera/depth/image_rect_raw", "/camera/depth/camera_info", "/camera/color/image_raw",
      "/camera/color/camera_info", "/joint_states"};
  return topics.at(static_cast<std::size_t>(part));
}

/// Its camera is that of large_lens, at 30 Hz.
class SoakPublishers {
 public:
  /// A robot_description and where the camera is are published; start() is for the rest.
  explicit SoakPublishers(int domain) : domain_(domain) {
    description_ = make_peer(
        domain, {"publish", "rt/robot_description", "std_msgs::msg::dds_::String_", latched});
    description_->give(encoded(io::StringMessage{live_urdf}));
    mount_ =
        make_peer(domain, {"publish", "rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", latched});
    mount_->give(live_transform("base", "optical"));
  }
  void start(Part part) {
    if (part == Part::joints)
      return joints_.begin(
          make_peer(domain_, {"publish", "rt" + topic_of(part),
                              "sensor_msgs::msg::dds_::JointState_", "reliable,depth=10"}));
    const bool is_image = part == Part::depth || part == Part::color;
    auto made = make_peer(domain_, {"repeat", "rt" + topic_of(part),
                                    is_image ? "sensor_msgs::msg::dds_::Image_"
                                             : "sensor_msgs::msg::dds_::CameraInfo_",
                                    "reliable,depth=5", "30"});
    made->give(part == Part::depth   ? live_depth(1, "optical", large_lens)
               : part == Part::color ? color_image()
                                     : encoded(live_info(1, large_lens)));
    camera_[static_cast<std::size_t>(part)] = std::move(made);
  }
  void kill(Part part) {
    if (part == Part::joints) return joints_.begin(nullptr);
    camera_[static_cast<std::size_t>(part)].reset();
  }

  /// Ends a camera's part after all it wrote is acknowledged.
  void end(Part part) { camera_[static_cast<std::size_t>(part)]->end(); }

 private:
  static constexpr const char* latched = "reliable,latched,depth=1";

  int domain_;
  std::unique_ptr<PeerProcess> description_, mount_;
  std::array<std::unique_ptr<PeerProcess>, 4> camera_;
  JointFeed joints_;
};

class LiveSoakFull : public testing::Test {
 protected:
  /// Skips the test unless PENUMBRA_FULL is set.
  void SetUp() override {
    if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  }

  /// Begins all, and waits for the first labels that say something.
  void begin(bool with_overlay) {
    publishers_ = std::make_unique<SoakPublishers>(domain_.id());
    labels_ = std::make_unique<LabelWatch>(domain_.id(), large_lens);
    live_ = std::make_unique<RunningProgram>(
        std::vector<std::string>{"live", "--domain", std::to_string(domain_.id()), "--reliable",
                                 "--depth-topic", topic_of(Part::depth), "--color-topic",
                                 topic_of(Part::color), "--summary", folder_.path() / "live.json"},
        folder_.path() / "live.log");
    if (with_overlay)
      overlay_ =
          make_peer(domain_.id(), {"count", "rt/penumbra/overlay/compressed",
                                   "sensor_msgs::msg::dds_::CompressedImage_", "reliable,depth=5"});
    for (const Part part : all_parts) publishers_->start(part);
    ASSERT_TRUE(labels_->known_after(0, dds_patience)) << read_bytes(folder_.path() / "live.log");
    std::this_thread::sleep_for(2s);
    before_ = resident();
  }
  /// Kills some publishers, begins them again after a while, and waits until all is well.
  void break_and_mend(std::mt19937_64& random) {
    const auto some_ms = [&](int least, int most) {
      return std::chrono::milliseconds(std::uniform_int_distribution(least, most)(random));
    };
    std::vector<Part> victims;
    while (victims.empty())
      for (const Part part : all_parts)
        if (std::bernoulli_distribution(0.35)(random)) victims.push_back(part);
    std::shuffle(victims.begin(), victims.end(), random);
    for (const Part part : victims) {
      std::this_thread::sleep_for(some_ms(0, 300));
      publishers_->kill(part);
    }
    std::this_thread::sleep_for(some_ms(50, 1500));
    for (const Part part : victims) publishers_->start(part);
    ASSERT_TRUE(labels_->known_after(system_now(), dds_patience)) << "no labels after a restart";
    std::this_thread::sleep_for(some_ms(200, 1000));
  }
  /// Ends all, publishers first, and expects that all labels were heard and true.
  void finish() {
    EXPECT_LT(resident() - before_, memory_slack);
    publishers_->end(Part::depth);
    std::this_thread::sleep_for(500ms);
    EXPECT_EQ(live_->end(), 0) << read_bytes(folder_.path() / "live.log");
    summary_ = json::parse(read_bytes(folder_.path() / "live.json"));
    const auto published = camera()["results_written"]["labels"].get<std::uint64_t>();
    const auto end = std::chrono::steady_clock::now() + dds_patience;
    while (labels_->newest_number() < published && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(10ms);
    labels_->end();
    verdict_ = labels_->judge();
    EXPECT_TRUE(verdict_.in_order);
    EXPECT_EQ(labels_->newest_number(), published);
    EXPECT_EQ(verdict_.known + verdict_.unknown, published);
    EXPECT_EQ(camera()["judged"], published) << "the subscriber is there before the robot is known";
    EXPECT_EQ(summary_["results_not_written"], 0);
    EXPECT_EQ(verdict_.wrong, 0U) << "the first at " << verdict_.first_wrong;
    EXPECT_GT(verdict_.known, 0U);
    // What DDS delivered is what became of the images.
    std::size_t all = 0;
    for (const char* fate : {"judged", "failed", "waiting", "in_work"})
      all += camera()[fate].get<std::size_t>();
    for (const auto& [reason, images] : camera()["dropped"].items())
      all += images.get<std::size_t>();
    EXPECT_EQ(all, camera()["received"]);
    EXPECT_EQ(topic(Part::depth)["received"], camera()["received"]);
    EXPECT_EQ(camera()["failed"], 0);
    for (const Part part : all_parts) EXPECT_EQ(topic(part)["unreadable"], 0) << topic_of(part);
  }

  [[nodiscard]] const json& topic(Part part) const {
    for (const json& one : summary_["topics"])
      if (one["name"] == topic_of(part)) return one;
    static const json none = {{"received", 0}, {"lost", 0}, {"overwritten", 0}, {"unreadable", 0}};
    return none;
  }
  [[nodiscard]] const json& camera() const { return summary_["cameras"][0]; }
  [[nodiscard]] double resident() const { return memory_of(std::to_string(live_->pid())).resident; }

  LoneDomain domain_;
  TemporaryFolder folder_;
  std::unique_ptr<SoakPublishers> publishers_;
  std::unique_ptr<LabelWatch> labels_;
  std::unique_ptr<PeerProcess> overlay_;
  std::unique_ptr<RunningProgram> live_;
  double before_ = 0.0;  // MiB in memory
  json summary_;
  LabelVerdict verdict_;
};

TEST_F(LiveSoakFull, Steady) {
  ASSERT_NO_FATAL_FAILURE(begin(false));
  std::this_thread::sleep_for(10min);
  finish();
  EXPECT_EQ(verdict_.lost_again, 0U) << "nothing is missing once all publishers are found";
  for (const Part part : all_parts) EXPECT_EQ(topic(part)["lost"], 0) << topic_of(part);
  EXPECT_FALSE(topic(Part::color)["received"] > 0) << "nobody wants an overlay";
}

TEST_F(LiveSoakFull, NoLabelsAreOfAWrongPoseAmongKilledPublishers) {
  auto random = seeded_random(static_cast<std::uint64_t>(system_now()));
  ASSERT_NO_FATAL_FAILURE(begin(true));
  const auto end = std::chrono::steady_clock::now() + 5min;
  do ASSERT_NO_FATAL_FAILURE(break_and_mend(random));
  while (std::chrono::steady_clock::now() < end);
  finish();
  EXPECT_TRUE(topic(Part::color)["received"] > 0);
}

/// Several cameras in one penumbra live: one of them compressed, the robot where TF says.
TEST(LiveCameras, TwoOfOneRobotByTf) {
  const LoneDomain domain;
  const TemporaryFolder folder;
  std::map<std::string, std::unique_ptr<PeerProcess>> peers;
  const auto begin = [&](const std::string& topic, const std::string& type, const char* qos) {
    peers[topic] = make_peer(domain.id(), {"publish", "rt" + topic, type, qos});
  };
  begin("/robot_description", "std_msgs::msg::dds_::String_", "reliable,latched,depth=1");
  begin("/tf_static", "tf2_msgs::msg::dds_::TFMessage_", "reliable,latched,depth=1");
  begin("/tf", "tf2_msgs::msg::dds_::TFMessage_", "best_effort");
  for (const std::string camera : {"/left", "/right"})
    begin(camera + "/camera_info", "sensor_msgs::msg::dds_::CameraInfo_", "best_effort");
  begin("/left/depth", "sensor_msgs::msg::dds_::Image_", "best_effort");
  begin("/right/depth/compressedDepth", "sensor_msgs::msg::dds_::CompressedImage_", "best_effort");

  const Image<std::uint16_t> wall(64, 48, 3000);
  const std::vector<std::byte> compressed_wall = compressed_depth(wall, true, 0, 0);
  const auto tell_at = [&](std::int64_t stamp, int tick) {
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(0, 0, 1) * Eigen::AngleAxisd(spin_at(stamp), Eigen::Vector3d::UnitZ());
    peers["/tf"]->give(encoded(io::TfMessage{{{{stamp, "base"}, "board", pose}}}));
    if (tick % 5 != 0) return;
    const std::int64_t taken = stamp - 5 * milliseconds;
    for (const char* info : {"/left/camera_info", "/right/camera_info"})
      peers[info]->give(encoded(live_info(taken)));
    peers["/left/depth"]->give(live_depth(taken));
    peers["/right/depth/compressedDepth"]->give(encoded(io::CompressedImageMessage{
        {taken, "optical"}, "16UC1; compressedDepth rvl", compressed_wall}));
  };

  peers["/robot_description"]->give(encoded(io::StringMessage{live_urdf}));
  peers["/tf_static"]->give(live_transform("base", "optical"));
  LabelWatch left(domain.id(), {}, "/penumbra/left/labels");
  LabelWatch right(domain.id(), {}, "/penumbra/right/labels");
  RunningProgram live(
      {"live", "--domain", std::to_string(domain.id()), "--camera", "left=/left/depth", "--camera",
       "right=/right/depth/compressedDepth", "--poses", "tf"},
      folder.path() / "live.log");
  constexpr std::size_t enough = 20;  // known labels; until all topics are found they are unknown
  auto next = std::chrono::steady_clock::now();
  const auto end = next + dds_patience;
  for (int tick = 0; next < end && (left.known_count() < enough || right.known_count() < enough);
       ++tick, next += 10ms) {
    std::this_thread::sleep_until(next);
    tell_at(system_now(), tick);
  }
  EXPECT_EQ(live.end(), 0) << read_bytes(folder.path() / "live.log");
  for (LabelWatch* watch : {&left, &right}) {
    watch->end();
    const LabelVerdict verdict = watch->judge();
    EXPECT_EQ(verdict.wrong, 0U) << "the first at " << verdict.first_wrong;
    EXPECT_GE(verdict.known, enough);
  }
}

}  // namespace
}  // namespace penumbra::test
