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
/// conditions, arguments, namespaces and expressions. A URDF without any comes out as it is. Text
/// is kept as written. Elements of simulators and controllers become empty: neither changes what is
/// drawn. Names of included and YAML files are relative to the file being read, the first one's to
/// `folder`. Throws InputError that names file and line for what is not
/// understood. An argument that no file uses is an error if its name is close to a declared one,
/// else a note.
[[nodiscard]] XmlElement expand_xacro(const XmlElement& root, const std::filesystem::path& folder,
                                      const std::map<std::string, std::string>& arguments,
                                      FileLocator& packages, std::vector<std::string>& notes);

/// Reads a YAML file as xacro.load_yaml() does, with its tags for units (!degrees, !millimeters).
[[nodiscard]] Value load_yaml(const std::filesystem::path& file, Budget& budget);

}  // namespace penumbra::detail
