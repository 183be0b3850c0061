// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace penumbra::detail {

/// What separates words, as XML has it.
inline constexpr std::string_view white_space = " \t\r\n";

/// The text without white space around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The text in quotes, on one line and cut to a length that a message can hold.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Where the text stops to be UTF-8 (RFC 3629); npos if all of it is.
[[nodiscard]] std::size_t find_not_utf8(std::string_view text);

/// Whether a text in UTF-8 holds characters that end a line or steer a terminal: C0, DEL or C1.
[[nodiscard]] bool holds_control(std::string_view text);

/// A number printed without trailing zeros.
[[nodiscard]] std::string printed(double number);

/// A finite decimal number that fills the whole text; independent of the locale.
[[nodiscard]] std::optional<double> to_number(std::string_view text);

/// Exactly out.size() such numbers with white space between them; false for anything else.
[[nodiscard]] bool to_numbers(std::string_view text, std::span<double> out);

}  // namespace penumbra::detail
