// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <set>
#include <type_traits>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/bag_source.hpp>
#include <io/assembly/judged_cameras.hpp>
#include <io/assembly/pose_messages.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

/// How long images wait for their pose, in seconds of recording. Enough for 10 joint states a
/// second with three lost, and 0.1 s of transport.
constexpr double longest_wait = 0.5;
/// How long images wait for the camera_info and colour image with their stamp. Drivers send them
/// together, but some send one camera_info for all images. Nanoseconds of recording.
constexpr std::int64_t longest_companion_wait = 200'000'000;
constexpr std::size_t most_colors = 64;
constexpr std::size_t most_ready = 32;  // frames that wait for their camera_info and colour image

FrameQueueOptions queue_options(const BagSourceOptions& options) {
  return {.policy = DropPolicy::every,
          .time_offset = options.time_offset,
          .max_wait = longest_wait,
          .poses = options.poses};
}

std::string why_dropped(DropReason reason) {
  switch (reason) {
    case DropReason::no_stamp:
      return "the depth image's stamp is 0: it is not known when it was taken";
    case DropReason::clock_jump:
      return "the clock jumped back while the depth image waited for its pose";
    default:
      return "too many depth images waited for their poses";
  }
}

void join(std::string& message, const std::string& more) {
  if (!more.empty()) message += (message.empty() ? "" : "; ") + more;
}

}  // namespace

BagSource::BagSource(const std::filesystem::path& bag, const Robot& robot, BagSourceOptions options)
    : options_(std::move(options)),
      inbox_(bag),
      history_(robot, history_options(options_.compare_sources)),
      queue_(robot, history_, queue_options(options_),
             [this](const DroppedFrame& frame) { dropped_.push_back(frame); }),
      depth_(options_.camera, options_.depth_camera),
      colors_(most_colors),
      targets_(robot, options_.camera.frame_id, options_.poses.frame_prefix) {
  check_range();
  // Fixed frames also hold before their message. If a frame is published several times, its first
  // value holds until the second message.
  std::set<std::string> known;
  for (const TransformMessage& t : options_.scene.static_transforms)
    if (known.insert(t.child_frame_id).second)
      history_.add_static_transform(t.header.frame_id, t.child_frame_id, t.T_parent_child);
}

void BagSource::check_range() {
  const auto count = options_.topics.depth.messages;
  if (!count) return;
  const auto most = static_cast<std::int64_t>(*count);
  const std::int64_t first = options_.first.value_or(0);
  const std::int64_t end = options_.end.value_or(most);
  if (first >= end || end > most)
    throw InputError("--frames " + std::to_string(first) + ":" + std::to_string(end) +
                     ": the bag has the frames 0 to " + std::to_string(most - 1) +
                     ", all of them 0:" + std::to_string(most));
  size_ = static_cast<std::size_t>(end - first);
}

bool BagSource::next(FrameData& data, Frame& frame) {
  while (ready_.empty() || !is_presentable()) {
    if (ended_ && ready_.empty()) {
      if (given_ > 0) return false;
      throw InputError(inbox_.name() + ": none of its " + std::to_string(images_) +
                       " depth images is in the range; change --frames");
    }
    read_message();
  }
  current_ = std::move(ready_.front());
  ready_.pop_front();
  ++given_;
  present(data, frame);
  return true;
}

void BagSource::read_message() {
  const bool past_end = options_.end && static_cast<std::int64_t>(images_) >= *options_.end;
  BagMessage message;
  if ((past_end && waiting_.empty()) || !inbox_.next(message)) {
    ended_ = true;
    queue_.finish();
  } else {
    now_ = message.log_time;
    take(message);
  }
  collect();
}

void BagSource::take(const BagMessage& message) {
  const BagTopic& topic = inbox_.topic_of(message);
  const auto is = [&](const TopicUse& use) {
    return topic.name == use.name && topic.type == use.type;
  };
  const BagTopics& topics = options_.topics;
  const bool is_plain = topic.type == message_type<ImageMessage>();
  if (is(topics.depth))
    return is_plain ? take_depth<ImageMessage>(message)
                    : take_depth<CompressedImageMessage>(message);
  if (is(topics.camera_info))
    return take_info(message, *options_.scene.camera_info, camera_changes_);
  if (topics.color_info && is(*topics.color_info))
    return take_info(message, *options_.scene.color_info, color_changes_);
  if (topics.color && options_.with_color && is(*topics.color))
    return is_plain ? take_color<ImageMessage>(message)
                    : take_color<CompressedImageMessage>(message);
  for (const TopicUse& use : topics.joints)
    if (is(use)) return take_joints(message);
  for (const TopicUse& use : topics.targets)
    if (is(use)) return take_targets(message);
  for (const TopicUse& use : topics.transforms)
    if (is(use)) return take_transforms(message, use.name.ends_with("static"));
}

template <typename M>
void BagSource::take_depth(const BagMessage& message) {
  const std::uint64_t index = images_++;
  const auto number = static_cast<std::int64_t>(index);
  if (number < options_.first.value_or(0) ||
      number >= options_.end.value_or(std::numeric_limits<std::int64_t>::max()))
    return;
  M image;
  Waiting waiting;
  std::string fault;
  if (!inbox_.decode(message, image, &fault)) {
    waiting.fault = fault;
    return give_unposed(index, std::move(waiting), "the depth image's message cannot be read");
  }
  waiting.payload.assign(message.data.begin(), message.data.end());
  waiting.message = message;
  waiting.message.data = waiting.payload;
  waiting.stamp = image.header.stamp;
  pairs_.add_image(waiting.stamp);
  camera_changes_.add_image(waiting.stamp);
  color_changes_.add_image(waiting.stamp);
  if (frame_name(image.header.frame_id) != frame_name(*options_.scene.depth_frame))
    waiting.fault = "the depth image is of the frame '" + printable(image.header.frame_id) +
                    "', the first one of '" + printable(*options_.scene.depth_frame) + "'";
  waiting_.emplace(index, std::move(waiting));
  queue_.push(index, image.header.stamp, now_);
}

void BagSource::take_info(const BagMessage& message, const CameraInfoMessage& first,
                          CameraChanges& changes) {
  CameraInfoMessage info;
  if (!inbox_.decode(message, info)) return;
  if (&changes == &camera_changes_) pairs_.add_info(info.header.stamp);
  const bool differs = !is_same_camera(info, first);
  if (differs && !changes.differs())
    inbox_.add_fault(inbox_.topic_of(message).name, message.log_time,
                     "is of another camera than the first one");
  changes.add_info(info.header.stamp, differs);
}

void BagSource::take_joints(const BagMessage& message) {
  JointStateMessage state;
  if (!inbox_.decode(message, state)) return;
  add_to_history(state, sources_.of_joints(inbox_.topic_of(message).name, 0, state), history_);
}

void BagSource::take_transforms(const BagMessage& message, bool is_static) {
  TfMessage found;
  if (!inbox_.decode(message, found)) return;
  const std::string& source = sources_.of_transforms(inbox_.topic_of(message).name, 0);
  add_to_history(found, is_static, source, history_);
}

void BagSource::take_targets(const BagMessage& message) {
  const std::string& type = inbox_.topic_of(message).type;
  if (type == message_type<Detection2DArrayMessage>())
    take_targets_as<Detection2DArrayMessage>(message);
  else if (type == message_type<Detection3DArrayMessage>())
    take_targets_as<Detection3DArrayMessage>(message);
  else if (type == message_type<KeypointsMessage>())
    take_targets_as<KeypointsMessage>(message);
  else
    take_targets_as<PoseStampedMessage>(message);
}

template <typename M>
void BagSource::take_targets_as(const BagMessage& message) {
  if (M found; inbox_.decode(message, found)) targets_.add(inbox_.topic_of(message).name, found);
}

template <typename M>
void BagSource::take_color(const BagMessage& message) {
  if (M image; inbox_.decode(message, image)) colors_.add(keep_image(image));
}

void BagSource::collect() {
  const auto take_waiting = [this](std::uint64_t index) {
    return std::move(waiting_.extract(index).mapped());
  };
  for (Ready ready; queue_.next(now_, ready.pose); ready = {}) {
    ready.index = ready.pose.key;
    ready.image = take_waiting(ready.index);
    ready_.push_back(std::move(ready));
  }
  for (const DroppedFrame& frame : std::exchange(dropped_, {}))
    give_unposed(frame.key, take_waiting(frame.key), why_dropped(frame.reason));
}

void BagSource::give_unposed(std::uint64_t index, Waiting image, const std::string& why) {
  Ready ready;
  ready.index = index;
  ready.pose.stamp = image.stamp;
  ready.pose.pose.status = options_.poses.source == PoseSource::transforms
                               ? FrameStatus::missing_transform
                               : FrameStatus::missing_joints;
  ready.pose.pose.message = why;
  ready.image = std::move(image);
  ready_.push_back(std::move(ready));
}

bool BagSource::is_presentable() const {
  const Waiting& image = ready_.front().image;
  if (ended_ || image.payload.empty() || ready_.size() >= most_ready ||
      now_ > image.message.log_time + longest_companion_wait)
    return true;
  const bool has_color =
      !options_.with_color || !options_.topics.color || colors_.reaches(image.stamp);
  const bool has_color_info = !options_.topics.color_info || color_changes_.reaches(image.stamp);
  const bool has_info =
      pairs_.are_certain() ? pairs_.covers(image.stamp) : camera_changes_.reaches(image.stamp);
  return has_info && has_color && has_color_info;
}

void BagSource::present(FrameData& data, Frame& frame) {
  const QueuedFrame& pose = current_.pose;
  frame = pose.frame();
  frame.index = static_cast<std::size_t>(current_.index);
  frame.targets = targets_.take();
  if (pose.stamp <= 0) frame.stamp.reset();
  data.index = static_cast<std::int64_t>(current_.index);
  data.stamp = frame.stamp;
  data.message = pose.pose.message;

  DepthView depth;
  std::string fault = decode(current_.image, depth);
  if (fault.empty() && depth_.is_of_other_camera() && has_pose(frame.source_status)) {
    history_.transforms().at(pose.pose_stamp, options_.camera.frame_id, *options_.scene.depth_frame,
                             T_color_depth_);
    fault = depth_.bring(T_color_depth_, depth);
  }
  if (fault.empty()) {
    frame.depth = depth;
  } else {
    join(data.message, fault);
    if (frame.source_status == FrameStatus::ok) frame.source_status = FrameStatus::bad_depth;
  }
  frame.source_message = data.message;
  data.status = frame.source_status;
  if (!options_.with_color) return;
  show_color(pose.stamp, data);
  std::visit(
      [&](const auto& view) {
        using T = std::remove_const_t<std::remove_pointer_t<decltype(view.data)>>;
        Image<T> copy(view.empty() ? 0 : view.width, view.empty() ? 0 : view.height);
        for (int v = 0; v < copy.height(); ++v)
          std::copy_n(view.row(v), copy.width(), copy.view().row(v));
        data.depth = std::move(copy);
      },
      frame.depth);
}

std::string BagSource::decode(const Waiting& image, DepthView& depth) {
  if (!image.fault.empty()) return image.fault;
  if (pairs_.are_certain() && image.stamp > 0 && !pairs_.covers(image.stamp))
    return "its camera_info is missing, although other images have one: it may be another camera's";
  if (camera_changes_.differs(image.stamp) || color_changes_.differs(image.stamp))
    return "camera_info is of another camera than the first one";
  const auto decode_as = [&](auto message) -> std::string {
    if (std::string fault; !inbox_.decode(image.message, message, &fault)) return fault;
    return depth_.decode(message, depth);
  };
  std::string fault = inbox_.topic_of(image.message).type == message_type<ImageMessage>()
                          ? decode_as(ImageMessage())
                          : decode_as(CompressedImageMessage());
  if (fault.empty()) return depth_.check_size(depth);
  inbox_.add_fault(options_.topics.depth.name, image.message.log_time, fault);
  return fault;
}

void BagSource::show_color(std::int64_t stamp, FrameData& data) {
  data.color_message.clear();
  if (!options_.topics.color) {
    data.color = {};
    return;
  }
  const KeptImage* const color = colors_.find(stamp);
  data.color_message =
      color == nullptr ? ColorImages::none_near : decode_color(*color, options_.camera, data.color);
  if (!data.color_message.empty()) data.color = {};
  colors_.forget_before(stamp);
}

std::vector<std::string> BagSource::notes() const {
  std::vector<std::string> lines = inbox_.notes();
  const std::string& bag = inbox_.name();
  for (const std::string& refusal : refusals_of(history_))
    lines.push_back(std::string(bag).append(": ").append(refusal));
  if (targets_.waiting() > 0)
    lines.push_back(bag + ": " + std::to_string(targets_.waiting()) +
                    " targets came after the last frame and are not judged");
  if (targets_.replaced() > 0)
    lines.push_back(
        bag + ": " + std::to_string(targets_.replaced()) +
        " targets are not judged: newer ones with their names came before the next frame");
  if (targets_.discarded() > 0)
    lines.push_back(bag + ": " + std::to_string(targets_.discarded()) +
                    " targets are not judged: no frame came for more than 1 s, or for " +
                    std::to_string(TargetInbox::most_waiting) + " of them");
  return lines;
}

}  // namespace penumbra::io
