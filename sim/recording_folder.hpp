// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <sim/recording_sink.hpp>

namespace penumbra::sim {

/// Writes a simulation as a recording for `penumbra run`, with the truth next to it:
///   recording.yaml, camera_info.yaml, camera_pose.csv, the arm's URDF folder
///   joint_states.csv   positions as reported; true_joint_states.csv: true positions
///   color/, depth/     000000.png; 8-bit RGB and 16-bit millimetres; second_depth/ too
///   ids/000000.png     16-bit SimFrame::ids
///   truth.csv          poses and pixel counts of every object in every frame
///   scene.yaml         seed, options, and known data of the object and the grasp
class RecordingFolder final : public RecordingSink {
 public:
  /// Throws InputError if the folder is not empty or cannot be made. `simulation` must outlive
  /// this.
  RecordingFolder(const std::filesystem::path& folder, const Simulation& simulation,
                  const std::string& scene, const SimulationOptions& options);

  void add(const SimFrame& frame, std::size_t index) override;
  void finish() override;
  [[nodiscard]] std::string where() const override { return folder_.string(); }

 private:
  void write_robot();
  void write_camera(const std::string& prefix, const Camera& camera,
                    const Eigen::Isometry3d& T_base_camera) const;
  void write_scene(const std::string& scene, const SimulationOptions& options) const;
  [[nodiscard]] std::filesystem::path image(const char* kind, std::size_t index) const;

  std::filesystem::path folder_;
  const Simulation& simulation_;
  bool second_camera_;
  std::string description_;  // recording.yaml, written last
  std::ofstream joints_, true_joints_, truth_;
  Image<std::uint16_t> ids_;
};

}  // namespace penumbra::sim
