// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pose_lookup.hpp>

#include <io/bag/bag_reader.hpp>

namespace penumbra::io {

/// The data needed from a bag, and the topics that the user names.
struct TopicOptions {
  std::optional<std::string> depth, camera_info, color;
  std::vector<std::string> joints, targets;
  std::optional<PoseSource> poses;
  /// Reads colour images for pictures. If `color` is set, depth is judged in them.
  bool with_color = false;
  bool needs_description = true;  ///< the robot's description is read from the bag
  bool needs_transforms = true;   ///< the camera's pose is read from the bag
};

/// A topic that is read, its role, and why it was chosen.
struct TopicUse {
  std::string role;  ///< "depth"
  std::string name;
  std::string type;
  std::string why;
  std::optional<std::uint64_t> messages = {};  ///< if the bag has a count
};

/// The topics to read from a bag, by role.
struct BagTopics {
  PoseSource poses = PoseSource::joints;
  TopicUse depth, camera_info;
  std::optional<TopicUse> color;
  std::optional<TopicUse> color_info;  ///< if depth is registered to the color camera
  std::vector<TopicUse> joints, transforms, targets;
  std::optional<TopicUse> description;

  /// Returns all topics, in the order in which they are printed.
  [[nodiscard]] std::vector<TopicUse> all() const;
};

/// Several topics match and the user named none of them.
class AmbiguousTopics : public InputError {
  using InputError::InputError;
};

/// Chooses the topics of the camera only, like choose_topics.
[[nodiscard]] BagTopics choose_camera_topics(const std::string& source,
                                             std::span<const BagTopic> topics,
                                             const TopicOptions& options);

/// Returns the name of the camera_info topic next to an image topic.
[[nodiscard]] std::string camera_info_topic(const std::string& image_topic);

/// Chooses topics by name and type; topics without messages are ignored. Throws InputError that
/// names the bag, the candidates and the option to use if no topic or several topics match.
[[nodiscard]] BagTopics choose_topics(const std::string& bag, std::span<const BagTopic> topics,
                                      const TopicOptions& options);

}  // namespace penumbra::io
