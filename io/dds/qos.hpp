// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <dds/dds.h>

#include <io/dds/participant.hpp>

namespace penumbra::io {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, DeleteQos>;

/// As ROS 2's own participants say it.
[[nodiscard]] QosPointer make_qos(const TopicQos& qos);

/// What discovery tells of another's.
[[nodiscard]] TopicQos read_qos(const dds_qos_t* qos);

/// DDS's number of a policy, as incompatible ones are told: "reliability".
[[nodiscard]] std::string policy_name(std::uint32_t policy);

}  // namespace penumbra::io
