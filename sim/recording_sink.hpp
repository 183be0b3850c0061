// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <sim/simulation.hpp>

namespace penumbra::sim {

/// Where the frames of a simulation are written to.
class RecordingSink {
 public:
  virtual ~RecordingSink() = default;

  /// `index`: of the frame in its scene. Throws InputError where the system refuses to write.
  virtual void add(const SimFrame& frame, std::size_t index) = 0;

  /// Ends the recording. Throws InputError where the system refuses to write.
  virtual void finish() = 0;

  /// What was written, in words.
  [[nodiscard]] virtual std::string where() const = 0;
};

/// What a recording says of its scene, as YAML: seed, options, and what is known of the object and
/// the grasp.
[[nodiscard]] std::string scene_text(const Simulation& simulation, const std::string& scene,
                                     const SimulationOptions& options);

/// SimFrame::ids as recordings have them; `to` is kept where the size stays.
void store_ids(const SimFrame& frame, Image<std::uint16_t>& to);

}  // namespace penumbra::sim
