// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>

#include <io/ros/message_definition.hpp>
#include <io/ros/message_texts-inl.hpp>

namespace penumbra::io {
namespace {

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

std::string_view definition_of(std::string_view type) {
  static const auto definitions = make_definitions();
  const auto at = definitions.find(short_type(type));
  return at == definitions.end() ? std::string_view() : at->second;
}

}  // namespace penumbra::io
