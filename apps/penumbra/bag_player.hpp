// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apps/penumbra/arguments.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <io/bag/bag_reader.hpp>
#include <io/dds/participant.hpp>
#include <io/ros/restamp.hpp>

namespace penumbra::app {

/// A topic of a bag as it is published.
struct PlayedTopic {
  std::string name;  ///< after --remap
  std::string type;
  io::TopicQos qos;
  std::unique_ptr<io::Publication> publication;  ///< null: it is not played
  std::optional<io::Restamper> restamper;        ///< of types with headers, with --restamp
  std::uint64_t written = 0;
  std::uint64_t behind = 0;      ///< not written, as reliable subscribers were behind
  std::uint64_t unreadable = 0;  ///< not written, as their stamps could not be found
};

/// Publishes a bag's messages at the pace of their log times.
class BagPlayer {
 public:
  /// Throws InputError for a bag without anything to play and for topics that it does not have.
  BagPlayer(const PlayArguments& arguments, io::Participant& graph);

  /// Once from start to end. False: it was stopped.
  bool play(StopSignal& stop);

  /// Waits, not long, until reliable subscribers have everything.
  void finish();

  [[nodiscard]] const std::vector<PlayedTopic>& topics() const { return topics_; }
  [[nodiscard]] double most_late() const { return most_late_; }  ///< seconds behind the pace

  /// What was left out, and why: one line each.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Clock;

  void announce(std::size_t index);
  void note_kept_stamps(const std::string& type);
  bool is_wanted(const std::string& topic) const;
  bool is_latched(const io::BagTopic& topic);
  void check_names() const;
  void write(PlayedTopic& topic, const io::BagMessage& message, const Clock& clock);

  const PlayArguments& arguments_;
  io::Participant& graph_;
  std::unique_ptr<io::BagReader> reader_;
  std::vector<PlayedTopic> topics_;  // as the bag numbers them
  std::vector<std::string> notes_;
  std::vector<std::byte> changed_;
  double most_late_ = 0.0;
};

}  // namespace penumbra::app
