// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/base/version.hpp>

int main() {
  const penumbra::TriangleMesh none;
  std::cout << "penumbra " PENUMBRA_VERSION ": " << penumbra::connected_components(none).size()
            << " pieces\n";
}
