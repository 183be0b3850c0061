// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <deque>
#include <set>
#include <tuple>

#include <glob.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/robot/urdf_node-inl.hpp>
#include <penumbra/robot/xacro-inl.hpp>
#include <penumbra/robot/xacro_scope-inl.hpp>

namespace penumbra::detail {
namespace {

namespace fs = std::filesystem;

/// Returns whether an element cannot change the drawn robot, but for properties that it sets.
bool is_left_out(const std::string& element) {
  return element == "gazebo" || element == "ros2_control" || element == "transmission";
}

class Expander {
 public:
  Expander(fs::path folder, std::map<std::string, std::string> arguments, FileLocator& packages)
      : folders_{std::move(folder)}, arguments_(std::move(arguments)), packages_(packages) {
    for (const auto& [name, value] : arguments_) unused_.insert(name);
  }

  XmlElement expand(const XmlElement& root, std::vector<std::string>& notes) {
    Scope& top = make_scope(nullptr, false);
    add_functions(top);
    XmlElement out = shell_of(root, top, root.name);
    expand_children(root, top, out);
    for (const std::string& name : unused_) {
      const std::string what = *root.file + ": no file uses the argument " + in_quotes(name);
      if (const auto near = similar_name(declared_, name))
        throw InputError(what + "; is " + in_quotes(std::string(*near)) + " meant?");
      notes.push_back(what);
    }
    return out;
  }

  /// Returns what a text stands for: a value of any type if it is one expression.
  Value evaluate_text(std::string_view text, Scope& scope) {
    std::vector<Value> parts;
    while (!text.empty()) parts.push_back(next_part(text, scope));
    if (parts.size() == 1) return parts.front();
    std::string joined;
    for (const Value& part : parts) joined += to_text(part);
    budget_.spend(joined.size());
    return joined;
  }

 private:
  Scope& make_scope(Scope* parent, bool is_namespace) {
    constexpr std::size_t cost = 1000;
    budget_.spend(cost);
    return scopes_.emplace_back(evaluate_, parent, is_namespace);
  }

  /// Evaluates the text up to the next expression, or that expression, and cuts it off.
  Value next_part(std::string_view& text, Scope& scope) {
    const auto cut = [&](std::size_t count) {
      std::string part(text.substr(0, count));
      text.remove_prefix(count);
      return part;
    };
    // $${ stands for a literal ${.
    const std::size_t other = std::min(text.find_first_not_of('$'), text.size());
    const bool opens = other < text.size() && (text[other] == '{' || text[other] == '(');
    if (other == 0 || !opens)
      return cut(std::min(text.find('$', std::max<std::size_t>(other, 1)), text.size()));
    if (other > 1) return cut(other + 1).substr(1);
    const bool is_expression = text[1] == '{';
    const std::size_t end = text.find(is_expression ? '}' : ')');
    if (end == std::string_view::npos) throw InputError(in_quotes(text) + " is not closed");
    const std::string inner = cut(end + 1).substr(2, end - 2);
    const std::string source = budget_.nested([&] { return to_text(evaluate_text(inner, scope)); });
    if (!is_expression) return substitute(source);
    try {
      return evaluate(source, scope, budget_);
    } catch (const InputError& error) {
      throw InputError("${" + source + "}: " + error.what());
    }
  }

  /// $(find PACKAGE), $(arg NAME), $(dirname), $(env NAME), $(optenv NAME DEFAULT), $(eval
  /// EXPRESSION)
  Value substitute(const std::string& text) {
    const std::string_view all = trimmed(text);
    const std::size_t space = std::min(all.find(' '), all.size());
    const std::string_view command = all.substr(0, space);
    const std::string name(trimmed(all.substr(space)));
    if (command == "arg") return argument(name);
    if (command == "find") return packages_.find_package(name).string();
    if (command == "dirname") return folders_.front().string();
    if (command == "eval") return to_text(evaluate(name, arguments_alone(name), budget_));
    if (command == "env" || command == "optenv") {
      const std::size_t end = std::min(name.find(' '), name.size());
      const char* value = std::getenv(name.substr(0, end).c_str());
      if (value != nullptr) return std::string(value);
      if (command == "optenv") return std::string(trimmed(std::string_view(name).substr(end)));
      throw InputError("the environment has no variable " + in_quotes(name));
    }
    throw InputError("$(" + text +
                     ") is not supported; expected find, arg, dirname, env, optenv or eval");
  }

  /// Returns the names that $(eval EXPRESSION) knows: arguments, but no properties.
  Scope& arguments_alone(std::string_view expression) {
    std::erase_if(unused_, [&](const std::string& name) {
      return expression.find(name) != std::string_view::npos;
    });
    Scope& names = make_scope(nullptr, false);
    for (const auto& [name, value] : arguments_) names.set(name, value, true);
    return names;
  }

  Value argument(const std::string& name) {
    const auto found = arguments_.find(name);
    if (found == arguments_.end())
      throw InputError("the argument " + in_quotes(name) + " is not given; give it: " + name +
                       ":=VALUE");
    unused_.erase(name);
    return found->second;
  }

  /// Evaluates an attribute. Throws InputError with its place.
  Value attribute_value(const XmlElement& element, const XmlAttribute& attribute, Scope& scope) {
    try {
      return evaluate_text(attribute.value, scope);
    } catch (const InputError& error) {
      fail(element, attribute.name + "=" + in_quotes(attribute.value) + ": " + error.what());
    }
  }

  std::optional<Value> optional_attribute(const XmlElement& element, const std::string& key,
                                          Scope& scope) {
    for (const XmlAttribute& attribute : element.attributes)
      if (attribute.name == key) return attribute_value(element, attribute, scope);
    return std::nullopt;
  }

  Value required_attribute(const XmlElement& element, const std::string& key, Scope& scope) {
    if (auto value = optional_attribute(element, key, scope)) return *value;
    fail(element, "the attribute " + in_quotes(key) + " is missing");
  }

  std::string name_of(const XmlElement& element, Scope& scope, const std::string& key = "name") {
    std::string name = to_text(required_attribute(element, key, scope));
    if (name.empty()) fail(element, "the attribute " + in_quotes(key) + " is empty");
    return name;
  }

  /// Macros, arguments and blocks have names without expressions.
  [[nodiscard]] std::string name_as_written(const XmlElement& element) const {
    const std::string* name = element.attribute("name");
    if (name == nullptr || name->empty()) fail(element, "the attribute \"name\" is missing");
    return *name;
  }

  bool is_set(const XmlElement& element, const std::string& key, bool absent, Scope& scope) {
    const auto value = optional_attribute(element, key, scope);
    return value ? truth_of(element, *value) : absent;
  }

  [[nodiscard]] bool truth_of(const XmlElement& element, const Value& value) const {
    try {
      return to_truth(value);
    } catch (const InputError& error) {
      fail(element, error.what());
    }
  }

  static void expect(const XmlElement& element, std::initializer_list<std::string_view> known) {
    for (const XmlAttribute& a : element.attributes)
      if (std::ranges::find(known, a.name) == known.end() && !a.name.starts_with("xmlns:"))
        throw InputError(element.place() + ": <" + element.name + "> has an unknown attribute " +
                         in_quotes(a.name));
  }

  [[noreturn]] void fail(const XmlElement& element, const std::string& what) const {
    std::string place = element.place() + ": ";
    if (!calls_.empty())
      place += "in <" + calls_.back()->name + "> of " + calls_.back()->place() + ": ";
    throw InputError(place + what);
  }

  /// Returns the element without children under a name, its attributes evaluated.
  XmlElement shell_of(const XmlElement& element, Scope& scope, const std::string& name) {
    XmlElement out{name, element.file, element.line, {}, {}, element.text};
    for (const XmlAttribute& a : element.attributes)
      if (!a.name.starts_with("xacro:"))
        out.attributes.push_back({a.name, to_text(attribute_value(element, a, scope))});
    return out;
  }

  void expand_children(const XmlElement& parent, Scope& scope, XmlElement& out) {
    for (const XmlElement& child : parent.children) {
      if (child.name == "xacro:attribute" && parent.name.starts_with("xacro:"))
        fail(child, "in <" + parent.name + "> it changes nothing; write it in the element itself");
      expand_element(child, scope, out, child.name);
    }
  }

  /// `name`: in place of the element's.
  void expand_element(const XmlElement& element, Scope& scope, XmlElement& out,
                      const std::string& name) {
    constexpr std::size_t deepest = 500;
    spend(element);
    if (++nesting_ > deepest)
      fail(element, "macros, blocks or files contain each other without end");
    if (is_left_out(name)) {
      out.children.push_back({name, element.file, element.line, {}, {}, {}});
      set_properties_in(element, scope);
    } else if (name.starts_with("xacro:")) {
      run(element, scope, out, name.substr(name.find(':') + 1));
    } else {
      XmlElement copy = shell_of(element, scope, name);
      expand_children(element, scope, copy);
      out.children.push_back(std::move(copy));
    }
    --nesting_;
  }

  void spend(const XmlElement& element) {
    constexpr std::size_t cost = 200;
    budget_.spend(cost + element.text.size());
    for (const XmlAttribute& a : element.attributes)
      budget_.spend(cost + a.name.size() + a.value.size());
  }

  /// Expands what an element of no interest contains, as far as that is possible: it may set
  /// properties that others use.
  void set_properties_in(const XmlElement& element, Scope& scope) {
    XmlElement nothing;
    const auto before = std::tuple(calls_.size(), folders_.size(), nesting_);
    try {
      expand_children(element, scope, nothing);
    } catch (const InputError&) {  // of a package or argument that only a simulator needs
      calls_.resize(std::get<0>(before));
      folders_.resize(std::get<1>(before));
      nesting_ = std::get<2>(before);
    }
  }

  /// Does what a xacro: element says.
  void run(const XmlElement& element, Scope& scope, XmlElement& out, const std::string& name) {
    if (name == "property") return define_property(element, scope);
    if (name == "macro") return define_macro(element, scope);
    if (name == "arg") return declare_argument(element, scope);
    if (name == "include") return include(element, scope, out);
    if (name == "insert_block") return insert_block(element, scope, out);
    if (name == "attribute") return set_attribute(element, scope, out);
    if (name == "element")
      return expand_element(element, scope, out, name_of(element, scope, "xacro:name"));
    if (name == "call") return call_macro(element, name_of(element, scope, "macro"), scope, out);
    if (name != "if" && name != "unless") return call_macro(element, name, scope, out);
    expect(element, {"value"});
    if (truth_of(element, required_attribute(element, "value", scope)) == (name == "if"))
      expand_children(element, scope, out);
  }

  void set_attribute(const XmlElement& element, Scope& scope, XmlElement& out) {
    expect(element, {"name", "value"});
    const std::string name = name_of(element, scope);
    std::erase_if(out.attributes, [&](const XmlAttribute& a) { return a.name == name; });
    out.attributes.push_back({name, to_text(required_attribute(element, "value", scope))});
  }

  void define_property(const XmlElement& element, Scope& scope) {
    expect(element, {"name", "value", "default", "remove", "scope", "lazy_eval"});
    const std::string name = name_of(element, scope);
    if (is_set(element, "remove", false, scope)) return scope.remove(name);
    const std::string* text = element.attribute("value");
    if (text == nullptr) text = element.attribute("default");
    if (text != nullptr && element.attribute("value") == nullptr && scope.has(name)) return;
    const std::string* where = element.attribute("scope");
    const bool is_local = where == nullptr || *where == "local";
    if (!is_local && *where != "global" && *where != "parent")
      fail(element, "scope=" + in_quotes(*where) + " is unknown; expected parent or global");
    Scope& target = is_local ? scope : *where == "global" ? scope.top() : scope.caller();
    if (text == nullptr) return target.set_block("**" + name, &element);
    const bool is_lazy = is_local && is_set(element, "lazy_eval", true, scope);
    try {
      target.set(name, is_lazy ? Value(*text) : evaluate_text(*text, scope), !is_lazy);
    } catch (const InputError& error) {
      fail(element, in_quotes(*text) + ": " + error.what());
    }
  }

  void define_macro(const XmlElement& element, Scope& scope) {
    expect(element, {"name", "params"});
    std::string name = name_as_written(element);
    if (name.starts_with("xacro:")) name = name.substr(name.find(':') + 1);
    Macro macro{&element, {}};
    const std::string* list = element.attribute("params");
    constexpr std::size_t longest = 10'000;
    if (list != nullptr && list->size() > longest) fail(element, "params is too long");
    std::string_view rest = list == nullptr ? "" : trimmed(*list);
    while (!rest.empty()) {
      const std::size_t before = rest.size();
      macro.parameters.push_back(next_parameter(rest));
      if (rest.size() == before)
        fail(element, "params=" + in_quotes(*list) + " is no list of names");
    }
    scope.set_macro(name, std::move(macro));
  }

  void declare_argument(const XmlElement& element, Scope& scope) {
    expect(element, {"name", "default", "doc"});
    const std::string name = name_as_written(element);
    unused_.erase(name);
    declared_ += name + " ";
    if (arguments_.contains(name)) return;
    if (const auto value = optional_attribute(element, "default", scope))
      arguments_[name] = to_text(*value);
  }

  [[nodiscard]] fs::path from_here(const std::string& file) const { return folders_.back() / file; }

  void include(const XmlElement& element, Scope& scope, XmlElement& out) {
    expect(element, {"filename", "ns", "optional"});
    const std::string name = name_of(element, scope, "filename");
    Scope* target = &scope;
    if (element.attribute("ns") != nullptr) {
      target = &make_scope(&scope, true);
      scope.set(name_of(element, scope, "ns"), static_cast<Names*>(target), true);
    }
    const fs::path pattern = from_here(name);
    if (pattern.parent_path().string().find_first_of("*?[") != std::string::npos)
      fail(element, "filename=" + in_quotes(name) + ": folders cannot have wildcards");
    for (const fs::path& file : files_of(pattern)) {
      std::error_code error;
      if (!fs::exists(file, error) && is_set(element, "optional", false, scope)) continue;
      include_file(element, file, *target, out);
    }
  }

  /// Returns the files that a name with wildcards matches; any other name as it is.
  static std::vector<fs::path> files_of(const fs::path& pattern) {
    if (pattern.string().find_first_of("*?[") == std::string::npos) return {pattern};
    std::vector<fs::path> files;
    glob_t found{};
    if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
      files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    globfree(&found);
    return files;
  }

  void include_file(const XmlElement& element, const fs::path& file, Scope& scope,
                    XmlElement& out) {
    const XmlElement& root = kept_.emplace_back([&] {
      try {
        const std::string text = read_whole_file(file, FileLimit::text);
        budget_.spend(text.size());
        return read_xml(text, file.string());
      } catch (const InputError& error) {
        fail(element, error.what());
      }
    }());
    folders_.push_back(file.parent_path());
    expand_children(root, scope, out);
    folders_.pop_back();
  }

  void insert_block(const XmlElement& element, Scope& scope, XmlElement& out) {
    expect(element, {"name"});
    const std::string name = name_as_written(element);
    if (const Block content = scope.find_block("**" + name))
      expand_children(*content, scope, out);
    else if (const Block whole = scope.find_block("*" + name))
      expand_element(*whole, scope, out, whole->name);
    else
      fail(element, "there is no block " + in_quotes(name));
  }

  /// Returns the macro and the scope that it is called in: of NAMESPACE.NAME, the namespace.
  std::pair<std::shared_ptr<const Macro>, Scope*> find_macro(const std::string& name,
                                                             Scope& scope) {
    if (auto macro = scope.find_macro(name)) return {macro, &scope};
    const std::size_t dot = name.find('.');
    Scope* inner = dot == std::string::npos ? nullptr : scope.find_namespace(name.substr(0, dot));
    if (inner == nullptr) return {nullptr, nullptr};
    return find_macro(name.substr(dot + 1), *inner);
  }

  void call_macro(const XmlElement& element, const std::string& name, Scope& from,
                  XmlElement& out) {
    const auto [macro, scope] = find_macro(name, from);
    if (macro == nullptr) fail(element, in_quotes(name) + " is no known macro");
    Scope& inner = make_scope(scope, false);
    set_parameters(element, *macro, *scope, inner);
    calls_.push_back(&element);
    expand_children(*macro->body, inner, out);
    calls_.pop_back();
  }

  void set_parameters(const XmlElement& element, const Macro& macro, Scope& scope, Scope& inner) {
    std::set<std::string> names;
    for (const Parameter& parameter : macro.parameters) names.insert(parameter.name);
    std::set<std::string> given;
    for (const XmlAttribute& a : element.attributes) {
      if (element.name == "xacro:call" && a.name == "macro") continue;
      if (!names.contains(a.name)) fail(element, "the macro has no parameter " + in_quotes(a.name));
      inner.set(a.name, attribute_value(element, a, scope), true);
      given.insert(a.name);
    }
    XmlElement& blocks = kept_.emplace_back();
    expand_children(element, scope, blocks);
    auto block = blocks.children.begin();
    for (const Parameter& parameter : macro.parameters) {
      if (parameter.name.starts_with('*')) {
        if (block == blocks.children.end())
          fail(element, "the macro needs an element for " + in_quotes(parameter.name));
        inner.set_block(parameter.name, &*block++);
      } else if (!given.contains(parameter.name)) {
        inner.set(parameter.name, default_of(element, parameter, scope), true);
      }
    }
    if (block != blocks.children.end())
      fail(element, "the macro has no parameter for the element <" + block->name + ">");
  }

  Value default_of(const XmlElement& element, const Parameter& parameter, Scope& scope) {
    try {
      if (parameter.forwards)
        if (auto value = scope.find(parameter.name)) return *value;
      if (parameter.value) return evaluate_text(*parameter.value, scope);
    } catch (const InputError& error) {
      fail(element, "the default of " + in_quotes(parameter.name) + ": " + error.what());
    }
    fail(element, "the macro's parameter " + in_quotes(parameter.name) + " is not given");
  }

  /// The functions of module xacro.
  void add_functions(Scope& top) {
    const auto text_of = [](const List& values) {
      std::string text;
      for (const Value& value : values) text += (text.empty() ? "" : " ") + to_text(value);
      return text;
    };
    const auto one = [](const List& values) {
      if (values.size() != 1) throw InputError("a function of xacro needs one argument");
      return to_text(values[0]);
    };
    const Value load = make_function(
        [=, this](const List& values) { return load_yaml(from_here(one(values)), budget_); });
    const Value remark = make_function([](const List&) { return Value(std::string()); });
    const Value fail_with = make_function([=](const List& values) -> Value {
      throw InputError("the file says: " + text_of(values));
    });
    top.set("load_yaml", load, true);
    top.set(
        "xacro",
        make_dictionary(
            {{"load_yaml", load},
             {"arg", make_function([=, this](const List& v) { return argument(one(v)); })},
             {"abs_filename", make_function([=, this](const List& v) {
                return Value(from_here(one(v)).string());
              })},
             {"dotify", make_function([](const List& v) { return v.empty() ? Value() : v[0]; })},
             {"message", remark},
             {"warning", remark},
             {"print_location", remark},
             {"error", fail_with},
             {"fatal", fail_with}}),
        true);
  }

  std::vector<fs::path> folders_;  // of the files that include one another
  std::map<std::string, std::string> arguments_;
  std::set<std::string> unused_;  // given arguments that no file has named yet
  std::string declared_;          // with a space behind each
  FileLocator& packages_;
  Scope::Evaluate evaluate_ = [this](const std::string& text, Scope& scope) {
    return evaluate_text(text, scope);
  };
  std::deque<Scope> scopes_;
  std::deque<XmlElement> kept_;           // what macros and blocks are parts of
  std::vector<const XmlElement*> calls_;  // of macros, the innermost last
  Budget budget_;
  std::size_t nesting_ = 0;
};

}  // namespace

XmlElement expand_xacro(const XmlElement& root, const fs::path& folder,
                        const std::map<std::string, std::string>& arguments, FileLocator& packages,
                        std::vector<std::string>& notes) {
  return Expander(folder, arguments, packages).expand(root, notes);
}

}  // namespace penumbra::detail
