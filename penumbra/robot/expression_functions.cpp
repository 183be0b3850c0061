// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/expression-inl.hpp>

namespace penumbra::detail {
namespace {

using Integer = std::int64_t;
using Functions = std::map<std::string, Value, std::less<>>;

void need_count(const List& arguments, std::size_t least, std::size_t most) {
  if (arguments.size() < least || arguments.size() > most)
    throw InputError("a function got " + std::to_string(arguments.size()) + " arguments");
}

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

Value from_real(double (*function)(double)) {
  return make_function([=](const List& arguments) -> Value {
    need_count(arguments, 1, 1);
    const double result = function(number_at(arguments, 0));
    if (!std::isfinite(result)) throw InputError("a function of a number outside its domain");
    return result;
  });
}

Value from_two(double (*function)(double, double)) {
  return make_function([=](const List& arguments) -> Value {
    need_count(arguments, 2, 2);
    return function(number_at(arguments, 0), number_at(arguments, 1));
  });
}

Value to_integer(const List& arguments) {
  need_count(arguments, 1, 1);
  if (const auto* text = arguments[0].as<std::string>()) {
    if (const auto integer = parse_integer(*text)) return *integer;
    throw InputError(in_quotes(*text) + " is no whole number");
  }
  return whole(std::trunc(number_at(arguments, 0)));
}

Value to_float(const List& arguments) {
  need_count(arguments, 1, 1);
  if (const auto* text = arguments[0].as<std::string>()) {
    if (const auto number = parse_float(*text)) return *number;
    throw InputError(in_quotes(*text) + " is no number");
  }
  return number_at(arguments, 0);
}

/// Rounds halves to even, on the decimal digits.
Value rounded(const List& arguments) {
  need_count(arguments, 1, 2);
  const double number = number_at(arguments, 0);
  if (arguments.size() == 1) return whole(std::nearbyint(number));
  constexpr Integer most_digits = 20;
  const Integer digits = std::clamp<Integer>(integer_at(arguments, 1), 0, most_digits);
  return to_number(fixed(number, static_cast<int>(digits))).value_or(number);
}

Value absolute(const List& arguments) {
  need_count(arguments, 1, 1);
  const auto* integer = arguments[0].as<Integer>();
  if (integer != nullptr && *integer < 0) return apply_operator("-", Integer{0}, *integer);
  return integer != nullptr ? arguments[0] : Value(std::abs(number_at(arguments, 0)));
}

template <bool largest>
Value extreme(const List& arguments) {
  const List items = arguments.size() == 1 ? items_of(arguments[0]) : arguments;
  if (items.empty()) throw InputError("min and max need a value");
  return largest ? *std::ranges::max_element(items, is_less)
                 : *std::ranges::min_element(items, is_less);
}

Value range(const List& arguments) {
  need_count(arguments, 1, 3);
  constexpr std::size_t longest = 10'000;
  const Integer first = arguments.size() == 1 ? 0 : integer_at(arguments, 0);
  const Integer end = integer_at(arguments, arguments.size() == 1 ? 0 : 1);
  const Integer step = arguments.size() == 3 ? integer_at(arguments, 2) : 1;
  if (step == 0 || std::abs(static_cast<double>(step)) > 1e15)
    throw InputError("range needs another step");
  List items;
  for (Integer i = first; step > 0 ? i < end : i > end; i += step) {
    if (items.size() == longest) throw InputError("range has more than 10000 items");
    items.emplace_back(i);
  }
  return make_list(std::move(items));
}

Value length(const List& arguments) {
  need_count(arguments, 1, 1);
  return static_cast<Integer>(items_of(arguments[0]).size());
}

Value sorted(const List& arguments) {
  need_count(arguments, 1, 1);
  List items = items_of(arguments[0]);
  std::ranges::stable_sort(items, is_less);
  return make_list(std::move(items));
}

Value sum(const List& arguments) {
  need_count(arguments, 1, 1);
  Value total = Integer{0};
  for (const Value& item : items_of(arguments[0])) total = apply_operator("+", total, item);
  return total;
}

Value mapped(const List& arguments) {
  need_count(arguments, 2, 2);
  const auto* function = arguments[0].as<std::shared_ptr<const Function>>();
  if (function == nullptr) throw InputError("map needs a function");
  List out;
  for (const Value& item : items_of(arguments[1])) out.push_back((*function)->call({item}));
  return make_list(std::move(out));
}

Value to_dictionary(const List& arguments) {
  need_count(arguments, 0, 1);
  Dictionary out;
  if (arguments.empty()) return make_dictionary({});
  if (arguments[0].dictionary() != nullptr) return arguments[0];
  for (const Value& pair : items_of(arguments[0]))
    out.emplace_back(item_of(pair, Integer{0}), item_of(pair, Integer{1}));
  return make_dictionary(std::move(out));
}

Functions math_functions() {
  Functions functions{
      {"pi", std::numbers::pi},
      {"tau", 2.0 * std::numbers::pi},
      {"e", std::numbers::e},
      {"inf", std::numeric_limits<double>::infinity()},
      {"nan", std::numeric_limits<double>::quiet_NaN()},
      {"sin", from_real([](double x) { return std::sin(x); })},
      {"cos", from_real([](double x) { return std::cos(x); })},
      {"tan", from_real([](double x) { return std::tan(x); })},
      {"asin", from_real([](double x) { return std::asin(x); })},
      {"acos", from_real([](double x) { return std::acos(x); })},
      {"atan", from_real([](double x) { return std::atan(x); })},
      {"sqrt", from_real([](double x) { return std::sqrt(x); })},
      {"fabs", from_real([](double x) { return std::abs(x); })},
      {"radians", from_real([](double x) { return x * (std::numbers::pi / 180.0); })},
      {"degrees", from_real([](double x) { return x * (180.0 / std::numbers::pi); })},
      {"atan2", from_two([](double y, double x) { return std::atan2(y, x); })},
      {"hypot", from_two([](double x, double y) { return std::hypot(x, y); })},
      {"pow", make_function([](const List& arguments) {
         need_count(arguments, 2, 2);
         return apply_operator("**", number_at(arguments, 0), number_at(arguments, 1));
       })}};
  for (const auto& [name, function] :
       std::initializer_list<std::pair<const char*, double (*)(double)>>{
           {"floor", [](double x) { return std::floor(x); }},
           {"ceil", [](double x) { return std::ceil(x); }},
           {"trunc", [](double x) { return std::trunc(x); }}})
    functions[name] = make_function([function = function](const List& arguments) {
      need_count(arguments, 1, 1);
      return whole(function(number_at(arguments, 0)));
    });
  return functions;
}

Functions python_functions() {
  Functions functions;
  for (const auto& [name, function] :
       std::initializer_list<std::pair<const char*, Value (*)(const List&)>>{
           {"int", to_integer},
           {"float", to_float},
           {"round", rounded},
           {"abs", absolute},
           {"min", extreme<false>},
           {"max", extreme<true>},
           {"range", range},
           {"len", length},
           {"sorted", sorted},
           {"sum", sum},
           {"map", mapped},
           {"dict", to_dictionary}})
    functions[name] = make_function(function);
  functions["str"] = make_function([](const List& arguments) -> Value {
    need_count(arguments, 0, 1);
    return arguments.empty() ? std::string() : to_text(arguments[0]);
  });
  functions["list"] = functions["tuple"] = make_function([](const List& arguments) {
    need_count(arguments, 0, 1);
    return make_list(arguments.empty() ? List{} : items_of(arguments[0]));
  });
  functions["bool"] = make_function([](const List& arguments) -> Value {
    need_count(arguments, 1, 1);
    return is_true(arguments[0]);
  });
  return functions;
}

Value module_of(const Functions& functions) {
  return make_dictionary(Dictionary(functions.begin(), functions.end()));
}

Functions all_functions() {
  Functions functions = math_functions();
  const Functions python = python_functions();
  Value math = module_of(functions);
  functions.insert(python.begin(), python.end());
  functions["math"] = std::move(math);
  functions["python"] = module_of(python);
  return functions;
}

Value split(const std::string& text, const List& arguments) {
  need_count(arguments, 0, 1);
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

Value replaced(std::string text, const List& arguments) {
  need_count(arguments, 2, 2);
  const std::string& from = text_at(arguments, 0);
  const std::string& to = text_at(arguments, 1);
  if (from.empty()) throw InputError("replace needs a text to replace");
  std::string out;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(from, at);
    out += text.substr(at, end - at);
    if (end == std::string::npos) return out;
    out += to;
    at = end + from.size();
    constexpr std::size_t longest = 1'000'000;
    if (out.size() > longest) throw InputError("a text is too long");
  }
}

Value join(const std::string& text, const List& arguments) {
  need_count(arguments, 1, 1);
  const List items = items_of(arguments[0]);
  std::string out;
  for (std::size_t i = 0; i < items.size(); ++i) out += (i == 0 ? "" : text) + text_at(items, i);
  return out;
}

template <int (*letter)(int)>
Value cased(std::string text, const List& arguments) {
  need_count(arguments, 0, 0);
  std::ranges::transform(text, text.begin(), [](char c) {
    return static_cast<char>(letter(static_cast<unsigned char>(c)));
  });
  return text;
}

/// Returns a method that is a function of the text and the arguments.
template <typename Method>
Value bound(const std::string& text, Method method) {
  return make_function([=](const List& arguments) { return Value(method(text, arguments)); });
}

std::optional<Value> text_method(const std::string& text, std::string_view name) {
  if (name == "split") return bound(text, split);
  if (name == "replace") return bound(text, replaced);
  if (name == "join") return bound(text, join);
  if (name == "lower") return bound(text, cased<std::tolower>);
  if (name == "upper") return bound(text, cased<std::toupper>);
  if (name == "strip")
    return bound(text, [](const std::string& t, const List& arguments) {
      need_count(arguments, 0, 0);
      return std::string(trimmed(t));
    });
  if (name == "startswith")
    return bound(text, [](const std::string& t, const List& arguments) {
      need_count(arguments, 1, 1);
      return t.starts_with(text_at(arguments, 0));
    });
  if (name == "endswith")
    return bound(text, [](const std::string& t, const List& arguments) {
      need_count(arguments, 1, 1);
      return t.ends_with(text_at(arguments, 0));
    });
  return std::nullopt;
}

/// get(key[, default]), keys(), values(), items()
std::optional<Value> dictionary_method(const Value& dictionary, std::string_view name) {
  if (name == "get")
    return make_function([=](const List& arguments) -> Value {
      need_count(arguments, 1, 2);
      for (const auto& [key, value] : *dictionary.dictionary())
        if (are_equal(key, arguments[0])) return item_of(dictionary, key);
      return arguments.size() == 2 ? arguments[1] : Value();
    });
  if (name != "keys" && name != "values" && name != "items") return std::nullopt;
  return make_function([=, name = std::string(name)](const List& arguments) {
    need_count(arguments, 0, 0);
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
  static const Functions functions = all_functions();
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
  if (!method) throw InputError("there is no " + in_quotes(name) + " in it");
  return *method;
}

}  // namespace penumbra::detail
