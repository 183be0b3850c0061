// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/robot/file_locator-inl.hpp>
#include <penumbra/robot/link_choice-inl.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/urdf-inl.hpp>

namespace penumbra::detail {

struct LinkGeometry {
  std::vector<PreparedMesh> meshes;
  LinkReport report;
  Eigen::AlignedBox3d without_margin;  ///< bounds
};

/// Makes the triangles of links. Each mesh file is read once.
class GeometryLoader {
 public:
  GeometryLoader(const Urdf& urdf, const std::filesystem::path& folder, const RobotOptions& options)
      : file_(urdf.file),
        locator_(folder, options.packages),
        allow_missing_(options.allow_missing_meshes),
        extra_(options.extra) {}

  /// The chosen geometry of a link and its extra meshes, margin included. Throws InputError that
  /// names link, file and reason for geometry that cannot be had, unless missing meshes are
  /// allowed.
  [[nodiscard]] LinkGeometry load(const UrdfLink& link, const LinkChoice& choice);

  /// Where packages were found, then what is odd about mesh files and about links' sizes.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  void add_elements(const UrdfLink& link, Geometry geometry, LinkGeometry& out);
  void add(const UrdfElement& element, LinkGeometry& out);
  void add(const ExtraMesh& extra, LinkGeometry& out);
  /// Notes that the link lacks some of its geometry.
  static void lack(const std::string& where, const std::string& what, LinkReport& link);
  /// Where a fault is, for messages.
  [[nodiscard]] std::string at(const UrdfElement& element, const std::string& link) const;
  void note_size(const LinkGeometry& geometry);
  PreparedMesh make_mesh(const UrdfElement& element, double margin, std::string& source);
  TriangleMesh read_mesh(const UrdfMesh& mesh, std::string& source);
  const TriangleMesh& read_file(const std::filesystem::path& file);

  std::string file_;
  FileLocator locator_;
  bool allow_missing_;
  std::vector<ExtraMesh> extra_;
  std::map<std::filesystem::path, TriangleMesh> files_;
  std::vector<std::string> file_notes_;
  std::vector<std::string> size_notes_;
};

}  // namespace penumbra::detail
