// SPDX-License-Identifier: Apache-2.0
#include "soak_publishers.hpp"

#include "../support/pixels.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

namespace penumbra::test {
namespace {

constexpr const char* image_type = "sensor_msgs::msg::dds_::Image_";
constexpr const char* info_type = "sensor_msgs::msg::dds_::CameraInfo_";
constexpr const char* latched = "reliable,latched,depth=1";

/// Shades with a sensor's noise: an even image would be compressed in no time.
std::vector<std::byte> color_image() {
  Image<Rgb8> picture(large_lens.width, large_lens.height);
  std::minstd_rand noise(1);
  const auto shade = [&](int at, int end) {
    return static_cast<std::uint8_t>(200 * at / end + static_cast<int>(noise() % 8));
  };
  for (const auto [u, v] : each_pixel(picture))
    picture(u, v) = {shade(u, large_lens.width), shade(v, large_lens.height),
                     shade(u + v, 4 * large_lens.width)};
  return encoded(
      io::image_message(io::MessageHeader{1, "optical"}, "rgb8", std::as_const(picture).view()));
}

/// The number behind a word of a line.
std::optional<std::int64_t> number_behind(const std::optional<std::string>& line,
                                          const std::string& word) {
  if (!line || !line->starts_with(word)) return std::nullopt;
  return std::stoll(line->substr(word.size()));
}

}  // namespace

std::unique_ptr<PeerProcess> make_peer(int domain, const std::vector<std::string>& words) {
  std::vector<std::string> all = {std::to_string(domain)};
  all.insert(all.end(), words.begin(), words.end());
  auto process = std::make_unique<PeerProcess>(all);
  const bool publishes = words[0] == "publish" || words[0] == "repeat";
  if (publishes && !process->says("ready")) throw std::runtime_error("a peer is not ready");
  return process;
}

JointFeed::JointFeed(const JointFaults& faults) : faults_(faults), thread_([this] { feed(); }) {}

JointFeed::~JointFeed() {
  ends_ = true;
  thread_.join();
}

void JointFeed::begin(std::unique_ptr<PeerProcess> process) {
  const std::lock_guard lock(mutex_);
  process_ = std::move(process);
}

void JointFeed::kill() {
  const std::lock_guard lock(mutex_);
  process_.reset();
}

void JointFeed::feed() {
  constexpr int hertz = 100;
  std::mt19937_64 random(faults_.seed);
  std::multimap<std::int64_t, std::int64_t> waiting;  // stamps, by when they are told
  std::uniform_int_distribution<std::int64_t> delay(0, faults_.longest_delay);
  std::bernoulli_distribution is_lost(faults_.lost);
  for (std::int64_t tick = system_now(); !ends_;) {
    tick = next_tick(std::max(tick, system_now()), hertz);
    std::this_thread::sleep_for(std::chrono::nanoseconds(tick - system_now()));
    if (!is_lost(random)) waiting.emplace(tick + delay(random) * milliseconds, tick);
    const auto end = waiting.upper_bound(tick);
    const std::lock_guard lock(mutex_);
    for (auto due = waiting.begin(); process_ && due != end; ++due)
      process_->give(live_joints(due->second));
    waiting.erase(waiting.begin(), end);
  }
}

std::string topic_of(Part part) {
  static const std::array<std::string, all_parts.size()> topics = {
      "/camera/depth/image_rect_raw", "/camera/depth/camera_info", "/camera/color/image_raw",
      "/camera/color/camera_info", "/joint_states"};
  return topics.at(static_cast<std::size_t>(part));
}

SoakPublishers::SoakPublishers(int domain, const JointFaults& faults)
    : domain_(domain), joints_(faults) {
  description_ = make_peer(
      domain, {"publish", "rt/robot_description", "std_msgs::msg::dds_::String_", latched});
  description_->give(encoded(io::StringMessage{live_urdf}));
  mount_ =
      make_peer(domain, {"publish", "rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", latched});
  mount_->give(encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
}

void SoakPublishers::start(Part part) {
  if (part == Part::joints)
    return joints_.begin(
        make_peer(domain_, {"publish", "rt" + topic_of(part), "sensor_msgs::msg::dds_::JointState_",
                            "reliable,depth=10"}));
  const bool is_image = part == Part::depth || part == Part::color;
  auto made = make_peer(domain_, {"repeat", "rt" + topic_of(part),
                                  is_image ? image_type : info_type, "reliable,depth=5", "30"});
  made->give(part == Part::depth   ? live_depth(1, "optical", large_lens)
             : part == Part::color ? color_image()
                                   : encoded(live_info(1, large_lens)));
  camera_[static_cast<std::size_t>(part)] = std::move(made);
}

void SoakPublishers::kill(Part part) {
  if (part == Part::joints) return joints_.kill();
  camera_[static_cast<std::size_t>(part)].reset();
}

PeerProcess* SoakPublishers::process(Part part) {
  return part == Part::joints ? joints_.process() : camera_[static_cast<std::size_t>(part)].get();
}

std::optional<std::int64_t> SoakPublishers::heard(Part part) {
  return number_behind(process(part)->line(), "heard ");
}

std::size_t SoakPublishers::end(Part part) {
  PeerProcess& peer = *process(part);
  peer.end();
  for (auto line = peer.line(); line; line = peer.line())
    if (const auto written = number_behind(line, "written "))
      return static_cast<std::size_t>(*written);
  return 0;
}

}  // namespace penumbra::test
