// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <penumbra/robot/xml_document-inl.hpp>

namespace penumbra::detail {

/// What an element of a URDF may hold. Names with a namespace prefix (drake:..., xsi:...) are other
/// tools' extensions and need no entry, unless the name behind the prefix is one that is read: such
/// an element may well be meant for us, so it is an error, as is what is in no list.
struct ElementRule {
  std::span<const std::string_view> attributes;          ///< that are read
  std::span<const std::string_view> ignored_attributes;  ///< known to change nothing that is drawn
  std::span<const std::string_view> children;            ///< that are read
  std::span<const std::string_view> ignored_children;    ///< known to change nothing that is drawn
};

/// An element of a URDF and where it stands, for messages. Every function throws InputError that
/// names file, line and element.
class UrdfNode {
 public:
  UrdfNode(const XmlElement& xml, const std::string& file, std::string where)
      : xml_(&xml), file_(&file), where_(std::move(where)) {}

  [[nodiscard]] const std::string& name() const { return xml_->name; }
  [[nodiscard]] int line() const { return xml_->line; }

  /// Fails for anything in the element that the rule does not list, and for text.
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
  const XmlElement* xml_;
  const std::string* file_;
  std::string where_;
};

}  // namespace penumbra::detail
