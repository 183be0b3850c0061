// SPDX-License-Identifier: Apache-2.0
// What a camera and a robot say on ROS 2's graph, and what comes back: to measure penumbra live.
//   live_camera BAG DOMAIN SECONDS [overlay]
// Publishes a bag's first depth and color image 30 times a second, stamped anew, and joint states
// 100 times a second that sway around the bag's first; subscribes to labels, mask, filtered_depth
// and targets (and overlays), and prints how many came and how long after their stamps.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iostream>
#include <map>
#include <string>
#include <thread>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_reader.hpp>
#include <io/dds/participant.hpp>
#include <io/live/latency_histogram.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/message_encoder.hpp>

namespace {

using namespace penumbra;
using namespace std::chrono_literals;
using Bytes = std::vector<std::byte>;
using Clock = std::chrono::system_clock;

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

/// The first message of each topic.
class FirstMessages {
 public:
  explicit FirstMessages(const std::string& path) {
    const auto bag = io::open_bag(path);
    topics_.assign(bag->topics().begin(), bag->topics().end());
    io::BagMessage message;
    while (payloads_.size() < topics_.size() && bag->next(message))
      payloads_.try_emplace(message.topic, message.data.begin(), message.data.end());
  }
  template <typename M>
  M of(const std::string& ending) const {
    for (const auto& [topic, payload] : payloads_) {
      if (topics_[topic].type != io::message_type<M>() || !topics_[topic].name.ends_with(ending))
        continue;
      M message;
      const io::Decoder<M> decoder(topics_[topic].type, topics_[topic].definition);
      if (const auto fault = decoder.decode(payload, message)) throw InputError(*fault);
      return message;
    }
    throw InputError("the bag has no " + io::message_type<M>() + " of " + ending);
  }

 private:
  std::vector<io::BagTopic> topics_;
  std::map<std::size_t, Bytes> payloads_;
};

class Publisher {
 public:
  template <typename M>
  Publisher(io::Participant& graph, const std::string& topic, const M&, bool latched = false)
      : publication_(graph.advertise(topic, io::message_type<M>(),
                                     {.reliable = true, .latched = latched, .depth = 5})) {}
  template <typename M>
  void tell(const M& message) {
    io::encode(message, payload_);
    if (!publication_->write(payload_)) ++refused;
  }
  std::size_t refused = 0;

 private:
  std::unique_ptr<io::Publication> publication_;
  Bytes payload_;
};

/// What came back of one topic.
struct Returned {
  std::string topic;
  std::unique_ptr<io::Subscription> subscription;
  io::LatencyHistogram latency;
};

/// All results begin with a header: the stamp stands behind the encapsulation.
std::int64_t stamp_of(std::span<const std::byte> payload) {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  std::memcpy(&seconds, payload.data() + 4, 4);
  std::memcpy(&nanoseconds, payload.data() + 8, 4);
  return seconds * 1'000'000'000LL + nanoseconds;
}

void listen(io::Participant& graph, std::vector<Returned>& results, const std::atomic<bool>& ends) {
  while (!ends) {
    graph.wait(100ms);
    const std::int64_t arrival = now();
    for (Returned& result : results)
      for (io::Sample sample; result.subscription->take(sample);)
        result.latency.add(1e-6 * static_cast<double>(arrival - stamp_of(sample.data)));
  }
}

std::vector<Returned> subscribe_to_results(io::Participant& graph, bool with_overlay) {
  std::vector<Returned> results;
  for (const char* name : {"labels", "mask", "filtered_depth"})
    results.push_back(
        {name,
         graph.subscribe(std::string("/penumbra/") + name, "sensor_msgs/msg/Image", {.depth = 5}),
         {}});
  results.push_back(
      {"targets",
       graph.subscribe("/penumbra/targets", "penumbra_msgs/msg/Targets", {.depth = 5}),
       {}});
  if (with_overlay)
    results.push_back({"overlay",
                       graph.subscribe("/penumbra/overlay/compressed",
                                       "sensor_msgs/msg/CompressedImage", {.depth = 5}),
                       {}});
  return results;
}

void tell(const std::vector<Returned>& results) {
  for (const Returned& result : results)
    std::cout << result.topic << ": " << result.latency.count() << " came, "
              << result.subscription->status().lost << " lost, median "
              << result.latency.quantile(0.5).value_or(0) << " ms, p99 "
              << result.latency.quantile(0.99).value_or(0) << " ms after their stamps\n";
}

int run(const std::string& bag, int domain, double seconds, bool with_overlay) {
  const FirstMessages first(bag);
  auto depth = first.of<io::ImageMessage>("/image_raw");
  auto info = first.of<io::CameraInfoMessage>("/camera_info");
  auto joints = first.of<io::JointStateMessage>("/joint_states");
  const auto color_file = first.of<io::CompressedImageMessage>("/compressed");
  Image<io::Rgb8> color;
  if (const auto fault = io::decode_colour(color_file, color)) throw InputError(*fault);

  const auto graph = io::join_graph({.domain = domain});
  const auto back = io::join_graph({.domain = domain});
  Publisher description(*graph, "/robot_description", io::StringMessage{}, true);
  Publisher mount(*graph, "/tf_static", io::TfMessage{}, true);
  Publisher depths(*graph, "/camera/depth/image_raw", depth);
  Publisher infos(*graph, "/camera/depth/camera_info", info);
  Publisher colors(*graph, "/camera/color/image_raw", depth);
  Publisher color_infos(*graph, "/camera/color/camera_info", info);
  Publisher states(*graph, "/joint_states", joints);
  std::vector<Returned> results = subscribe_to_results(*back, with_overlay);
  description.tell(first.of<io::StringMessage>("/robot_description"));
  mount.tell(first.of<io::TfMessage>("/tf_static"));

  std::atomic<bool> ends = false;
  std::thread listening([&] { listen(*back, results, ends); });
  const std::vector<double> rest = joints.positions;
  std::size_t images = 0;
  auto next = Clock::now();
  const auto end =
      next + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  for (std::size_t tick = 0; next < end; ++tick, next += 10ms) {
    std::this_thread::sleep_until(next);
    joints.header.stamp = now();
    for (std::size_t j = 0; j < rest.size(); ++j)
      joints.positions[j] = rest[j] + 0.2 * std::sin(0.01 * static_cast<double>(tick + 50 * j));
    states.tell(joints);
    if (tick * 3 / 10 == images) continue;  // 30 of 100
    images = tick * 3 / 10;
    info.header.stamp = depth.header.stamp = joints.header.stamp;
    depths.tell(depth);
    infos.tell(info);
    color_infos.tell(info);
    io::ImageMessage picture = io::image_message(depth.header, "rgb8", std::as_const(color).view());
    colors.tell(picture);
  }
  std::this_thread::sleep_for(500ms);
  ends = true;
  listening.join();
  std::cout << images << " depth images of " << depth.width << " x " << depth.height
            << " published, " << depths.refused << " refused\n";
  tell(results);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    std::cerr << "live_camera BAG DOMAIN SECONDS [overlay]\n";
    return 2;
  }
  try {
    return run(argv[1], std::stoi(argv[2]), std::stod(argv[3]), argc == 5);
  } catch (const std::exception& error) {
    std::cerr << "live_camera: " << error.what() << '\n';
    return 2;
  }
}
