// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <sim/experiments/experiment.hpp>

namespace penumbra::sim {

const std::vector<std::string>& experiments() {
  static const std::vector<std::string> none;
  return none;
}

void run_experiment(const ExperimentOptions&, const std::function<void(std::size_t)>&,
                    const std::function<void()>&) {
  throw InputError(
      "this build has no experiments; install libmujoco-dev, libopencv-calib3d-dev "
      "and libopencv-features2d-dev (scripts/packages.sh --install build sim) "
      "and build with -DPENUMBRA_WITH_SIMULATION=ON");
}

}  // namespace penumbra::sim
