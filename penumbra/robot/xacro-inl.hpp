// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/robot/expression-inl.hpp>
#include <penumbra/robot/file_locator.hpp>

namespace penumbra::detail {

/// Expands a xacro file (https://github.com/ros/xacro/wiki): properties, macros, blocks, includes,
/// conditions, arguments, namespaces and expressions. A URDF without any comes out as it is. Text,
/// which changes nothing that is drawn, is kept as written; so elements of simulators and
/// controllers are left out. Includes and YAML files are searched from the file that is read, the
/// first one's from `folder`. Throws InputError that names file and line for what is not
/// understood. An argument that no file uses is an error if it is nearly a declared one, else a
/// note.
[[nodiscard]] XmlElement expand_xacro(const XmlElement& root, const std::filesystem::path& folder,
                                      const std::map<std::string, std::string>& arguments,
                                      FileLocator& packages, std::vector<std::string>& notes);

/// Reads a YAML file as xacro.load_yaml() does, with its tags for units (!degrees, !millimeters).
[[nodiscard]] Value load_yaml(const std::filesystem::path& file, Budget& budget);

}  // namespace penumbra::detail
