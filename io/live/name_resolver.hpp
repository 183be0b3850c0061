// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// Names of topics as a node of ROS 2 has them: those without a "/" before them stand in its
/// namespace, and each may be remapped. For one thread.
class NameResolver {
 public:
  /// `name_space`: "" or "cell", "/cell/arm". Throws InputError for what is none.
  explicit NameResolver(std::string_view name_space = "");

  /// "FROM:=TO"; throws InputError for anything else, and a FROM that is remapped already.
  void remap(std::string_view rule);

  /// The name on the graph: "/cell/joint_states" of "joint_states". Throws InputError for what is
  /// no name of a topic.
  [[nodiscard]] std::string resolve(std::string_view name) const;

  /// "" or "/cell".
  [[nodiscard]] const std::string& name_space() const { return name_space_; }
  /// Names that are remapped, but were never asked for until now.
  [[nodiscard]] std::vector<std::string> unused() const;

 private:
  [[nodiscard]] std::string expand(std::string_view name) const;

  std::string name_space_;  // "" or "/cell"
  std::map<std::string, std::string, std::less<>> rules_;
  mutable std::set<std::string> used_;  // of the rules
};

}  // namespace penumbra::io
