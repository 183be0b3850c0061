// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

/// Casts rays at a robot that moves, with Embree: each link is an instance.
class LinkRays {
 public:
  explicit LinkRays(const Robot& robot);
  ~LinkRays();

  void place(std::span<const Isometry3d> T_root_link);

  /// The first surface on a ray from `from` before `most` lengths of `direction`.
  struct Hit {
    double at;         ///< in lengths of the direction
    std::size_t link;  ///< index
  };
  [[nodiscard]] std::optional<Hit> cast(const Vector3d& from, const Vector3d& direction,
                                        double most) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace penumbra::test
