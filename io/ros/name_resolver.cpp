// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/printable.hpp>
#include <io/ros/name_resolver.hpp>

namespace penumbra::io {
namespace {

/// Returns whether this is a name by ROS 2's rule: letters, digits and _ between single slashes, no
/// part starting with a digit.
bool is_name(std::string_view name) {
  if (name.empty() || name.ends_with('/')) return false;
  bool starts = true;  // a part begins here
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (c == '/') {
      if (starts && i > 0) return false;
      starts = true;
      continue;
    }
    if (std::isalnum(c) == 0 && c != '_') return false;
    if (starts && std::isdigit(c) != 0) return false;
    starts = false;
  }
  return !starts;
}

}  // namespace

NameResolver::NameResolver(std::string_view name_space) {
  if (name_space.empty() || name_space == "/") return;
  if (!is_name(name_space))
    throw InputError("--namespace '" + printable(name_space) +
                     "': is not a name of ROS 2; expected letters, digits and _ between slashes");
  name_space_ = (name_space.starts_with('/') ? "" : "/") + std::string(name_space);
}

std::string NameResolver::expand(std::string_view name) const {
  if (!is_name(name))
    throw InputError(
        "'" + printable(name) +
        "' is not a topic name; expected letters, digits and _ between slashes, such as "
        "/camera/depth/image_raw");
  return name.starts_with('/') ? std::string(name) : name_space_ + "/" + std::string(name);
}

void NameResolver::remap(std::string_view rule) {
  const std::size_t at = rule.find(":=");
  if (at == std::string_view::npos || at == 0 || at + 2 == rule.size())
    throw InputError("--remap '" + printable(rule) + "': expected FROM:=TO");
  if (!rules_.emplace(expand(rule.substr(0, at)), expand(rule.substr(at + 2))).second)
    throw InputError("--remap '" + printable(rule) + "': that name is remapped already");
}

std::string NameResolver::resolve(std::string_view name) const {
  std::string full = expand(name);
  const auto rule = rules_.find(full);
  if (rule == rules_.end()) return full;
  used_.insert(std::move(full));
  return rule->second;
}

std::vector<std::string> NameResolver::unused() const {
  std::vector<std::string> names;
  for (const auto& [from, to] : rules_)
    if (!used_.contains(from)) names.push_back(from);
  return names;
}

}  // namespace penumbra::io
