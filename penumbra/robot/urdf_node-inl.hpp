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

/// What an element of a URDF may hold. Names with a namespace prefix (drake:..., xsi:...) are other
/// tools' extensions and need no entry.
struct ElementRule {
  std::span<const std::string_view> attributes;          ///< that are read
  std::span<const std::string_view> ignored_attributes;  ///< known to change nothing that is drawn
  std::span<const std::string_view> children;            ///< that are read
  std::span<const std::string_view> ignored_children;    ///< known to change nothing that is drawn
};

/// A file that is read, and what it holds that is not known.
struct UrdfFile {
  std::string name;
  std::map<std::string, std::string> warnings;  ///< one line for each kind, by what it is of
};

/// An element of a URDF and where it stands, for messages. Every function throws InputError that
/// names file, line and element.
class UrdfNode {
 public:
  UrdfNode(const XmlElement& xml, UrdfFile& file, std::string where)
      : xml_(&xml), file_(&file), where_(std::move(where)) {}

  [[nodiscard]] const std::string& name() const { return xml_->name; }
  [[nodiscard]] int line() const { return xml_->line; }

  /// Warns of elements, attributes and text in the element that the rule does not list. Fails for
  /// those whose name is nearly one that is read, or is one behind a namespace prefix.
  void expect(const ElementRule& rule) const;

  [[nodiscard]] std::vector<UrdfNode> children() const;
  [[nodiscard]] std::optional<UrdfNode> child(std::string_view key) const;  ///< at most one
  [[nodiscard]] UrdfNode required_child(std::string_view key) const;

  [[nodiscard]] bool has(std::string_view key) const { return xml_->attribute(key) != nullptr; }
  [[nodiscard]] const std::string& text(std::string_view key) const;  ///< present and not empty
  [[nodiscard]] const std::string& identifier(
      std::string_view key) const;                          ///< text that can be shown
  [[nodiscard]] double number(std::string_view key) const;  ///< finite
  [[nodiscard]] double number_or(std::string_view key, double absent) const;
  [[nodiscard]] double positive(std::string_view key, double at_most) const;
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key) const;
  void numbers(std::string_view key, std::span<double> out) const;

  /// The same element under a name that tells it from its like: link "base".
  [[nodiscard]] UrdfNode named(const std::string& where) const { return {*xml_, *file_, where}; }

  [[noreturn]] void fail(const std::string& what) const;

 private:
  void check_name(const std::string& what, std::string_view name,
                  std::span<const std::string_view> read,
                  std::span<const std::string_view> ignored) const;
  [[nodiscard]] std::string place() const;  ///< file, line and element

  const XmlElement* xml_;
  UrdfFile* file_;
  std::string where_;
};

}  // namespace penumbra::detail
