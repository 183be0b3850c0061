// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>

namespace penumbra {

struct Robot::Model {
  using Index = std::map<std::string, std::size_t, std::less<>>;

  std::string name;
  std::vector<std::string> links;
  std::vector<Joint> joints;
  std::vector<std::string> variables;
  Index link_index;
  Index variable_index;
  std::vector<std::vector<PreparedMesh>> meshes;  // of each link
  std::vector<LinkReport> report;                 // of each link
  std::vector<std::string> notes;
};

}  // namespace penumbra
