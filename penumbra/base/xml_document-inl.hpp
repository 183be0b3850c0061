// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace penumbra::detail {

struct XmlAttribute {
  std::string name;
  std::string value;
};

/// An element of an XML file; comments and processing instructions are left out.
struct XmlElement {
  std::string name;
  int line = 0;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;
  std::string text;  ///< the pieces of text between the children, with a space between them

  [[nodiscard]] const std::string* attribute(std::string_view key) const;
};

/// Reads well-formed XML of one root element; nested at most 100 deep. Throws InputError that
/// starts with `file` (and the line).
[[nodiscard]] XmlElement read_xml(std::string_view xml, const std::string& file);

/// Throws InputError with file and line for a name, value or text in the element that is no UTF-8:
/// it could not be written to a report as it is. Comments may hold what they like.
void require_utf8(const XmlElement& element, const std::string& file);

}  // namespace penumbra::detail
