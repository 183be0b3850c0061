// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/robot/expression-inl.hpp>

namespace penumbra::detail {

using Block = const XmlElement*;  // of a tree that lives as long as the scopes

/// A parameter of a macro, with a default if it has one.
struct Parameter {
  std::string name;       // "*name": an element; "**name": an element's content
  bool forwards = false;  // ^: by default the caller's property of that name
  std::optional<std::string> value = {};
};

struct Macro {
  Block body;
  std::vector<Parameter> parameters;
};

/// A property. Text with expressions is evaluated when it is used.
struct Property {
  Value value;
  bool is_evaluated = true;
  bool is_in_use = false;  // being evaluated
};

/// Cuts the first parameter off a macro's list: NAME, NAME:=DEFAULT, NAME:=^|DEFAULT.
[[nodiscard]] Parameter next_parameter(std::string_view& list);

/// Returns the truth that a condition's value stands for. Throws InputError.
[[nodiscard]] bool to_truth(const Value& value);

/// Properties, macros and blocks, which hide those of the scopes around it.
class Scope : public Names {
 public:
  using Evaluate = std::function<Value(const std::string& text, Scope&)>;

  Scope(const Evaluate& evaluate, Scope* parent, bool is_namespace)
      : evaluate_(evaluate), parent_(parent), is_namespace_(is_namespace) {}

  /// Finds a property here or around, or a function or constant of Python.
  std::optional<Value> find(const std::string& name) override;
  [[nodiscard]] bool has(const std::string& name) const;
  /// If not `is_evaluated`, text is evaluated at its first use.
  void set(const std::string& name, Value value, bool is_evaluated);
  void remove(const std::string& name);  ///< here and in the scopes around

  Scope& caller();  ///< where scope="parent" sets
  Scope& top() { return parent_ == nullptr ? *this : parent_->top(); }

  void set_macro(const std::string& name, Macro macro);
  [[nodiscard]] std::shared_ptr<const Macro> find_macro(const std::string& name) const;
  void set_block(const std::string& name, Block block) { blocks_[name] = block; }
  [[nodiscard]] Block find_block(const std::string& name) const;
  Scope* find_namespace(const std::string& name);  ///< of an include with ns=NAME

 private:
  const Evaluate& evaluate_;
  Scope* parent_;
  bool is_namespace_;
  std::map<std::string, Property> properties_;
  std::map<std::string, std::shared_ptr<const Macro>> macros_;
  std::map<std::string, Block> blocks_;
};

}  // namespace penumbra::detail
