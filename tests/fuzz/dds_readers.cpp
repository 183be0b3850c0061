// SPDX-License-Identifier: Apache-2.0
// What other participants of DDS say of their topics: names, and types as their definition.
#include "readers.hpp"

#include <io/dds/graph_names.hpp>
#include <io/dds/type_hash.hpp>

namespace penumbra::fuzz {
namespace {

void read_type(std::string_view text) {
  static_cast<void>(io::type_hash("a/msg/B", text));
  const std::string_view name = text.substr(0, text.find('\n'));
  if (const auto topic = io::ros_topic(name))
    require(io::dds_topic(*topic) == name, "a topic has one name");
  if (const auto type = io::ros_type(name))
    require(io::dds_type(*type) == name, "a type has one name");
}

const Added dds({{"dds", read_type}});

}  // namespace
}  // namespace penumbra::fuzz
