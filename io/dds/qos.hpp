// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <dds/dds.h>

#include <io/dds/participant.hpp>

namespace penumbra::io {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, DeleteQos>;

/// Returns the QoS in the form that ROS 2's own participants use, with the hash of the message type
/// as user data, which nodes of Jazzy and later compare. `definition`: the type's ros2msg text;
/// empty: the built-in one.
[[nodiscard]] QosPointer make_qos(const TopicQos& qos, const std::string& type,
                                  std::string_view definition = {});

/// Returns the QoS of a discovered endpoint.
[[nodiscard]] TopicQos read_qos(const dds_qos_t* qos);

/// Returns the name of a policy by DDS's number, for incompatible QoS: "reliability".
[[nodiscard]] std::string policy_name(std::uint32_t policy);

}  // namespace penumbra::io
