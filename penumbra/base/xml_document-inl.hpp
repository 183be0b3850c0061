// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::detail {

struct XmlAttribute {
  std::string name;
  std::string value;
};

/// An element of an XML file, without comments and processing instructions.
struct XmlElement {
  std::string name;
  int line = 0;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;
  std::string text;  ///< all text between the children, joined with spaces
  std::shared_ptr<const std::string> file = {};  ///< its file, for messages

  [[nodiscard]] const std::string* attribute(std::string_view key) const;
};

/// Reads well-formed XML with one root element, nested no deeper than tinyxml2 allows. Throws
/// InputError with `file` and the line.
[[nodiscard]] XmlElement read_xml(std::string_view xml, const std::string& file);

}  // namespace penumbra::detail
