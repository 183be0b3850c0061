// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/urdf_node-inl.hpp>

namespace penumbra::detail {
namespace {

std::vector<std::string_view> words(std::string_view list) {
  std::vector<std::string_view> all;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(' '), list.size());
    all.push_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return all;
}

bool contains(std::string_view list, std::string_view name) {
  const auto all = words(list);
  return std::find(all.begin(), all.end(), name) != all.end();
}

// "drake:acceleration", "xmlns:xacro" and the default namespace.
bool is_extension(std::string_view name) {
  return name.find(':') != std::string_view::npos || name == "xmlns";
}

// "u:origin" where "origin" is read; "xmlns:origin" only declares a prefix.
bool is_prefixed(std::string_view read, std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon != std::string_view::npos && !name.starts_with("xmlns:") &&
         contains(read, name.substr(colon + 1));
}

/// Returns the optimal string alignment distance between names, without regard to case.
std::size_t distance(std::string_view a, std::string_view b) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t changed = d[i - 1][j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, changed});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string_view> similar_name(std::string_view names, std::string_view name) {
  constexpr std::size_t letters_per_mistake = 4;
  for (const std::string_view known : words(names)) {
    const std::size_t mistakes = std::max<std::size_t>(known.size() / letters_per_mistake, 1);
    if (name.size() <= known.size() + mistakes && distance(name, known) <= mistakes) return known;
  }
  return std::nullopt;
}

void UrdfNode::expect(const ElementRule& rule) const {
  for (const XmlAttribute& a : xml_->attributes)
    check_name("attribute " + in_quotes(a.name), a.name, rule.attributes, rule.ignored_attributes);
  for (const XmlElement& c : xml_->children) {
    const UrdfNode child(c, *warnings_, where_);
    child.check_name("element " + in_quotes(c.name), c.name, rule.children, rule.ignored_children);
  }
  if (!xml_->text.empty()) warn("text", "text " + in_quotes(xml_->text) + " is ignored");
}

void UrdfNode::warn(const std::string& kind, const std::string& what) const {
  warnings_->try_emplace(kind, place() + ": " + what);
}

void UrdfNode::check_name(const std::string& what, std::string_view name, std::string_view read,
                          std::string_view ignored) const {
  if (is_prefixed(read, name))
    fail(what + " has a prefix and would be ignored; write it without the prefix, or remove it");
  if (const std::size_t colon = name.find(':');
      colon != std::string_view::npos && similar_name("xacro", name.substr(0, colon)))
    fail(what + " would be ignored; is xacro: meant?");
  if (is_extension(name) || contains(read, name) || contains(ignored, name)) return;
  if (const auto known = similar_name(read, name))
    fail("unknown " + what + "; is " + in_quotes(std::string(*known)) + " meant?");
  warn(what, "unknown " + what + " is ignored");
}

std::vector<UrdfNode> UrdfNode::children() const {
  std::vector<UrdfNode> nodes;
  nodes.reserve(xml_->children.size());
  for (const XmlElement& c : xml_->children)
    nodes.emplace_back(c, *warnings_, where_.empty() ? c.name : where_ + ", " + c.name);
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

const std::string& UrdfNode::identifier() const {
  const std::string& name = text("name");
  if (std::any_of(name.begin(), name.end(),
                  [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }))
    fail("name=" + in_quotes(name) + " contains control characters; remove them");
  return name;
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

std::string UrdfNode::place() const {
  return xml_->place() + ": " + (where_.empty() ? xml_->name : where_);
}

void UrdfNode::fail(const std::string& what) const { throw InputError(place() + ": " + what); }

}  // namespace penumbra::detail
