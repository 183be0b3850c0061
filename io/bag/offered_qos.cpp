// SPDX-License-Identifier: Apache-2.0
#include <io/bag/offered_qos.hpp>

namespace penumbra::io {
namespace {

constexpr OfferedQos unreadable{.latched = {}, .is_unreadable = true};

OfferedQos of_list(const YamlNode& profiles) {
  OfferedQos qos;
  for (const YamlNode& profile : profiles.items()) {
    const YamlNode* durability_node = profile.find("durability");
    if (durability_node == nullptr) continue;
    const std::string& durability = durability_node->text();
    if (durability == "1" || durability == "transient_local") qos.latched = true;
    if (durability == "2" || durability == "volatile") qos.latched = qos.latched.value_or(false);
  }
  return qos;
}

}  // namespace

OfferedQos read_offered_qos(const std::string& profiles) {
  if (profiles.empty()) return {};
  try {
    const YamlNode list = YamlNode::parse(profiles, "offered_qos_profiles");
    return list.is_null() ? OfferedQos{} : of_list(list);
  } catch (const InputError&) {
    return unreadable;
  }
}

OfferedQos read_offered_qos(const YamlNode& profiles) {
  if (profiles.is_null()) return {};
  try {
    return profiles.is_list() ? of_list(profiles) : read_offered_qos(profiles.text_or_empty());
  } catch (const InputError&) {
    return unreadable;
  }
}

void merge(const OfferedQos& other, OfferedQos& qos) {
  if (other.latched) qos.latched = *other.latched || qos.latched.value_or(false);
  qos.is_unreadable |= other.is_unreadable;
}

}  // namespace penumbra::io
