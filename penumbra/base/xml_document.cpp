// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <tinyxml2.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/base/xml_document-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr std::ptrdiff_t most_parts = 2'000'000;  // tags and attributes: about 500 MB of memory

[[noreturn]] void fail(const std::string& file, int line, const std::string& what) {
  throw InputError(file + ":" + std::to_string(line) + ": " + what);
}

/// tinyxml2 does not apply what a '<!' declaration says (entities, default attributes).
void refuse_declaration(const tinyxml2::XMLNode& node, const std::string& file) {
  if (const auto* declaration = node.ToUnknown())
    fail(file, node.GetLineNum(),
         "the declaration " + in_quotes("<!" + std::string(declaration->Value()) + ">") +
             " is not supported; remove it and write out its entities");
}

// The parser limits the depth of this recursion.
XmlElement read_element(const tinyxml2::XMLElement& xml,
                        const std::shared_ptr<const std::string>& file) {
  XmlElement element{xml.Name(), file, xml.GetLineNum(), {}, {}, {}};
  for (const auto* a = xml.FirstAttribute(); a != nullptr; a = a->Next())
    element.attributes.push_back({a->Name(), a->Value()});
  for (const auto* node = xml.FirstChild(); node != nullptr; node = node->NextSibling()) {
    refuse_declaration(*node, *file);
    if (const auto* child = node->ToElement()) {
      element.children.push_back(read_element(*child, file));
    } else if (const auto* text = node->ToText()) {
      if (!element.text.empty()) element.text += ' ';
      element.text += trimmed(text->Value());
    }
  }
  return element;
}

void check_start(std::string_view xml, const std::string& file) {
  if (trimmed(xml).empty()) throw InputError(file + ": is empty; XML is expected");
  if (xml.find('\0') != std::string_view::npos)
    throw InputError(file + ": contains zero bytes; XML in UTF-8 is expected");
  const auto parts =
      std::count_if(xml.begin(), xml.end(), [](char c) { return c == '<' || c == '='; });
  if (parts > most_parts)
    throw InputError(file + ": has more than " + std::to_string(most_parts) +
                     " tags and attributes; check that it is the right file");
  // tinyxml2 compares each attribute of a tag with all others.
  constexpr std::size_t most_attributes = 10'000;
  std::size_t attributes = 0;
  for (const char c : xml) {
    attributes = c == '<' ? 0 : attributes + (c == '=' ? 1 : 0);
    if (attributes > most_attributes) throw InputError(file + ": a tag has too many attributes");
  }
  const bool has_mark = xml.starts_with("\xEF\xBB\xBF");
  if (!trimmed(xml.substr(has_mark ? 3 : 0)).starts_with('<'))
    throw InputError(file + ": is not XML: it does not start with '<'");
}

}  // namespace

const std::string* XmlElement::attribute(std::string_view key) const {
  for (const auto& a : attributes)
    if (a.name == key) return &a.value;
  return nullptr;
}

XmlElement read_xml(std::string_view xml, const std::string& file) {
  check_start(xml, file);
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS)
    fail(file, document.ErrorLineNum(),
         std::string("is not well-formed XML: ") + document.ErrorName());
  const tinyxml2::XMLElement* root = nullptr;
  for (const auto* node = document.FirstChild(); node != nullptr; node = node->NextSibling()) {
    refuse_declaration(*node, file);
    const auto* element = node->ToElement();
    if (node->ToText() != nullptr || (element != nullptr && root != nullptr))
      fail(file, node->GetLineNum(), "is not well-formed XML: content after the root element");
    if (element != nullptr) root = element;
  }
  if (root == nullptr) throw InputError(file + ": contains no XML element");
  return read_element(*root, std::make_shared<const std::string>(file));
}

}  // namespace penumbra::detail
