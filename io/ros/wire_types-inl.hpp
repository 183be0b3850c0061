// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <io/ros/message_fields-inl.hpp>

namespace penumbra::io {

template <typename T>
concept WireMessage = requires {
  Fields<T>::members;
};

/// How definitions write the type of a member.
template <typename T>
struct WireType {
  using Value = T;
  static std::string text() {
    if constexpr (WireMessage<T>) return std::string(Fields<T>::type);
    if constexpr (std::same_as<T, bool>) return "bool";
    if constexpr (std::same_as<T, std::uint8_t>) return "uint8";
    if constexpr (std::same_as<T, std::int32_t>) return "int32";
    if constexpr (std::same_as<T, std::uint32_t>) return "uint32";
    if constexpr (std::same_as<T, std::uint64_t>) return "uint64";
    if constexpr (std::same_as<T, double>) return "float64";
    if constexpr (std::same_as<T, std::string>) return "string";
  }
};

template <typename T>
struct WireType<std::vector<T>> {
  using Value = T;
  static std::string text() { return WireType<T>::text() + "[]"; }
};

template <typename T, std::size_t N>
struct WireType<std::array<T, N>> {
  using Value = T;
  static std::string text() { return WireType<T>::text() + "[" + std::to_string(N) + "]"; }
};

template <>
struct WireType<std::span<const std::byte>> {
  using Value = std::uint8_t;
  static std::string text() { return "uint8[]"; }
};

/// The type that a member has on the wire.
template <typename M, typename T>
WireType<T> wire_type(const Member<M, T>&);
template <typename W, typename M, typename T>
WireType<W> wire_type(const Converted<W, M, T>&);

/// Calls `call` with each member of a message, in the order of the wire.
template <WireMessage M, typename F>
void for_each_member(const F& call) {
  std::apply([&](const auto&... members) { (call(members), ...); }, Fields<M>::members);
}

}  // namespace penumbra::io
