// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <new>

#include <io/dds/qos.hpp>
#include <io/dds/type_hash.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

constexpr dds_duration_t longest_write = DDS_MSECS(100);

}  // namespace

QosPointer make_qos(const TopicQos& qos, const std::string& type, std::string_view definition) {
  QosPointer made(dds_create_qos());
  if (!made) throw std::bad_alloc();
  dds_qset_reliability(made.get(),
                       qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       longest_write);
  dds_qset_durability(made.get(),
                      qos.latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(made.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  // The history that a latched topic keeps for late subscribers.
  if (qos.latched)
    dds_qset_durability_service(made.get(), 0, DDS_HISTORY_KEEP_LAST, qos.depth,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(made.get(), false);
  const std::array<dds_data_representation_id_t, 1> plain_cdr = {DDS_DATA_REPRESENTATION_XCDR1};
  dds_qset_data_representation(made.get(), plain_cdr.size(), plain_cdr.data());
  const std::string_view text = definition.empty() ? definition_of(type) : definition;
  const std::string hash = text.empty() ? "" : type_hash(type, text);
  const std::string user_data = "typehash=" + hash + ";";
  if (!hash.empty()) dds_qset_userdata(made.get(), user_data.data(), user_data.size());
  return made;
}

TopicQos read_qos(const dds_qos_t* qos) {
  TopicQos read;
  read.depth = 0;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_duration_t blocking = 0;
  if (dds_qget_reliability(qos, &reliability, &blocking))
    read.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  if (dds_qget_durability(qos, &durability)) read.latched = durability != DDS_DURABILITY_VOLATILE;
  return read;
}

std::string policy_name(std::uint32_t policy) {
  switch (policy) {
    case DDS_DURABILITY_QOS_POLICY_ID:
      return "durability";
    case DDS_DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case DDS_LATENCYBUDGET_QOS_POLICY_ID:
      return "latency budget";
    case DDS_OWNERSHIP_QOS_POLICY_ID:
      return "ownership";
    case DDS_LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case DDS_RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case DDS_DESTINATIONORDER_QOS_POLICY_ID:
      return "destination order";
    case DDS_DATA_REPRESENTATION_QOS_POLICY_ID:
      return "data representation";
    default:
      return "policy " + std::to_string(policy);
  }
}

}  // namespace penumbra::io
