// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../apps/program.hpp"
#include "../apps/tiny_bag.hpp"
#include "../support/running_program.hpp"
#include "listening.hpp"
#include "lone_domain.hpp"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace penumbra::test {

/// A domain of its own, on which programs run that this test hears.
class LiveGraph : public testing::Test {
 protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] Words on_domain(const std::string& command, const Words& options = {}) const {
    return Words{command, "--domain", std::to_string(domain_.id())} + options;
  }
  /// Plays a bag again and again, with the stamps of now.
  [[nodiscard]] std::unique_ptr<RunningProgram> play_in_loop(const TinyBag& bag) const {
    bag.write_mcap(path("bag.mcap"));
    return std::make_unique<RunningProgram>(
        on_domain("play", {"--loop", "--restamp", path("bag.mcap")}), path("play.log"));
  }
  [[nodiscard]] std::unique_ptr<RunningProgram> live(const Words& options) const {
    return std::make_unique<RunningProgram>(on_domain("live", options), path("live.log"));
  }
  [[nodiscard]] std::unique_ptr<io::Subscription> hear(const std::string& topic,
                                                       const std::string& type) const {
    return graph_->subscribe(topic, type, {.reliable = true, .depth = 100});
  }
  /// Waits for messages of a topic until `is_enough(message)`; false: in vain.
  template <typename M, typename IsEnough>
  [[nodiscard]] bool hears(io::Subscription& heard, IsEnough is_enough) const {
    const io::Decoder<M> decoder;
    io::SerializedMessage sample;
    return eventually(*graph_, [&] {
      bool is_so = false;
      for (M message; !is_so && heard.take(sample);)
        is_so = !decoder.decode(sample.data, message) && is_enough(message);
      return is_so;
    });
  }

  TemporaryFolder folder_;
  LoneDomain domain_;
  std::unique_ptr<io::Participant> graph_ = io::join_graph({.domain = domain_.id()});
};

}  // namespace penumbra::test
