// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <penumbra/base/error.hpp>

#include <io/dds/graph_names.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr std::string_view topic_prefix = "rt";
constexpr std::string_view type_middle = "dds_";

// Names also come from other programs and have any length. So no regular expressions are used:
// their matching is recursive.
bool is_graph_word(std::string_view word) {
  if (word.empty() || (word[0] >= '0' && word[0] <= '9')) return false;
  for (const char c : word)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'))
      return false;
  return true;
}

bool is_topic(std::string_view name) {
  if (name.empty() || name[0] != '/') return false;
  while (!name.empty()) {
    name.remove_prefix(1);
    const std::size_t end = std::min(name.find('/'), name.size());
    if (!is_graph_word(name.substr(0, end))) return false;
    name.remove_prefix(end);
  }
  return true;
}

/// Returns the N words between separators, or nothing if there are not N valid words.
template <std::size_t N>
std::optional<std::array<std::string_view, N>> words_of(std::string_view text,
                                                        std::string_view separator) {
  std::array<std::string_view, N> words;
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = i + 1 < N ? text.find(separator) : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    words[i] = text.substr(0, end);
    if (!is_graph_word(words[i])) return std::nullopt;
    if (i + 1 < N) text.remove_prefix(end + separator.size());
  }
  return words;
}

bool is_kind(std::string_view word) { return word == "msg" || word == "srv" || word == "action"; }

}  // namespace

std::string dds_topic(std::string_view topic) {
  if (!is_topic(topic))
    throw InputError("topic '" + printable(topic) +
                     "': is not a full ROS 2 topic name such as /camera/depth/image_raw: letters, "
                     "digits and _, no digit after a /");
  return std::string(topic_prefix) + std::string(topic);
}

std::string dds_type(std::string_view type) {
  const auto words = words_of<3>(type, "/");
  if (!words || !is_kind((*words)[1]))
    throw InputError("type '" + printable(type) +
                     "': is not a ROS 2 message type such as sensor_msgs/msg/Image");
  const auto& [package, kind, name] = *words;
  return std::string(package) + "::" + std::string(kind) + "::" + std::string(type_middle) +
         "::" + std::string(name) + "_";
}

std::optional<std::string> ros_topic(std::string_view dds_name) {
  if (!dds_name.starts_with(topic_prefix)) return std::nullopt;
  const std::string_view name = dds_name.substr(topic_prefix.size());
  if (!is_topic(name)) return std::nullopt;
  return std::string(name);
}

std::optional<std::string> ros_type(std::string_view dds_name) {
  const auto words = words_of<4>(dds_name, "::");
  if (!words) return std::nullopt;
  auto [package, kind, middle, name] = *words;
  if (!is_kind(kind) || middle != type_middle || name.back() != '_') return std::nullopt;
  name.remove_suffix(1);
  return std::string(package) + "/" + std::string(kind) + "/" + std::string(name);
}

}  // namespace penumbra::io
