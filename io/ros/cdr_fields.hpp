// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <io/ros/cdr_reader.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {

/// Throws InputError for definitions with wstring: what follows could not be found.
void refuse_wstrings(const MessageDefinition& definition);

/// How many values a field has; of a sequence its number is read. Each takes `min_bytes` (one or
/// more), so that no number of them can be claimed that the payload does not hold.
[[nodiscard]] std::size_t count_values(CdrReader& reader, const FieldDefinition& field,
                                       std::size_t min_bytes);

/// Steps over a field. A fault names it.
void skip_field(CdrReader& reader, const FieldDefinition& field,
                const std::vector<TypeDefinition>& types);

}  // namespace penumbra::io
