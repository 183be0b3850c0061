// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/expression-inl.hpp>

namespace penumbra::detail {
namespace {

using Integer = std::int64_t;

constexpr std::size_t longest_sequence = 100'000;  // text or list

std::string type_name(const Value& value) {
  constexpr std::array<const char*, 9> names = {"None", "bool", "int",      "float",    "str",
                                                "list", "dict", "function", "namespace"};
  return names[value.index()];
}

/// Returns the shortest text that reads back as the same number, in Python's form.
std::string float_text(double number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0.0 ? "inf" : "-inf";
  constexpr double least_exponential = 1e16;
  constexpr double least_fixed = 1e-4;
  const double size = std::abs(number);
  const bool is_fixed = size == 0.0 || (size >= least_fixed && size < least_exponential);
  std::array<char, 64> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number,
                    is_fixed ? std::chars_format::fixed : std::chars_format::scientific)
          .ptr;
  std::string text(buffer.data(), end);
  if (is_fixed && text.find('.') == std::string::npos) text += ".0";
  return text;
}

std::string quoted(const std::string& text) {
  const char quote =
      text.find('\'') != std::string::npos && text.find('"') == std::string::npos ? '"' : '\'';
  std::string out(1, quote);
  for (const char c : text) {
    if (c == quote || c == '\\') out += '\\';
    out += c;
  }
  return out + quote;
}

/// As Python's repr().
std::string represented(const Value& value) {
  const auto* text = value.as<std::string>();
  return text != nullptr ? quoted(*text) : to_text(value);
}

[[noreturn]] void fail_operator(std::string_view op, const Value& a, const Value& b) {
  throw InputError("'" + std::string(op) + "' is not defined between " + type_name(a) + " and " +
                   type_name(b));
}

std::optional<Integer> integer_in(const Value& value) {
  if (const auto* integer = value.as<Integer>()) return *integer;
  if (const auto* truth = value.as<bool>()) return *truth ? 1 : 0;
  return std::nullopt;
}

Integer whole_power(Integer base, Integer exponent) {
  if (base >= -1 && base <= 1) return exponent % 2 == 0 && (base != 0 || exponent == 0) ? 1 : base;
  Integer result = 1;
  for (; exponent > 0; --exponent)
    if (__builtin_mul_overflow(result, base, &result)) throw InputError("a number is too large");
  return result;
}

Value integer_operator(char op, Integer a, Integer b) {
  Integer out = 0;
  bool overflows = false;
  if (op == '+') overflows = __builtin_add_overflow(a, b, &out);
  if (op == '-') overflows = __builtin_sub_overflow(a, b, &out);
  if (op == '*') overflows = __builtin_mul_overflow(a, b, &out);
  if (op == '%' || op == 'f') {  // f: the floor of a quotient
    if (b == 0) throw InputError("division by zero");
    if (b == -1) return integer_operator('*', op == '%' ? 0 : a, -1);
    const bool is_down = a % b != 0 && ((a < 0) != (b < 0));
    out = op == '%' ? a % b + (is_down ? b : 0) : a / b - (is_down ? 1 : 0);
  }
  if (overflows) throw InputError("a number is too large");
  return out;
}

double float_remainder(double a, double b) {
  const double rest = std::fmod(a, b);
  return rest != 0.0 && (rest < 0.0) != (b < 0.0) ? rest + b : rest;
}

Value float_operator(std::string_view op, double a, double b) {
  if (op == "+") return a + b;
  if (op == "-") return a - b;
  if (op == "*") return a * b;
  if (op == "**") {
    const double power = std::pow(a, b);
    if (std::isnan(power) || (a == 0.0 && b < 0.0))
      throw InputError("a power that is no real number");
    return power;
  }
  if (b == 0.0) throw InputError("division by zero");
  if (op == "/") return a / b;
  return op == "%" ? float_remainder(a, b) : std::nearbyint((a - float_remainder(a, b)) / b);
}

template <typename Sequence>
Sequence repeated(const Sequence& sequence, Integer times) {
  Sequence out;
  if (sequence.empty()) return out;
  if (times > 0 && sequence.size() > longest_sequence / static_cast<std::size_t>(times))
    throw InputError("a text or list is too long");
  for (Integer i = 0; i < times; ++i) out.insert(out.end(), sequence.begin(), sequence.end());
  return out;
}

template <typename Sequence>
Sequence joined(Sequence a, const Sequence& b) {
  if (a.size() + b.size() > longest_sequence) throw InputError("a text or list is too long");
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Adds an item to the size of what contains it.
template <typename Items>
void count(const Value& item, Container<Items>& in) {
  const auto add = [&](std::size_t size, int depth) {
    constexpr int deepest = 50;
    in.size += 1 + size;
    in.depth = std::max(in.depth, 1 + depth);
    if (in.size > longest_sequence || in.depth > deepest)
      throw InputError("a list or dictionary is too long or nested too deeply");
  };
  const auto* list = item.as<std::shared_ptr<const Container<List>>>();
  const auto* dictionary = item.as<std::shared_ptr<const Container<Dictionary>>>();
  if (list != nullptr) return add((*list)->size, (*list)->depth);
  if (dictionary != nullptr) return add((*dictionary)->size, (*dictionary)->depth);
  add(0, 0);
}

std::size_t index_in(Integer index, std::size_t size) {
  const auto length = static_cast<Integer>(size);
  if (index < -length || index >= length)
    throw InputError("index " + std::to_string(index) + " lies beyond the " + std::to_string(size) +
                     " items");
  return static_cast<std::size_t>(index < 0 ? index + length : index);
}

/// Characters are bytes here.
void check_ascii(const std::string& text) {
  if (std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) > 127; }))
    throw InputError("the characters of " + in_quotes(text) + " cannot be told apart: not ASCII");
}

std::string_view numeral(std::string_view text) {
  text = trimmed(text);
  return text.starts_with('+') && !text.starts_with("+-") ? text.substr(1) : text;
}

}  // namespace

const List* Value::list() const {
  const auto* list = as<std::shared_ptr<const Container<List>>>();
  return list == nullptr ? nullptr : &(*list)->items;
}

const Dictionary* Value::dictionary() const {
  const auto* dictionary = as<std::shared_ptr<const Container<Dictionary>>>();
  return dictionary == nullptr ? nullptr : &(*dictionary)->items;
}

Value make_list(List items) {
  Container<List> list;
  for (const Value& item : items) count(item, list);
  list.items = std::move(items);
  return std::make_shared<const Container<List>>(std::move(list));
}

Value make_dictionary(const Dictionary& items) {
  Container<Dictionary> dictionary;
  std::map<std::string, std::size_t> places;
  for (const auto& [key, value] : items) {
    const auto [place, is_new] =
        places.try_emplace(std::to_string(key.index()) + to_text(key), dictionary.items.size());
    count(value, dictionary);
    if (is_new)
      dictionary.items.emplace_back(key, value);
    else
      dictionary.items[place->second].second = value;
  }
  return std::make_shared<const Container<Dictionary>>(std::move(dictionary));
}

Value make_function(Function function) {
  return std::make_shared<const Function>(std::move(function));
}

std::string to_text(const Value& value) {
  if (const auto* text = value.as<std::string>()) return *text;
  if (const auto* truth = value.as<bool>()) return *truth ? "True" : "False";
  if (const auto* integer = value.as<Integer>()) return std::to_string(*integer);
  if (const auto* number = value.as<double>()) return float_text(*number);
  std::string out;
  if (const List* list = value.list()) {
    for (const Value& item : *list) out += (out.empty() ? "" : ", ") + represented(item);
    return "[" + out + "]";
  }
  if (const Dictionary* dictionary = value.dictionary()) {
    for (const auto& [key, item] : *dictionary)
      out += (out.empty() ? "" : ", ") + represented(key) + ": " + represented(item);
    return "{" + out + "}";
  }
  if (value.index() != 0) throw InputError("a " + type_name(value) + " is no text");
  return "None";
}

bool is_true(const Value& value) {
  if (const auto* text = value.as<std::string>()) return !text->empty();
  if (const auto number = number_in(value)) return *number != 0.0;
  if (const List* list = value.list()) return !list->empty();
  if (const Dictionary* dictionary = value.dictionary()) return !dictionary->empty();
  return value.index() != 0;
}

std::optional<double> number_in(const Value& value) {
  if (const auto integer = integer_in(value)) return static_cast<double>(*integer);
  if (const auto* number = value.as<double>()) return *number;
  return std::nullopt;
}

bool are_equal(const Value& a, const Value& b) {
  if (number_in(a) && number_in(b)) return *number_in(a) == *number_in(b);
  if (a.index() != b.index()) return false;
  if (const auto* text = a.as<std::string>()) return *text == *b.as<std::string>();
  if (const List* list = a.list()) return std::ranges::equal(*list, *b.list(), are_equal);
  if (a.dictionary() != nullptr) throw InputError("dictionaries are not compared");
  return a.index() == 0;
}

bool is_less(const Value& a, const Value& b) {
  if (number_in(a) && number_in(b)) return *number_in(a) < *number_in(b);
  const auto* left = a.as<std::string>();
  const auto* right = b.as<std::string>();
  if (left != nullptr && right != nullptr) return *left < *right;
  if (a.list() != nullptr && b.list() != nullptr)
    return std::ranges::lexicographical_compare(*a.list(), *b.list(), is_less);
  fail_operator("<", a, b);
}

std::optional<Integer> parse_integer(std::string_view text) {
  const std::string_view digits = numeral(text);
  Integer value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_whole = error == std::errc() && end == digits.data() + digits.size();
  return is_whole ? std::optional(value) : std::nullopt;
}

std::optional<double> parse_float(std::string_view text) {
  const std::string_view digits = numeral(text);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_whole =
      end == digits.data() + digits.size() && digits.find('(') == std::string::npos;
  return error == std::errc() && is_whole ? std::optional(value) : std::nullopt;
}

Value apply_operator(std::string_view op, const Value& a, const Value& b) {
  const auto left = integer_in(a);
  const auto right = integer_in(b);
  if (left && right && op != "/") {
    if (op != "**") return integer_operator(op == "//" ? 'f' : op[0], *left, *right);
    if (*right >= 0) return whole_power(*left, *right);
  }
  if (number_in(a) && number_in(b)) return float_operator(op, *number_in(a), *number_in(b));
  const auto* text = a.as<std::string>();
  const List* list = a.list();
  if (op == "*" && right && text != nullptr) return repeated(*text, *right);
  if (op == "*" && right && list != nullptr) return make_list(repeated(*list, *right));
  if (op == "*" && left && !number_in(b)) return apply_operator(op, b, a);
  if (op == "+" && text != nullptr && b.as<std::string>() != nullptr)
    return joined(*text, *b.as<std::string>());
  if (op == "+" && list != nullptr && b.list() != nullptr)
    return make_list(joined(*list, *b.list()));
  fail_operator(op, a, b);
}

Value item_of(const Value& a, const Value& b) {
  if (const Dictionary* dictionary = a.dictionary()) {
    for (const auto& [key, item] : *dictionary)
      if (are_equal(key, b)) return item;
    throw InputError("the dictionary has no key " + in_quotes(to_text(b)));
  }
  const auto index = integer_in(b);
  const auto* text = a.as<std::string>();
  if (index && a.list() != nullptr) return (*a.list())[index_in(*index, a.list()->size())];
  if (text != nullptr) check_ascii(*text);
  if (index && text != nullptr) return std::string(1, (*text)[index_in(*index, text->size())]);
  throw InputError("a " + type_name(a) + " has no items by " + type_name(b));
}

List items_of(const Value& value) {
  List items;
  if (const List* list = value.list()) return *list;
  if (const auto* text = value.as<std::string>()) {
    check_ascii(*text);
    for (const char c : *text) items.emplace_back(std::string(1, c));
  } else if (const Dictionary* dictionary = value.dictionary()) {
    for (const auto& [key, item] : *dictionary) items.push_back(key);
  } else {
    throw InputError("a " + type_name(value) + " has no items");
  }
  return items;
}

void Budget::spend(std::size_t amount) {
  if (amount > left_)
    throw InputError("expands to too much: more than any robot needs; is it a loop?");
  left_ -= amount;
}

}  // namespace penumbra::detail
