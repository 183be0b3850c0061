// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace penumbra::io {

/// Names of topics as a node of ROS 2 has them: those without a "/" before them stand in its
/// namespace, and each may be remapped.
class NameResolver {
 public:
  /// `name_space`: "" or "cell", "/cell/arm". Throws InputError for what is none.
  explicit NameResolver(std::string_view name_space = "");

  /// "FROM:=TO"; throws InputError for anything else, and a FROM that is remapped already.
  void remap(std::string_view rule);

  /// The name on the graph: "/cell/joint_states" of "joint_states". Throws InputError for what is
  /// no name of a topic.
  [[nodiscard]] std::string resolve(std::string_view name) const;

 private:
  [[nodiscard]] std::string expand(std::string_view name) const;

  std::string name_space_;  // "" or "/cell"
  std::map<std::string, std::string, std::less<>> rules_;
};

}  // namespace penumbra::io
