// SPDX-License-Identifier: Apache-2.0
// C++ aggregates as Python values: made by keywords whose defaults are the aggregate's own, then
// not to be changed (replace() makes another), so that no change can be lost in a copy.
#pragma once

#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <python/bindings.hpp>

#include <penumbra/base/setting.hpp>

namespace penumbra::python {

/// A property: a data member, or a function of the object.
template <typename Get>
struct Field {
  const char* name;
  Get get;
  std::string doc;
};
template <typename Get>
Field(const char*, Get, const char*) -> Field<Get>;

/// A mapping of any kind, as an argument.
template <typename V>
struct Mapping {
  std::map<std::string, V> values;
  operator std::map<std::string, V>() && { return std::move(values); }  // NOLINT
};
/// A stamp as an argument, std::int64_t or an optional one. Raises TypeError for seconds.
template <typename T>
struct Nanoseconds {
  T value;
  operator T() const { return value; }  // NOLINT(google-explicit-constructor)
};
/// A list that cannot be changed, as a result.
template <typename V>
struct Frozen {
  std::vector<V> values;
};

/// The type of a member as an argument.
template <typename M>
struct GivenAs {
  using type = M;
};
template <typename V>
struct GivenAs<std::map<std::string, V>> {
  using type = Mapping<V>;
};
template <>
struct GivenAs<std::optional<std::int64_t>> {
  using type = Nanoseconds<std::optional<std::int64_t>>;
};
template <typename M>
using Given = typename GivenAs<M>::type;

/// The value of a property, as Python gets it.
template <typename M>
M shown(const M& value) {
  return value;
}
template <typename V>
Mapping<V> shown(const std::map<std::string, V>& values) {
  return {values};
}
template <typename V>
Frozen<V> shown(const std::vector<V>& values) {
  return {values};
}
inline Numbers shown(const Numbers& numbers) { return numbers; }
inline Poses shown(const Poses& poses) { return poses; }
template <typename V, std::size_t n>
Frozen<V> shown(const std::array<V, n>& values) {
  return {{values.begin(), values.end()}};
}
template <typename V>
Frozen<V> shown(std::span<const V> values) {
  return {{values.begin(), values.end()}};
}

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

template <typename T, typename... Options, typename... Get>
void show_properties(py::class_<T, Options...>& of, Field<Get>... fields) {
  (of.def_property_readonly(
       fields.name, [get = fields.get](const T& self) { return shown(std::invoke(get, self)); },
       fields.doc.c_str()),
   ...);
}

template <typename T, typename... Options>
void bind_repr(py::class_<T, Options...>& of, const std::vector<const char*>& names) {
  of.def("__repr__", [names](const Self<T>& self) { return repr_of(self, names); });
}

/// Properties, all of which are in the repr.
template <typename T, typename... Options, typename... Get>
void show_fields(py::class_<T, Options...>& of, Field<Get>... fields) {
  show_properties(of, fields...);
  bind_repr(of, {fields.name...});
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

/// A constructor from members: the first `positional` ones must be given, the others are keywords
/// whose defaults are the aggregate's.
template <std::size_t positional, typename T, typename... M>
void bind_init(py::class_<T>& of, Field<M T::*>... fields) {
  const T defaults{};
  const std::tuple all(fields...);
  const auto make = [fields...](Given<M>... values) {
    T made{};
    ((made.*fields.get = std::move(values)), ...);
    return made;
  };
  const auto keyword = [&]<typename V>(const Field<V T::*>& field) {
    return py::arg(field.name) = Given<V>{defaults.*field.get};
  };
  [&]<std::size_t... First, std::size_t... Rest>(std::index_sequence<First...>,
                                                 std::index_sequence<Rest...>) {
    of.def(py::init(make), py::arg(std::get<First>(all).name)..., py::kw_only(),
           keyword(std::get<positional + Rest>(all))...);
  }
  (std::make_index_sequence<positional>(), std::make_index_sequence<sizeof...(M) - positional>());
}

/// A constructor as bind_init(), properties and replace().
template <std::size_t positional = 0, typename T, typename... M>
void bind_members(py::class_<T>& of, Field<M T::*>... fields) {
  bind_init<positional>(of, fields...);
  show_properties(of, fields...);
  bind_replace(of, {fields.name...});
}

/// Likewise with all members in the repr.
template <std::size_t positional = 0, typename T, typename... M>
void bind_fields(py::class_<T>& of, Field<M T::*>... fields) {
  bind_members<positional>(of, fields...);
  bind_repr(of, {fields.name...});
}

/// A setting, with a sentence for its docstring.
template <typename T, typename M>
Field<M T::*> field_of(const Setting<T, M>& setting) {
  std::string doc = setting.meaning;
  doc[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(doc[0])));
  if (*setting.unit != 0) doc += std::string(" (") + setting.unit + ")";
  return {setting.name, setting.member, doc + "."};
}

/// bind_fields() of the settings of T and of `more` members, and check().
template <typename T, typename... M>
void bind_settings(py::class_<T>& of, Field<M T::*>... more) {
  std::apply([&](const auto&... setting) { bind_fields(of, field_of(setting)..., more...); },
             T::settings());
  of.def("check", &T::check, "Raises InputError, with the values, for settings out of bounds.");
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

template <typename T>
struct type_caster<penumbra::python::Nanoseconds<T>>
    : penumbra::python::ValueCaster<penumbra::python::Nanoseconds<T>> {
  static constexpr auto name = make_caster<T>::name;
  bool load(handle source, bool convert) {
    if (!source.is_none() && PyIndex_Check(source.ptr()) == 0)
      throw type_error("a stamp: expected integer nanoseconds, as round(1e9 * seconds); got " +
                       pybind11::cast<std::string>(str(type::of(source).attr("__qualname__"))));
    make_caster<T> inner;
    if (!inner.load(source, convert)) return false;
    this->value.value = cast_op<T>(inner);
    return true;
  }
  static handle cast(const penumbra::python::Nanoseconds<T>& stamp, return_value_policy policy,
                     handle parent) {
    return make_caster<T>::cast(stamp.value, policy, parent);
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
