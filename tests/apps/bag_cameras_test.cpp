// SPDX-License-Identifier: Apache-2.0
// Bags of two cameras: depth of the one brought to the other, and each judged by itself, against a
// scene of planes that a formula tells. Bags whose camera_info changes on the way, comes late or
// not at all.
#include "../support/test.hpp"
#include "fixtures.hpp"

#include <penumbra/labels/labels.hpp>

#include <io/ros/image_codec.hpp>

namespace penumbra::test {
namespace {

constexpr double wall = 3.0;   // m, in the frame "base"
constexpr double plate = 0.5;  // a plate of 7 cm x 6 cm before the board

struct Pinhole {
  Intrinsics lens;
  Eigen::Isometry3d T_base_camera;
};

const Pinhole color{{tiny_width, tiny_height, 60.0, 60.0, 31.3, 23.7},
                    Eigen::Isometry3d::Identity()};

/// Coarser and wider, 5 cm beside, turned by 3 degrees and a little rolled.
Pinhole infrared() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Vector3d(0.05, -0.02, 0.01);
  T.rotate(Eigen::AngleAxisd(-0.05, Vector3d::UnitY()));
  T.rotate(Eigen::AngleAxisd(0.02, Vector3d::UnitZ()));
  return {{120, 90, 80.0, 80.0, 58.2, 46.1}, T};
}

struct Hit {
  double depth = inf, robot = inf;    // along the camera's z, and the robot's alone
  Vector3d point = Vector3d::Zero();  // in "base"
};

/// How far along the ray a box is entered; infinite: never.
double enter(const Vector3d& from, const Vector3d& way, const Vector3d& low, const Vector3d& high) {
  return enter_box(from - (low + high) / 2, way, (high - low) / 2).value_or(inf);
}

/// What a pixel sees with the board's near face at `board`. The ray's z is 1, so that the way along
/// it is the depth.
Hit look(const Pinhole& camera, int u, int v, double board) {
  const Vector3d from = camera.T_base_camera.translation();
  const Vector3d way = camera.T_base_camera.linear() * camera.lens.ray(u, v);
  Hit hit;
  hit.robot = enter(from, way, {-0.2, -0.1, board}, {0.2, 0.1, board + 0.1});
  hit.depth = std::min({hit.robot, (wall - from.z()) / way.z(),
                        enter(from, way, {-0.06, -0.03, plate}, {0.01, 0.03, plate + 0.001})});
  hit.point = from + hit.depth * way;
  return hit;
}

Label label_of(const Hit& hit) {
  if (!std::isfinite(hit.robot)) return Label::clear;
  if (hit.depth < hit.robot - 0.1) return Label::front;
  return Label::occluded;
}

double board_of(int frame) { return 0.95 + 0.05 * frame; }

class BagCamerasTest : public BagTest {
 protected:
  /// A depth camera of its own, which sees the scene.
  void add_depth_camera(const Pinhole& camera, const std::string& name) {
    for (int frame = 0; frame < 3; ++frame) {
      const io::MessageHeader header{tiny_stamp(frame), name};
      const std::int64_t arrival = header.stamp + 30'000'000;
      Image<std::uint16_t> depth(camera.lens.width(), camera.lens.height());
      for (const auto [u, v] : each_pixel(depth))
        depth(u, v) = static_cast<std::uint16_t>(
            std::lround(1000.0 * look(camera, u, v, board_of(frame)).depth));
      bag_.add("/" + name + "/camera_info", arrival, camera_info_of(camera.lens, header));
      bag_.add("/" + name + "/depth", arrival,
               io::image_message(header, "16UC1", std::as_const(depth).view()));
    }
    bag_.add("/tf_static", tiny_stamp(0) - 150'000'000,
             io::TfMessage{{{{0, "base"}, name, camera.T_base_camera}}});
    bag_.sort();
  }

  /// The formula's labels, where they are the same two pixels around.
  template <typename Skip>
  void expect_labels(const Pinhole& camera, const Skip& skip, int& compared, int& wrong) {
    for (int frame = 0; frame < 3; ++frame) {
      const Image<std::uint8_t> told = labels(static_cast<std::size_t>(frame));
      ASSERT_EQ(told.width(), camera.lens.width());
      ASSERT_EQ(told.height(), camera.lens.height());
      const double board = board_of(frame);
      for (const auto [u, v] : each_pixel(2, 2, told.width() - 2, told.height() - 2)) {
        if (!is_even(camera, u, v, board) || skip(u, v, board)) continue;
        ++compared;
        if (told(u, v) != static_cast<std::uint8_t>(label_of(look(camera, u, v, board)))) ++wrong;
      }
    }
  }

  static bool is_even(const Pinhole& camera, int u, int v, double board) {
    const Hit here = look(camera, u, v, board);
    for (const auto [x, y] : each_pixel(u - 2, v - 2, u + 3, v + 3)) {
      const Hit other = look(camera, x, y, board);
      if (label_of(other) != label_of(here) || std::abs(other.depth - here.depth) > 0.05)
        return false;
    }
    return true;
  }

  /// Whether the depth camera sees what the color camera sees there.
  static bool is_seen(const Pinhole& depth, int u, int v, double board) {
    const Hit here = look(color, u, v, board);
    const Vector3d p = depth.T_base_camera.inverse() * here.point;
    const Intrinsics& lens = depth.lens;
    const int x = static_cast<int>(std::lround(lens.fx() * p.x() / p.z() + lens.cx()));
    const int y = static_cast<int>(std::lround(lens.fy() * p.y() / p.z() + lens.cy()));
    if (x < 2 || y < 2 || x >= lens.width() - 2 || y >= lens.height() - 2) return false;
    return is_even(depth, x, y, board) && std::abs(look(depth, x, y, board).depth - p.z()) < 0.02;
  }
};

TEST_F(BagCamerasTest, DepthOfACameraBesideIsBroughtToColor) {
  bag_.remove(depth_topic);
  bag_.rename(info_topic, "/camera/color/camera_info");
  const Pinhole camera = infrared();
  add_depth_camera(camera, "infrared");
  expect_has(succeed(run({"--color-topic", color_topic})).out,
             {"depth: /infrared/depth (", "camera_info: /infrared/camera_info (",
              "color camera_info: /camera/color/camera_info ("});
  const auto hidden = [&](int u, int v, double board) { return !is_seen(camera, u, v, board); };
  int compared = 0, wrong = 0;
  expect_labels(color, hidden, compared, wrong);
  EXPECT_GT(compared, 3 * 1500) << "of 3 images of 3072 pixels";
  EXPECT_EQ(wrong, 0);
}

TEST_F(BagCamerasTest, TheSecondCameraIsJudgedInItsOwnImageAndTheReportSaysWhatWasTaken) {
  const Pinhole camera = infrared();
  add_depth_camera(camera, "second");
  expect_has(succeed(run({"--depth-topic", "/second/depth"})).out, {"'second'", "'base'"});
  const Json bag = report()["settings"]["bag"];
  expect_values(bag, {{"/topics/0/role", "depth"},
                      {"/topics/0/name", "/second/depth"},
                      {"/topics/0/type", "sensor_msgs/msg/Image"},
                      {"/topics/0/why", "as --depth-topic says"},
                      {"/poses", "joints"},
                      {"/camera", {{"frame", "second"}, {"link", "base"}, {"by", "tf"}}},
                      {"/time_offset_s", 0.0},
                      {"/first_publisher", false}});
  std::set<std::string> roles;
  for (const Json& topic : bag["topics"]) roles.insert(topic["role"]);
  EXPECT_EQ(roles,
            (std::set<std::string>{"depth", "camera_info", "robot", "joints", "transforms"}));
  int compared = 0, wrong = 0;
  expect_labels(
      camera, [](int, int, double) { return false; }, compared, wrong);
  EXPECT_GT(compared, 3 * 7000) << "of 3 images of 10800 pixels";
  EXPECT_EQ(wrong, 0);

  expect_recorded({"--depth-topic", depth_topic});
}

/// A bag whose images come quickly, with what their driver says of the camera.
class BagDrivers : public BagTest {
 protected:
  static constexpr std::int64_t period = 50'000'000;

  BagDrivers() {
    for (const TinyBag::Message& message : bag_.messages) {
      if (message.topic == depth_topic && depth_.empty()) depth_ = message.data;
      if (message.topic == info_topic && info_.empty()) info_ = message.data;
    }
    for (const char* const topic : {depth_topic, info_topic, color_topic}) bag_.remove(topic);
  }

  /// Each letter is an image, `period` after the one before: `f` comes with the first camera's
  /// info, `o` with another's, `-` with none. `F`, `O`: the info comes 120 ms later, when the
  /// image's pose has long been known.
  void play(const std::string& script) {
    std::int64_t stamp = tiny_stamp(0);
    for (const char driver : script) {
      auto camera = decoded<io::CameraInfoMessage>(info_);
      camera.header.stamp = stamp;
      const std::int64_t late = driver == 'F' || driver == 'O' ? 120'000'000 : 0;
      if (driver == 'o' || driver == 'O') camera.k[0] = 61;
      if (driver != '-') bag_.add(info_topic, stamp + late, camera);
      auto image = decoded<io::ImageMessage>(depth_);
      image.header.stamp = stamp;
      bag_.add(depth_topic, stamp, image);
      stamp += period;
    }
  }

 private:
  std::vector<std::byte> depth_, info_;
};

TEST_F(BagDrivers, EachImageIsJudgedByItsOwnCameraOrNot) {
  const TinyBag bare = bag_;
  for (const auto& [why, script, wanted] :  // `o`: ok, `b`: bad_depth
       {std::array{"another camera's info is not taken", "fof", "obo"},
        {"nor one that comes late", "FOF", "obo"},
        {"another camera's topic is heard some images late", "ffff--ooo", "oooobbbbb"},
        {"the first camera comes again", "ffffooo--fff", "oooobbbbbooo"},
        // 0.2 s is what an image waits for its own.
        {"infos come seldom: the last holds until the next", "f---------o----",
         "oooooobbbbbbbbb"}}) {
    bag_ = bare;
    play(script);
    bag_.sort();
    succeed(run());
    std::string all;
    for (const std::string& status : statuses()) all += status.at(0);
    EXPECT_EQ(all, wanted) << why;
  }
}

}  // namespace
}  // namespace penumbra::test
