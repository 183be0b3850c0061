// SPDX-License-Identifier: Apache-2.0
// Bags of two cameras: depth of the one brought to the other, and each judged by itself, against a
// scene of planes that a formula tells.
#include "fixtures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include <Eigen/Geometry>

#include <penumbra/labels/labels.hpp>

#include <io/ros/image_codec.hpp>

namespace penumbra::test {
namespace {

using Eigen::Vector3d;

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
  double depth = std::numeric_limits<double>::infinity();  // along the camera's z
  double robot = std::numeric_limits<double>::infinity();  // the robot's alone
  Vector3d point = Vector3d::Zero();                       // in "base"
};

/// How far along the ray a box is entered; infinite: never.
double enter(const Vector3d& from, const Vector3d& way, const Vector3d& low, const Vector3d& high) {
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double a = (low[i] - from[i]) / way[i], b = (high[i] - from[i]) / way[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first < last ? first : std::numeric_limits<double>::infinity();
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
      for (int v = 0; v < depth.height(); ++v)
        for (int u = 0; u < depth.width(); ++u)
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
      for (int v = 2; v < told.height() - 2; ++v)
        for (int u = 2; u < told.width() - 2; ++u) {
          if (!is_even(camera, u, v, board) || skip(u, v, board)) continue;
          ++compared;
          if (told(u, v) != static_cast<std::uint8_t>(label_of(look(camera, u, v, board)))) ++wrong;
        }
    }
  }

  static bool is_even(const Pinhole& camera, int u, int v, double board) {
    const Hit here = look(camera, u, v, board);
    for (int y = v - 2; y <= v + 2; ++y)
      for (int x = u - 2; x <= u + 2; ++x) {
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
  bag_.remove("/camera/depth/image_rect_raw");
  bag_.rename("/camera/depth/camera_info", "/camera/color/camera_info");
  const Pinhole camera = infrared();
  add_depth_camera(camera, "infrared");
  const Words options = {"--color-topic", "/camera/color/image_raw/compressed"};
  expect_has(succeed(run(options)).out,
             {"depth: /infrared/depth (", "camera_info: /infrared/camera_info (",
              "color camera_info: /camera/color/camera_info ("});
  const auto hidden = [&](int u, int v, double board) { return !is_seen(camera, u, v, board); };
  int compared = 0, wrong = 0;
  expect_labels(color, hidden, compared, wrong);
  EXPECT_GT(compared, 3 * 1500) << "of 3 images of 3072 pixels";
  EXPECT_EQ(wrong, 0);

  // The test would see a camera that is elsewhere.
  bag_.edit<io::TfMessage>("/tf_static", [](auto& tf) {
    if (tf.transforms[0].child_frame_id == "infrared")
      tf.transforms[0].T_parent_child.translation().x() -= 0.08;
  });
  succeed(run(options));
  expect_labels(color, hidden, compared, wrong);
  EXPECT_GT(wrong, 30);
}

TEST_F(BagCamerasTest, TheSecondCameraIsJudgedInItsOwnImage) {
  const Pinhole camera = infrared();
  add_depth_camera(camera, "second");
  expect_has(succeed(run({"--depth-topic", "/second/depth"})).out, {"'second'", "'base'"});
  int compared = 0, wrong = 0;
  expect_labels(
      camera, [](int, int, double) { return false; }, compared, wrong);
  EXPECT_GT(compared, 3 * 7000) << "of 3 images of 10800 pixels";
  EXPECT_EQ(wrong, 0);

  succeed(run({"--depth-topic", "/camera/depth/image_rect_raw"}));
  expect_recorded_labels();
}

TEST_F(BagCamerasTest, TheReportSaysWhatWasTaken) {
  add_depth_camera(infrared(), "second");
  succeed(run({"--depth-topic", "/second/depth", "--time-offset", "0.001"}));
  const Json bag = report()["settings"]["bag"];
  expect_values(bag, {{"/topics/0/role", "depth"},
                      {"/topics/0/name", "/second/depth"},
                      {"/topics/0/type", "sensor_msgs/msg/Image"},
                      {"/topics/0/why", "as --depth-topic says"},
                      {"/poses", "joints"},
                      {"/camera", {{"frame", "second"}, {"link", "base"}, {"by", "tf"}}},
                      {"/time_offset_s", 0.001},
                      {"/first_publisher", false}});
  std::set<std::string> roles;
  for (const Json& topic : bag["topics"]) roles.insert(topic["role"]);
  EXPECT_EQ(roles,
            (std::set<std::string>{"depth", "camera_info", "robot", "joints", "transforms"}));
}

}  // namespace
}  // namespace penumbra::test
