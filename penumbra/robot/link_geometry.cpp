// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/mesh/surface_offset.hpp>
#include <penumbra/robot/link_geometry-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr double farthest_vertex = 1e6;  // metres from the link's origin

// Metres. Fingertips and sensors are larger; links of up to 2 m that are drawn a thousand times too
// small are not.
constexpr double smallest_link = 0.002;

std::string nothing_left(const std::string& source, double margin) {
  return source + ": a margin of " + printed(margin) +
         " m leaves nothing of it; use a margin nearer to 0";
}

std::string round_name(const char* kind, double radius, double length) {
  return std::string(kind) + " radius " + printed(radius) + " length " + printed(length);
}

/// Makes a primitive's triangles, enlarged by the margin on all sides, and describes it, without
/// the margin, in `source`.
struct PrimitiveMaker {
  std::string& source;
  double margin;

  TriangleMesh operator()(const UrdfBox& box) const {
    source = "box " + printed(box.size.x()) + " x " + printed(box.size.y()) + " x " +
             printed(box.size.z());
    return make_box({padded(box.size.x()), padded(box.size.y()), padded(box.size.z())});
  }
  TriangleMesh operator()(const UrdfCylinder& cylinder) const {
    source = round_name("cylinder", cylinder.radius, cylinder.length);
    return make_cylinder(padded(2.0 * cylinder.radius) / 2.0, padded(cylinder.length));
  }
  TriangleMesh operator()(const UrdfSphere& sphere) const {
    source = "sphere radius " + printed(sphere.radius);
    return make_sphere(padded(2.0 * sphere.radius) / 2.0);
  }
  TriangleMesh operator()(const UrdfCapsule& capsule) const {
    source = round_name("capsule", capsule.radius, capsule.length);
    return make_capsule(padded(2.0 * capsule.radius) / 2.0, capsule.length);
  }
  TriangleMesh operator()(const UrdfEllipsoid& ellipsoid) const {
    const Eigen::Vector3d& radii = ellipsoid.radii;
    source = "ellipsoid radii " + printed(radii.x()) + ", " + printed(radii.y()) + ", " +
             printed(radii.z());
    const double largest = radii.maxCoeff();
    TriangleMesh mesh = make_sphere(largest);
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = vertex.cwiseProduct((radii / largest).cast<float>());
    return mesh;
  }
  TriangleMesh operator()(const UrdfMesh&) const { return {}; }  // read from a file instead

  [[nodiscard]] double padded(double size) const {
    if (margin < 0.0 && size + 2.0 * margin <= 0.0) throw InputError(nothing_left(source, margin));
    return size + 2.0 * margin;
  }
};

/// Scales, then places the mesh, in double. Keeps the outside of a mirrored mesh outside.
void place(const UrdfMesh& file, const Eigen::Isometry3d& origin, TriangleMesh& mesh) {
  const Eigen::Vector3d& scale = file.scale;
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d scaled = scale.cwiseProduct(file.T_scaled_file * vertex.cast<double>());
    const Eigen::Vector3d placed = origin * scaled;
    if (!(placed.cwiseAbs().maxCoeff() <= farthest_vertex))
      throw InputError("a vertex lies beyond 1e6 m; check the unit and the scale");
    vertex = placed.cast<float>();
  }
  if (scale.prod() < 0.0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

/// Adds a mesh with its margin to a link. Its source is the last one in the link's report.
void keep(const PreparedMesh& mesh, PreparedMesh with_margin, LinkGeometry& out) {
  LinkReport& report = out.report;
  if (with_margin.triangles.empty())
    throw InputError(nothing_left(report.sources.back(), report.margin));
  report.watertight = (out.meshes.empty() || report.watertight) && mesh.watertight;
  report.drawn = true;
  report.triangles += with_margin.triangles.size();
  report.bounds.extend(with_margin.bounds);
  out.without_margin.extend(mesh.bounds);
  out.meshes.push_back(std::move(with_margin));
}

void report_missing(const std::string& place, const std::string& what, LinkReport& link) {
  link.missing = true;
  if (link.fault.empty()) link.fault = place + what;
  link.reason += "; missing: " + what;
}

}  // namespace

LinkGeometry GeometryLoader::load(const UrdfLink& link, const LinkChoice& choice) {
  const auto start = std::chrono::steady_clock::now();
  LinkGeometry out;
  out.report.link = link.name;
  out.report.reason = choice.reason;
  out.report.missing = choice.lacks_geometry;
  const auto is_its = [&](const ExtraMesh& extra) { return extra.link == link.name; };
  if (!choice.draw && std::none_of(extra_.begin(), extra_.end(), is_its)) return out;
  out.report.margin = choice.margin;
  if (choice.draw)
    for (const UrdfElement& element : link.elements(choice.geometry)) add(element, out);
  for (const ExtraMesh& extra : extra_)
    if (is_its(extra)) add(extra, out);
  note_size(out);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  out.report.load_ms = took.count();
  return out;
}

void GeometryLoader::add(const UrdfElement& element, LinkGeometry& out) {
  if (!element.fault.empty()) {
    if (!allow_missing_) throw InputError(element.fault);
    return report_missing("", element.fault, out.report);
  }
  const std::string place = element.place + ": ";
  const double margin = out.report.margin;
  std::string& source = out.report.sources.emplace_back();
  std::optional<PreparedMesh> mesh;
  try {
    mesh = make_mesh(element, 0.0, source);
  } catch (const InputError& error) {
    if (!allow_missing_) throw InputError(place + error.what());
    return report_missing(place, error.what(), out.report);
  }
  try {
    const bool is_offset = std::holds_alternative<UrdfMesh>(element.shape) ||
                           std::holds_alternative<UrdfEllipsoid>(element.shape);
    keep(*mesh,
         is_offset || margin == 0.0 ? offset_surface(*mesh, margin)
                                    : make_mesh(element, margin, source),
         out);
  } catch (const InputError& error) {
    throw InputError(place + error.what());
  }
}

void GeometryLoader::add(const ExtraMesh& extra, LinkGeometry& out) {
  out.report.sources.push_back(extra.mesh.string());
  out.report.reason += "; with an extra mesh";
  try {
    const PreparedMesh mesh(read_file(extra.mesh));
    keep(mesh, offset_surface(mesh, out.report.margin), out);
  } catch (const InputError& error) {
    throw InputError("extra of link " + in_quotes(extra.link) + ": " + error.what());
  }
}

void GeometryLoader::note_size(const LinkGeometry& geometry) {
  const LinkReport& link = geometry.report;
  const double size = geometry.without_margin.sizes().maxCoeff();
  if (!link.drawn || link.missing) return;
  if (size > likely_millimetres)
    size_notes_.push_back("link '" + link.link + "': its geometry is " + printed(std::round(size)) +
                          " m large: is it in millimetres? give metres, or the mesh a scale");
  if (size >= smallest_link) return;
  std::array<char, 32> millimetres{};
  std::snprintf(millimetres.data(), millimetres.size(), "%.2g", 1e3 * size);
  size_notes_.push_back("link '" + link.link + "': its geometry is only " + millimetres.data() +
                        " mm large; check the unit");
}

std::vector<std::string> GeometryLoader::notes() const {
  std::vector<std::string> all = locator_.notes();
  all.insert(all.end(), size_notes_.begin(), size_notes_.end());
  return all;
}

PreparedMesh GeometryLoader::make_mesh(const UrdfElement& element, double margin,
                                       std::string& source) {
  TriangleMesh placed;
  const auto* const file = std::get_if<UrdfMesh>(&element.shape);
  if (file != nullptr) {
    source = file->filename;
    const auto path = locator_.locate(file->filename);
    source = path.string();
    placed = read_file(path);
  } else {
    placed = std::visit(PrimitiveMaker{source, margin}, element.shape);
  }
  place(file == nullptr ? UrdfMesh() : *file, element.origin, placed);
  PreparedMesh mesh(placed);
  if (mesh.triangles.empty())
    throw InputError(source + ": no triangle has an area; check the unit and the scale");
  return mesh;
}

const TriangleMesh& GeometryLoader::read_file(const std::filesystem::path& file) {
  if (const auto known = files_.find(file); known != files_.end()) return known->second;
  return files_[file] = load_mesh(file);
}

}  // namespace penumbra::detail
