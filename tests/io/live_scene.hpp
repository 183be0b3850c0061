// SPDX-License-Identifier: Apache-2.0
// A synthetic robot and camera whose true pose is a function of the stamp: a board that turns
// before a camera, with the messages of both on ROS 2's topics.
#pragma once

#include "messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <string>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/live/live_inbox.hpp>
#include <io/live/live_worker.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::test {

inline constexpr std::int64_t milliseconds = 1'000'000;
inline constexpr std::int64_t seconds = 1000 * milliseconds;
inline constexpr std::int64_t start = 1000 * seconds;  // the board is level then
inline constexpr std::int64_t image_period = 33 * milliseconds;

/// A camera of the scene.
struct LiveLens {
  double focal = 60.0;
  int width = 64, height = 48;
  double cx = 31.3, cy = 23.7;

  [[nodiscard]] Camera camera() const {
    return {.intrinsics = Intrinsics(width, height, focal, focal, cx, cy),
            .frame_id = "optical",
            .T_parent_camera = Eigen::Isometry3d::Identity()};
  }
};

/// A camera of realistic size. The board fills as much of its image as of the small one.
inline constexpr LiveLens large_lens{
    .focal = 900.0, .width = 1280, .height = 720, .cx = 640.3, .cy = 359.7};

/// A board of 0.4 m x 0.2 m that turns before the camera.
inline constexpr const char* live_urdf = R"(<robot name="tiny">
  <link name="base"/>
  <link name="board">
    <collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision>
  </link>
  <joint name="spin" type="continuous">
    <parent link="base"/><child link="board"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 1"/>
  </joint>
</robot>
)";

/// Returns the board's angle at a stamp, radians. Its speed is constant, so that poses between two
/// states are known, and moves the rim by a pixel in about 20 ms.
inline double spin_at(std::int64_t stamp) {
  constexpr std::int64_t turn = 2 * seconds;
  // Whole turns are removed first, because a double loses about 100 of the nanoseconds since 1970.
  const double part = static_cast<double>(stamp % turn) / static_cast<double>(turn);
  return std::remainder(2 * std::numbers::pi * part, 2 * std::numbers::pi);
}

inline io::CameraInfoMessage live_info(std::int64_t stamp, const LiveLens& lens = {}) {
  return camera_info_of(lens.camera().intrinsics, {stamp, "optical"});
}

inline std::vector<std::byte> live_joints(std::int64_t stamp, double angle) {
  return encoded(
      io::JointStateMessage{.header = {stamp, ""}, .names = {"spin"}, .positions = {angle}});
}
inline std::vector<std::byte> live_joints(std::int64_t stamp) {
  return live_joints(stamp, spin_at(stamp));
}

inline std::vector<std::byte> live_transform(const std::string& parent, const std::string& child,
                                             const Eigen::Vector3d& at = {0, 0, 0}) {
  return encoded(
      io::TfMessage{{{{0, parent}, child, Eigen::Isometry3d(Eigen::Translation3d(at))}}});
}

/// Returns a target at a point.
inline std::vector<std::byte> live_target(std::int64_t stamp, const Eigen::Vector3d& at,
                                          const std::string& frame = "optical") {
  return encoded(
      io::PoseStampedMessage{{stamp, frame}, Eigen::Isometry3d(Eigen::Translation3d(at))});
}

/// Returns MoveIt's message of a cube on the board.
inline io::AttachedObjectMessage live_part(std::int64_t stamp,
                                           std::uint8_t operation = io::CollisionObjectMessage::add,
                                           const std::string& id = "part", double size = 0.3,
                                           double x = 0.5) {
  io::AttachedObjectMessage part{.link_name = "board"};
  part.object.header = {stamp, "board"};
  part.object.id = id;
  part.object.operation = operation;
  part.object.pose = {{x, 0, 0}, {0, 0, 0, 1}};
  part.object.primitives = {
      {.type = io::SolidPrimitiveMessage::box, .dimensions = {size, size, size}}};
  part.object.primitive_poses = {{{0, 0, 0}, {0, 0, 0, 1}}};
  return part;
}

/// Returns depth of a wall at 3 m. Each pixel of the board is beyond, so labels show where it was
/// drawn.
inline std::vector<std::byte> live_depth(std::int64_t stamp, const std::string& frame = "optical",
                                         const LiveLens& lens = {}) {
  const Image<std::uint16_t> wall(lens.width, lens.height, 3000);
  return encoded(io::image_message(io::MessageHeader{stamp, frame}, "16UC1", wall.view()));
}

/// Returns the labels of the wall with the board at a stamp.
class LiveTruth {
 public:
  explicit LiveTruth(const LiveLens& lens = {})
      : wall_(lens.width, lens.height, 3000),
        pipeline_(Robot::parse(live_urdf, "/"), lens.camera()) {}

  const FrameReport& judge(std::int64_t stamp) {
    positions_ = {spin_at(stamp)};
    Frame frame;
    frame.stamp = stamp;
    frame.depth = wall_.view();
    frame.pose.positions = positions_;
    return pipeline_.process(frame);
  }

 private:
  const Image<std::uint16_t> wall_;
  std::vector<double> positions_;
  Pipeline pipeline_;
};

/// Keeps the published results.
class KeptResults final : public io::ResultSink {
 public:
  struct Published {
    io::Result result;
    std::int64_t stamp;
    std::vector<std::byte> payload;
  };
  std::vector<Published> published;
  std::map<io::Result, bool> wanted;  ///< results that are not named are wanted

  [[nodiscard]] bool wants(io::Result result) const override {
    const auto found = wanted.find(result);
    return found == wanted.end() || found->second;
  }
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    published.push_back({result, stamp, {payload.begin(), payload.end()}});
  }
  [[nodiscard]] std::size_t count(io::Result result) const {
    return static_cast<std::size_t>(
        std::count_if(published.begin(), published.end(),
                      [&](const Published& one) { return one.result == result; }));
  }
  /// Returns the last result of a kind.
  template <typename M>
  M last(io::Result result) {
    for (auto one = published.rbegin(); one != published.rend(); ++one) {
      if (one->result != result) continue;
      last_ = one->payload;
      return decoded<M>(last_);
    }
    ADD_FAILURE() << "nothing was published";
    return M();
  }

 private:
  std::vector<std::byte> last_;
};

/// Says of what types clouds and targets are.
inline void set_types(io::LiveInbox& inbox) {
  for (std::size_t i = 0; i < inbox.topics().size(); ++i)
    if (inbox.topics()[i].role == io::TopicRole::cloud)
      inbox.set_type(i, io::message_type<io::PointCloud2Message>());
    else if (inbox.topics()[i].role == io::TopicRole::targets)
      inbox.set_type(i, io::message_type<io::PoseStampedMessage>());
}

/// An inbox and its worker, driven by hand.
class LiveBench {
 public:
  LiveBench() : LiveBench(one_camera()) {}
  explicit LiveBench(const io::LiveOptions& options) : inbox(options) { set_types(inbox); }

  static io::LiveOptions one_camera(const std::vector<std::string>& targets = {}) {
    io::LiveOptions options;
    options.cameras = {
        {.depth_topic = "/camera/depth/image_rect_raw", .info_topic = "/camera/depth/camera_info"}};
    options.target_topics = targets;
    return options;
  }
  /// One camera and robots with namespaces.
  static io::LiveOptions of_robots(const std::vector<std::string>& names,
                                   const std::vector<std::string>& targets = {}) {
    io::LiveOptions options = one_camera(targets);
    io::set_robots(options, names, [](const std::string& name) { return "/" + name; });
    return options;
  }

  void publish(const std::string& topic, std::span<const std::byte> payload,
               std::uint64_t publisher = 0) {
    for (std::size_t i = 0; i < inbox.topics().size(); ++i)
      if (inbox.topics()[i].name == topic)
        return inbox.receive(i, {payload, nullptr, publisher}, now);
    FAIL() << topic;
  }
  void tell_robot(const std::string& urdf = live_urdf) {
    publish("/robot_description", encoded(io::StringMessage{urdf}));
    if (const auto request = inbox.take_load_request()) inbox.set_robot(io::make_robot(*request));
  }
  /// Publishes the descriptions of several robots.
  void tell_robots(const std::vector<std::string>& names) {
    for (const std::string& name : names)
      publish("/" + name + "/robot_description", encoded(io::StringMessage{live_urdf}));
    inbox.set_robot(io::make_robot(*inbox.take_load_request()));
  }
  void tell_transform(const std::string& parent, const std::string& child, double x = 0.0) {
    publish("/tf_static", live_transform(parent, child, {x, 0, 0}));
  }
  void tell_mount() { tell_transform("base", "optical"); }
  void tell_joints(std::int64_t stamp, std::uint64_t publisher = 0) {
    publish("/joint_states", live_joints(stamp), publisher);
  }
  /// Publishes joint states before and after a stamp.
  void tell_joints_around(std::int64_t stamp, const std::string& topic = "/joint_states") {
    for (const int by : {-10, 10}) publish(topic, live_joints(stamp + by * milliseconds));
  }
  void tell_info(std::int64_t stamp, double focal = 60.0) {
    publish("/camera/depth/camera_info", encoded(live_info(stamp, {.focal = focal})));
  }
  void tell_depth(std::int64_t stamp) {
    publish("/camera/depth/image_rect_raw", live_depth(stamp));
  }

  /// Publishes robot, camera and mount.
  void tell_all() {
    tell_robot();
    tell_mount();
    tell_info(0);
  }

  /// Judges all images that can be judged. Returns their number.
  std::size_t work() {
    std::size_t judged = 0;
    for (; inbox.next(0, now, true, job); ++judged) {
      const io::LiveOutcome outcome = worker.judge(job, results);
      if (outcome.find_warnings) inbox.warn(0, job.setup, outcome.find_warnings());
      inbox.done(0, outcome, now, now);
    }
    return judged;
  }

  /// Judges an image whose pose is known.
  std::size_t judge(std::int64_t stamp) {
    tell_joints_around(stamp);
    tell_depth(stamp);
    now += image_period;
    return work();
  }

  [[nodiscard]] io::ImageCounts counts() const { return inbox.camera(0).counts(); }
  [[nodiscard]] std::string status() {
    return results.last<io::TargetsMessage>(io::Result::targets).status;
  }
  [[nodiscard]] std::vector<std::byte> pixels(io::Result result) {
    const auto image = results.last<io::ImageMessage>(result);
    return {image.data.begin(), image.data.end()};
  }
  /// Returns how many pixels of the last mask are the robot's.
  [[nodiscard]] std::ptrdiff_t masked() {
    const auto mask = pixels(io::Result::mask);
    return std::count(mask.begin(), mask.end(), std::byte{255});
  }

  std::int64_t now = 1000 * seconds;
  io::LiveInbox inbox;
  io::LiveWorker worker{inbox.options(), 0, {}, nullptr};
  io::AssembledFrame job;
  KeptResults results;
};

/// Expects each published label image to show the true pose at its stamp or to be all unknown.
/// Returns the number of those that show a pose.
inline std::size_t expect_true_labels(const std::vector<KeptResults::Published>& published,
                                      LiveTruth& truth) {
  std::size_t known = 0;
  for (const auto& one : published) {
    if (one.result != io::Result::labels) continue;
    const auto image = decoded<io::ImageMessage>(one.payload);
    const bool says_nothing = std::all_of(
        image.data.begin(), image.data.end(),
        [](std::byte label) { return label == static_cast<std::byte>(Label::unknown); });
    if (says_nothing) continue;
    ++known;
    const FrameReport& report = truth.judge(one.stamp);
    EXPECT_EQ(std::memcmp(image.data.data(), report.labels.data, image.data.size()), 0)
        << "wrong labels at " << one.stamp;
  }
  return known;
}

}  // namespace penumbra::test
