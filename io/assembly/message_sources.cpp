// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <io/assembly/message_sources.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

/// Returns fields as one key. Names have no zero byte.
template <typename... Fields>
std::string key_of(const Fields&... fields) {
  std::string key;
  ((key.append(fields), key.push_back('\0')), ...);
  return key;
}

std::string describe(const JointStateMessage& state) {
  std::string text = std::to_string(state.names.size()) + " joints";
  if (state.names.size() == 1) text = "joint '" + printable(state.names[0]) + "'";
  if (state.names.size() > 1) text += " from '" + printable(state.names[0]) + "'";
  if (!state.velocities.empty()) text += ", velocities";
  if (!state.efforts.empty()) text += ", efforts";
  if (!state.header.frame_id.empty()) text += ", frame '" + printable(state.header.frame_id) + "'";
  return text;
}

}  // namespace

const std::string& MessageSources::of_joints(const std::string& topic, std::uint64_t publisher,
                                             const JointStateMessage& state) {
  std::string key = key_of(topic, std::to_string(publisher), state.header.frame_id,
                           state.velocities.empty() ? "" : "v", state.efforts.empty() ? "" : "e");
  for (const std::string& name : state.names) key += key_of(name);
  if (const auto found = names_.find(key); found != names_.end()) return found->second;
  return keep(key, name_of(topic, publisher) + " (" + describe(state) + ")");
}

const std::string& MessageSources::of_transforms(const std::string& topic,
                                                 std::uint64_t publisher) {
  const std::string key = key_of(topic, std::to_string(publisher));
  if (const auto found = names_.find(key); found != names_.end()) return found->second;
  return keep(key, name_of(topic, publisher));
}

std::string MessageSources::name_of(const std::string& topic, std::uint64_t publisher) {
  if (publisher == 0) return printable(topic);
  const auto [place, is_new] = publishers_.try_emplace({topic, publisher}, 0);
  if (is_new) place->second = ++counts_[topic];
  return "publisher " + std::to_string(place->second) + " of " + printable(topic);
}

const std::string& MessageSources::keep(const std::string& key, std::string name) {
  if (names_.size() >= most) {  // remaining publishers get new names and become new sources
    names_.clear();
    publishers_.clear();
  }
  const std::string base = name;
  for (int i = 2; !used_.insert(name).second; ++i) name = base + " #" + std::to_string(i);
  if (used_.size() >= 2 * most) used_.clear();
  return names_.emplace(key, std::move(name)).first->second;
}

}  // namespace penumbra::io
