// SPDX-License-Identifier: Apache-2.0
// A publisher or subscriber of ROS 2's graph on another vendor's DDS, for tests: messages are bytes
// in CDR, of any type.
//   fast_dds_peer DOMAIN publish TOPIC TYPE QOS SIZE COUNT HZ
//     says "ready", "matched" (if not latched), begins with a line on stdin, says "written N":
//     messages of pattern.hpp
//   fast_dds_peer DOMAIN publish TOPIC TYPE QOS
//     messages from stdin, each behind its size in 4 bytes
//   fast_dds_peer DOMAIN repeat TOPIC TYPE QOS HZ
//     one message with a header from stdin, likewise, again and again with each tick of the clock
//     as its stamp
//   fast_dds_peer DOMAIN watch TOPIC TYPE QOS
//     "NUMBER STAMP DIGEST" for each message with a header: its writer's sequence number, from 1
//     on, and its stamp in nanoseconds since 1970
//   fast_dds_peer DOMAIN count TOPIC TYPE QOS
//     says "ready", "matched", and "NUMBER SIZE" for each message of pattern.hpp
// TOPIC and TYPE are DDS's: rt/image, sensor_msgs::msg::dds_::Image_. QOS: words of reliable,
// latched, depth=N with commas between, or "best_effort". DOMAIN: on this machine alone. Ends
// with stdin.
#include "pattern.hpp"

#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <poll.h>
#include <unistd.h>

namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using namespace penumbra::test;
using Bytes = std::vector<std::byte>;

class BytesType final : public dds::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1024;  // grows
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    if (payload->max_size < bytes.size()) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const auto* const from = reinterpret_cast<const std::byte*>(payload->data);
    static_cast<Bytes*>(data)->assign(from, from + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

struct Qos {
  explicit Qos(const std::string& text)
      : reliable(text.find("reliable") != std::string::npos),
        latched(text.find("latched") != std::string::npos) {
    const std::size_t at = text.find("depth=");
    if (at != std::string::npos) depth = std::stoi(text.substr(at + 6));
  }
  bool reliable, latched;
  int depth = 5;
};

template <typename EntityQos>
EntityQos entity_qos(const Qos& qos) {
  EntityQos made;
  made.reliability().kind =
      qos.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  made.durability().kind =
      qos.latched ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  made.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  made.history().depth = qos.depth;
  made.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return made;
}

/// On 127.0.0.1 alone, without multicast or shared memory.
dds::DomainParticipantQos participant_qos() {
  dds::DomainParticipantQos qos;
  qos.name("fast_dds_peer");
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  udp->sendBufferSize = udp->receiveBufferSize = 4 << 20;
  udp->maxInitialPeersRange = 33;  // participants of Cyclone DDS's that it finds
  qos.transport().user_transports.push_back(udp);
  qos.transport().use_builtin_transports = false;
  rtps::Locator_t here;
  rtps::IPLocator::setIPv4(here, "127.0.0.1");
  auto& builtin = qos.wire_protocol().builtin;
  builtin.initialPeersList.push_back(here);
  builtin.metatrafficUnicastLocatorList.push_back(here);
  builtin.discovery_config.initial_announcements.period = {0, 50'000'000};
  builtin.discovery_config.leaseDuration = {3, 0};
  builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
  return qos;
}

bool stdin_ended() {
  pollfd in{STDIN_FILENO, POLLIN, 0};
  if (poll(&in, 1, 0) <= 0) return false;
  char byte = 0;
  return read(STDIN_FILENO, &byte, 1) <= 0;
}

void say(const std::string& line) { std::cout << line << std::endl; }

bool is_matched(dds::DataWriter& writer) {
  dds::PublicationMatchedStatus matched;
  return writer.get_publication_matched_status(matched) == ReturnCode_t::RETCODE_OK &&
         matched.current_count > 0;
}

void publish_pattern(dds::DataWriter& writer, std::size_t size, std::uint32_t count, double rate,
                     const Qos& qos) {
  using namespace std::chrono_literals;
  while (!qos.latched && !is_matched(writer)) {
    if (stdin_ended()) return;
    std::this_thread::sleep_for(5ms);
  }
  if (!qos.latched) say("matched");
  std::string line;
  if (!std::getline(std::cin, line)) return;
  std::uint32_t refused = 0;
  auto next = std::chrono::steady_clock::now();
  for (std::uint32_t number = 0; number < count; ++number) {
    auto message = pattern_message(number, size);
    if (!writer.write(&message)) ++refused;
    next += std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate));
    std::this_thread::sleep_until(next);
  }
  if (qos.reliable) writer.wait_for_acknowledgments({10, 0});
  say("written " + std::to_string(count - refused));
  while (!stdin_ended()) std::this_thread::sleep_for(20ms);
}

bool read_message(Bytes& message) {
  std::uint32_t size = 0;
  if (std::fread(&size, sizeof(size), 1, stdin) != 1) return false;
  message.resize(size);
  return std::fread(message.data(), 1, size, stdin) == size;
}

void repeat(dds::DataWriter& writer, std::int64_t hertz, const Qos& qos) {
  Bytes message;
  if (!read_message(message)) return;
  for (std::int64_t tick = 0; !stdin_ended();) {
    tick = next_tick(std::max(tick, system_now()), hertz);
    std::this_thread::sleep_for(std::chrono::nanoseconds(tick - system_now()));
    set_stamp(message, tick);
    if (!writer.write(&message)) std::cerr << "a message was refused\n";
  }
  if (qos.reliable) writer.wait_for_acknowledgments({10, 0});
}

void publish(dds::DataWriter& writer, const std::vector<std::string>& words) {
  const Qos qos(words[4]);
  say("ready");
  if (words[1] == "repeat")
    repeat(writer, std::stol(words.at(5)), qos);
  else if (words.size() == 8)
    publish_pattern(writer, std::stoul(words[5]), static_cast<std::uint32_t>(std::stoul(words[6])),
                    std::stod(words[7]), qos);
  else
    for (Bytes message; read_message(message);) writer.write(&message);
}

void wait_for_a_publisher(dds::DataReader& reader) {
  say("ready");
  dds::SubscriptionMatchedStatus matched;
  while (matched.current_count == 0 && !stdin_ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    static_cast<void>(reader.get_subscription_matched_status(matched));
  }
  say("matched");
}

void subscribe(dds::DataReader& reader, const std::string& mode) {
  if (mode == "count") wait_for_a_publisher(reader);
  Bytes message;
  dds::SampleInfo info;
  while (!stdin_ended()) {
    reader.wait_for_unread_message({0, 20'000'000});
    while (reader.take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      if (mode == "count")
        say(std::to_string(pattern_number(message)) + " " + std::to_string(message.size()));
      else
        say(std::to_string(info.sample_identity.sequence_number().to64long()) + " " +
            std::to_string(stamp_of(message)) + " " + std::to_string(digest_of(message)));
    }
  }
}

int run(const std::vector<std::string>& words) {
  const std::string &mode = words.at(1), &type = words.at(3);
  const Qos qos(words.at(4));
  auto* const factory = dds::DomainParticipantFactory::get_instance();
  auto* const participant = factory->create_participant(
      static_cast<std::uint32_t>(std::stoul(words[0])), participant_qos());
  if (participant == nullptr) return 1;
  dds::TypeSupport(new BytesType(type)).register_type(participant);
  auto* const topic = participant->create_topic(words[2], type, dds::TOPIC_QOS_DEFAULT);
  if (mode == "publish" || mode == "repeat") {
    auto* const publisher = participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    auto* const writer = publisher->create_datawriter(topic, entity_qos<dds::DataWriterQos>(qos));
    if (writer == nullptr) return 1;
    publish(*writer, words);
  } else {
    auto* const subscriber = participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    auto* const reader = subscriber->create_datareader(topic, entity_qos<dds::DataReaderQos>(qos));
    if (reader == nullptr) return 1;
    subscribe(*reader, mode);
  }
  participant->delete_contained_entities();
  factory->delete_participant(participant);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "fast_dds_peer: " << error.what() << '\n';
    return 1;
  }
}
