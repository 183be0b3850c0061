// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/assembly/frame_tree.hpp>

namespace penumbra::io {

std::string_view frame_name(std::string_view name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

bool FrameTree::add(std::string_view parent, std::string_view child) {
  if (parents_.size() >= max_frames) return false;
  return parents_.emplace(frame_name(child), frame_name(parent)).second;
}

bool FrameTree::knows(std::string_view frame) const {
  return has_parent(frame) ||
         std::ranges::any_of(parents_, [&](const auto& edge) { return edge.second == frame; });
}

std::vector<std::string> FrameTree::chain(std::string_view frame) const {
  std::vector<std::string> frames = {std::string(frame_name(frame))};
  for (auto up = parents_.find(frames.back());
       up != parents_.end() && frames.size() <= parents_.size(); up = parents_.find(frames.back()))
    frames.push_back(up->second);
  return frames;
}

bool FrameTree::connects(std::string_view a, std::string_view b) const {
  return chain(a).back() == chain(b).back();
}

}  // namespace penumbra::io
