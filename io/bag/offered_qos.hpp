// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <io/bag/bag_reader.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {

/// Reads the QoS of the publishers that a recorder stored: a YAML list of profiles, with rmw's
/// numbers up to Humble and names since. An empty text gives an empty QoS.
[[nodiscard]] OfferedQos read_offered_qos(const std::string& profiles);

/// Reads the value in a metadata.yaml: a text or, since Jazzy, a list.
[[nodiscard]] OfferedQos read_offered_qos(const YamlNode& profiles);

/// Merges the QoS of further publishers into `qos`.
void merge(const OfferedQos& other, OfferedQos& qos);

}  // namespace penumbra::io
