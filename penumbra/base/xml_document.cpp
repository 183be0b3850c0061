// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <tinyxml2.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/base/xml_references-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr std::ptrdiff_t most_parts = 2'000'000;  // some 500 MB of memory

[[noreturn]] void fail(const std::string& file, int line, const std::string& what) {
  throw InputError(file + ":" + std::to_string(line) + ": " + what);
}

// tinyxml2 would take a reference that it does not know for text.
std::string read_text(const char* raw, int line, const std::string& file) {
  try {
    return without_references(raw);
  } catch (const InputError& error) {
    fail(file, line, error.what());
  }
}

std::vector<XmlAttribute> read_attributes(const tinyxml2::XMLElement& xml,
                                          const std::string& file) {
  std::vector<XmlAttribute> attributes;
  for (const auto* a = xml.FirstAttribute(); a != nullptr; a = a->Next())
    attributes.push_back({a->Name(), read_text(a->Value(), a->GetLineNum(), file)});
  return attributes;
}

/// A '<!' declaration stands nowhere but before the root element, where check_prolog finds it.
void check_known(const tinyxml2::XMLNode& node, const std::string& file) {
  if (const auto* unknown = node.ToUnknown())
    fail(file, node.GetLineNum(),
         "is not well-formed XML: the declaration '<!" + std::string(unknown->Value()) +
             ">' in or behind the root element");
}

// The depth is bounded by the parser, so that recursion is safe.
XmlElement read_element(const tinyxml2::XMLElement& xml, const std::string& file) {
  XmlElement element{xml.Name(), xml.GetLineNum(), read_attributes(xml, file), {}, {}};
  for (const auto* node = xml.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (const auto* child = node->ToElement()) {
      element.children.push_back(read_element(*child, file));
    } else if (const auto* text = node->ToText()) {
      if (!element.text.empty()) element.text += ' ';
      element.text += trimmed(text->CData() ? text->Value()
                                            : read_text(text->Value(), text->GetLineNum(), file));
    } else {
      check_known(*node, file);
    }
  }
  return element;
}

void check_start(std::string_view xml, const std::string& file) {
  if (trimmed(xml).empty()) throw InputError(file + ": is empty; a URDF file is expected");
  if (xml.find('\0') != std::string_view::npos)
    throw InputError(file +
                     ": is not text in UTF-8 (it holds zero bytes, as UTF-16 does); a URDF " +
                     "in UTF-8 is expected");
  const auto parts =
      std::count_if(xml.begin(), xml.end(), [](char c) { return c == '<' || c == '='; });
  if (parts > most_parts)
    throw InputError(file + ": has more than " + std::to_string(most_parts) +
                     " tags and attributes; check that it is the right file");
  const bool marked = xml.starts_with("\xEF\xBB\xBF");
  if (!trimmed(xml.substr(marked ? 3 : 0)).starts_with('<'))
    throw InputError(file + ": is not XML (it does not start with '<'); a URDF is expected");
}

/// What a DOCTYPE declares (entities, default attributes) is not read, so none is accepted.
void check_prolog(std::string_view xml, const std::string& file) {
  std::size_t at = xml.find('<');
  for (std::string_view end; at != std::string_view::npos; at = xml.find('<', at)) {
    if (xml.substr(at).starts_with("<?"))
      end = "?>";
    else if (xml.substr(at).starts_with("<!--"))
      end = "-->";
    else
      break;
    at = xml.find(end, at + end.size() + 1);
    if (at == std::string_view::npos) return;  // which the parser tells
  }
  if (at == std::string_view::npos || !xml.substr(at).starts_with("<!")) return;
  const std::string_view declaration = xml.substr(at, xml.find_first_of("[>\r\n", at) - at);
  const auto line =
      1 + std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  fail(file, static_cast<int>(line),
       "has a DOCTYPE (" + std::string(trimmed(declaration.substr(0, 60))) +
           "), which is not accepted: what it declares is not read; remove it and write out its "
           "entities");
}

void require_utf8(std::string_view text, const std::string& what, int line,
                  const std::string& file) {
  const std::size_t at = find_not_utf8(text);
  if (at == std::string_view::npos) return;
  std::array<char, 8> byte{};
  std::snprintf(byte.data(), byte.size(), "0x%02X", static_cast<unsigned char>(text[at]));
  fail(file, line,
       what + " is not text in UTF-8 (byte " + byte.data() + "); save the file as UTF-8");
}

std::string reason_of(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "a closing tag is missing or belongs to another element";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "a tag has no name or no '>', or the file ends within it";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is not of the form name=\"value\", or is given twice";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "text after which no tag follows";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
      return "a CDATA section is not closed";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
      return "a '<?' declaration is not closed, or stands behind an element";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment is not closed";
    case tinyxml2::XML_ERROR_PARSING_UNKNOWN:
      return "a '<!' declaration is not closed";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested more than 100 deep";
    default:
      return "the file ends too early, or holds something else than elements";
  }
}

}  // namespace

const std::string* XmlElement::attribute(std::string_view key) const {
  for (const auto& a : attributes)
    if (a.name == key) return &a.value;
  return nullptr;
}

void require_utf8(const XmlElement& element, const std::string& file) {
  require_utf8(element.name, "an element's name", element.line, file);
  const std::string of_element = " of <" + element.name + ">";
  for (const XmlAttribute& a : element.attributes) {
    require_utf8(a.name, "an attribute's name" + of_element, element.line, file);
    require_utf8(a.value, "attribute " + a.name + of_element, element.line, file);
  }
  require_utf8(element.text, "the text" + of_element, element.line, file);
  for (const XmlElement& child : element.children) require_utf8(child, file);
}

XmlElement read_xml(std::string_view xml, const std::string& file) {
  check_start(xml, file);
  check_prolog(xml, file);
  tinyxml2::XMLDocument document(false);  // references are left to read_text
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS)
    fail(file, document.ErrorLineNum(), "is not well-formed XML: " + reason_of(document));
  const tinyxml2::XMLElement* root = nullptr;
  for (const auto* node = document.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToText() != nullptr)
      fail(file, node->GetLineNum(), "is not well-formed XML: text outside of the root element");
    check_known(*node, file);
    if (node->ToElement() == nullptr) continue;
    if (root != nullptr)
      fail(file, node->GetLineNum(), "is not well-formed XML: a second root element");
    root = node->ToElement();
  }
  if (root == nullptr) throw InputError(file + ": holds no XML element; a URDF is expected");
  return read_element(*root, file);
}

}  // namespace penumbra::detail
