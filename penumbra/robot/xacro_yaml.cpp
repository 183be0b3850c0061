// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <numbers>
#include <regex>

#include <yaml-cpp/yaml.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/robot/xacro-inl.hpp>

namespace penumbra::detail {
namespace {

/// Returns what the number behind a tag is multiplied with.
std::optional<double> unit_of(const std::string& tag) {
  constexpr std::array<std::pair<const char*, double>, 6> units{
      {{"!radians", 1.0},
       {"!degrees", std::numbers::pi / 180.0},
       {"!meters", 1.0},
       {"!millimeters", 0.001},
       {"!foot", 0.3048},
       {"!inches", 0.0254}}};
  for (const auto& [name, factor] : units)
    if (tag == name) return factor;
  return std::nullopt;
}

class NoNames : public Names {
  std::optional<Value> find(const std::string&) override { return std::nullopt; }
};

/// Returns whether YAML 1.1 reads a plain scalar as a number that would be text, or another number,
/// elsewhere: 010, 0x1F, 1_000, 12:30, .inf.
bool is_odd_number(const std::string& text) {
  static const std::regex odd(
      "[-+]?(0[0-7_]*[0-9_]+|0[xb][0-9a-fA-F_]+|[0-9][0-9_]*(:[0-5]?[0-9])+(\\.[0-9_]*)?|"
      "[0-9]*_[0-9_.]*|\\.(inf|Inf|INF|nan|NaN|NAN))");
  return std::regex_match(text, odd);
}

Value plain_scalar(const std::string& text) {
  static const std::regex integer("[-+]?(0|[1-9][0-9]*)");
  static const std::regex number("([-+]?[0-9]+\\.[0-9]*|\\.[0-9]+)([eE][-+][0-9]+)?");
  constexpr std::size_t longest_number = 100;
  if (text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL") return {};
  for (const char* yes : {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"})
    if (text == yes) return true;
  for (const char* no : {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"})
    if (text == no) return false;
  if (text.size() > longest_number) return text;
  if (is_odd_number(text))
    throw InputError(in_quotes(text) +
                     " is a number in a form that is not supported; write it as a "
                     "decimal number, or in quotes");
  if (std::regex_match(text, integer))
    if (const auto value = parse_integer(text)) return *value;
  if (std::regex_match(text, number))
    if (const auto value = parse_float(text)) return *value;
  return text;
}

class Reader {
 public:
  Reader(std::string file, Budget& budget) : file_(std::move(file)), budget_(budget) {}

  Value read(const YAML::Node& node, int depth = 0) {
    constexpr int deepest = 30;
    if (depth > deepest) fail(node, "is nested too deeply");
    constexpr std::size_t cost = 50;
    budget_.spend(cost);
    if (node.IsScalar()) return scalar(node);
    if (!node.Tag().empty() && node.Tag() != "?" && !node.Tag().starts_with("tag:yaml.org"))
      fail(node, "the tag " + in_quotes(node.Tag()) + " is not supported here");
    if (node.IsSequence()) {
      List list;
      for (const YAML::Node& item : node) list.push_back(read(item, depth + 1));
      return make_list(std::move(list));
    }
    if (!node.IsMap()) return {};
    Dictionary merged;  // before the others, which count more
    Dictionary own;
    for (const auto& entry : node) {
      const YAML::Node& key = entry.first;
      if (key.IsScalar() && key.Scalar() == "<<" && key.Tag() != "!")
        merge(read(entry.second, depth + 1), merged);
      else
        own.emplace_back(read(key, depth + 1), read(entry.second, depth + 1));
    }
    merged.insert(merged.end(), own.begin(), own.end());
    return make_dictionary(merged);
  }

 private:
  /// Adds a dictionary, or several: the first one in a list overrides the others.
  static void merge(const Value& value, Dictionary& out) {
    if (const List* list = value.list())
      for (auto item = list->rbegin(); item != list->rend(); ++item) merge(*item, out);
    if (const Dictionary* dictionary = value.dictionary())
      out.insert(out.end(), dictionary->begin(), dictionary->end());
  }

  Value scalar(const YAML::Node& node) {
    const std::string& text = node.Scalar();
    budget_.spend(text.size());
    try {
      if (node.Tag() == "?" || node.Tag().empty()) return plain_scalar(text);
    } catch (const InputError& error) {
      fail(node, error.what());
    }
    if (node.Tag() == "!" || node.Tag() == "tag:yaml.org,2002:str") return text;
    const auto unit = unit_of(node.Tag());
    if (!unit) fail(node, "the tag " + in_quotes(node.Tag()) + " is not supported");
    NoNames none;
    const auto number = number_in(evaluate(text, none, budget_));
    if (!number) fail(node, in_quotes(text) + " is no number");
    return *number * *unit;
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    throw InputError(file_ + ":" + std::to_string(node.Mark().line + 1) + ": " + what);
  }

  std::string file_;
  Budget& budget_;
};

}  // namespace

Value load_yaml(const std::filesystem::path& file, Budget& budget) {
  const std::string text = read_whole_file(file, FileLimit::text);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) throw InputError(file.string() + ": has several documents");
    return documents.empty() ? Value() : Reader(file.string(), budget).read(documents[0]);
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

}  // namespace penumbra::detail
