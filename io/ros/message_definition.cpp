// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>
#include <io/ros/message_definition.hpp>
#include <io/ros/message_texts-inl.hpp>

namespace penumbra::io {
namespace {

// Removes the first line or word from `text` and returns it.
std::string_view take_until(std::string_view& text, std::string_view ends) {
  const std::size_t end = std::min(text.find_first_of(ends), text.size());
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return taken;
}

// A field's type with its package: "geometry_msgs/Point[4]" for "Point[4]" in
// geometry_msgs/Polygon.
std::string full_type(std::string_view text, std::string_view owner) {
  const std::size_t end = std::min(text.find_first_of("[<"), text.size());
  std::string name = short_type(text.substr(0, end));
  if (name == "char") name = "uint8";
  if (name == "time") name = "builtin_interfaces/Time";
  const bool is_message = !name.empty() && name.front() >= 'A' && name.front() <= 'Z';
  if (is_message && name.find('/') == std::string::npos)
    name.insert(0, owner.substr(0, owner.find('/') + 1));
  return name.append(text.substr(end));
}

// "TYPE NAME", "TYPE NAME DEFAULT" or "TYPE NAME=VALUE"; the last is a constant.
void add_field(std::string_view line, MessageFields& owner) {
  const std::string type = full_type(take_until(line, " \t"), owner.type);
  line = trimmed(line);
  const std::size_t end = std::min(line.find_first_of(" \t="), line.size());
  if (!trimmed(line.substr(end)).starts_with('='))
    owner.fields.push_back((type + " ").append(line.substr(0, end)));
}

std::string shown(std::span<const std::string> fields, std::size_t i) {
  return i < fields.size() ? "'" + printable(fields[i]) + "'" : "no further field";
}

constexpr std::size_t separator_width = 80;

const MessageText* find_text(std::string_view type) {
  const auto texts = message_texts();
  const auto at = std::find_if(texts.begin(), texts.end(),
                               [type](const MessageText& text) { return text.type == type; });
  return at == texts.end() ? nullptr : &*at;
}

// Adds the message types in a message, and those in them, in the order of their fields.
void add_dependencies(const MessageText& message, std::vector<std::string>& types) {
  const MessageDefinition definition(message.type, message.text);
  for (const std::string& field : definition.types().front().fields) {
    const std::string type = field.substr(0, field.find_first_of(" ["));
    const MessageText* nested = find_text(type);
    if (nested == nullptr || std::find(types.begin(), types.end(), type) != types.end()) continue;
    types.push_back(type);
    add_dependencies(*nested, types);
  }
}

std::map<std::string, std::string, std::less<>> make_definitions() {
  std::map<std::string, std::string, std::less<>> definitions;
  for (const MessageText& message : message_texts()) {
    std::vector<std::string> types;
    add_dependencies(message, types);
    std::string text(message.text);
    for (const std::string& type : types)
      text += std::string(separator_width, '=') + "\nMSG: " + type + "\n" +
              std::string(find_text(type)->text);
    definitions.emplace(message.type, std::move(text));
  }
  return definitions;
}

}  // namespace

MessageDefinition::MessageDefinition(std::string_view type, std::string_view text)
    : types_{{.type = short_type(type)}} {
  constexpr std::string_view mark = "MSG:", separator = "===";
  if (text.size() > max_text)
    throw InputError("the definition of '" + printable(type) + "' has " +
                     std::to_string(text.size()) + " bytes; at most " + std::to_string(max_text) +
                     " are possible");
  while (!text.empty()) {
    std::string_view line = take_until(text, "\n");
    line = trimmed(take_until(line, "#"));
    if (line.starts_with(mark))
      types_.push_back({.type = short_type(trimmed(line.substr(mark.size())))});
    else if (!line.empty() && !line.starts_with(separator))
      add_field(line, types_.back());
  }
  types_.push_back({"builtin_interfaces/Time", {"int32 sec", "uint32 nanosec"}});
}

std::string MessageDefinition::difference(const MessageFields& expected) const {
  const auto found = std::find_if(types_.begin(), types_.end(),
                                  [&](const auto& type) { return type.type == expected.type; });
  if (found == types_.end()) return "lacks " + expected.type;
  const auto [is, wanted] = std::mismatch(found->fields.begin(), found->fields.end(),
                                          expected.fields.begin(), expected.fields.end());
  if (is == found->fields.end() && wanted == expected.fields.end()) return {};
  const auto i = static_cast<std::size_t>(is - found->fields.begin());
  return expected.type + " has " + shown(found->fields, i) + " in place of " +
         shown(expected.fields, i);
}

std::string difference_from_built_in(const MessageDefinition& definition, std::string_view type) {
  const MessageDefinition built_in(type, definition_of(type));
  for (const MessageFields& expected : built_in.types())
    if (std::string difference = definition.difference(expected); !difference.empty())
      return difference;
  return {};
}

std::string short_type(std::string_view type) {
  constexpr std::string_view middle = "/msg/";
  std::string name(type);
  if (const std::size_t at = name.find(middle); at != std::string::npos)
    name.replace(at, middle.size(), "/");
  return name;
}

std::string_view definition_of(std::string_view type) {
  static const auto definitions = make_definitions();
  const auto at = definitions.find(short_type(type));
  return at == definitions.end() ? std::string_view() : at->second;
}

}  // namespace penumbra::io
