// SPDX-License-Identifier: Apache-2.0
// penumbra live for a while among publishers and subscribers of another vendor, with images of a
// real camera's size: what comes of each sample, when labels are there, what it takes.
#pragma once

#include "../support/temporary_folder.hpp"
#include "label_watch.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"
#include "soak_publishers.hpp"
#include "soak_table.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra::test {

class LiveSoak : public testing::Test {
 protected:
  using Json = nlohmann::json;

  void SetUp() override;

  /// Begins all, and waits for the first labels that say something.
  void begin(const SoakScene& scene, bool with_overlay);

  void run_steadily(std::chrono::seconds length);

  /// Once a minute.
  void note_memory();

  /// Ends all, publishers first; of what was written the count is kept.
  void finish();

  /// Labels that were published were heard. To a subscriber that is starved newer ones come in
  /// place of older ones, and the last ones not if it stays so.
  void expect_all_heard(std::uint64_t published) const;

  /// Whether nothing else runs, so that nothing is late.
  [[nodiscard]] virtual bool is_alone() const { return false; }

  [[nodiscard]] const Json& topic(Part part) const;
  [[nodiscard]] const Json& camera() const { return summary_["cameras"][0]; }

  /// What DDS delivered is what became of the images.
  void expect_all_accounted() const;
  /// What was written arrived, or is counted: newer ones replaced it before it was read or, where
  /// the publisher is starved, before they were sent.
  void expect_all_arrived() const;

  [[nodiscard]] SoakTable table(const std::string& title) const;
  void add_latencies(SoakTable& table) const;

  void soak_steadily(std::chrono::seconds length, bool with_overlay);

  void soak_in_chaos(std::chrono::seconds length);
  /// Kills some publishers, begins them again after a while, and takes the time until all is well.
  void break_and_mend(std::mt19937_64& random);

  LoneDomain domain_;
  TemporaryFolder folder_;
  std::unique_ptr<SoakPublishers> publishers_;
  std::unique_ptr<LabelWatch> labels_;
  std::unique_ptr<PeerProcess> overlay_;
  std::unique_ptr<LiveProgram> live_;
  ProcessUsage before_, after_;
  std::vector<double> minutes_;  // MiB after each
  std::size_t written_ = 0;
  Json summary_;
  LabelVerdict verdict_;
  std::vector<double> recoveries_, discoveries_;  // s
};

}  // namespace penumbra::test
