// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>

#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

namespace penumbra::sim {

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, DeleteModel>;
using DataPtr = std::unique_ptr<mjData, DeleteData>;

/// Returns the mutex for the state that belongs to the whole process: OpenGL's loader, MuJoCo's
/// reader with its last model, and MuJoCo's fault handler.
[[nodiscard]] inline std::mutex& mujoco_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Returns the world pose of body `body`, metres.
[[nodiscard]] inline Eigen::Isometry3d body_pose(const mjData& data, int body) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(data.xpos + 3 * body);
  pose.linear() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.xmat + 9 * body);
  return pose;
}

}  // namespace penumbra::sim
