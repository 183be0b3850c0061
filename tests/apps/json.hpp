// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace penumbra::test {

using Json = nlohmann::ordered_json;
using Keys = std::vector<std::string>;

/// Of an object, in their order.
inline Keys keys(const Json& json) {
  Keys names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

}  // namespace penumbra::test
