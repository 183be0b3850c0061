// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/base/error.hpp>

#include <io/assembly/joint_names.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {

JointNames::JointNames(std::string_view text) : are_same_(text.empty()) {
  if (are_same_) return;
  const std::size_t equals = text.find('=');
  const auto split = [&](std::string_view side) -> std::array<std::string, 2> {
    if (equals == std::string_view::npos || std::ranges::count(side, '*') != 1)
      throw InputError("joint_names '" + printable(text) +
                       "': expected MESSAGE=JOINT with one * on each side, as 'left/*=*'");
    const std::size_t star = side.find('*');
    return {std::string(side.substr(0, star)), std::string(side.substr(star + 1))};
  };
  message_ = split(text.substr(0, equals));
  joint_ = split(text.substr(equals + 1));
}

std::string JointNames::joint_of(std::string_view name) const {
  const auto& [before, after] = message_;
  if (are_same_ || name.size() < before.size() + after.size() || !name.starts_with(before) ||
      !name.ends_with(after))
    return std::string(name);
  name.remove_prefix(before.size());
  name.remove_suffix(after.size());
  return joint_[0] + std::string(name) + joint_[1];
}

}  // namespace penumbra::io
