// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <sim/arm.hpp>
#include <sim/depth_sensor.hpp>
#include <sim/random.hpp>
#include <sim/scene.hpp>
#include <sim/simulation.hpp>
#include <sim/stage.hpp>
#include <sim/temporary_folder.hpp>
#include <sim/texture.hpp>

namespace penumbra::study {

inline constexpr double degree = std::numbers::pi / 180.0;

/// What is simulated.
struct Setup {
  std::string name;
  bool on_hand = false;  ///< the camera moves with the flange
  std::size_t frames = 10;
  bool search = false;
  bool object = false;        ///< something stands before the arm
  double missing = 0.0;       ///< share of the depth image without measurement
  bool wrong_joints = false;  ///< of one frame
  double speed = 0.0;         ///< of the arm's tip, m/s, root mean square; 0: it stands
  double late = 0.0;          ///< seconds from an image's stamp to when it was taken
  bool tool = false;          ///< the flange carries something that the URDF lacks
  bool person = false;        ///< somebody stands near the arm
  sim::DepthNoise sensor = sim::DepthNoise::d415();
  double depth_scale = 0.0;  ///< of the sensor: by how much of itself its depth is too large
  std::vector<double> joint_errors = {};  ///< of the positions that are reported, rad
  bool masks = false;                     ///< the frames have masks of the robot in place of depth
  int mask_grown = 0;                     ///< pixels by which they are too large
  double mask_border = 0.0;               ///< share of their border that is off by up to 12 pixels
  double wrong_masks = 0.0;               ///< share of frames whose mask shows another pose
  bool colors = false;                    ///< the frames have colour images in place of depth
  double light = 0.0;  ///< standard deviation of the logarithm of colour images' brightness
};

struct RobotChoice {
  std::string name;
  std::filesystem::path urdf;
  RobotOptions options;
  std::string flange;
  std::vector<double> centre;  ///< joint positions around which poses are drawn, rad
};

/// A simulated robot, and a depth camera whose pose is known.
class Cell {
 public:
  [[nodiscard]] static Intrinsics intrinsics() { return {848, 480, 610.0, 610.0, 423.5, 239.5}; }

  Cell(const RobotChoice& choice, const Setup& setup, std::uint64_t seed)
      : choice_(choice),
        setup_(setup),
        random_(seed, 77),
        arm_(choice.urdf, choice.options, folder_.path()),
        stage_(arm_, room(), folder_.path(), intrinsics()),
        sensor_(noise(setup), intrinsics().fx(), seed, 3),
        parent_(setup.on_hand ? *robot().find_link(choice.flange) : 0),
        small_renderer_(
            make_depth_renderer(Backend::cpu, intrinsics().binned(8, 8), bodies_of(robot()))) {
    if (setup.on_hand) {
      // On a bracket beside the flange, so that the gripper is in view.
      const Eigen::Vector3d jitter(random_.normal(), random_.normal(), random_.normal());
      T_parent_camera_ = Eigen::Isometry3d::Identity();
      T_parent_camera_.translation() = Eigen::Vector3d(0.0, -0.16, -0.12) + 0.01 * jitter;
      T_parent_camera_.linear() =
          Eigen::AngleAxisd(-0.5 + 0.05 * random_.normal(), Eigen::Vector3d::UnitX()).matrix();
    } else {
      const double around = random_.uniform(-1.2, 1.2), away = random_.uniform(1.1, 1.7);
      const Eigen::Vector3d eye(away * std::cos(around), away * std::sin(around),
                                random_.uniform(0.5, 1.1));
      const Eigen::Vector3d target(random_.uniform(-0.1, 0.2), random_.uniform(-0.1, 0.1),
                                   random_.uniform(0.3, 0.5));
      T_parent_camera_ = sim::look_at(eye, target);
    }
  }

  [[nodiscard]] const Robot& robot() const { return arm_.robot(); }
  [[nodiscard]] const Eigen::Isometry3d& truth() const { return T_parent_camera_; }

  std::vector<KeptFrame> frames() {
    std::vector<KeptFrame> all;
    if (setup_.speed > 0.0) return moving_frames();
    while (all.size() < setup_.frames) {
      KeptFrame frame;
      frame.index = all.size();
      frame.joints = pose();
      draw(frame);
      if (setup_.masks) draw_mask(frame);
      if (setup_.colors) draw_colors(frame);
      if (setup_.wrong_joints && frame.index == 4)
        for (double& joint : frame.joints) joint += random_.uniform(0.1, 0.3);
      frame.joints = reported(std::move(frame.joints));
      frame.T_root_link.resize(robot().links().size());
      robot().forward_kinematics(frame.joints, frame.T_root_link);
      all.push_back(std::move(frame));
    }
    return all;
  }

  /// Lets every joint swing around a new pose, with Setup::speed.
  void start_swing() {
    centre_ = pose();
    phases_.clear();
    rates_.clear();
    for (std::size_t i = 0; i < choice_.centre.size(); ++i) {
      phases_.push_back(random_.uniform(0.0, 6.28));
      rates_.push_back(random_.uniform(0.7, 1.3));
    }
    pace_ = 1.0;
    const auto tip = [&](double t) -> Eigen::Vector3d {
      return arm_.link_pose(joints_at(t), choice_.flange).translation();
    };
    double squares = 0.0;
    for (int i = 0; i < 200; ++i)
      squares += ((tip(0.1 * i + 0.01) - tip(0.1 * i)) / 0.01).squaredNorm();
    pace_ = setup_.speed / std::sqrt(squares / 200.0);
  }

  /// The positions of the swinging joints, rad, after some seconds.
  [[nodiscard]] std::vector<double> joints_at(double seconds) const {
    constexpr double amplitude = 0.35;  // rad
    std::vector<double> joints = centre_;
    for (std::size_t i = 0; i < phases_.size(); ++i)
      joints[i] += amplitude * std::sin(pace_ * rates_[i] * seconds + phases_[i]);
    return joints;
  }

  /// Measures the depth of the frame's joints.
  void draw(KeptFrame& frame) {
    std::vector<Eigen::Isometry3d> parts(7, Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d T_root_camera =
        setup_.on_hand ? arm_.link_pose(frame.joints, choice_.flange) * T_parent_camera_
                       : T_parent_camera_;
    // The object is somewhere in the cell, or between the camera and the arm.
    parts[4].translation() = Eigen::Vector3d(0.0, 5.0, 0.1);
    if (setup_.object)
      parts[4].translation() = T_root_camera * Eigen::Vector3d(random_.uniform(-0.2, 0.2),
                                                               random_.uniform(-0.1, 0.1), 0.7);
    const Eigen::Isometry3d away(Eigen::Translation3d(0.0, 9.0, 0.0));
    parts[5] = setup_.tool ? arm_.link_pose(frame.joints, choice_.flange) : away;
    parts[6] = away;
    if (setup_.person)
      parts[6].translation() =
          Eigen::Vector3d(random_.uniform(-0.7, 0.2), random_.uniform(0.5, 0.9), 0.75);
    stage_.place(frame.joints, parts);
    const int width = intrinsics().width(), height = intrinsics().height();
    Image<float> depth(width, height);
    const auto all = [](std::int32_t) { return true; };
    stage_.draw_ids({intrinsics(), T_root_camera}, all, {0, 0, width, height}, nullptr, &depth);
    Image<std::uint16_t> measured;
    sensor_.measure(depth, frame.index, measured);
    frame.depth = Image<float>(measured.width(), measured.height());
    for (std::size_t i = 0; i < measured.size(); ++i)
      frame.depth.data()[i] =
          static_cast<float>(metres_of(measured.data()[i]) * (1.0 + setup_.depth_scale));
  }

  /// Replaces the depth by the mask of the visible robot, with the setup's faults.
  void draw_mask(KeptFrame& frame) {
    if (random_.uniform(0.0, 1.0) < setup_.wrong_masks) {
      KeptFrame other;
      other.joints = pose();
      draw(other);
    }
    const Eigen::Isometry3d T_root_camera =
        setup_.on_hand ? arm_.link_pose(frame.joints, choice_.flange) * T_parent_camera_
                       : T_parent_camera_;
    const int width = intrinsics().width(), height = intrinsics().height();
    Image<std::int32_t> ids(width, height);
    const auto all = [](std::int32_t) { return true; };
    stage_.draw_ids({intrinsics(), T_root_camera}, all, {0, 0, width, height}, &ids, nullptr);
    frame.depth = {};
    frame.mask = Image<std::uint8_t>(width, height);
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
        frame.mask(u, v) = ids(u, v) != 0 && (setup_.tool || ids(u, v) < sim::first_object_id);
    for (int i = 0; i < std::abs(setup_.mask_grown); ++i)
      paint(frame.mask, border(frame.mask), 1, setup_.mask_grown > 0);
    const std::vector<std::pair<int, int>> edge = border(frame.mask);
    constexpr double mean_width = 16.0;  // pixels of the border that a disc covers
    const double discs = setup_.mask_border * static_cast<double>(edge.size()) / mean_width;
    for (int i = 0; i < discs; ++i) {
      const auto at =
          static_cast<std::size_t>(random_.uniform(0.0, static_cast<double>(edge.size()) - 0.001));
      paint(frame.mask, {edge[at]}, static_cast<int>(random_.uniform(4.0, 12.0)),
            random_.uniform(0.0, 1.0) < 0.5);
    }
  }

  /// Replaces the depth by a colour image with noise, in the setup's light.
  void draw_colors(KeptFrame& frame) {
    constexpr double noise = 3.0;  // levels
    frame.depth = {};
    stage_.draw_color({intrinsics(), truth()}, frame.color);
    const double light = std::exp(setup_.light * random_.normal());
    const auto seen = [&](std::uint8_t level) {
      return static_cast<std::uint8_t>(
          std::clamp(light * level + noise * random_.normal() + 0.5, 0.0, 255.0));
    };
    for (std::size_t i = 0; i < frame.color.size(); ++i) {
      Rgb8& pixel = frame.color.data()[i];
      pixel = {seen(pixel.r), seen(pixel.g), seen(pixel.b)};
    }
  }

  /// A first guess: 100 mm and 10 degrees off, in any direction.
  [[nodiscard]] Eigen::Isometry3d off() {
    const auto any = [&] {
      return Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal()).normalized();
    };
    Eigen::Isometry3d T = truth();
    T.translation() += 0.1 * any();
    T.linear() = T.linear() * Eigen::AngleAxisd(10.0 * degree, any()).matrix();
    return T;
  }

 private:
  /// Pixels of the mask next to one that is not.
  static std::vector<std::pair<int, int>> border(const Image<std::uint8_t>& mask) {
    std::vector<std::pair<int, int>> found;
    for (int v = 1; v + 1 < mask.height(); ++v)
      for (int u = 1; u + 1 < mask.width(); ++u)
        if (mask(u, v) != 0 && (mask(u - 1, v) == 0 || mask(u + 1, v) == 0 || mask(u, v - 1) == 0 ||
                                mask(u, v + 1) == 0))
          found.emplace_back(u, v);
    return found;
  }

  /// Sets or clears discs. Radius 1 sets a pixel's four neighbours, and clears the pixel alone.
  static void paint(Image<std::uint8_t>& mask, const std::vector<std::pair<int, int>>& centres,
                    int radius, bool set) {
    const int reach = radius == 1 && !set ? 0 : radius;
    for (const auto& [u, v] : centres)
      for (int y = std::max(0, v - reach); y <= std::min(mask.height() - 1, v + reach); ++y)
        for (int x = std::max(0, u - reach); x <= std::min(mask.width() - 1, u + reach); ++x)
          if ((x - u) * (x - u) + (y - v) * (y - v) <= reach * reach) mask(x, y) = set;
  }

  [[nodiscard]] std::vector<double> reported(std::vector<double> joints) const {
    for (std::size_t i = 0; i < setup_.joint_errors.size(); ++i)
      joints[i] += setup_.joint_errors[i];
    return joints;
  }

  static sim::DepthNoise noise(const Setup& setup) {
    sim::DepthNoise noise = setup.sensor;
    noise.holes = std::max(noise.holes, setup.missing);
    return noise;
  }

  sim::SceneDescription room() {
    sim::SceneDescription scene;
    const auto box = [&](const std::string& size, const std::string& at) {
      std::string looks;
      if (setup_.colors) {  // which others do not see
        constexpr int pixels = 256;
        const std::string name = "print" + std::to_string(scene.textures.size());
        scene.assets += "<texture name=\"" + name + "\" type=\"2d\" builtin=\"flat\" width=\"" +
                        std::to_string(pixels) + "\" height=\"" + std::to_string(pixels) +
                        "\"/><material name=\"" + name + "\" texture=\"" + name +
                        "\" specular=\"0\"/>";
        scene.textures.push_back({name, sim::busy_print(pixels, pixels, random_)});
        looks = " material=\"" + name + "\"";
      }
      scene.parts.push_back({-1, "<geom type=\"box\" size=\"" + size + "\" pos=\"" + at + "\"" +
                                     looks + " group=\"2\"/>"});
    };
    box("3 3 0.05", "0 0 -0.06");
    box("0.05 3 2", "-1.2 0 1");
    box("3 0.05 2", "0 -1.6 1");
    box("0.15 0.2 0.15", "-0.5 0.6 0.1");
    scene.parts.push_back({-1, R"(<geom type="cylinder" size="0.04 0.12" group="2"/>)"});
    scene.parts.push_back(
        {0, R"(<geom type="box" size="0.05 0.03 0.06" pos="0 0 0.06" group="2"/>)"});
    scene.parts.push_back({-1, R"(<geom type="capsule" size="0.17 0.6" group="2"/>)"});
    return scene;
  }

  /// A pose with all links above the table. A camera on the hand looks at the arm.
  std::vector<double> pose() {
    const double range = setup_.on_hand ? 2.5 : 0.7;
    for (;;) {
      std::vector<double> joints = robot().rest_positions();
      for (std::size_t i = 0; i < choice_.centre.size(); ++i)
        joints[i] = choice_.centre[i] + random_.uniform(-range, range);
      const auto centres = arm_.part_centres(joints);
      if (std::all_of(centres.begin(), centres.end(),
                      [](const Eigen::Vector3d& centre) { return centre.z() > 0.04; }) &&
          (!setup_.on_hand || sees_arm(joints)))
        return joints;
    }
  }

  /// Whether links that do not move with the camera fill a tenth of its image, and none is nearer
  /// than the camera can measure.
  bool sees_arm(const std::vector<double>& joints) {
    std::vector<Eigen::Isometry3d> poses(robot().links().size()), rest = poses;
    robot().forward_kinematics(joints, poses);
    robot().forward_kinematics(robot().rest_positions(), rest);
    const Eigen::Isometry3d T_camera_root = (poses[parent_] * T_parent_camera_).inverse();
    std::vector<bool> moves;
    for (std::size_t i = 0; i < poses.size(); ++i)
      moves.push_back(
          !(rest[parent_].inverse() * rest[i]).isApprox(poses[parent_].inverse() * poses[i], 1e-6));
    for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
    constexpr float nearest = 0.1f;  // metres
    const VirtualDepthView robot_seen = small_renderer_->render(poses);
    const auto& depth = robot_seen.depth;
    const auto& links = robot_seen.links;
    int seen = 0;
    for (int v = 0; v < links.height; ++v)
      for (int u = 0; u < links.width; ++u) {
        if (links(u, v) == 0) continue;
        if (depth(u, v) < nearest) return false;
        seen += moves[links(u, v) - 1U];
      }
    return seen > links.width * links.height / 10;
  }

  /// Frames of the swinging arm, with the poses at the times of 30 images per second around them.
  std::vector<KeptFrame> moving_frames() {
    constexpr double period = 1.0 / 30.0;  // seconds
    constexpr int around = 4;              // images before and after
    start_swing();
    std::vector<KeptFrame> all;
    while (all.size() < setup_.frames) {
      KeptFrame frame;
      frame.index = all.size();
      const double stamp = 1.7 / pace_ * static_cast<double>(all.size());
      frame.joints = joints_at(stamp + setup_.late);
      draw(frame);
      frame.joints = reported(joints_at(stamp));
      frame.stamp = static_cast<std::int64_t>(1e9 * stamp);
      for (int k = -around; k <= around; ++k) {
        KeptFrame& near = frame.nearby.emplace_back();
        near.stamp = *frame.stamp + static_cast<std::int64_t>(1e9 * period * k);
        near.joints = reported(joints_at(stamp + period * k));
        near.T_root_link.resize(robot().links().size());
        robot().forward_kinematics(near.joints, near.T_root_link);
      }
      frame.T_root_link = frame.nearby[around].T_root_link;
      all.push_back(std::move(frame));
    }
    return all;
  }

  const RobotChoice& choice_;
  const Setup& setup_;
  sim::Random random_;
  sim::TemporaryFolder folder_;
  sim::Arm arm_;
  sim::Stage stage_;
  sim::DepthSensor sensor_;
  std::size_t parent_;
  std::unique_ptr<DepthRenderer> small_renderer_;
  Eigen::Isometry3d T_parent_camera_;
  std::vector<double> centre_, phases_, rates_;  // of the swing
  double pace_ = 1.0;
};

using detail::median;
using detail::quantile;

/// The folder of the data, and the robots.
inline std::filesystem::path data_folder() {
  return std::getenv("PENUMBRA_DATA") != nullptr ? std::getenv("PENUMBRA_DATA")
                                                 : PENUMBRA_STUDY_DATA;
}

inline std::vector<RobotChoice> robots() {
  const std::filesystem::path data = data_folder();
  const auto visual = [](std::map<std::string, std::filesystem::path> packages) {
    RobotOptions options;
    options.packages = std::move(packages);
    options.geometry = Geometry::visual;
    options.geometry_fallback = true;
    return options;
  };
  return {{"shipped arm", PENUMBRA_STUDY_ARM, visual({}), "tool0", {0.0, 0.2, 1.0, 0.3, 0.6, 0.0}},
          {"xArm 7",
           data / "robots/xarm7/xarm7.urdf",
           visual({{"xarm_description", data / "robots/xarm7/xarm_description"}}),
           "link_eef",
           {0.0, -0.3, 0.0, 1.2, 0.0, 1.2, 0.0}},
          {"UR5e",
           data / "robots/ur5e/ur5e.urdf",
           visual({{"ur_description", data / "robots/ur5e/ur_description"}}),
           "tool0",
           {0.0, -1.4, 1.4, -1.5, -1.5, 0.0}}};
}

}  // namespace penumbra::study
