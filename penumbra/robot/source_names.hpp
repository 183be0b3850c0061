// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace penumbra {

/// Numbers for those who tell something, by their names. A number is never given twice; of a name
/// that was forgotten for newer ones it is another one the next time.
class SourceNames {
 public:
  static constexpr std::size_t most = 256;  ///< that are remembered

  /// The number of a name, a new one for a new name.
  std::uint32_t number_of(std::string_view name) {
    for (std::size_t i = names_.size(); i-- > 0;)
      if (names_[i] == name) return first_ + static_cast<std::uint32_t>(i);
    if (names_.size() == most) {
      names_.pop_front();
      ++first_;
    }
    names_.emplace_back(name);
    return first_ + static_cast<std::uint32_t>(names_.size() - 1);
  }

  /// "another source" for one that is forgotten or has no name.
  [[nodiscard]] std::string name_of(std::uint32_t number) const {
    const std::size_t place = static_cast<std::uint32_t>(number - first_);
    return place < names_.size() && !names_[place].empty() ? names_[place] : "another source";
  }

 private:
  std::deque<std::string> names_;
  std::uint32_t first_ = 0;  // number of the first name
};

}  // namespace penumbra
