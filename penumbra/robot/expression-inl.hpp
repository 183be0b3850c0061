// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <penumbra/base/error.hpp>

namespace penumbra::detail {

struct Value;
using List = std::vector<Value>;
using Dictionary = std::vector<std::pair<Value, Value>>;  // the keys are unique

/// A list or dictionary, and how much is in it and in what it contains.
template <typename Items>
struct Container {
  Items items;
  std::size_t size = 0;
  int depth = 0;
};

/// What a name stands for, in an expression.
class Names {
 public:
  virtual ~Names() = default;
  [[nodiscard]] virtual std::optional<Value> find(const std::string& name) = 0;
};

using Function = std::function<Value(const List&)>;

/// A value of Python: None, a number, text, a container, a function, or a namespace.
struct Value : std::variant<std::monostate, bool, std::int64_t, double, std::string,
                            std::shared_ptr<const Container<List>>,
                            std::shared_ptr<const Container<Dictionary>>,
                            std::shared_ptr<const Function>, Names*> {
  using variant::variant;

  template <typename T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(static_cast<const variant*>(this));
  }
  [[nodiscard]] const List* list() const;
  [[nodiscard]] const Dictionary* dictionary() const;
};

// Throw InputError for more, or more deeply nested, items than a robot needs. Of equal keys the
// last value counts, in the first one's place.
[[nodiscard]] Value make_list(List items);
[[nodiscard]] Value make_dictionary(const Dictionary& items);
[[nodiscard]] Value make_function(Function function);

// As Python's str(), bool(), == and <. Throw InputError where Python has an error.
[[nodiscard]] std::string to_text(const Value& value);
[[nodiscard]] bool is_true(const Value& value);
[[nodiscard]] bool are_equal(const Value& a, const Value& b);
[[nodiscard]] bool is_less(const Value& a, const Value& b);

/// Returns the number; null for anything else. True is 1.
[[nodiscard]] std::optional<double> number_in(const Value& value);
/// Parses white space, a sign and decimal digits, as Python's int().
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);
/// Parses as Python's float(), infinities and NaN too.
[[nodiscard]] std::optional<double> parse_float(std::string_view text);

/// An operator with two operands: + - * / // % **
[[nodiscard]] Value apply_operator(std::string_view op, const Value& a, const Value& b);
/// Returns a[b].
[[nodiscard]] Value item_of(const Value& a, const Value& b);
/// Returns a.name: an entry of a dictionary or namespace, or a method.
[[nodiscard]] Value attribute_of(const Value& a, const std::string& name);
/// Returns the items of a list, the keys of a dictionary or the characters of a text.
[[nodiscard]] List items_of(const Value& value);

/// Python's functions and its module math, by their names; null for others.
[[nodiscard]] std::optional<Value> find_builtin(const std::string& name);

/// Limits how much one file can expand to: its text, elements, and steps of evaluation.
class Budget {
 public:
  void spend(std::size_t amount);  ///< throws InputError when all is spent

  /// Calls a function. Throws InputError if such calls are nested too deeply.
  template <typename F>
  auto nested(F&& call) {
    constexpr int deepest = 1000;
    if (depth_ >= deepest) throw InputError("is nested too deeply; is it a loop?");
    struct Level {
      int& depth;
      explicit Level(int& d) : depth(d) { ++depth; }
      ~Level() { --depth; }
    } const level(depth_);
    return call();
  }

 private:
  std::size_t left_ = 50'000'000;
  int depth_ = 0;
};

/// Evaluates the subset of Python's expressions that robot descriptions use: literals, arithmetic,
/// comparisons, and/or/not, if/else, lists, dictionaries, slices, calls, methods and
/// comprehensions (https://docs.python.org/3/reference/expressions.html). Throws InputError for
/// anything else.
[[nodiscard]] Value evaluate(std::string_view expression, Names& names, Budget& budget);

}  // namespace penumbra::detail
