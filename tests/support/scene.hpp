// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::test {

/// Bodies with their poses, owned.
class Scene {
 public:
  /// Adds a body of these meshes and returns its index.
  std::size_t add(const std::vector<TriangleMesh>& meshes,
                  const Eigen::Isometry3d& T_camera_body = Eigen::Isometry3d::Identity()) {
    meshes_.emplace_back(meshes.begin(), meshes.end());
    names_.push_back("body" + std::to_string(names_.size()));
    poses.push_back(T_camera_body);
    return poses.size() - 1;
  }
  std::size_t add(const TriangleMesh& mesh,
                  const Eigen::Isometry3d& T_camera_body = Eigen::Isometry3d::Identity()) {
    return add(std::vector<TriangleMesh>{mesh}, T_camera_body);
  }

  [[nodiscard]] std::vector<Body> bodies() const {
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < meshes_.size(); ++i) bodies.push_back({names_[i], meshes_[i]});
    return bodies;
  }

  std::vector<Eigen::Isometry3d> poses;  ///< T_camera_body, one per body

 private:
  std::deque<std::vector<PreparedMesh>> meshes_;
  std::deque<std::string> names_;
};

}  // namespace penumbra::test
