// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace penumbra::test {

/// The JSON in a report page's script of this id.
inline nlohmann::ordered_json page_json(const std::string& page, const std::string& id) {
  const std::string tag = "id=\"" + id + "\">";
  const auto start = page.find(tag);
  if (start == std::string::npos) return {};
  const auto begin = start + tag.size();
  return nlohmann::ordered_json::parse(page.substr(begin, page.find("</script", begin) - begin));
}

}  // namespace penumbra::test
