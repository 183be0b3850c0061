// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <span>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/expression-inl.hpp>

namespace penumbra::detail {
namespace {

using Integer = std::int64_t;

double number_at(const List& arguments, std::size_t i) {
  const auto number = number_in(arguments[i]);
  if (!number) throw InputError("a number is expected, not " + in_quotes(to_text(arguments[i])));
  return *number;
}

Integer integer_at(const List& arguments, std::size_t i) {
  const auto* integer = arguments[i].as<Integer>();
  if (integer == nullptr)
    throw InputError("a whole number is expected, not " + in_quotes(to_text(arguments[i])));
  return *integer;
}

const std::string& text_at(const List& arguments, std::size_t i) {
  const auto* text = arguments[i].as<std::string>();
  if (text == nullptr) throw InputError("a text is expected, not " + to_text(arguments[i]));
  return *text;
}

Value whole(double number) {
  constexpr double largest = 9e18;
  if (!(std::abs(number) < largest)) throw InputError("a number is too large to be whole");
  return static_cast<Integer>(number);
}

template <auto function>
Value real(const List& arguments) {
  const double result = function(number_at(arguments, 0));
  if (!std::isfinite(result)) throw InputError("the number is outside the function's domain");
  return result;
}

template <auto function>
Value real_of_two(const List& arguments) {
  return function(number_at(arguments, 0), number_at(arguments, 1));
}

template <auto function>
Value whole_of(const List& arguments) {
  return whole(function(number_at(arguments, 0)));
}

Value to_integer(const List& arguments) {
  const auto* text = arguments[0].as<std::string>();
  if (text == nullptr) return whole(std::trunc(number_at(arguments, 0)));
  if (const auto integer = parse_integer(*text)) return *integer;
  throw InputError(in_quotes(*text) + " is no whole number");
}

Value to_float(const List& arguments) {
  const auto* text = arguments[0].as<std::string>();
  if (text == nullptr) return number_at(arguments, 0);
  if (const auto number = parse_float(*text)) return *number;
  throw InputError(in_quotes(*text) + " is no number");
}

/// Rounds the exact decimal value, halves to even.
Value rounded(const List& arguments) {
  const double number = number_at(arguments, 0);
  if (arguments.size() == 1) return whole(std::nearbyint(number));
  constexpr Integer most_digits = 20;
  const Integer digits = std::min(integer_at(arguments, 1), most_digits);
  if (digits < 0) throw InputError("round() takes no negative digits here");
  if (arguments[0].as<Integer>() != nullptr) return arguments[0];
  return to_number(fixed(number, static_cast<int>(digits))).value_or(number);
}

Value absolute(const List& arguments) {
  return apply_operator("*", Integer{number_at(arguments, 0) < 0.0 ? -1 : 1}, arguments[0]);
}

template <bool largest>
Value extreme(const List& arguments) {
  const List items = arguments.size() == 1 ? items_of(arguments[0]) : arguments;
  if (items.empty()) throw InputError("min and max need a value");
  return largest ? *std::ranges::max_element(items, is_less)
                 : *std::ranges::min_element(items, is_less);
}

Value range(const List& arguments) {
  constexpr std::size_t longest = 10'000;
  constexpr Integer largest = 1'000'000'000'000;
  const Integer first = arguments.size() == 1 ? 0 : integer_at(arguments, 0);
  const Integer end = integer_at(arguments, arguments.size() == 1 ? 0 : 1);
  const Integer step = arguments.size() == 3 ? integer_at(arguments, 2) : 1;
  if (step == 0 || std::max({first, end, step}) > largest ||
      std::min({first, end, step}) < -largest)
    throw InputError("range takes whole numbers within +-1e12, and a step that is not 0");
  List items;
  for (Integer i = first; step > 0 ? i < end : i > end; i += step) {
    if (items.size() == longest) throw InputError("range has more than 10000 items");
    items.emplace_back(i);
  }
  return make_list(std::move(items));
}

Value length(const List& arguments) { return static_cast<Integer>(items_of(arguments[0]).size()); }

Value sorted(const List& arguments) {
  List items = items_of(arguments[0]);
  std::ranges::stable_sort(items, is_less);
  return make_list(std::move(items));
}

Value sum(const List& arguments) {
  Value total = Integer{0};
  for (const Value& item : items_of(arguments[0])) total = apply_operator("+", total, item);
  return total;
}

Value mapped(const List& arguments) {
  const auto* function = arguments[0].as<std::shared_ptr<const Function>>();
  if (function == nullptr) throw InputError("map needs a function");
  List out;
  for (const Value& item : items_of(arguments[1])) out.push_back((**function)({item}));
  return make_list(std::move(out));
}

Value to_list(const List& arguments) {
  return make_list(arguments.empty() ? List{} : items_of(arguments[0]));
}

Value to_string(const List& arguments) {
  return arguments.empty() ? std::string() : to_text(arguments[0]);
}

Value to_dictionary(const List& arguments) {
  Dictionary out;
  if (arguments.empty()) return make_dictionary({});
  if (arguments[0].dictionary() != nullptr) return arguments[0];
  for (const Value& pair : items_of(arguments[0]))
    out.emplace_back(item_of(pair, Integer{0}), item_of(pair, Integer{1}));
  return make_dictionary(out);
}

/// A function, and how many arguments it takes.
struct Builtin {
  const char* name;
  std::size_t least, most;
  Value (*call)(const List&);
};

constexpr Builtin math[] = {
    {"sin", 1, 1, real<[](double x) { return std::sin(x); }>},
    {"cos", 1, 1, real<[](double x) { return std::cos(x); }>},
    {"tan", 1, 1, real<[](double x) { return std::tan(x); }>},
    {"asin", 1, 1, real<[](double x) { return std::asin(x); }>},
    {"acos", 1, 1, real<[](double x) { return std::acos(x); }>},
    {"atan", 1, 1, real<[](double x) { return std::atan(x); }>},
    {"sqrt", 1, 1, real<[](double x) { return std::sqrt(x); }>},
    {"fabs", 1, 1, real<[](double x) { return std::abs(x); }>},
    {"radians", 1, 1, real<[](double x) { return x * (std::numbers::pi / 180.0); }>},
    {"degrees", 1, 1, real<[](double x) { return x * (180.0 / std::numbers::pi); }>},
    {"atan2", 2, 2, real_of_two<[](double y, double x) { return std::atan2(y, x); }>},
    {"hypot", 2, 2, real_of_two<[](double x, double y) { return std::hypot(x, y); }>},
    {"pow", 2, 2,
     [](const List& a) { return apply_operator("**", number_at(a, 0), number_at(a, 1)); }},
    {"floor", 1, 1, whole_of<[](double x) { return std::floor(x); }>},
    {"ceil", 1, 1, whole_of<[](double x) { return std::ceil(x); }>},
    {"trunc", 1, 1, whole_of<[](double x) { return std::trunc(x); }>}};

constexpr std::size_t any_count = 1'000'000;

constexpr Builtin python[] = {{"int", 1, 1, to_integer},
                              {"float", 1, 1, to_float},
                              {"str", 0, 1, to_string},
                              {"bool", 1, 1, [](const List& a) { return Value(is_true(a[0])); }},
                              {"list", 0, 1, to_list},
                              {"dict", 0, 1, to_dictionary},
                              {"round", 1, 2, rounded},
                              {"abs", 1, 1, absolute},
                              {"min", 1, any_count, extreme<false>},
                              {"max", 1, any_count, extreme<true>},
                              {"range", 1, 3, range},
                              {"len", 1, 1, length},
                              {"sorted", 1, 1, sorted},
                              {"sum", 1, 1, sum},
                              {"map", 2, 2, mapped}};

void check_count(const char* name, const List& arguments, std::size_t least, std::size_t most) {
  if (arguments.size() < least || arguments.size() > most)
    throw InputError(std::string(name) + "() got " + std::to_string(arguments.size()) +
                     " arguments");
}

Dictionary functions_of(std::span<const Builtin> builtins) {
  Dictionary functions;
  for (const Builtin& builtin : builtins)
    functions.emplace_back(builtin.name, make_function([=](const List& arguments) {
                             check_count(builtin.name, arguments, builtin.least, builtin.most);
                             return builtin.call(arguments);
                           }));
  return functions;
}

std::map<std::string, Value, std::less<>> all_functions() {
  Dictionary of_math = functions_of(math);
  of_math.emplace_back("pi", std::numbers::pi);
  of_math.emplace_back("tau", 2.0 * std::numbers::pi);
  of_math.emplace_back("e", std::numbers::e);
  of_math.emplace_back("inf", std::numeric_limits<double>::infinity());
  const Dictionary of_python = functions_of(python);
  std::map<std::string, Value, std::less<>> all;
  for (const Dictionary& functions : {of_math, of_python})
    for (const auto& [name, function] : functions) all[to_text(name)] = function;
  all["math"] = make_dictionary(of_math);
  all["python"] = make_dictionary(of_python);
  return all;
}

Value split(const std::string& text, const List& arguments) {
  List parts;
  const std::string separator = arguments.empty() ? "" : text_at(arguments, 0);
  for (std::string_view rest = separator.empty() ? trimmed(text) : text;;) {
    const std::size_t end =
        separator.empty() ? rest.find_first_of(" \t\r\n") : rest.find(separator);
    if (!separator.empty() || !rest.empty()) parts.emplace_back(std::string(rest.substr(0, end)));
    if (end == std::string_view::npos) return make_list(std::move(parts));
    rest.remove_prefix(end + std::max<std::size_t>(separator.size(), 1));
    if (separator.empty()) rest = trimmed(rest);
  }
}

Value replaced(const std::string& text, const List& arguments) {
  if (text_at(arguments, 0).empty()) throw InputError("replace() needs a text to replace");
  const List pieces = items_of(split(text, {text_at(arguments, 0)}));
  const std::string& to = text_at(arguments, 1);
  constexpr std::size_t longest = 100'000;
  if (to.size() * pieces.size() > longest) throw InputError("a text is too long");
  std::string out;
  for (std::size_t i = 0; i < pieces.size(); ++i) out += (i == 0 ? "" : to) + text_at(pieces, i);
  return out;
}

template <bool front, bool back>
Value stripped(const std::string& text, const List& arguments) {
  const std::string letters = arguments.empty() ? " \t\r\n\v\f" : text_at(arguments, 0);
  const std::size_t first = front ? text.find_first_not_of(letters) : 0;
  const std::size_t end = back ? text.find_last_not_of(letters) + 1 : text.size();
  return first < end ? text.substr(first, end - first) : std::string();
}

Value join(const std::string& text, const List& arguments) {
  const List items = items_of(arguments[0]);
  constexpr std::size_t longest = 100'000;
  std::string out;
  for (std::size_t i = 0; i < items.size(); ++i) {
    out += (i == 0 ? "" : text) + text_at(items, i);
    if (out.size() > longest) throw InputError("a text is too long");
  }
  return out;
}

template <auto letter>
Value cased(std::string text, const List&) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return static_cast<char>(letter(static_cast<unsigned char>(c)));
  });
  return text;
}

struct TextMethod {
  const char* name;
  std::size_t least, most;
  Value (*call)(const std::string&, const List&);
};

constexpr TextMethod text_methods[] = {
    {"split", 0, 1, split},
    {"replace", 2, 2, replaced},
    {"join", 1, 1, join},
    {"lower", 0, 0,
     [](const std::string& t, const List& a) {
       return cased<[](int c) { return std::tolower(c); }>(t, a);
     }},
    {"upper", 0, 0,
     [](const std::string& t, const List& a) {
       return cased<[](int c) { return std::toupper(c); }>(t, a);
     }},
    {"strip", 0, 1, stripped<true, true>},
    {"lstrip", 0, 1, stripped<true, false>},
    {"rstrip", 0, 1, stripped<false, true>},
    {"startswith", 1, 1,
     [](const std::string& t, const List& a) { return Value(t.starts_with(text_at(a, 0))); }},
    {"endswith", 1, 1,
     [](const std::string& t, const List& a) { return Value(t.ends_with(text_at(a, 0))); }}};

std::optional<Value> text_method(const std::string& text, std::string_view name) {
  for (const TextMethod& method : text_methods)
    if (name == method.name)
      return make_function([=](const List& arguments) {
        check_count(method.name, arguments, method.least, method.most);
        return method.call(text, arguments);
      });
  return std::nullopt;
}

/// get(key[, default]), keys(), values(), items()
std::optional<Value> dictionary_method(const Value& dictionary, std::string_view name) {
  if (name == "get")
    return make_function([=](const List& arguments) -> Value {
      check_count("get", arguments, 1, 2);
      for (const auto& [key, value] : *dictionary.dictionary())
        if (are_equal(key, arguments[0])) return item_of(dictionary, key);
      return arguments.size() == 2 ? arguments[1] : Value();
    });
  if (name != "keys" && name != "values" && name != "items") return std::nullopt;
  return make_function([=, name = std::string(name)](const List& arguments) {
    check_count(name.c_str(), arguments, 0, 0);
    List out;
    for (const auto& [key, value] : *dictionary.dictionary()) {
      if (name == "keys") out.push_back(key);
      if (name == "values") out.push_back(value);
      if (name == "items") out.push_back(make_list({key, value}));
    }
    return make_list(std::move(out));
  });
}

}  // namespace

std::optional<Value> find_builtin(const std::string& name) {
  static const std::map<std::string, Value, std::less<>> functions = all_functions();
  const auto found = functions.find(name);
  return found == functions.end() ? std::nullopt : std::optional(found->second);
}

Value attribute_of(const Value& a, const std::string& name) {
  if (const auto* names = a.as<Names*>())
    if (const auto value = (*names)->find(name)) return *value;
  std::optional<Value> method;
  if (const Dictionary* dictionary = a.dictionary()) {
    for (const auto& [key, value] : *dictionary)
      if (are_equal(key, name)) return item_of(a, name);
    method = dictionary_method(a, name);
  }
  if (const auto* text = a.as<std::string>()) method = text_method(*text, name);
  if (!method) throw InputError("it has no " + in_quotes(name) + ", or that is not supported");
  return *method;
}

}  // namespace penumbra::detail
