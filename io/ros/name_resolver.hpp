// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io {

/// Resolves topic names like a node of ROS 2: relative names are in its namespace, and each name
/// may be remapped. Use one thread at a time.
class NameResolver {
 public:
  /// `name_space`: "", "cell" or "/cell/arm". Throws InputError if it is not a name.
  explicit NameResolver(std::string_view name_space = "");

  /// Adds the rule "FROM:=TO". Throws InputError for other texts and for a FROM that is remapped
  /// already.
  void remap(std::string_view rule);

  /// Returns the name on the graph: "/cell/joint_states" for "joint_states". Throws InputError if
  /// it is not a topic name.
  [[nodiscard]] std::string resolve(std::string_view name) const;

  /// Returns "" or "/cell".
  [[nodiscard]] const std::string& name_space() const { return name_space_; }
  /// Returns the names that are remapped but were never resolved.
  [[nodiscard]] std::vector<std::string> unused() const;

 private:
  [[nodiscard]] std::string expand(std::string_view name) const;

  std::string name_space_;  // "" or "/cell"
  std::map<std::string, std::string, std::less<>> rules_;
  mutable std::set<std::string> used_;  // names of rules that were used
};

}  // namespace penumbra::io
