// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <io/ros/message_definition.hpp>
#include <io/ros/message_fields-inl.hpp>

namespace penumbra::io {

/// How many values a member holds, and of which type each is.
template <typename T>
struct Shape {
  using Value = T;
  static constexpr Arity arity = Arity::one;
  static constexpr std::size_t count = 0;
};

template <typename T>
struct Shape<std::vector<T>> {
  using Value = T;
  static constexpr Arity arity = Arity::sequence;
  static constexpr std::size_t count = 0;
};

template <typename T, std::size_t N>
struct Shape<std::array<T, N>> {
  using Value = T;
  static constexpr Arity arity = Arity::array;
  static constexpr std::size_t count = N;
};

template <>
struct Shape<std::span<const std::byte>> {
  using Value = std::uint8_t;
  static constexpr Arity arity = Arity::sequence;
  static constexpr std::size_t count = 0;
};

template <typename T>
concept WireMessage = requires {
  Fields<T>::members;
};

/// What a member must be declared as.
struct WantedType {
  WireType type;
  const char* name;
};

template <typename T>
constexpr WantedType wanted_type() {
  if constexpr (WireMessage<T>) return {WireType::message, "a message"};
  if constexpr (std::same_as<T, bool>) return {WireType::boolean, "bool"};
  if constexpr (std::same_as<T, std::uint8_t>) return {WireType::octet, "uint8"};
  if constexpr (std::same_as<T, std::int32_t>) return {WireType::int32, "int32"};
  if constexpr (std::same_as<T, std::uint32_t>) return {WireType::uint32, "uint32"};
  if constexpr (std::same_as<T, std::uint64_t>) return {WireType::uint64, "uint64"};
  if constexpr (std::same_as<T, double>) return {WireType::float64, "float64"};
  if constexpr (std::same_as<T, std::string>) return {WireType::string, "string"};
}

template <typename T>
[[nodiscard]] bool has_shape(const FieldDefinition& field) {
  using S = Shape<T>;
  return field.type == wanted_type<typename S::Value>().type && field.arity == S::arity &&
         (S::arity != Arity::array || field.count == S::count);
}

template <typename T>
[[nodiscard]] std::string shape_text() {
  using S = Shape<T>;
  std::string name = wanted_type<typename S::Value>().name;
  if (S::arity == Arity::one) return name;
  return name + (S::arity == Arity::array ? "[" + std::to_string(S::count) + "]" : "[]");
}

}  // namespace penumbra::io
