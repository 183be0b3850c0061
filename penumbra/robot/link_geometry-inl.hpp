// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/robot/file_locator.hpp>
#include <penumbra/robot/link_choice-inl.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/urdf-inl.hpp>

namespace penumbra::detail {

struct LinkGeometry {
  std::vector<PreparedMesh> meshes;
  LinkReport report;
  Eigen::AlignedBox3d without_margin;  ///< bounds
};

/// Makes the triangles of links. Reads each mesh file once.
class GeometryLoader {
 public:
  GeometryLoader(FileLocator& locator, const RobotOptions& options)
      : locator_(locator), allow_missing_(options.allow_missing_meshes), extra_(options.extra) {}

  /// Returns the chosen geometry of a link and its extra meshes, margin included. Throws InputError
  /// that names link, file and reason for geometry that cannot be loaded, unless missing meshes are
  /// allowed.
  [[nodiscard]] LinkGeometry load(const UrdfLink& link, const LinkChoice& choice);

  /// Where packages were found, then links of a suspicious size.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  void add(const UrdfElement& element, LinkGeometry& out);
  void add(const ExtraMesh& extra, LinkGeometry& out);
  void note_size(const LinkGeometry& geometry);
  PreparedMesh make_mesh(const UrdfElement& element, double margin, std::string& source);
  const TriangleMesh& read_file(const std::filesystem::path& file);

  FileLocator& locator_;
  bool allow_missing_;
  std::vector<ExtraMesh> extra_;
  std::map<std::filesystem::path, TriangleMesh> files_;
  std::vector<std::string> size_notes_;
};

}  // namespace penumbra::detail
