// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <numbers>

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

Value plain_scalar(const std::string& text) {
  if (text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL") return {};
  for (const char* yes : {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"})
    if (text == yes) return true;
  for (const char* no : {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"})
    if (text == no) return false;
  if (const auto integer = parse_integer(text)) return *integer;
  if (const auto number = to_number(text)) return *number;
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
    if (node.IsSequence()) {
      List list;
      for (const YAML::Node& item : node) list.push_back(read(item, depth + 1));
      return make_list(std::move(list));
    }
    if (!node.IsMap()) return {};
    Dictionary dictionary;
    for (const auto& entry : node) {
      Value value = read(entry.second, depth + 1);
      if (entry.first.IsScalar() && entry.first.Scalar() == "<<" && value.dictionary() != nullptr)
        dictionary.insert(dictionary.begin(), value.dictionary()->begin(),
                          value.dictionary()->end());
      else
        dictionary.emplace_back(read(entry.first, depth + 1), std::move(value));
    }
    return make_dictionary(std::move(dictionary));
  }

 private:
  Value scalar(const YAML::Node& node) {
    const std::string& text = node.Scalar();
    budget_.spend(text.size());
    if (node.Tag() == "?" || node.Tag().empty()) return plain_scalar(text);
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
    return Reader(file.string(), budget).read(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

}  // namespace penumbra::detail
