// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/data.hpp"
#include "fixtures.hpp"

#include <Eigen/Geometry>

namespace penumbra::test {

/// A copy of a real recording and of its URDF, to be changed. Skips where the data is absent.
class RealRecording : public FolderTest {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_DATA();
    copy_recording("xarm7_realsense");
  }

  void copy_recording(const std::string& name) {
    fs::remove_all(path("recording"));
    fs::copy(data_folder() / name, path("recording"), fs::copy_options::recursive);
    fs::copy(robots / "xarm7.urdf", path("xarm7.urdf"), fs::copy_options::overwrite_existing);
    const fs::path yaml = path("recording/recording.yaml");
    edit_file(yaml, "../robots/xarm7/xarm7.urdf", path("xarm7.urdf"));
    edit_file(yaml, "../robots/xarm7/xarm_description", robots / "xarm_description");
  }

  Outcome run(const std::string& name, const Words& options = {}) const {
    return penumbra(Words{"run", path("recording"), "-o", path(name)} + options);
  }

  const fs::path robots = fs::absolute(data_folder() / "robots/xarm7");
};

}  // namespace penumbra::test
