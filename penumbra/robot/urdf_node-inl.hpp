// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/xml_document-inl.hpp>

namespace penumbra::detail {

/// The known content of an element of a URDF, as names with spaces between them. What is ignored
/// does not change what is drawn: dynamics, colours, controllers, simulators
/// (http://wiki.ros.org/urdf/XML). Names with a namespace prefix (drake:..., xsi:...) are
/// extensions of other tools and need no entry.
struct ElementRule {
  std::string_view attributes = {}, ignored_attributes = {};
  std::string_view children = {}, ignored_children = {};
};

using UrdfWarnings = std::map<std::string, std::string>;  ///< kind of unknown content -> a line

/// Returns the one of some names, with spaces between them, that is close to another name.
[[nodiscard]] std::optional<std::string_view> similar_name(std::string_view names,
                                                           std::string_view name);

/// An element of a URDF. Every function throws InputError that names file, line and element.
class UrdfNode {
 public:
  UrdfNode(const XmlElement& xml, UrdfWarnings& warnings, std::string where)
      : xml_(&xml), warnings_(&warnings), where_(std::move(where)) {}

  [[nodiscard]] const XmlElement& xml() const { return *xml_; }
  [[nodiscard]] const std::string& name() const { return xml_->name; }
  [[nodiscard]] std::string place() const;  ///< file, line and element, for messages

  /// Warns of elements, attributes and text that the rule does not list. Fails for names that are
  /// close to one that is read, or that are one behind a namespace prefix.
  void expect(const ElementRule& rule) const;

  [[nodiscard]] std::vector<UrdfNode> children() const;
  [[nodiscard]] std::optional<UrdfNode> child(std::string_view key) const;  ///< at most one
  [[nodiscard]] UrdfNode required_child(std::string_view key) const;

  [[nodiscard]] bool has(std::string_view key) const { return xml_->attribute(key) != nullptr; }
  [[nodiscard]] const std::string& text(std::string_view key) const;  ///< present and not empty
  [[nodiscard]] const std::string& identifier() const;      ///< "name", without control characters
  [[nodiscard]] double number(std::string_view key) const;  ///< finite
  [[nodiscard]] double number_or(std::string_view key, double absent) const;
  [[nodiscard]] double positive(std::string_view key, double at_most) const;
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key) const;
  void numbers(std::string_view key, std::span<double> out) const;

  /// Returns the element under a longer name for messages: link "base".
  [[nodiscard]] UrdfNode named(const std::string& where) const {
    return {*xml_, *warnings_, where};
  }

  /// Returns another element of the file under the name of this one.
  [[nodiscard]] UrdfNode with(const XmlElement& xml) const { return {xml, *warnings_, where_}; }

  /// Warns of the first element of a kind of mistake.
  void warn(const std::string& kind, const std::string& what) const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void check_name(const std::string& what, std::string_view name, std::string_view read,
                  std::string_view ignored) const;

  const XmlElement* xml_;
  UrdfWarnings* warnings_;
  std::string where_;
};

}  // namespace penumbra::detail
