// SPDX-License-Identifier: Apache-2.0
#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include <io/files/joint_file.hpp>
#include <io/files/recording.hpp>

namespace penumbra::bench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

LinkPoses link_poses(const Robot& robot, const std::vector<double>& positions,
                     const Isometry3d& T_camera_root) {
  LinkPoses poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  for (Isometry3d& pose : poses) pose = T_camera_root * pose;
  return poses;
}

/// T_camera_root of a camera at `eye` that looks at `aim`, the root's z axis up.
Isometry3d look_at(const Vector3d& eye, const Vector3d& aim) {
  const Vector3d forward = (aim - eye).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << right, forward.cross(right), forward;
  Isometry3d T_root_camera = Isometry3d::Identity();
  T_root_camera.linear() = R;
  T_root_camera.translation() = eye;
  return T_root_camera.inverse();
}

/// A sphere about the origin of about that many triangles, wound outwards.
TriangleMesh sphere(double radius, std::size_t triangles) {
  const auto rings = static_cast<std::uint32_t>(
      std::max(3.0, std::round(std::sqrt(static_cast<double>(triangles) / 4.0)) + 1));
  const std::uint32_t around = 2 * rings;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const double polar = M_PI * i / rings;
      const double azimuth = M_PI * j / rings;
      const double sine = i == rings ? 0.0 : std::sin(polar);  // exactly: the pole closes
      const Vector3d unit(sine * std::cos(azimuth), sine * std::sin(azimuth), std::cos(polar));
      mesh.vertices.emplace_back((unit * radius).cast<float>());
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const std::uint32_t a = i * around + j;
      const std::uint32_t b = i * around + (j + 1) % around;
      if (i > 0) mesh.triangles.push_back({a, b + around, b});
      if (i + 1 < rings) mesh.triangles.push_back({a, a + around, b + around});
    }
  }
  return mesh;
}

/// Positions of each frame: every joint swings at its own speed.
std::vector<std::vector<double>> swings(const Robot& robot, std::size_t frames,
                                        std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> phase, speed;
  for (std::size_t i = 0; i < robot.variables().size(); ++i) {
    phase.push_back(2 * M_PI * unit(random));
    speed.push_back(0.5 + unit(random));
  }
  constexpr double frame_time = 1.0 / 30.0;
  std::vector<std::vector<double>> all(frames, robot.rest_positions());
  for (std::size_t frame = 0; frame < frames; ++frame)
    for (std::size_t i = 0; i < phase.size(); ++i)
      all[frame][i] = 1.5 * std::sin(phase[i] + speed[i] * frame_time * static_cast<double>(frame));
  return all;
}

}  // namespace

std::filesystem::path data_folder() {
  const char* given = std::getenv("PENUMBRA_DATA");
  return given != nullptr ? given : PENUMBRA_DATA_DEFAULT;
}

BenchScene ur5e_scene(Geometry geometry, int width, int height, double f, std::size_t frames,
                      std::uint64_t seed) {
  RobotOptions options;
  options.geometry = geometry;
  const auto load = [options] {
    return Robot::load(data_folder() / "robots" / "ur5e" / "ur5e.urdf", options);
  };
  auto robot = std::make_shared<const Robot>(load());
  const std::string kind = geometry == Geometry::visual ? "visual" : "collision";
  BenchScene scene{"UR5e " + kind + ", " + std::to_string(width) + "x" + std::to_string(height),
                   Intrinsics(width, height, f, f, 0.5 * width + 7.3, 0.5 * height - 4.1),
                   robot,
                   {}};
  const Isometry3d T_camera_root = look_at({1.15, -0.3, 0.5}, {0.0, 0.0, 0.3});
  scene.T_root_camera = T_camera_root.inverse();
  scene.load_robot = load;
  for (const std::vector<double>& positions : swings(*robot, frames, seed)) {
    scene.path.push_back(link_poses(*robot, positions, T_camera_root));
    scene.joints.push_back(positions);
  }
  return scene;
}

BenchScene ur5e_cell(std::size_t count, std::size_t frames, std::uint64_t seed) {
  const Robot arm = Robot::load(data_folder() / "robots" / "ur5e" / "ur5e.urdf");
  std::vector<PlacedRobot> arms;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 0.9 * (static_cast<double>(i % 4) - 1.5), y = i < 4 ? 0.0 : 1.0;
    arms.push_back({"arm" + std::to_string(i), arm, Isometry3d(Eigen::Translation3d(x, y, 0.0))});
  }
  auto robot = std::make_shared<const Robot>(Robot::join(arms));
  BenchScene scene{std::to_string(count) + " UR5e",
                   Intrinsics(1280, 720, 915.0, 915.0, 640.0, 360.0),
                   robot,
                   {}};
  const Isometry3d T_camera_root = look_at({0.0, -3.4, 1.6}, {0.0, 0.5, 0.3});
  scene.T_root_camera = T_camera_root.inverse();
  for (const std::vector<double>& positions : swings(*robot, frames, seed)) {
    scene.path.push_back(link_poses(*robot, positions, T_camera_root));
    scene.joints.push_back(positions);
  }
  return scene;
}

BenchScene xarm7_scene(std::size_t frames) {
  const io::Recording recording = io::Recording::open(data_folder() / "xarm7_realsense");
  const auto load = [recording] { return recording.load_robot(); };
  auto robot = std::make_shared<const Robot>(load());
  const Intrinsics& k = recording.camera.camera.intrinsics;
  BenchScene scene{
      "xArm 7, " + std::to_string(k.width()) + "x" + std::to_string(k.height()), k, robot, {}};
  const std::vector<io::JointRow> rows = io::read_joint_file(recording.frames.joints, *robot);
  const Isometry3d T_camera_root = recording.camera.camera.T_parent_camera->inverse();
  scene.T_root_camera = *recording.camera.camera.T_parent_camera;
  scene.load_robot = load;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double at = static_cast<double>(frame) * static_cast<double>(rows.size() - 1) /
                      static_cast<double>(frames);
    const auto row = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(row);
    std::vector<double> positions = rows[row].positions;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      positions[i] += part * (rows[row + 1].positions[i] - positions[i]);
    }
    scene.path.push_back(link_poses(*robot, positions, T_camera_root));
    scene.joints.push_back(positions);
  }
  return scene;
}

std::vector<Image<std::uint16_t>> sensor_images(DepthRenderer& renderer, const BenchScene& scene) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 4.0F);
  std::vector<Image<std::uint16_t>> images;
  for (const LinkPoses& poses : scene.path) {
    const VirtualDepthView view = renderer.render(poses);
    Image<std::uint16_t>& image = images.emplace_back(view.depth.width, view.depth.height);
    for (int v = 0; v < view.depth.height; ++v) {
      for (int u = 0; u < view.depth.width; ++u) {
        const float z = view.depth(u, v) > 0 ? view.depth(u, v) : 2.5F;
        const bool hole = random() % 100 == 0;
        image(u, v) = hole ? std::uint16_t{0}
                           : static_cast<std::uint16_t>(std::max(1.0F, 1e3F * z + noise(random)));
      }
    }
  }
  return images;
}

SphereScene::SphereScene(std::size_t count, std::size_t triangles)
    : count_(count),
      mesh_{},
      radius_(0.45 / std::sqrt(static_cast<double>(count))) {  // the same area for every count
  mesh_.emplace_back(sphere(radius_, triangles / count));
}

std::vector<Body> SphereScene::bodies() const { return std::vector<Body>(count_, {"ball", mesh_}); }

std::size_t SphereScene::triangle_count() const { return count_ * mesh_[0].triangles.size(); }

std::vector<LinkPoses> SphereScene::path(std::size_t frames) const {
  std::vector<LinkPoses> path;
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count_))));
  for (std::size_t frame = 0; frame < frames; ++frame) {
    LinkPoses& poses = path.emplace_back();
    const double angle = 0.02 * static_cast<double>(frame);
    for (std::size_t i = 0; i < count_; ++i) {
      const double middle = 0.5 * static_cast<double>(columns - 1);
      const std::size_t row = i / columns;
      const double x = 2.0 * radius_ * (static_cast<double>(i % columns) - middle);
      const double y = 2.0 * radius_ * (static_cast<double>(row) - middle);
      const Vector3d centre(x + 0.1 * std::sin(angle), y + 0.1 * std::cos(angle), 2.0);
      poses.push_back(Eigen::Translation3d(centre) *
                      Eigen::AngleAxisd(angle, Vector3d(1, 2, 3).normalized()));
    }
  }
  return path;
}

}  // namespace penumbra::bench
