// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pose_lookup.hpp>

#include <io/assembly/bag_options.hpp>
#include <io/bag/bag_reader.hpp>

namespace penumbra::io {

/// A topic that is taken.
struct TopicUse {
  std::string role;  ///< "depth"
  std::string name;
  std::string type;
  std::string why;
  std::optional<std::uint64_t> messages = {};  ///< where the bag tells
};

/// Which topics of a bag say what.
struct BagTopics {
  PoseSource poses = PoseSource::joints;
  TopicUse depth, camera_info;
  std::optional<TopicUse> color;
  std::optional<TopicUse> color_info;  ///< if depth images are brought to the color camera
  std::vector<TopicUse> joints, transforms, targets;
  std::optional<TopicUse> description;

  /// All of them, in the order in which they are told.
  [[nodiscard]] std::vector<TopicUse> all() const;
};

/// Several topics may be what is looked for, and none is named.
class AmbiguousTopics : public InputError {
  using InputError::InputError;
};

/// Returns the topics of the camera alone, as choose_topics does.
[[nodiscard]] BagTopics choose_camera_topics(const std::string& source,
                                             std::span<const BagTopic> topics,
                                             const BagOptions& options, bool with_color);

/// The camera_info that is looked for beside an image topic.
[[nodiscard]] std::string info_topic_beside(const std::string& image_topic);

/// Chooses by names and types; ignores topics without messages. `with_color`: pictures are drawn.
/// Throws InputError that names the bag, the candidates and the option that chooses, where there is
/// none or more than one.
[[nodiscard]] BagTopics choose_topics(const std::string& bag, std::span<const BagTopic> topics,
                                      const BagOptions& options, bool with_color);

}  // namespace penumbra::io
