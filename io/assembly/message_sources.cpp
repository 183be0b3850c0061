// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <io/assembly/message_sources.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

/// A 64-bit FNV-1a hash.
class Key {
 public:
  void add(std::string_view text) {
    for (const char c : text) mix(static_cast<unsigned char>(c));
    mix(0);
  }
  void add(std::uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8) mix(number >> shift & 0xFFU);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void mix(std::uint64_t byte) { value_ = (value_ ^ byte) * 0x100000001B3U; }

  std::uint64_t value_ = 0xCBF29CE484222325U;
};

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
  Key key;
  key.add(topic);
  key.add(publisher);
  key.add(state.header.frame_id);
  for (const std::string& name : state.names) key.add(name);
  key.add((state.velocities.empty() ? 0U : 1U) + (state.efforts.empty() ? 0U : 2U));
  if (const auto found = names_.find(key.value()); found != names_.end()) return found->second;
  return keep(key.value(), name_of(topic, publisher) + " (" + describe(state) + ")");
}

const std::string& MessageSources::of_transforms(const std::string& topic,
                                                 std::uint64_t publisher) {
  Key key;
  key.add(topic);
  key.add(publisher);
  if (const auto found = names_.find(key.value()); found != names_.end()) return found->second;
  return keep(key.value(), name_of(topic, publisher));
}

std::string MessageSources::name_of(const std::string& topic, std::uint64_t publisher) {
  if (publisher == 0) return printable(topic);
  const auto [place, is_new] = publishers_.try_emplace({topic, publisher}, 0);
  if (is_new) place->second = ++counts_[topic];
  return "publisher " + std::to_string(place->second) + " of " + printable(topic);
}

const std::string& MessageSources::keep(std::uint64_t key, std::string name) {
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
