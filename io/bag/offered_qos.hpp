// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <io/bag/bag_reader.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {

/// What a recorder kept of the publishers' QoS, a list of profiles as YAML: with rmw's numbers up
/// to Humble, with its words since. An empty text tells nothing.
[[nodiscard]] OfferedQos read_offered_qos(const std::string& profiles);

/// The same as a value of a metadata.yaml: a text or, since Jazzy, a list.
[[nodiscard]] OfferedQos read_offered_qos(const YamlNode& profiles);

/// Of all publishers of both.
void merge(const OfferedQos& other, OfferedQos& qos);

}  // namespace penumbra::io
