// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <utility>

#include <penumbra/base/text.hpp>
#include <penumbra/diagnosis/hypothesis-inl.hpp>

namespace penumbra::diagnosis {
namespace {

using detail::fixed;

constexpr double pi = std::numbers::pi;

/// Adds hypotheses that differ from the given setup by one mistake.
class Mistakes {
 public:
  explicit Mistakes(const Setup& setup) : setup_(setup) {}

  std::vector<Hypothesis> all() {
    if (setup_.has_depth() && !setup_.is_scanner) depth_units();
    if (!setup_.is_scanner) {  // how a camera's files may be written
      camera_poses();
      other_cameras();
    }
    other_joints();
    other_frames();
    other_times();
    return std::move(found_);
  }

 private:
  Hypothesis& add(Cause cause, std::string message) {
    found_.push_back(as_given(setup_));
    found_.back().cause = cause;
    found_.back().message = std::move(message);
    return found_.back();
  }

  void depth_units() {
    struct Unit {
      double factor;
      const char *by, *error;
    };
    static constexpr std::array units{
        Unit{1e-3, "0.001", "1000 times too large, as millimetres taken for metres are"},
        Unit{1e3, "1000", "1000 times too small, as metres taken for millimetres are"},
        Unit{0.1, "0.1", "10 times too large"},
        Unit{0.2, "0.2", "5 times too large"},
        Unit{0.25, "0.25", "4 times too large"},
        Unit{10.0, "10", "10 times too small"}};
    for (const Unit& unit : units)
      add(Cause::depth_unit, std::string("depth is ") + unit.error + ": multiply it by " + unit.by +
                                 ", or depth_scale (default: 0.001 for 16 bits, 1 for floats)")
          .depth_factor = unit.factor;
    add(Cause::depth_ray,
        "depth is the distance along each pixel's ray: give its z-component, or "
        "set depth_along to ray")
        .along_ray = true;
    scaled_depths();
  }

  /// Depth of images or floats that use all of their range, whatever is in them.
  void scaled_depths() {
    constexpr float farthest = 60.0F;  // metres: 65535 in millimetres, nearly
    const float largest = largest_depth(setup_);
    if (largest > normalised && largest < farthest) return;
    constexpr double step = 0.05;  // of the logarithm
    const double sign = largest > normalised ? -1.0 : 1.0;
    for (int i = 6; i <= 90; ++i)
      with_amount(sign * i * step, step, [&setup = setup_](double amount) {
        Hypothesis hypothesis = as_given(setup);
        hypothesis.cause = Cause::depth_scale;
        hypothesis.depth_factor = std::exp(amount);
        const std::string factor = fixed(hypothesis.depth_factor, amount > 0.0 ? 2 : 4);
        hypothesis.message = "depth looks normalised: it fits if it is multiplied by about " +
                             factor + ": give metres, or multiply depth_scale by it";
        return hypothesis;
      });
  }

  void camera_poses() {
    const Eigen::Isometry3d& T = setup_.T_parent_camera;
    const auto turned = [&](const Eigen::Matrix3d& R) {
      Eigen::Isometry3d other = T;
      other.linear() = T.linear() * R;
      return other;
    };
    Eigen::Isometry3d other = T;
    other.translation() /= 1000.0;
    constexpr double nearest = 0.02;  // metres between a camera and its parent link, if any
    if (other.translation().norm() > nearest)
      add(Cause::camera_unit, "the camera's position is in millimetres: give metres")
          .T_parent_camera = other;
    add(Cause::camera_inverted,
        "the camera's pose looks inverted: give the pose of the camera in its parent link's frame")
        .T_parent_camera = T.inverse();
    other = T;
    other.linear() = T.linear().transpose();
    add(Cause::camera_transposed, "the rotation of the camera's pose looks transposed")
        .T_parent_camera = other;
    Eigen::Matrix3d body_optical, gl_optical;
    body_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    gl_optical << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    add(Cause::camera_axes,
        "the camera's pose looks like that of its body (x forward, z up): give the pose of the "
        "optical frame (x right, y down, z forward)")
        .T_parent_camera = turned(body_optical);
    add(Cause::camera_axes,
        "the camera's pose looks like that of OpenGL's axes (y up, z back): give the pose of the "
        "optical frame (x right, y down, z forward)")
        .T_parent_camera = turned(gl_optical);
  }

  /// camera_info of another resolution, whose principal point is not in the image's middle, or of
  /// another camera.
  void other_cameras() {
    const Intrinsics& given = setup_.raw_camera;
    const double width = given.width(), height = given.height();
    // Of the frames' images, which may be free of a lens's distortion and smaller, if the given
    // camera has another focal length and its principal point in the middle.
    const auto with = [&](double scale) {
      const Intrinsics& kept = setup_.camera;
      const double x = (given.cx() - 0.5 * (width - 1.0)) / given.fx(),
                   y = (given.cy() - 0.5 * (height - 1.0)) / given.fy();
      return Intrinsics(kept.width(), kept.height(), scale * kept.fx(), scale * kept.fy(),
                        kept.cx() - kept.fx() * x, kept.cy() - kept.fy() * y);
    };
    constexpr double off_centre = 0.12;  // of the image; principal points of sensors are nearer
    const double across = width / (2.0 * given.cx() + 1.0),
                 down = height / (2.0 * given.cy() + 1.0);
    if (given.cx() > 0.0 && given.cy() > 0.0 &&
        (std::abs(across - 1.0) > 2.0 * off_centre || std::abs(down - 1.0) > 2.0 * off_centre))
      for (const double scale : {across, down})
        add(Cause::intrinsics, "camera_info is of images of about " + fixed(width / scale, 0) +
                                   "x" + fixed(height / scale, 0) + " pixels, but these are " +
                                   std::to_string(given.width()) + "x" +
                                   std::to_string(given.height()))
            .camera = with(scale);
    constexpr double step = 0.05;  // of the logarithm
    for (int i = -16; i <= 16; ++i)
      if (std::abs(i) >= 2)
        with_amount(i * step, step, [&setup = setup_](double amount) {
          const Intrinsics& camera = setup.camera;
          const double scale = std::exp(amount);
          Hypothesis hypothesis = as_given(setup);
          hypothesis.cause = Cause::intrinsics;
          hypothesis.camera = Intrinsics(camera.width(), camera.height(), scale * camera.fx(),
                                         scale * camera.fy(), camera.cx(), camera.cy());
          const double focal = setup.raw_camera.fx();
          hypothesis.message = "the focal length in camera_info is " + fixed(focal, 0) +
                               " pixels, but the images show about " + fixed(scale * focal, 0) +
                               ": is camera_info of another stream or camera?";
          return hypothesis;
        });
  }

  void with_amount(double amount, double step, const std::function<Hypothesis(double)>& make) {
    Hypothesis hypothesis = make(amount);
    if (hypothesis.cause == Cause::none) return;
    hypothesis.with_amount = make;
    hypothesis.amount = amount;
    hypothesis.step = step;
    found_.push_back(std::move(hypothesis));
  }

  void with_joints(Cause cause, std::string message,
                   const std::function<void(std::vector<double>&)>& change) {
    found_.push_back(of_joints(setup_, cause, std::move(message), change));
  }

  static Hypothesis of_joints(const Setup& setup, Cause cause, std::string message,
                              const std::function<void(std::vector<double>&)>& change) {
    Hypothesis hypothesis = as_given(setup);
    hypothesis.cause = cause;
    hypothesis.message = std::move(message);
    for (std::size_t k = 0; k < setup.frames.size(); ++k) {
      std::vector<double> joints = setup.frames[k].joints;
      change(joints);
      for (double& joint : joints)
        if (!std::isfinite(joint) || std::abs(joint) > 1e6) joint = 0.0;
      setup.robot.forward_kinematics(joints, hypothesis.T_root_link[k]);
    }
    return hypothesis;
  }

  void other_joints() {
    const std::vector<std::size_t> turning = turning_variables();
    if (std::ranges::any_of(setup_.frames, [](const auto& f) { return f.joints.empty(); })) return;
    const auto name = [&](std::size_t i) { return "'" + setup_.robot.variables()[i] + "'"; };
    const bool is_large = std::ranges::any_of(setup_.frames, [&](const KeptFrame& frame) {
      return std::ranges::any_of(
          turning, [&](std::size_t i) { return std::abs(frame.joints[i]) > 2.0 * pi; });
    });
    if (is_large)
      with_joints(Cause::joint_unit, "joint positions are in degrees: give radians",
                  [&](auto& joints) {
                    for (const std::size_t i : turning) joints[i] *= pi / 180.0;
                  });
    for (const std::size_t i : turning) {
      with_joints(Cause::joint_sign, "joint " + name(i) + " turns the other way: change its sign",
                  [&](auto& joints) { joints[i] = -joints[i]; });
      for (int by = -175; by <= 180; by += std::abs(by) < 45 ? 5 : 15)
        if (by != 0)
          with_amount(by * pi / 180.0, 5.0 * pi / 180.0, [&setup = setup_, i](double amount) {
            return of_joints(setup, Cause::joint_zero,
                             "the zero of joint '" + setup.robot.variables()[i] +
                                 "' is off: it reads about " +
                                 fixed(std::abs(amount) * 180.0 / pi, 0) + " degrees too " +
                                 (amount > 0 ? "low" : "high"),
                             [&](auto& joints) { joints[i] += amount; });
          });
      for (const std::size_t j : turning)
        if (j > i)
          with_joints(Cause::joint_order,
                      "the positions of joints " + name(i) + " and " + name(j) +
                          " look exchanged: check the order of the joints",
                      [&](auto& joints) { std::swap(joints[i], joints[j]); });
    }
  }

  /// Those that turn something that is drawn.
  [[nodiscard]] std::vector<std::size_t> turning_variables() const {
    const Robot& robot = setup_.robot;
    std::vector<bool> carries(robot.links().size());
    for (std::size_t link = robot.links().size(); link-- > 1;) {
      carries[link] = carries[link] || !robot.meshes(link).empty();
      if (carries[link]) carries[robot.joints()[link - 1].parent] = true;
    }
    std::set<std::size_t> variables;
    for (const Joint& joint : robot.joints())
      if (joint.variable && carries[joint.child] &&
          (joint.type == JointType::revolute || joint.type == JointType::continuous))
        variables.insert(*joint.variable);
    return {variables.begin(), variables.end()};
  }

  void other_frames() {
    constexpr int most = 4;
    for (int by = -most; by <= most; ++by) {
      if (by == 0) continue;
      Hypothesis hypothesis = as_given(setup_);
      std::size_t used = 0;
      for (std::size_t k = 0; k < setup_.frames.size(); ++k) {
        hypothesis.T_root_link[k].clear();
        const KeptFrame& frame = setup_.frames[k];
        const auto near = std::ranges::find_if(frame.nearby, [&](const KeptFrame& other) {
          return other.number == frame.number + static_cast<std::size_t>(by);
        });
        if (near != frame.nearby.end()) hypothesis.T_root_link[k] = near->T_root_link, ++used;
      }
      if (used < 2 && used < setup_.frames.size()) continue;
      hypothesis.cause = Cause::joint_time;
      hypothesis.message =
          "the joint positions of a frame fit the image of " + std::to_string(std::abs(by)) +
          (std::abs(by) == 1 ? " frame " : " frames ") + (by > 0 ? "before" : "after") +
          ": are joint positions missing or shifted?";
      found_.push_back(std::move(hypothesis));
    }
  }

  void other_times() {
    constexpr double step = 0.02;  // seconds
    for (int i = -12; i <= 12; ++i)
      if (i != 0)
        with_amount(i * step, step, [&setup = setup_](double by) {
          Hypothesis hypothesis = as_given(setup);
          std::size_t used = 0;
          for (std::size_t k = 0; k < setup.frames.size(); ++k) {
            hypothesis.T_root_link[k] = poses_at(setup.robot, setup.frames[k], by);
            used += !hypothesis.T_root_link[k].empty();
          }
          if (2 * used < setup.frames.size()) return hypothesis;
          hypothesis.cause = Cause::joint_time;
          hypothesis.message = "images and joint states are about " + fixed(1e3 * std::abs(by), 0) +
                               " ms apart: of a bag or topics, set time_offset to " + fixed(by, 3);
          return hypothesis;
        });
  }

  const Setup& setup_;
  std::vector<Hypothesis> found_;
};

}  // namespace

Hypothesis as_given(const Setup& setup) {
  Hypothesis hypothesis{.camera = setup.camera,
                        .T_parent_camera = setup.T_parent_camera,
                        .T_root_link = {},
                        .message = {},
                        .with_amount = {}};
  for (const KeptFrame& frame : setup.frames) hypothesis.T_root_link.push_back(frame.T_root_link);
  return hypothesis;
}

float largest_depth(const Setup& setup) {
  float largest = 0.0F;
  for (const KeptFrame& frame : setup.frames)
    for (const float z : std::span(frame.depth.data(), frame.depth.size()))
      if (std::isfinite(z)) largest = std::max(largest, z);
  return largest;
}

std::vector<Hypothesis> mistakes(const Setup& setup) { return Mistakes(setup).all(); }

}  // namespace penumbra::diagnosis
