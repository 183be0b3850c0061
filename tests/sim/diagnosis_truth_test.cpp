// SPDX-License-Identifier: Apache-2.0
// Setups that are right but for one mistake, in MuJoCo's images: depth under a D415's noise, or
// colour images alone.
#include "simulated.hpp"

#include <cstdio>

#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/session/session.hpp>

namespace penumbra::test {
namespace {

using Cause = Diagnosis::Cause;

/// What a user gives; the frames are of the scene "random": new poses of the arm, with things
/// before, behind and next to it.
struct Given {
  Intrinsics camera;
  Eigen::Isometry3d T_base_camera;
  std::vector<Image<float>> depth;  // metres
  std::vector<std::vector<double>> joints;
  std::vector<Image<Rgb8>> color;  // in place of depth; empty: it is not
};

/// The camera is given elsewhere, by metres and degrees.
std::function<void(Given&)> moved(double metres, double turn) {
  return [=](Given& given) {
    given.T_base_camera.translation() += metres * Eigen::Vector3d(1, -1, 1).normalized();
    given.T_base_camera.linear() =
        given.T_base_camera.linear() *
        Eigen::AngleAxisd(turn * degree, Eigen::Vector3d(1, 1, 0).normalized()).matrix();
  };
}

void in_millimetres(Given& given) { given.T_base_camera.translation() *= 1000.0; }
void inverted(Given& given) { given.T_base_camera = given.T_base_camera.inverse(); }

/// Each frame's joints are given otherwise.
std::function<void(Given&)> changed(const std::function<void(std::vector<double>&)>& change) {
  return [=](Given& given) { std::ranges::for_each(given.joints, change); };
}

/// They are given as those of other frames.
std::function<void(Given&)> shifted(int by) {
  return [=](Given& given) {
    std::rotate(given.joints.begin(), given.joints.begin() + by, given.joints.end());
  };
}

class DiagnosisTruth : public testing::Test {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_SIMULATION();
    simulation_.emplace("random", without_color(3, true));
    given_.emplace(
        Given{simulation_->camera().intrinsics, simulation_->T_base_camera(), {}, {}, {}});
    sim::SimFrame frame;
    while (given_->depth.size() < 8 && simulation_->next(frame)) {
      given_->depth.push_back(in_metres(frame.depth));
      given_->joints.push_back(frame.joints);
    }
  }

  Diagnosis diagnosed(const std::function<void(Given&)>& spoil = [](Given&) {}) {
    Given given = *given_;
    spoil(given);
    Camera camera{given.camera, {}, {}, {}};
    camera.T_parent_camera = given.T_base_camera;
    PipelineConfig config;
    config.has_depth = given.color.empty();
    Session session(simulation_->robot(), camera, config);
    for (std::size_t i = 0; i < given.joints.size(); ++i) {
      Frame frame{.pose = {.positions = given.joints[i]}};
      if (config.has_depth)
        frame.depth = given.depth[i].view();
      else
        frame.color = std::as_const(given.color[i]).view();
      session.process(frame);
    }
    return session.diagnosis();
  }

  /// The cause is named alone.
  void expect(Cause cause, const std::function<void(Given&)>& spoil) {
    const Diagnosis found = diagnosed(spoil);
    EXPECT_EQ(to_string(found.cause), to_string(cause)) << found.message;
    EXPECT_EQ(found.other, Cause::none) << found.message;
    EXPECT_FALSE(found.message.empty());
  }

  /// The mistakes with joints that depth and colours tell.
  void expect_joints() {
    const std::size_t elbow = *simulation_->robot().find_variable("elbow");
    expect(Cause::joint_unit, changed([](auto& joints) {
             for (double& joint : joints) joint /= degree;
           }));
    expect(Cause::joint_sign, changed([&](auto& joints) { joints[elbow] = -joints[elbow]; }));
    expect(Cause::joint_zero, changed([&](auto& joints) { joints[elbow] += 20.0 * degree; }));
    expect(Cause::joint_time, shifted(1));
  }

  std::optional<sim::Simulation> simulation_;
  std::optional<Given> given_;
};

TEST_F(DiagnosisTruth, ACameraThatIsElsewhereOrWhosePoseIsWrittenInAnotherWay) {
  expect(Cause::camera_pose, moved(0.02, 0.5));
  expect(Cause::camera_pose, moved(0.05, 3.0));
  expect(Cause::camera_pose, moved(0.25, 12.0));
  expect(Cause::camera_unit, in_millimetres);
  expect(Cause::camera_inverted, inverted);
  expect(Cause::camera_transposed, [](Given& given) {
    given.T_base_camera.linear() = given.T_base_camera.linear().transpose().eval();
  });
  Eigen::Matrix3d optical_body, optical_gl;  // the axes of a body and of OpenGL, as columns
  optical_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  optical_gl << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  for (const Eigen::Matrix3d& axes : {optical_body, optical_gl})
    expect(Cause::camera_axes, [&](Given& given) {
      given.T_base_camera.linear() = given.T_base_camera.linear() * axes;
    });
}

/// The labels show nothing of it.
TEST_F(DiagnosisTruth, ASmallErrorOfTheCameraHasItsErrorBar) {
  const Diagnosis found = diagnosed(moved(0.010, 0.0));
  ASSERT_EQ(to_string(found.cause), to_string(Cause::camera_pose)) << found.message;
  int position = 0, error = 0;
  ASSERT_EQ(std::sscanf(found.message.c_str(), "the camera's pose is about %d +- %d mm", &position,
                        &error),
            2)
      << found.message;
  EXPECT_LE(std::abs(position - 10), error);
  EXPECT_LT(error, 8);
  EXPECT_EQ(diagnosed(moved(0.004, 0.1)).message, "");
}

TEST_F(DiagnosisTruth, DepthInAnotherUnitAndCameraInfoOfOtherImages) {
  for (const double factor : {10.0, 4.0, 1000.0})
    expect(Cause::depth_unit, [&](Given& given) {
      for (Image<float>& depth : given.depth)
        for (std::size_t i = 0; i < depth.size(); ++i)
          depth.data()[i] *= static_cast<float>(factor);
    });
  expect(Cause::depth_ray, [](Given& given) {
    for (Image<float>& depth : given.depth)
      for (const auto [u, v] : each_pixel(depth))
        depth(u, v) *= static_cast<float>(given.camera.ray(u, v).norm());
  });
  const auto scaled = [](double focal, double centre) {
    return [=](Given& given) {
      const Intrinsics& camera = given.camera;
      given.camera = {camera.width(),
                      camera.height(),
                      focal * camera.fx(),
                      focal * camera.fy(),
                      centre * (camera.cx() + 0.5) - 0.5,
                      centre * (camera.cy() + 0.5) - 0.5};
    };
  };
  expect(Cause::intrinsics, scaled(0.5, 0.5));
  expect(Cause::intrinsics, scaled(1.5, 1.5));
  expect(Cause::intrinsics, scaled(0.7, 1.0));
}

TEST_F(DiagnosisTruth, JointsOfAnotherConventionOrOfOtherFrames) {
  const Robot& robot = simulation_->robot();
  const std::size_t lift = *robot.find_variable("shoulder_lift"),
                    elbow = *robot.find_variable("elbow");
  expect_joints();
  expect(Cause::joint_order,
         changed([&](auto& joints) { std::swap(joints[lift], joints[elbow]); }));
  expect(Cause::joint_time, shifted(3));
}

/// The scene changes from image to image. The last joint turns little that is seen.
class DiagnosisByColor : public DiagnosisTruth {
 protected:
  void SetUp() override {
    DiagnosisTruth::SetUp();
    if (IsSkipped()) return;
    simulation_.emplace("random", sim::SimulationOptions{.seed = 3});
    sim::SimFrame frame;
    for (given_->joints.clear(); given_->color.size() < 16 && simulation_->next(frame);) {
      given_->color.push_back(frame.color);
      given_->joints.push_back(frame.joints);
    }
  }
};

TEST_F(DiagnosisByColor, NamesTheSameMistakes) {
  EXPECT_EQ(diagnosed().message, "");
  expect(Cause::camera_pose, moved(0.05, 3.0));
  expect(Cause::camera_unit, in_millimetres);
  expect(Cause::camera_inverted, inverted);
  expect_joints();
}

TEST_F(DiagnosisTruth, NothingIsInvented) {
  const Diagnosis of_a_right_setup = diagnosed();
  EXPECT_EQ(of_a_right_setup.cause, Cause::none);
  EXPECT_EQ(of_a_right_setup.message, "");
  const Diagnosis of_one_frame = diagnosed([](Given& given) {
    given.depth.resize(1);
    given.joints.resize(1);
  });
  EXPECT_EQ(of_one_frame.cause, Cause::none) << of_one_frame.message;
  const Diagnosis of_another_robot = diagnosed([&](Given& given) {
    for (std::size_t i = 0; i < given.joints.size(); ++i)
      for (std::size_t j = 0; j < given.joints[i].size(); ++j)
        given.joints[i][j] = std::sin(7.0 * static_cast<double>(i + 3 * j + i * j));
  });
  EXPECT_EQ(of_another_robot.cause, Cause::unexplained) << of_another_robot.message;
}

}  // namespace
}  // namespace penumbra::test
