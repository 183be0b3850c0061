// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/numbers.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

struct WireName {
  std::string_view name;
  WireType type;
  std::size_t bytes;  // at least
};

constexpr std::array<WireName, 16> wire_names = {{{"bool", WireType::boolean, 1},
                                                  {"uint8", WireType::octet, 1},
                                                  {"byte", WireType::octet, 1},
                                                  {"char", WireType::octet, 1},
                                                  {"int8", WireType::int8, 1},
                                                  {"int16", WireType::int16, 2},
                                                  {"uint16", WireType::uint16, 2},
                                                  {"int32", WireType::int32, 4},
                                                  {"uint32", WireType::uint32, 4},
                                                  {"int64", WireType::int64, 8},
                                                  {"uint64", WireType::uint64, 8},
                                                  {"float32", WireType::float32, 4},
                                                  {"float64", WireType::float64, 8},
                                                  {"string", WireType::string, 4},
                                                  {"wstring", WireType::wstring, 4},
                                                  {"", WireType::message, 1}}};

constexpr std::size_t most_bytes = std::numeric_limits<std::uint32_t>::max();

constexpr std::string_view name_characters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

bool is_type_name(std::string_view name) {
  const std::size_t slash = name.find('/');
  const auto plain = [](std::string_view part) {
    return !part.empty() && part.find_first_not_of(name_characters) == std::string_view::npos;
  };
  if (slash == std::string_view::npos) return plain(name);
  return plain(name.substr(0, slash)) && plain(name.substr(slash + 1));
}

// For messages: at most so much of a text that may be anything.
std::string shown(std::string_view text) {
  constexpr std::size_t most = 60;
  std::string copy(text.substr(0, most));
  std::replace_if(
      copy.begin(), copy.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + copy + (text.size() > most ? "...'" : "'");
}

std::string_view without_comment(std::string_view line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quote == 0 && line[i] == '#') return line.substr(0, i);
    if (line[i] != '"' && line[i] != '\'') continue;
    if (quote == 0)
      quote = line[i];
    else if (quote == line[i])
      quote = 0;
  }
  // An apostrophe in a comment is no quote: where none closes, the first # begins the comment.
  return quote == 0 ? line : line.substr(0, line.find('#'));
}

// Reads the lines of a definition one by one.
class DefinitionParser {
 public:
  DefinitionParser(std::string_view type, std::string_view text) : root_(shown(type)), rest_(text) {
    if (text.size() > MessageDefinition::max_text)
      fail("has " + std::to_string(text.size()) + " bytes; at most " +
           std::to_string(MessageDefinition::max_text) + " are possible");
    if (const std::string name = short_type(type); is_type_name(name))
      types_.push_back({.name = name});
    else
      fail("is no message type; one like sensor_msgs/msg/Image is wanted");
  }

  std::vector<TypeDefinition> parse() {
    while (!rest_.empty()) {
      ++line_;
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      take_line(trimmed(without_comment(rest_.substr(0, end))));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
    }
    return std::move(types_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError("message definition of " + root_ +
                     (line_ > 0 ? ", line " + std::to_string(line_) : "") + ": " + what);
  }

  void take_line(std::string_view line) {
    constexpr std::size_t least_separator = 3;
    if (line.empty()) return;
    if (line.size() >= least_separator && line.find_first_not_of('=') == std::string_view::npos) {
      awaits_name_ = true;
    } else if (awaits_name_) {
      begin_type(line);
    } else {
      take_member(line);
    }
  }

  void begin_type(std::string_view line) {
    constexpr std::string_view mark = "MSG:";
    const std::string name =
        line.starts_with(mark) ? short_type(trimmed(line.substr(mark.size()))) : std::string();
    if (!is_type_name(name) || name.find('/') == std::string::npos)
      fail("'MSG: package/Type' is wanted behind a line of '=', not " + shown(line));
    if (types_.size() >= MessageDefinition::max_types)
      fail("more than " + std::to_string(MessageDefinition::max_types) + " message types");
    for (const TypeDefinition& type : types_)
      if (type.name == name) fail(name + " is defined twice");
    types_.push_back({.name = name});
    awaits_name_ = false;
  }

  // TYPE NAME, TYPE NAME DEFAULT or TYPE NAME=VALUE
  void take_member(std::string_view line) {
    const std::size_t type_end = std::min(line.find_first_of(" \t"), line.size());
    const std::string_view type = line.substr(0, type_end);
    const std::string_view rest = trimmed(line.substr(type_end));
    const std::size_t name_end = std::min(rest.find_first_not_of(name_characters), rest.size());
    const std::string name(rest.substr(0, name_end));
    const std::string_view value = trimmed(rest.substr(name_end));
    const bool spaced = name_end == rest.size() || rest[name_end] == ' ' || rest[name_end] == '\t';
    if (name.empty() || (!spaced && !value.starts_with('=')))
      fail("'TYPE NAME' or 'TYPE NAME=VALUE' is wanted, not " + shown(line));
    TypeDefinition& owner = types_.back();
    if (value.starts_with('=')) {
      owner.constants.push_back({name, std::string(type), std::string(trimmed(value.substr(1)))});
      return;
    }
    FieldDefinition field = field_of(type);
    field.name = name;
    field.default_text = value;
    for (const FieldDefinition& other : owner.fields)
      if (other.name == name) fail(owner.name + " has " + name + " twice");
    owner.fields.push_back(std::move(field));
  }

  FieldDefinition field_of(std::string_view text) const {
    FieldDefinition field;
    const std::string_view all = text;
    if (const std::size_t bracket = text.find('['); bracket != std::string_view::npos) {
      const std::string_view inside = text.substr(bracket + 1);
      if (!inside.ends_with(']')) fail(shown(all) + " is no type");
      take_brackets(inside.substr(0, inside.size() - 1), field);
      text = text.substr(0, bracket);
    }
    if (const std::size_t bound = text.find("<="); bound != std::string_view::npos) {
      field.string_bound = number(text.substr(bound + 2));
      text = text.substr(0, bound);
      if (text != "string" && text != "wstring") fail(shown(all) + ": only strings have a bound");
    }
    name_type(text, field);
    return field;
  }

  void take_brackets(std::string_view inside, FieldDefinition& field) const {
    const bool bounded = inside.starts_with("<=");
    field.arity = inside.empty() || bounded ? Arity::sequence : Arity::array;
    if (!inside.empty()) field.count = number(inside.substr(bounded ? 2 : 0));
  }

  std::size_t number(std::string_view text) const {
    const auto value = parse_number<std::uint32_t>(text);
    if (!value || *value == 0) fail(shown(text) + " is no number of elements");
    return *value;
  }

  void name_type(std::string_view text, FieldDefinition& field) const {
    for (const WireName& known : wire_names) {
      if (text.empty() || known.name != text) continue;
      field.type = known.type;
      field.type_name = text;
      return;
    }
    field.type = WireType::message;
    std::string name = short_type(text);
    if (name == "time") name = "builtin_interfaces/Time";
    if (name == "duration") name = "builtin_interfaces/Duration";
    if (!is_type_name(name)) fail(shown(text) + " is no type");
    const std::string& owner = types_.back().name;
    const std::size_t package = owner.find('/');
    if (name.find('/') == std::string::npos && package != std::string::npos)
      name.insert(0, owner.substr(0, package + 1));
    field.type_name = name;
  }

  std::string root_;
  std::string_view rest_;
  std::size_t line_ = 0;
  bool awaits_name_ = false;
  std::vector<TypeDefinition> types_;
};

TypeDefinition seconds_type(const std::string& name) {
  TypeDefinition type{.name = name};
  type.fields.push_back({.name = "sec", .type_name = "int32", .type = WireType::int32});
  type.fields.push_back({.name = "nanosec", .type_name = "uint32", .type = WireType::uint32});
  return type;
}

// Finds the type of each field, and how many bytes types take at least.
class TypeLinker {
 public:
  explicit TypeLinker(std::vector<TypeDefinition>& types)
      : types_(types), states_(types.size(), State::unseen) {}

  // Types that the root does not reach are left as they are: nobody reads them.
  void link_root() { link(0); }

 private:
  enum class State { unseen, open, linked };

  void link(std::size_t index) {
    if (states_[index] == State::linked) return;
    if (states_[index] == State::open) fail(types_[index].name + " holds itself");
    states_[index] = State::open;
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < types_[index].fields.size(); ++i) {
      if (types_[index].fields[i].type == WireType::message) {
        const std::size_t nested = find(types_[index].fields[i].type_name);
        types_[index].fields[i].nested = nested;
        link(nested);
      }
      const FieldDefinition& field = types_[index].fields[i];
      bytes += field.arity == Arity::sequence ? 4
               : field.arity == Arity::array  ? field.count * min_bytes_each(field, types_)
                                              : min_bytes_each(field, types_);
      bytes = std::min(bytes, most_bytes);
    }
    types_[index].min_bytes = std::max<std::size_t>(bytes, 1);
    states_[index] = State::linked;
  }

  std::size_t find(const std::string& name) {
    for (std::size_t i = 0; i < types_.size(); ++i)
      if (types_[i].name == name) return i;
    if (name != "builtin_interfaces/Time" && name != "builtin_interfaces/Duration")
      fail("lacks the definition of " + name);
    types_.push_back(seconds_type(name));
    states_.push_back(State::unseen);
    return types_.size() - 1;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError("message definition of '" + types_.front().name + "': " + what);
  }

  std::vector<TypeDefinition>& types_;
  std::vector<State> states_;
};

}  // namespace

MessageDefinition::MessageDefinition(std::string_view type, std::string_view text)
    : types_(DefinitionParser(type, text).parse()) {
  TypeLinker(types_).link_root();
}

std::string type_text(const FieldDefinition& field) {
  std::string text = field.type_name;
  if (field.string_bound > 0) text += "<=" + std::to_string(field.string_bound);
  if (field.arity == Arity::one) return text;
  const std::string count = field.count > 0 ? std::to_string(field.count) : "";
  const bool bounded = field.arity == Arity::sequence && field.count > 0;
  return text + (bounded ? "[<=" : "[") + count + "]";
}

std::string short_type(std::string_view type) {
  constexpr std::string_view middle = "/msg/";
  std::string name(type);
  if (const std::size_t at = name.find(middle); at != std::string::npos)
    name.replace(at, middle.size(), "/");
  return name;
}

std::size_t min_bytes_each(const FieldDefinition& field, const std::vector<TypeDefinition>& types) {
  if (field.type == WireType::message) return types[field.nested].min_bytes;
  for (const WireName& known : wire_names)
    if (known.type == field.type) return known.bytes;
  return 1;
}

}  // namespace penumbra::io
