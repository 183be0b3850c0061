// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <string_view>

#include <penumbra/base/version.hpp>
#include <penumbra/robot/robot.hpp>

int main() {
  constexpr std::string_view urdf = R"(
    <robot name="two">
      <link name="base"/>
      <link name="tip">
        <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
      </link>
      <joint name="turn" type="continuous"><parent link="base"/><child link="tip"/></joint>
    </robot>)";
  const auto robot = penumbra::Robot::parse(urdf, ".");
  std::cout << "penumbra " PENUMBRA_VERSION ": " << robot.links().size() << " links\n";
}
