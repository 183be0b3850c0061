// SPDX-License-Identifier: Apache-2.0

#include "../support/test.hpp"

#include <io/files/statistics.hpp>

namespace penumbra::io {
namespace {

TEST(Statistics, QuantilesByRank) {
  EXPECT_FALSE(quantiles({}).has_value());
  EXPECT_EQ(quantiles({3.0})->p99, 3.0);
  EXPECT_EQ(quantiles({4.0, 1.0, 2.0, 3.0})->median, 3.0);

  std::vector<double> samples(200);
  std::iota(samples.rbegin(), samples.rend(), 1.0);
  EXPECT_EQ(quantiles(samples)->p99, 198.0) << "198 of 200 are 99 %";
  EXPECT_EQ(quantiles(samples)->median, 101.0);
  EXPECT_EQ(quantiles(samples)->max, 200.0);
}

}  // namespace
}  // namespace penumbra::io
