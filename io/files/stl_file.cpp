// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <io/files/disk_file.hpp>
#include <io/files/stl_file.hpp>

namespace penumbra::io {

void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh) {
  std::string bytes = stl_begin;
  bytes.resize(80, ' ');
  const auto append = [&bytes](const void* from, std::size_t count) {
    bytes.append(static_cast<const char*>(from), count);
  };
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  append(&count, sizeof count);
  for (const auto& triangle : mesh.triangles) {
    std::array<float, 12> numbers{};
    for (std::size_t k = 0; k < 3; ++k)
      std::copy_n(mesh.vertices[triangle[k]].data(), 3, numbers.begin() + 3 + 3 * k);
    append(numbers.data(), sizeof numbers);
    const std::uint16_t attributes = 0;
    append(&attributes, sizeof attributes);
  }
  write_file(file, bytes.data(), bytes.size());
}

}  // namespace penumbra::io
