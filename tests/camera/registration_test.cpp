// SPDX-License-Identifier: Apache-2.0
// Registered depth images of pixels without measurement, at edges, and of invalid images.
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "posed_cameras.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/registration.hpp>

namespace penumbra {
namespace {

using test::plain_camera;
using test::pose;

TEST(Registration, WhatIsNotMeasuredStaysSo) {
  const Camera camera = plain_camera(80, 60, 70);
  DepthRegistration registration(camera, camera);
  Image<float> depth(80, 60, 1.0F);
  const float none[] = {0.0F,   -1.0F, std::nanf(""), std::numeric_limits<float>::infinity(),
                        0.005F, 2e6F};
  for (int i = 0; i < 6; ++i) depth(10 + 5 * i, 30) = none[i];
  const auto same = std::get<ImageView<const float>>(
      registration.warp(depth.view(), Eigen::Isometry3d::Identity()));
  for (int v = 0; v < 60; ++v)
    for (int u = 0; u < 80; ++u) {
      const bool hole = v == 30 && u >= 10 && u <= 35 && u % 5 == 0;
      EXPECT_EQ(same(u, v), hole ? 0.0F : 1.0F) << u << ',' << v;
    }
}

TEST(Registration, StridesAreFollowedAndRubbishIsSafe) {
  auto random = test::seeded_random(9);
  const Camera from = plain_camera(64, 48, 50);
  const Camera to = plain_camera(90, 40, 60);
  DepthRegistration registration(from, to);
  const Image<float> padded(80, 48, 1.5F);
  const ImageView<const float> view{padded.data(), 64, 48, 80};
  const auto seen =
      std::get<ImageView<const float>>(registration.warp(view, Eigen::Isometry3d::Identity()));
  EXPECT_EQ(seen(45, 20), 1.5F);
  Image<float> rubbish(64, 48);
  for (int round = 0; round < test::samples(20); ++round) {
    for (std::size_t i = 0; i < rubbish.size(); ++i)
      rubbish.data()[i] = static_cast<float>(
          std::pow(10.0, std::uniform_real_distribution<double>(-3, 40)(random)));
    static_cast<void>(registration.warp(
        rubbish.view(), pose(0.3, -0.2, -0.5, 0.4 * round, Eigen::Vector3d(1, round, 2))));
  }
}

TEST(Registration, AFootprintIsBounded) {
  const Camera from = plain_camera(64, 48, 50);
  const Camera to = plain_camera(400, 400, 5000);
  DepthRegistration registration(from, to);
  Image<float> depth(64, 48);
  depth(31, 25) = 1.0F;
  const auto seen =
      std::get<ImageView<const float>>(registration.warp(depth.view(), pose(0, 0, -0.9)));
  std::size_t covered = 0;
  for (int v = 0; v < 400; ++v)
    for (int u = 0; u < 400; ++u) covered += seen(u, v) > 0 ? 1 : 0;
  EXPECT_LE(covered, static_cast<std::size_t>(4 * DepthRegistration::max_reach *
                                              DepthRegistration::max_reach));
}

TEST(Registration, RefusesWhatIsNoImageOfTheCamera) {
  const Camera camera = plain_camera(80, 60, 70);
  DepthRegistration registration(camera, camera);
  const Image<float> image(81, 60);
  EXPECT_THROW(static_cast<void>(registration.warp(image.view(), Eigen::Isometry3d::Identity())),
               std::invalid_argument);
  Camera reversed = camera;
  reversed.range = {3, 1};
  EXPECT_THROW(DepthRegistration(reversed, camera), InputError);
}

}  // namespace
}  // namespace penumbra
