// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <concepts>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/robot/expression-inl.hpp>

namespace penumbra::detail {
namespace {

struct Context {
  Names& names;
  Budget& budget;
};

/// A parsed expression. Copies share it.
class Code {
 public:
  template <typename Run>
  requires(!std::same_as<std::remove_cvref_t<Run>, Code>)
      Code(Run&& run)  // NOLINT: a function as it stands is code
      : run_(std::make_shared<const std::function<Value(Context)>>(std::forward<Run>(run))) {}
  Value operator()(Context at) const {
    return at.budget.nested([&] { return (*run_)(at); });
  }

 private:
  std::shared_ptr<const std::function<Value(Context)>> run_;
};

enum class Kind { number, text, name, symbol, end };

struct Token {
  Kind kind = Kind::end;
  std::string text;
};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Cuts an expression into its tokens.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : rest_(text) {}

  Token next() {
    rest_ = trimmed(rest_);
    if (rest_.empty()) return {};
    const char c = rest_.front();
    if (c == '\'' || c == '"') return {Kind::text, quoted(c)};
    if (is_digit(c) || (c == '.' && rest_.size() > 1 && is_digit(rest_[1])))
      return {Kind::number, number()};
    if (is_letter(c))
      return {Kind::name, take(while_in([](char x) { return is_letter(x) || is_digit(x); }))};
    for (const std::string_view symbol : {"**", "//", "==", "!=", "<=", ">="})
      if (rest_.starts_with(symbol)) return {Kind::symbol, take(2)};
    if (std::string_view("+-*/%()[]{},:.<>=").find(c) == std::string_view::npos)
      throw InputError("unexpected " + in_quotes(rest_.substr(0, 1)));
    return {Kind::symbol, take(1)};
  }

 private:
  template <typename Test>
  [[nodiscard]] std::size_t while_in(Test test) const {
    return static_cast<std::size_t>(std::ranges::find_if_not(rest_, test) - rest_.begin());
  }

  std::string take(std::size_t count) {
    std::string text(rest_.substr(0, count));
    rest_.remove_prefix(count);
    return text;
  }

  std::string number() {
    std::string text = take(while_in([](char c) { return is_digit(c) || c == '.'; }));
    if (!rest_.empty() && (rest_.front() == 'e' || rest_.front() == 'E')) {
      text += take(rest_.size() > 1 && (rest_[1] == '-' || rest_[1] == '+') ? 2 : 1);
      text += take(while_in(is_digit));
    }
    return text;
  }

  std::string quoted(char quote) {
    std::string text;
    for (std::size_t i = 1; i < rest_.size(); ++i) {
      char c = rest_[i];
      if (c == quote) {
        rest_.remove_prefix(i + 1);
        return text;
      }
      if (c == '\\' && i + 1 < rest_.size()) {
        c = rest_[++i];
        if (std::string_view("nt\\'\"").find(c) == std::string_view::npos)
          throw InputError("the escape \\" + std::string(1, c) + " is not supported");
        if (c == 'n') c = '\n';
        if (c == 't') c = '\t';
      }
      text += c;
    }
    throw InputError("a quote is not closed");
  }

  std::string_view rest_;
};

/// A comprehension's variable, which hides all other names.
class OneName : public Names {
 public:
  OneName(const std::string& name, Value value, Names& others)
      : name_(name), value_(std::move(value)), others_(others) {}
  std::optional<Value> find(const std::string& name) override {
    return name == name_ ? value_ : others_.find(name);
  }

 private:
  const std::string& name_;
  Value value_;
  Names& others_;
};

Value look_up(const std::string& name, Context at) {
  if (auto value = at.names.find(name)) return *value;
  if (auto value = find_builtin(name)) return *value;
  throw InputError("the name " + in_quotes(name) + " is not defined");
}

/// What it costs to make the value.
std::size_t size_of(const Value& value) {
  if (const auto* text = value.as<std::string>()) return 1 + text->size();
  if (const Dictionary* dictionary = value.dictionary()) return 1 + dictionary->size();
  return 1 + (value.list() != nullptr ? value.list()->size() : 0);
}

Value call(const Value& function, const List& arguments) {
  const auto* callable = function.as<std::shared_ptr<const Function>>();
  if (callable == nullptr) throw InputError("only functions can be called");
  return (**callable)(arguments);
}

bool contains(const Value& container, const Value& item) {
  const auto* text = container.as<std::string>();
  const auto* part = item.as<std::string>();
  if (text != nullptr && part != nullptr) return text->find(*part) != std::string::npos;
  return std::ranges::any_of(items_of(container),
                             [&](const Value& other) { return are_equal(other, item); });
}

/// Python has one None, True and False; which other values are one object is not defined.
bool is_same(const Value& a, const Value& b) {
  if (a.index() == 0 || b.index() == 0) return a.index() == b.index();
  if (a.as<bool>() == nullptr || b.as<bool>() == nullptr)
    throw InputError("'is' compares objects; write ==");
  return *a.as<bool>() == *b.as<bool>();
}

bool compare(const std::string& op, const Value& a, const Value& b) {
  if (op == "==") return are_equal(a, b);
  if (op == "!=") return !are_equal(a, b);
  if (op.starts_with("is")) return is_same(a, b) == (op == "is");
  if (op == "in") return contains(b, a);
  if (op == "not in") return !contains(b, a);
  if (op == "<") return is_less(a, b);
  if (op == ">") return is_less(b, a);
  return op == "<=" ? is_less(a, b) || are_equal(a, b) : is_less(b, a) || are_equal(a, b);
}

/// Returns items [from, to) of a list or text, as Python's slices without a step.
Value slice(const Value& whole, const Value& from, const Value& to) {
  const List items = items_of(whole);
  const auto size = static_cast<std::int64_t>(items.size());
  const auto bound = [&](const Value& value, std::int64_t absent) {
    if (value.index() == 0) return absent;
    const auto* index = value.as<std::int64_t>();
    if (index == nullptr) throw InputError("a slice needs whole numbers");
    return std::clamp<std::int64_t>(*index < 0 ? *index + size : *index, 0, size);
  };
  const std::int64_t first = bound(from, 0);
  const std::int64_t last = std::max(bound(to, size), first);
  if (whole.as<std::string>() != nullptr)
    return whole.as<std::string>()->substr(static_cast<std::size_t>(first),
                                           static_cast<std::size_t>(last - first));
  return make_list(List(items.begin() + first, items.begin() + last));
}

/// Parses an expression to code, operators of the lowest precedence first.
class Parser {
 public:
  explicit Parser(std::string_view text) : lexer_(text) { advance(); }

  Code whole() {
    Code code = tuple();
    if (token_.kind != Kind::end) throw InputError("unexpected " + in_quotes(token_.text));
    return code;
  }

 private:
  void advance() { token_ = lexer_.next(); }

  [[nodiscard]] bool is(std::string_view text) const {
    return token_.text == text && (token_.kind == Kind::symbol || token_.kind == Kind::name);
  }

  bool skip(std::string_view text) {
    if (!is(text)) return false;
    advance();
    return true;
  }

  void need(std::string_view text) {
    if (!skip(text))
      throw InputError(
          "expected '" + std::string(text) + "' " +
          (token_.kind == Kind::end ? "at the end" : "before " + in_quotes(token_.text)));
  }

  /// One expression, or several with commas between them as a list.
  Code tuple() {
    Code first = condition();
    if (!is(",")) return first;
    std::vector<Code> items{std::move(first)};
    while (skip(",") && token_.kind != Kind::end && !is(")")) items.push_back(condition());
    return list_of(std::move(items));
  }

  Code condition() {
    constexpr int deepest = 50;
    if (++depth_ > deepest) throw InputError("is nested too deeply");
    Code yes = disjunction();
    if (skip("if")) {
      Code test = disjunction();
      need("else");
      yes = [=, no = condition()](Context at) { return is_true(test(at)) ? yes(at) : no(at); };
    }
    --depth_;
    return yes;
  }

  Code disjunction() {
    Code left = conjunction();
    while (skip("or"))
      left = [=, right = conjunction()](Context at) {
        Value value = left(at);
        return is_true(value) ? value : right(at);
      };
    return left;
  }

  Code conjunction() {
    Code left = negation();
    while (skip("and"))
      left = [=, right = negation()](Context at) {
        Value value = left(at);
        return is_true(value) ? right(at) : value;
      };
    return left;
  }

  Code negation() {
    bool is_negated = false;
    bool has_not = false;
    for (; skip("not"); has_not = true) is_negated = !is_negated;
    Code operand = comparison();
    if (!has_not) return operand;
    return [=](Context at) { return Value(is_true(operand(at)) != is_negated); };
  }

  std::string comparison_operator() {
    for (const char* op : {"==", "!=", "<=", ">=", "<", ">", "in"})
      if (skip(op)) return op;
    if (skip("is")) return skip("not") ? "is not" : "is";
    if (!skip("not")) return "";
    need("in");
    return "not in";
  }

  Code comparison() {
    Code first = sum();
    std::vector<std::pair<std::string, Code>> others;
    for (std::string op = comparison_operator(); !op.empty(); op = comparison_operator())
      others.emplace_back(op, sum());
    if (others.empty()) return first;
    return [=](Context at) {
      Value left = first(at);
      for (const auto& [op, operand] : others) {
        Value right = operand(at);
        at.budget.spend(size_of(left) + size_of(right));
        if (!compare(op, left, right)) return Value(false);
        left = std::move(right);
      }
      return Value(true);
    };
  }

  static Code operation(const std::string& op, const Code& left, const Code& right) {
    return [=](Context at) {
      Value value = apply_operator(op, left(at), right(at));
      at.budget.spend(size_of(value));
      return value;
    };
  }

  /// Operands with operators of one rank between them.
  template <std::size_t N>
  Code chain(const std::array<const char*, N>& operators, Code (Parser::*operand)()) {
    Code left = (this->*operand)();
    for (bool found = true; found;) {
      found = false;
      for (const char* op : operators) {
        if (found || !skip(op)) continue;
        found = true;
        left = operation(op, left, (this->*operand)());
      }
    }
    return left;
  }

  Code sum() { return chain(std::array{"+", "-"}, &Parser::product); }
  Code product() { return chain(std::array{"*", "/", "//", "%"}, &Parser::sign); }

  Code sign() {
    bool is_negative = false;
    bool has_sign = false;
    for (; is("-") || is("+"); has_sign = true) {
      is_negative = is_negative != is("-");
      advance();
    }
    Code operand = power();
    if (!has_sign) return operand;
    return operation("*", constant(std::int64_t{is_negative ? -1 : 1}), operand);
  }

  Code power() {
    Code base = postfix();
    if (!skip("**")) return base;
    constexpr int deepest = 50;
    if (++depth_ > deepest) throw InputError("is nested too deeply");
    Code exponent = sign();
    --depth_;
    return operation("**", base, exponent);
  }

  Code postfix() {
    Code code = atom();
    for (;;) {
      if (skip(".")) {
        const std::string name = identifier();
        code = [=](Context at) {
          const Value value = code(at);
          at.budget.spend(size_of(value));
          return attribute_of(value, name);
        };
      } else if (skip("[")) {
        code = subscript(code);
      } else if (skip("(")) {
        code = call_of(code);
      } else {
        return code;
      }
    }
  }

  std::string identifier() {
    std::string name = token_.text;
    if (token_.kind != Kind::name || name.starts_with("__"))
      throw InputError("expected a name" + (name.empty() ? "" : ", not " + in_quotes(name)));
    advance();
    return name;
  }

  Code subscript(const Code& whole) {
    const Code none = [](Context) { return Value(); };
    Code from = is(":") ? none : condition();
    if (skip("]"))
      return [=](Context at) {
        const Value value = whole(at);
        at.budget.spend(size_of(value));
        return item_of(value, from(at));
      };
    need(":");
    Code to = is("]") ? none : condition();
    need("]");
    return [=](Context at) { return slice(whole(at), from(at), to(at)); };
  }

  Code call_of(const Code& function) {
    std::vector<Code> values;
    std::vector<std::pair<Code, Code>> named;  // one dictionary, the last argument
    while (!skip(")")) {
      Code value = condition();
      if (is("for")) {
        values.push_back(comprehension(value, ")"));
        break;
      }
      if (skip("=")) {
        named.emplace_back(constant(last_name_), condition());
      } else {
        values.push_back(std::move(value));
      }
      if (!is(")")) need(",");
    }
    if (!named.empty()) values.push_back(dictionary_of(std::move(named)));
    return [=](Context at) {
      List arguments;
      for (const Code& value : values) {
        arguments.push_back(value(at));
        at.budget.spend(size_of(arguments.back()));
      }
      Value result = call(function(at), arguments);
      at.budget.spend(size_of(result));
      return result;
    };
  }

  static Code list_of(std::vector<Code> items) {
    return [items = std::move(items)](Context at) {
      List list;
      for (const Code& item : items) list.push_back(item(at));
      return make_list(std::move(list));
    };
  }

  /// item for NAME in LIST [if TEST], up to the bracket.
  Code comprehension(const Code& item, std::string_view bracket) {
    need("for");
    const std::string name = identifier();
    need("in");
    Code list = disjunction();
    Code test = skip("if") ? disjunction() : [](Context) { return Value(true); };
    need(bracket);
    return [=](Context at) {
      List out;
      for (const Value& value : items_of(list(at))) {
        at.budget.spend(1);
        OneName names(name, value, at.names);
        const Context inner{names, at.budget};
        if (is_true(test(inner))) out.push_back(item(inner));
      }
      return make_list(std::move(out));
    };
  }

  Code list() {
    std::vector<Code> items;
    while (!skip("]")) {
      items.push_back(condition());
      if (items.size() == 1 && is("for")) return comprehension(items.front(), "]");
      if (!is("]")) need(",");
    }
    return list_of(std::move(items));
  }

  Code dictionary() {
    std::vector<std::pair<Code, Code>> items;
    while (!skip("}")) {
      Code key = condition();
      need(":");
      items.emplace_back(std::move(key), condition());
      if (!is("}")) need(",");
    }
    return dictionary_of(std::move(items));
  }

  static Code dictionary_of(std::vector<std::pair<Code, Code>> items) {
    return [items = std::move(items)](Context at) {
      Dictionary out;
      for (const auto& [key, value] : items) out.emplace_back(key(at), value(at));
      return make_dictionary(out);
    };
  }

  Code parentheses() {
    if (skip(")")) return list_of({});
    Code inner = tuple();
    if (is("for")) return comprehension(inner, ")");
    need(")");
    return inner;
  }

  Code atom() {
    if (token_.kind == Kind::number) return constant(number());
    if (token_.kind == Kind::text) return constant(text());
    if (skip("(")) return parentheses();
    if (skip("[")) return list();
    if (skip("{")) return dictionary();
    if (skip("True")) return constant(true);
    if (skip("False")) return constant(false);
    if (skip("None")) return constant({});
    std::string name = identifier();
    if (name == "lambda") throw InputError("lambda is not supported");
    last_name_ = name;
    return [name = std::move(name)](Context at) {
      Value value = look_up(name, at);
      at.budget.spend(value.as<std::string>() != nullptr ? size_of(value) : 1);
      return value;
    };
  }

  static Code constant(Value value) {
    return [value = std::move(value)](Context) { return value; };
  }

  Value number() {
    const std::string digits = token_.text;
    advance();
    if (const auto integer = parse_integer(digits)) return *integer;
    if (digits.find_first_not_of("0123456789") == std::string::npos)
      throw InputError(digits + " is too large");
    if (const auto real = parse_float(digits)) return *real;
    throw InputError(in_quotes(digits) + " is no number");
  }

  Value text() {
    std::string whole;
    for (; token_.kind == Kind::text; advance()) whole += token_.text;
    return whole;
  }

  Lexer lexer_;
  Token token_;
  int depth_ = 0;
  std::string last_name_;
};

}  // namespace

Value evaluate(std::string_view expression, Names& names, Budget& budget) {
  constexpr std::size_t longest = 4000;  // bounds the depth of the calls
  if (expression.size() > longest) throw InputError("is longer than 4000 characters");
  budget.spend(expression.size());
  return Parser(expression).whole()({names, budget});
}

}  // namespace penumbra::detail
