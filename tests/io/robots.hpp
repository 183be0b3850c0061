// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

/// Two joints that move, "shoulder" and "elbow", a finger that mimics "elbow", a fixed "flange".
inline constexpr const char* arm_urdf = R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/> <link name="upper"/> <link name="lower"/> <link name="finger"/>
  <link name="tool"/>
  <joint name="shoulder" type="continuous">
    <parent link="base"/> <child link="upper"/> <axis xyz="0 0 1"/>
  </joint>
  <joint name="elbow" type="prismatic">
    <parent link="upper"/> <child link="lower"/> <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="finger_joint" type="continuous">
    <parent link="lower"/> <child link="finger"/> <axis xyz="1 0 0"/>
    <mimic joint="elbow" multiplier="2"/>
  </joint>
  <joint name="flange" type="fixed">
    <parent link="lower"/> <child link="tool"/>
  </joint>
</robot>
)";

inline Robot arm() { return Robot::parse(arm_urdf, "."); }

/// A robot that is not drawn, with the link "base".
inline Robot bare_robot() {
  return Robot::parse(R"(<robot name="r"><link name="base"/></robot>)", ".");
}

}  // namespace penumbra::test
