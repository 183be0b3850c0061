// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/robot/robot.hpp>

#include <io/web/web_types.hpp>

namespace penumbra::io {

/// The drawing of a robot: the triangles of its renderer.
struct Scene {
  std::uint64_t version = 1;
  SharedBytes json;      ///< {"server", "version", "root", "links": [{"name", "meshes": [...]}]}
  SharedBytes geometry;  ///< float32 x y z in the link's frame, metres, and uint32 indices
};

[[nodiscard]] Scene make_scene(const Robot& robot, std::uint64_t version = 1);

/// Makes the scene of links whose geometry is not known.
[[nodiscard]] Scene make_scene(std::span<const std::string> links);

/// Returns "link_poses": [[x, y, z, qx, qy, qz, qw]...], "camera_pose": [...] (of a scan the
/// points' frame), all in the root link's frame; null if the robot's pose is not known.
[[nodiscard]] std::string poses_json(std::span<const Eigen::Isometry3d> T_root_link,
                                     const std::optional<Eigen::Isometry3d>& T_root_camera,
                                     std::size_t links);

}  // namespace penumbra::io
