// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::io {

struct InitOptions {
  std::filesystem::path folder;
  std::optional<std::filesystem::path> robot = {};  ///< null: the one in the folder
  std::map<std::string, std::filesystem::path> packages = {};
  std::map<std::string, std::string> arguments = {};  ///< of a xacro file
  bool force = false;                                 ///< replace a recording.yaml
};

/// What init_recording did.
struct InitResult {
  std::filesystem::path file;
  std::vector<std::string> lacking = {};  ///< a line for each thing that is missing or was guessed
  std::vector<std::string> needed = {};   ///< keys that a run cannot do without
  bool has_depth = false;
  bool has_pose = false;  ///< else calibrate --search is next
};

/// Looks at a folder of images, videos, joint files, URDF and camera files, and three levels of
/// folders below it, and writes a recording.yaml with what it found and comments for the rest.
/// Throws InputError if there is a recording.yaml, a bag, several robots, or neither robot nor
/// images.
[[nodiscard]] InitResult init_recording(const InitOptions& options);

}  // namespace penumbra::io
