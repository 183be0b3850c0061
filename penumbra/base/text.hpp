// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace penumbra::detail {

/// Returns the text without leading and trailing white space.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Returns the text in quotes for a message: one line, long text cut off.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Formats a number with six digits and no trailing zeros.
[[nodiscard]] std::string printed(double number);

/// Formats a number with so many digits after the point.
[[nodiscard]] std::string fixed(double number, int places);

/// Parses a finite decimal number that fills the whole text; independent of the locale.
[[nodiscard]] std::optional<double> to_number(std::string_view text);

/// Parses exactly out.size() such numbers, separated by white space; false for anything else.
[[nodiscard]] bool to_numbers(std::string_view text, std::span<double> out);

}  // namespace penumbra::detail
