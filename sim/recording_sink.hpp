// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <sim/simulation.hpp>

namespace penumbra::sim {

/// Writes the frames of a simulation.
class RecordingSink {
 public:
  virtual ~RecordingSink() = default;

  /// Writes a frame. `index`: the frame's index in its scene. Throws InputError if the system
  /// refuses to write.
  virtual void add(const SimFrame& frame, std::size_t index) = 0;

  /// Ends the recording. Throws InputError if the system refuses to write.
  virtual void finish() = 0;

  /// Returns a description of what was written.
  [[nodiscard]] virtual std::string where() const = 0;
};

/// Returns the description of a scene as YAML: seed, options, and the known data of the object and
/// the grasp.
[[nodiscard]] std::string scene_text(const Simulation& simulation, const std::string& scene,
                                     const SimulationOptions& options);

/// Converts SimFrame::ids to the format of recordings; `to` is reused if the size is the same.
void store_ids(const SimFrame& frame, Image<std::uint16_t>& to);

}  // namespace penumbra::sim
