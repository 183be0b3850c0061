// SPDX-License-Identifier: Apache-2.0
//   PENUMBRA_FULL=1 test_dds_live --gtest_filter='LiveSoakFull.*'
// is 10 minutes without overlays, 10 with them and 5 of chaos; PENUMBRA_SOAK_SECONDS=N makes N s of
// each.
#include "live_soak.hpp"

#include "../support/run_length.hpp"

#include <cstdlib>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

std::chrono::seconds length_or(int seconds) {
  const char* const given = std::getenv("PENUMBRA_SOAK_SECONDS");
  return std::chrono::seconds(given == nullptr ? seconds : std::atoi(given));
}

class LiveSoakFull : public LiveSoak {
 protected:
  [[nodiscard]] bool is_alone() const override { return true; }
};

TEST_F(LiveSoak, EverySampleIsAccountedFor) { soak_steadily(2s, true); }

TEST_F(LiveSoak, NoLabelsAreOfAWrongPoseAmongKilledPublishers) { soak_in_chaos(3s); }

TEST_F(LiveSoakFull, Steady) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  soak_steadily(length_or(600), false);
}

TEST_F(LiveSoakFull, SteadyWithOverlays) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  soak_steadily(length_or(600), true);
}

TEST_F(LiveSoakFull, Chaos) {
  if (!measures_in_full()) GTEST_SKIP() << "set PENUMBRA_FULL";
  soak_in_chaos(length_or(300));
}

}  // namespace
}  // namespace penumbra::test
