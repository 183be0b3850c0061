// SPDX-License-Identifier: Apache-2.0
// Values by stamp, against a list in the order of writing.
#include "../support/random.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/base/recent_values.hpp>

namespace penumbra::test {
namespace {

TEST(RecentValues, AreThoseOfTheSpanAndNoMoreThanAllowed) {
  std::mt19937_64 random = seeded_random(20263);
  std::uniform_int_distribution<std::int64_t> step(1, 4), span(0, 30);
  std::uniform_int_distribution<std::size_t> limit(1, 10);
  for (int round = 0; round < 50; ++round) {
    const std::int64_t within = span(random);
    const std::size_t most = limit(random);
    RecentValues<double> values(within);
    std::deque<std::int64_t> wanted;
    std::int64_t stamp = 1'000;
    for (int i = 0; i < 100; ++i) {
      stamp += step(random);
      values.at(stamp, most) = 2.0 * double(stamp);
      if (!wanted.empty() && (wanted.size() >= most || stamp - wanted.front() > within))
        wanted.pop_front();
      wanted.push_back(stamp);
      for (std::int64_t at = stamp - 50; at <= stamp; ++at) {
        const double* const found = values.find(at);
        const bool is_kept = std::ranges::find(wanted, at) != wanted.end();
        ASSERT_EQ(found != nullptr, is_kept) << at << " at " << stamp;
        if (found != nullptr) {
          ASSERT_EQ(*found, 2.0 * double(at));
        }
      }
    }
    values.at(stamp, most) = 7;  // again
    EXPECT_EQ(*values.find(stamp), 7);
    values.clear();
    EXPECT_EQ(values.find(stamp), nullptr);
  }
}

TEST(RecentValues, KeepTheirBuffers) {
  RecentValues<std::vector<int>> values(std::int64_t{10});
  std::set<const int*> buffers;
  for (std::int64_t stamp = 0; stamp < 1'000; ++stamp) {
    std::vector<int>& value = values.at(stamp);
    value.resize(100);
    buffers.insert(value.data());
  }
  EXPECT_EQ(buffers.size(), 11U) << "of the stamps of a span";
}

}  // namespace
}  // namespace penumbra::test
