// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <string_view>
#include <vector>

#include <penumbra/base/version.hpp>
#include <penumbra/session/session.hpp>

int main() {
  constexpr std::string_view urdf = R"(
    <robot name="two">
      <link name="base"/>
      <link name="tip">
        <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision>
      </link>
      <joint name="slide" type="prismatic">
        <origin xyz="0 0 1"/><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
        <limit lower="0" upper="1" effort="1" velocity="1"/>
      </joint>
    </robot>)";
  // The camera sits on the base and looks along z: the box's face is 1 m + 0.5 m - 0.1 m away.
  const penumbra::Camera camera{.intrinsics = penumbra::Intrinsics(64, 48, 60, 60, 32, 24),
                                .T_parent_camera = Eigen::Isometry3d::Identity()};
  penumbra::Session session(penumbra::Robot::parse(urdf, "."), camera);
  const std::vector<double> joints{0.5};
  const penumbra::Image<float> depth(64, 48, 1.4F);
  const auto& report = session.process({.depth = depth.view(), .pose = {.positions = joints}});
  std::cout << "penumbra " PENUMBRA_VERSION ": depth " << report.virtual_depth.depth(32, 24)
            << ", occluded " << report.pixels.occluded << '\n';
}
