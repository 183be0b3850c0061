// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <penumbra/base/error.hpp>

#include <sim/simulation.hpp>

namespace penumbra::sim {

// The constructor throws, so the members are never called.
struct Simulation::State {};

namespace {

[[noreturn]] void refuse_simulation() {
  throw InputError(
      "this build has no simulation; install libmujoco-dev and libepoxy-dev and build with "
      "-DPENUMBRA_WITH_SIMULATION=ON");
}

}  // namespace

const std::vector<std::string>& Simulation::scenes() {
  static const std::vector<std::string> none;
  return none;
}

Simulation::Simulation(const std::string&, const SimulationOptions&) { refuse_simulation(); }
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
bool Simulation::next(SimFrame&) { refuse_simulation(); }
void Simulation::skip(std::size_t) { refuse_simulation(); }
std::size_t Simulation::frames() const { refuse_simulation(); }
const std::filesystem::path& Simulation::urdf() const { refuse_simulation(); }
const std::vector<ArmPlace>& Simulation::arms() const { refuse_simulation(); }
const Robot& Simulation::robot() const { refuse_simulation(); }
const Camera& Simulation::camera() const { refuse_simulation(); }
const Eigen::Isometry3d& Simulation::T_base_camera() const { refuse_simulation(); }
const Eigen::Isometry3d& Simulation::T_base_second_camera() const { refuse_simulation(); }
const Image<Rgb8>& Simulation::model_image() const { refuse_simulation(); }
Eigen::Vector3d Simulation::object_size() const { refuse_simulation(); }
Eigen::Vector3d Simulation::conveyor_direction() const { refuse_simulation(); }
double Simulation::duration() const { refuse_simulation(); }
bool Simulation::is_whole() const { refuse_simulation(); }
std::optional<std::int64_t> Simulation::grasp_stamp() const { refuse_simulation(); }

}  // namespace penumbra::sim
