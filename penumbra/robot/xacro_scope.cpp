// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/xacro_scope-inl.hpp>

namespace penumbra::detail {
namespace {

/// Returns the number, truth or text that a property's text stands for.
Value literal(Value value) {
  const auto* text = value.as<std::string>();
  if (text == nullptr) return value;
  if (text->size() >= 2 && text->front() == '\'' && text->back() == '\'')
    return text->substr(1, text->size() - 2);
  if (text->find('_') != std::string::npos) return value;
  if (const auto integer = parse_integer(*text)) return *integer;
  if (const auto number = parse_float(*text)) return *number;
  if (*text == "true" || *text == "True") return true;
  if (*text == "false" || *text == "False") return false;
  return value;
}

}  // namespace

bool to_truth(const Value& value) {
  const auto* text = value.as<std::string>();
  if (text == nullptr) return is_true(value);
  if (*text == "true" || *text == "True") return true;
  if (*text == "false" || *text == "False") return false;
  if (const auto integer = parse_integer(*text)) return *integer != 0;
  throw InputError(in_quotes(*text) + " is neither true nor false");
}

/// Cuts the first parameter off a macro's list: NAME, NAME:=DEFAULT, NAME:=^|DEFAULT.
Parameter next_parameter(std::string_view& list) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  const auto skip_space = [&] {
    while (!list.empty() && is_space(list.front())) list.remove_prefix(1);
  };
  const std::size_t end = std::min(list.find_first_of(" \t\r\n:="), list.size());
  Parameter parameter{std::string(list.substr(0, end))};
  list.remove_prefix(end);
  skip_space();
  if (!list.starts_with("=") && !list.starts_with(":=")) return parameter;
  list.remove_prefix(list.front() == ':' ? 2 : 1);
  skip_space();
  parameter.forwards = list.starts_with('^');
  if (parameter.forwards) list.remove_prefix(list.starts_with("^|") ? 2 : 1);
  std::size_t i = 0;
  while (i < list.size() && !is_space(list[i])) {
    const std::string_view rest = list.substr(i);
    const char closing = rest.starts_with("${")              ? '}'
                         : rest.starts_with("$(")            ? ')'
                         : rest[0] == '\'' || rest[0] == '"' ? rest[0]
                                                             : '\0';
    const std::size_t close = closing == '\0' ? 0 : rest.find(closing, 1);
    i += close == std::string_view::npos ? 1 : close + 1;
  }
  if (i > 0) parameter.value = list.substr(0, i);
  list.remove_prefix(i);
  skip_space();
  return parameter;
}

bool Scope::has(const std::string& name) const {
  if (properties_.contains(name)) return true;
  return parent_ == nullptr ? find_builtin(name).has_value() : parent_->has(name);
}

void Scope::set(const std::string& name, Value value, bool is_evaluated) {
  value = literal(std::move(value));
  const bool is_text = value.as<std::string>() != nullptr;
  properties_[name] = {std::move(value), is_evaluated || !is_text};
}

void Scope::remove(const std::string& name) {
  for (Scope* at = this; at != nullptr; at = at->parent_) {
    at->properties_.erase(name);
    at->blocks_.erase("**" + name);
  }
}

Scope& Scope::caller() {
  Scope* at = parent_;
  while (at != nullptr && !is_namespace_ && at->is_namespace_) at = at->parent_;
  return at == nullptr ? *this : *at;
}

void Scope::set_macro(const std::string& name, Macro macro) {
  macros_[name] = std::make_shared<const Macro>(std::move(macro));
}

std::shared_ptr<const Macro> Scope::find_macro(const std::string& name) const {
  if (const auto found = macros_.find(name); found != macros_.end()) return found->second;
  return parent_ == nullptr || is_namespace_ ? nullptr : parent_->find_macro(name);
}

Block Scope::find_block(const std::string& name) const {
  if (const auto found = blocks_.find(name); found != blocks_.end()) return found->second;
  return parent_ == nullptr ? nullptr : parent_->find_block(name);
}

Scope* Scope::find_namespace(const std::string& name) {
  const auto value = find(name);
  auto* const* names = value ? value->as<Names*>() : nullptr;
  return names == nullptr ? nullptr : static_cast<Scope*>(*names);
}

std::optional<Value> Scope::find(const std::string& name) {
  const auto found = properties_.find(name);
  if (found == properties_.end())
    return parent_ == nullptr ? find_builtin(name) : parent_->find(name);
  if (found->second.is_evaluated) return found->second.value;
  if (found->second.is_in_use)
    throw InputError("the property " + in_quotes(name) + " is made of itself");
  found->second.is_in_use = true;
  const std::string text = to_text(found->second.value);
  try {
    set(name, evaluate_(text, *this), true);
  } catch (const InputError& error) {
    found->second.is_in_use = false;
    throw InputError("property " + in_quotes(name) + ": " + error.what());
  }
  return properties_[name].value;
}

}  // namespace penumbra::detail
