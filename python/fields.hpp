// SPDX-License-Identifier: Apache-2.0
// C++ aggregates as Python values: made by keywords whose defaults are the aggregate's own, then
// not to be changed (replace() makes another), so that no change can be lost in a copy.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <python/bindings.hpp>

namespace penumbra::python {

template <typename T, typename M>
struct Field {
  const char* name;
  M T::*member;
  const char* doc;
};
template <typename T, typename M>
Field(const char*, M T::*, const char*) -> Field<T, M>;

/// A mapping of any kind, as an argument.
template <typename V>
struct Mapping {
  std::map<std::string, V> values;
};
/// A list that is not to be changed, as a result.
template <typename V>
struct Frozen {
  std::vector<V> values;
};

/// How a member comes in, and how it is shown.
template <typename M>
struct Passed {
  using In = M;
  static In in(const M& m) { return m; }
  static M out(const M& m) { return m; }
  static M member(In&& m) { return std::move(m); }
};
template <typename V>
struct Passed<std::map<std::string, V>> {
  using In = Mapping<V>;
  static In in(const std::map<std::string, V>& m) { return {m}; }
  static Mapping<V> out(const std::map<std::string, V>& m) { return {m}; }
  static std::map<std::string, V> member(In&& m) { return std::move(m.values); }
};
template <typename V>
struct Passed<std::vector<V>> {
  using In = std::vector<V>;
  static In in(const std::vector<V>& m) { return m; }
  static Frozen<V> out(const std::vector<V>& m) { return {m}; }
  static std::vector<V> member(In&& m) { return std::move(m); }
};
/// Shown alone.
template <typename V, std::size_t n>
struct Passed<std::array<V, n>> {
  static Frozen<V> out(const std::array<V, n>& m) { return {{m.begin(), m.end()}}; }
};

/// "Name(field=value, ...)".
inline std::string repr_of(const py::object& self, const std::vector<const char*>& names) {
  std::string text = py::cast<std::string>(py::type::of(self).attr("__name__")) + "(";
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : ", ") + std::string(names[i]) + "=" +
            py::cast<std::string>(py::repr(self.attr(names[i])));
  return text + ")";
}

/// The same object with other values.
inline py::object replaced(const py::object& self, const std::vector<const char*>& names,
                           const py::kwargs& changes) {
  py::dict all;
  for (const char* const name : names) all[name] = self.attr(name);
  for (const auto& [name, value] : changes) all[name] = value;
  return py::type::of(self)(**all);
}

/// Properties that show the members of a value.
template <typename T, typename... M>
void show_fields(py::class_<T>& of, Field<T, M>... fields) {
  (of.def_property_readonly(
       fields.name,
       [member = fields.member](const T& self) { return Passed<M>::out(self.*member); },
       fields.doc),
   ...);
  const std::vector<const char*> names{fields.name...};
  of.def("__repr__", [names](const Self<T>& self) { return repr_of(self, names); });
}

template <typename T, typename... Options>
void bind_replace(py::class_<T, Options...>& of, const std::vector<const char*>& names) {
  of.def(
      "replace",
      [names](const Self<T>& self, const py::kwargs& changes) {
        return replaced(self, names, changes);
      },
      "The same with other values.");
}

/// Properties, a constructor by keywords and replace().
template <typename T, typename... M>
void bind_fields(py::class_<T>& of, Field<T, M>... fields) {
  const T defaults{};
  of.def(py::init([fields...](typename Passed<M>::In... values) {
           T made{};
           ((made.*fields.member = Passed<M>::member(std::move(values))), ...);
           return made;
         }),
         py::kw_only(), (py::arg(fields.name) = Passed<M>::in(defaults.*fields.member))...);
  show_fields(of, fields...);
  bind_replace(of, {fields.name...});
}

}  // namespace penumbra::python

namespace pybind11::detail {

template <typename V>
struct type_caster<penumbra::python::Mapping<V>>
    : penumbra::python::ValueCaster<penumbra::python::Mapping<V>> {
  static constexpr auto name = const_name("Mapping[str, ") + make_caster<V>::name + const_name("]");
  bool load(handle source, bool convert) {
    if (source.is_none() || !hasattr(source, "keys")) return false;
    make_caster<std::map<std::string, V>> inner;
    if (!inner.load(dict(reinterpret_borrow<object>(source)), convert)) return false;
    this->value.values = cast_op<std::map<std::string, V>&&>(std::move(inner));
    return true;
  }
  static handle cast(const penumbra::python::Mapping<V>& mapping, return_value_policy policy,
                     handle parent) {
    const auto values = reinterpret_steal<object>(
        make_caster<std::map<std::string, V>>::cast(mapping.values, policy, parent));
    return module_::import("types").attr("MappingProxyType")(values).release();
  }
};

template <typename V>
struct type_caster<penumbra::python::Frozen<V>>
    : penumbra::python::ValueCaster<penumbra::python::Frozen<V>> {
  static constexpr auto name = const_name("Tuple[") + make_caster<V>::name + const_name(", ...]");
  static handle cast(const penumbra::python::Frozen<V>& frozen, return_value_policy /*policy*/,
                     handle /*parent*/) {
    tuple made(frozen.values.size());
    for (std::size_t i = 0; i < frozen.values.size(); ++i)
      made[i] = pybind11::cast(frozen.values[i], return_value_policy::copy);
    return made.release();
  }
};

}  // namespace pybind11::detail
