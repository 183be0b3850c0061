// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/data.hpp"
#include "fixtures.hpp"

#include <io/files/pose_file.hpp>

namespace penumbra::test {

inline fs::path xarm_robots() { return fs::absolute(data_folder() / "robots/xarm7"); }
inline Words xarm_package() {
  return {"--package", "xarm_description=" + (xarm_robots() / "xarm_description").string()};
}

/// Copies a real recording, and its URDF next to it.
inline void copy_real_recording(const std::string& name, const fs::path& folder) {
  fs::remove_all(folder);
  fs::copy(data_folder() / name, folder, fs::copy_options::recursive);
  fs::copy(xarm_robots() / "xarm7.urdf", folder);
  const fs::path yaml = folder / "recording.yaml";
  edit_file(yaml, "../robots/xarm7/xarm7.urdf", "xarm7.urdf");
  edit_file(yaml, "../robots/xarm7/xarm_description", xarm_robots() / "xarm_description");
}

inline double metres_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

/// Returns a pose that is moved by some centimetres and turned.
inline Eigen::Isometry3d off(Eigen::Isometry3d pose,
                             const Eigen::Vector3d& by = {0.05, -0.06, 0.05}, double turn = 0.15) {
  pose.translation() += by;
  return pose.rotate(Eigen::AngleAxisd(turn, Eigen::Vector3d(1, 2, -1).normalized()));
}

/// A test with a recording in the folder "recording", to be changed.
class RecordingTest : public FolderTest {
 protected:
  using FolderTest::edit;
  void edit(const std::string& from, const std::string& to) const {
    edit_file(path("recording/recording.yaml"), from, to);
  }
  Outcome run(const std::string& name, const Words& options = {}) const {
    return penumbra(Words{"run", path("recording"), "-o", path(name)} + options);
  }
  Outcome calibrate(const Words& options = {}) const {
    return penumbra(Words{"calibrate", path("recording"), "-o", out()} + options);
  }
  /// Writes a first guess, and returns its option.
  [[nodiscard]] Words initial(const Eigen::Isometry3d& pose) const {
    io::write_pose_csv(path("initial.csv"), pose);
    return {"--initial", path("initial.csv")};
  }
  /// What calibrate found.
  [[nodiscard]] Eigen::Isometry3d found() const {
    return io::read_pose_csv(out("camera_pose.csv"));
  }
  [[nodiscard]] Json calibration() const { return read_json(out("calibration.json")); }
  /// What run says is wrong; null: nothing.
  [[nodiscard]] Json cause_told() const {
    const Json diagnosis = report()["summary"]["diagnosis"];
    return diagnosis.is_null() ? diagnosis : diagnosis["cause"];
  }
};

/// A copy of a real recording. Skips where the data is absent.
class RealRecording : public RecordingTest {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_DATA();
    copy_real_recording("xarm7_realsense", path("recording"));
  }
};

/// A copy of the shipped one.
class ExampleRecording : public RecordingTest {
 protected:
  ExampleRecording() { fs::copy(example, path("recording"), fs::copy_options::recursive); }

  const Eigen::Isometry3d truth_ = io::read_pose_csv(example / "camera_pose.csv");
};

}  // namespace penumbra::test
