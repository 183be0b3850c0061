// SPDX-License-Identifier: Apache-2.0
// Robots and meshes.
#include "readers.hpp"

#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::fuzz {
namespace {

void read_robot(std::string_view text) {
  static_cast<void>(Robot::parse(text, folder().path(), {.allow_missing_meshes = true}));
}

Reader mesh(const std::string& ending) {
  return {ending, [name = "a." + ending](std::string_view bytes) {
            require(!load_mesh(file(name, bytes)).triangles.empty(), "a mesh has triangles");
          }};
}

const Added core({{"urdf", read_robot},
                  {"xacro", read_robot},
                  {"mjcf", read_robot},
                  mesh("stl"),
                  mesh("dae"),
                  mesh("obj"),
                  mesh("ply"),
                  mesh("gltf"),
                  mesh("glb")});

}  // namespace
}  // namespace penumbra::fuzz
