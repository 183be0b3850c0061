// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/base/error.hpp>
#include <penumbra/robot/text-inl.hpp>
#include <penumbra/robot/urdf_node-inl.hpp>

namespace penumbra::detail {
namespace {

bool contains(std::span<const std::string_view> list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

// "drake:acceleration", "xmlns:xacro"; and the default namespace itself.
bool is_extension(std::string_view name) {
  return name.find(':') != std::string_view::npos || name == "xmlns";
}

// "u:origin", where "origin" is read; "xmlns:origin" only declares a prefix.
bool is_disguised(std::span<const std::string_view> read, std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon != std::string_view::npos && !name.starts_with("xmlns:") &&
         contains(read, name.substr(colon + 1));
}

std::string without_prefix(std::string_view name) {
  const std::string local(name.substr(name.find(':') + 1));
  return "would be skipped, as it has a prefix, and " + local +
         " is read; write it without the prefix, or remove it";
}

std::string listed(std::span<const std::string_view> names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
  return out.empty() ? "nothing" : out;
}

bool is_macro_text(std::string_view text) {
  return text.find("${") != std::string_view::npos || text.find("$(") != std::string_view::npos;
}

constexpr const char* kExpandXacro =
    "this is a xacro file, not a URDF; expand it first: xacro FILE.urdf.xacro > FILE.urdf";

}  // namespace

void UrdfNode::expect(const ElementRule& rule) const {
  for (const auto& [key, value] : xml_->attributes) {
    if (key.starts_with("xacro:") || is_macro_text(value))
      fail("attribute " + key + "=" + in_quotes(value) + ": " + kExpandXacro);
    if (is_disguised(rule.attributes, key))
      fail("attribute " + in_quotes(key) + " " + without_prefix(key));
    if (!is_extension(key) && !contains(rule.attributes, key) &&
        !contains(rule.ignored_attributes, key))
      fail("unknown attribute " + in_quotes(key) + "; expected " + listed(rule.attributes));
  }
  for (const XmlElement& c : xml_->children) {
    const UrdfNode child(c, *file_, where_);
    if (c.name.starts_with("xacro:")) child.fail("<" + c.name + ">: " + kExpandXacro);
    if (is_disguised(rule.children, c.name))
      child.fail("<" + c.name + "> " + without_prefix(c.name));
    if (!is_extension(c.name) && !contains(rule.children, c.name) &&
        !contains(rule.ignored_children, c.name))
      child.fail("unknown element <" + c.name + ">; expected " + listed(rule.children));
  }
  if (is_macro_text(xml_->text)) fail("text " + in_quotes(xml_->text) + ": " + kExpandXacro);
  if (!xml_->text.empty()) fail("unexpected text " + in_quotes(xml_->text) + "; remove it");
}

std::vector<UrdfNode> UrdfNode::children() const {
  std::vector<UrdfNode> nodes;
  nodes.reserve(xml_->children.size());
  for (const XmlElement& c : xml_->children)
    nodes.emplace_back(c, *file_, where_.empty() ? c.name : where_ + ", " + c.name);
  return nodes;
}

std::optional<UrdfNode> UrdfNode::child(std::string_view key) const {
  std::optional<UrdfNode> found;
  for (const UrdfNode& node : children()) {
    if (node.name() != key) continue;
    if (found) node.fail("is given twice; one is expected");
    found = node;
  }
  return found;
}

UrdfNode UrdfNode::required_child(std::string_view key) const {
  if (auto node = child(key)) return *node;
  fail("the element <" + std::string(key) + "> is missing");
}

const std::string& UrdfNode::text(std::string_view key) const {
  const std::string* value = xml_->attribute(key);
  if (value == nullptr) fail("the attribute " + in_quotes(key) + " is missing");
  if (value->empty()) fail("the attribute " + in_quotes(key) + " is empty");
  return *value;
}

const std::string& UrdfNode::identifier(std::string_view key) const {
  const std::string& value = text(key);
  if (holds_control(value))
    fail(std::string(key) + "=" + in_quotes(value) +
         " holds control characters; a name of visible characters is expected");
  return value;
}

double UrdfNode::number(std::string_view key) const {
  double value = 0.0;
  numbers(key, {&value, 1});
  return value;
}

double UrdfNode::number_or(std::string_view key, double absent) const {
  return has(key) ? number(key) : absent;
}

double UrdfNode::positive(std::string_view key, double at_most) const {
  const double value = number(key);
  if (value <= 0.0 || value > at_most)
    fail(std::string(key) + "=" + in_quotes(text(key)) + " must be above 0 and at most " +
         printed(at_most) + " m");
  return value;
}

Eigen::Vector3d UrdfNode::vector(std::string_view key) const {
  Eigen::Vector3d value;
  numbers(key, {value.data(), 3});
  return value;
}

void UrdfNode::numbers(std::string_view key, std::span<double> out) const {
  const std::string& value = text(key);
  if (to_numbers(value, out)) return;
  const std::string expected =
      out.size() == 1 ? "one finite number" : std::to_string(out.size()) + " finite numbers";
  fail(std::string(key) + "=" + in_quotes(value) + " is not " + expected);
}

void UrdfNode::fail(const std::string& what) const {
  throw InputError(*file_ + ":" + std::to_string(line()) + ": " +
                   (where_.empty() ? xml_->name : where_) + ": " + what);
}

}  // namespace penumbra::detail
