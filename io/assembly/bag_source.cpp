// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>

#include <io/assembly/bag_scene.hpp>
#include <io/assembly/bag_source.hpp>

namespace penumbra::io {
namespace {

/// How long images wait for their pose, in seconds of recording. Enough for 10 joint states a
/// second with three lost, and 0.1 s of transport.
constexpr double longest_wait = 0.5;
constexpr std::size_t most_waiting = 32;

std::vector<CameraInputOptions> cameras_of(const BagSourceOptions& bag) {
  if (!bag.camera) return {};
  CameraInputOptions options;
  if (bag.topics.color && bag.with_color) options.color_topic = bag.topics.color->name;
  if (bag.topics.color_info) options.color_info_topic = bag.topics.color_info->name;
  options.mount.frame_prefix = bag.bag.frame_prefix;
  options.poses = bag.topics.poses;
  options.time_offset = bag.bag.time_offset;
  options.max_wait = longest_wait;
  options.max_frames = most_waiting;
  options.has_targets = !bag.topics.targets.empty();
  options.known = bag.camera;
  return {options};
}

std::vector<CloudInputOptions> clouds_of(const BagSourceOptions& bag) {
  if (!bag.cloud) return {};
  CloudInputOptions options = *bag.cloud;
  options.mount.frame_prefix = bag.bag.frame_prefix;
  options.poses = bag.topics.poses;
  options.time_offset = bag.bag.time_offset;
  options.max_frames = most_waiting;
  options.has_targets = !bag.topics.targets.empty();
  return {options};
}

}  // namespace

BagSource::BagSource(const std::filesystem::path& bag, const Robot& robot, BagSourceOptions options)
    : options_(std::move(options)),
      bag_(open_bag(bag)),
      name_(bag.string()),
      assembler_({.robot = {},
                  .given = robot,
                  .joint_names = options_.bag.joint_names,
                  .compare_sources = !options_.bag.first_publisher,
                  .static_transforms = options_.static_transforms},
                 cameras_of(options_), clouds_of(options_)) {
  if (options_.camera) depth_.emplace(options_.camera->cameras);
  check_range();
}

const TopicUse& BagSource::sensor() const {
  if (!options_.cloud) return options_.topics.depth;
  return *std::ranges::find(options_.topics.clouds, options_.cloud->topic, &TopicUse::name);
}

void BagSource::check_range() {
  const auto count = sensor().messages;
  if (!count) return;
  const auto most = static_cast<std::int64_t>(*count);
  const std::int64_t first = options_.first.value_or(0);
  const std::int64_t end = options_.end.value_or(most);
  if (first >= end || end > most)
    throw InputError(options_.range_option + " " + std::to_string(first) + ":" +
                     std::to_string(end) + ": the bag has the frames 0 to " +
                     std::to_string(most - 1) + ", all of them 0:" + std::to_string(most));
  size_ = static_cast<std::size_t>(end - first);
}

bool BagSource::is_in_range(std::int64_t image) const {
  return image >= options_.first.value_or(0) &&
         image < options_.end.value_or(std::numeric_limits<std::int64_t>::max());
}

bool BagSource::read(std::size_t /*number*/, Frame& frame) {
  AssembledFrame current;
  while (!assembler_.next(0, now_, options_.with_color, current)) {
    if (!ended_) {
      read_message();
      continue;
    }
    if (given_) return false;
    throw InputError(name_ + ": none of its " + std::to_string(images_) +
                     (options_.cloud ? " clouds" : " depth images") + " is in the range; change " +
                     options_.range_option);
  }
  given_ = true;
  if (depth_)
    if (const auto fault = depth_->read(current); !fault.empty())
      assembler_.add_fault(options_.topics.depth.name, current.arrived, fault);
  if (current.scan && time_note_.empty()) time_note_ = current.scan->received->points.time_note;
  frame = std::move(static_cast<Frame&>(current));
  *frame.index += static_cast<std::size_t>(options_.first.value_or(0));
  const bool has_depth = options_.topics.has_depth;
  const bool is_shown = options_.with_color && (options_.topics.color || !has_depth);
  const bool is_checked =
      !has_depth && !options_.cloud && *frame.index % SetupCheck::color_step == 0;
  if (is_shown || is_checked) {
    Image<Rgb8> color;
    frame.color_message = current.color_image ? decode_color(*current.color_image,
                                                             options_.camera->cameras.judged, color)
                                              : ColorImages::none_near;
    if (frame.color_message.empty())
      frame.color = SharedColor(std::make_shared<const Image<Rgb8>>(std::move(color)));
    if (!is_shown) frame.color_message.clear();  // nobody asked for a picture
  }
  assembler_.done(0, true);
  return true;
}

void BagSource::read_message() {
  const bool past_end = options_.end && images_ >= *options_.end;
  BagMessage message;
  if ((past_end && assembler_.sensor(0).counts().waiting == 0) || !bag_->next(message)) {
    ended_ = true;
    return assembler_.finish();
  }
  now_ = message.log_time;
  const auto& input = input_of(message.topic);
  if (!input) return;
  const TopicRole role = assembler_.topics()[*input].role;
  const bool is_sensor = role == TopicRole::depth || role == TopicRole::cloud;
  const bool is_skipped = is_sensor && !is_in_range(images_++);
  if (is_skipped && !is_read_as<CompressedVideoMessage>(assembler_.topics()[*input].type)) return;
  assembler_.receive(*input, {.data = message.data, .is_skipped = is_skipped}, now_);
}

const std::optional<std::size_t>& BagSource::input_of(std::size_t topic) {
  while (inputs_.size() <= topic) {
    const BagTopic& next = bag_->topics()[inputs_.size()];
    const auto role = options_.topics.role_of(next);
    const bool is_used = role && *role != TopicRole::description &&
                         (*role != TopicRole::color || options_.with_color) &&
                         (*role != TopicRole::cloud || next.name == sensor().name);
    auto& input = inputs_.emplace_back();
    if (!is_used) continue;
    try {
      input = assembler_.add_topic({.role = *role,
                                    .camera = 0,
                                    .robot = options_.topics.robot_of(next),
                                    .name = next.name,
                                    .type = next.type,
                                    .latched = false,
                                    .definition = next.definition});
    } catch (const InputError& error) {
      throw InputError(name_ + ": " + error.what());
    }
  }
  return inputs_[topic];
}

std::vector<std::string> BagSource::notes() const {
  std::vector<std::string> lines = bag_notes(name_, *bag_, assembler_.faults());
  for (const std::string& line : assembler_.notes()) lines.push_back(name_ + ": " + line);
  if (!time_note_.empty()) lines.push_back(sensor().name + ": " + time_note_);
  const TargetInbox& targets = assembler_.sensor(0).setup()->targets;
  if (targets.waiting() > 0)
    lines.push_back(name_ + ": " + std::to_string(targets.waiting()) +
                    " targets came after the last frame and are not judged");
  if (targets.replaced() > 0)
    lines.push_back(
        name_ + ": " + std::to_string(targets.replaced()) +
        " targets are not judged: newer ones with their names came before the next frame");
  if (targets.discarded() > 0)
    lines.push_back(name_ + ": " + std::to_string(targets.discarded()) +
                    " targets are not judged: no frame came for more than 1 s, or for " +
                    std::to_string(TargetInbox::most_waiting) + " of them");
  return lines;
}

}  // namespace penumbra::io
