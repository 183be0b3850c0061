// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text-inl.hpp>
#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/mesh/surface_offset.hpp>
#include <penumbra/robot/link_geometry-inl.hpp>

namespace penumbra::detail {
namespace {

constexpr double kFarthestVertex = 1e6;  // metres from the link's origin

// Metres. The smallest parts that are links of their own, fingertips and sensors, are larger; what
// is up to 2 m large and drawn a thousand times too small is not.
constexpr double kSmallestLink = 0.002;

std::string nothing_left(const std::string& source, double margin) {
  return source + ": nothing is left of it with a margin of " + printed(margin) +
         " m; take a margin nearer to 0";
}

std::string round_name(const char* kind, double radius, double length) {
  return std::string(kind) + " radius " + printed(radius) + " length " + printed(length);
}

/// Makes a primitive's triangles, with a margin by which its surface lies farther out; its
/// description, without the margin, comes into `source`.
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
  TriangleMesh operator()(const UrdfMesh&) const { return {}; }  // comes from a file instead

  [[nodiscard]] double padded(double size) const {
    if (margin < 0.0 && size + 2.0 * margin <= 0.0) throw InputError(nothing_left(source, margin));
    return size + 2.0 * margin;
  }
};

// Scaled, then placed, in double. A mirrored mesh keeps its outside outside.
void place(const Eigen::Vector3d& scale, const Eigen::Isometry3d& origin, TriangleMesh& mesh) {
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d scaled = scale.cwiseProduct(vertex.cast<double>());
    const Eigen::Vector3d placed = origin * scaled;
    if (!(placed.cwiseAbs().maxCoeff() <= kFarthestVertex))
      throw InputError("a vertex lies beyond 1e6 m; check the unit and the scale");
    vertex = placed.cast<float>();
  }
  if (scale.prod() < 0.0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// Adds a mesh with its margin to a link. Its source is the last one in the link's report.
void keep(const PreparedMesh& mesh, PreparedMesh with_margin, LinkGeometry& out) {
  LinkReport& report = out.report;
  if (with_margin.triangles.empty())
    throw InputError(nothing_left(report.sources.back(), report.margin));
  report.watertight = (out.meshes.empty() || report.watertight) && mesh.watertight;
  out.without_margin.extend(mesh.bounds);
  out.meshes.push_back(std::move(with_margin));
}

// The report's figures of the meshes as they are drawn.
void measure(LinkGeometry& link) {
  LinkReport& report = link.report;
  report.drawn = !link.meshes.empty();
  for (const PreparedMesh& mesh : link.meshes) {
    report.triangles += mesh.triangles.size();
    report.bounds.extend(mesh.bounds);
  }
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
  if (choice.draw) add_elements(link, choice.geometry, out);
  for (const ExtraMesh& extra : extra_)
    if (is_its(extra)) add(extra, out);
  measure(out);
  note_size(out);
  out.report.load_ms = milliseconds_since(start);
  return out;
}

void GeometryLoader::add_elements(const UrdfLink& link, Geometry geometry, LinkGeometry& out) {
  for (const UrdfElement& element : link.elements(geometry)) {
    if (!element.fault.empty()) {
      if (!allow_missing_) throw InputError(element.fault);
      lack("", element.fault, out.report);
      continue;
    }
    try {
      add(element, out);
    } catch (const InputError& error) {
      throw InputError(at(element, link.name) + error.what());
    }
  }
}

void GeometryLoader::lack(const std::string& where, const std::string& what, LinkReport& link) {
  link.missing = true;
  if (link.fault.empty()) link.fault = where + what;
  link.reason += "; missing: " + what;
}

std::string GeometryLoader::at(const UrdfElement& element, const std::string& link) const {
  return file_ + ":" + std::to_string(element.line) + ": link " + in_quotes(link) + ": ";
}

void GeometryLoader::note_size(const LinkGeometry& geometry) {
  const LinkReport& link = geometry.report;
  if (!link.drawn || link.missing) return;
  const double size = geometry.without_margin.sizes().maxCoeff();
  if (size >= kSmallestLink) return;
  std::array<char, 32> millimetres{};
  std::snprintf(millimetres.data(), millimetres.size(), "%.2g", 1e3 * size);
  size_notes_.push_back("link '" + link.link + "': its geometry is only " + millimetres.data() +
                        " mm large; is the unit right?");
}

void GeometryLoader::add(const UrdfElement& element, LinkGeometry& out) {
  std::string& source = out.report.sources.emplace_back();
  std::optional<PreparedMesh> mesh;
  try {
    mesh = make_mesh(element, 0.0, source);
  } catch (const InputError& error) {
    if (!allow_missing_) throw;
    return lack(at(element, out.report.link), error.what(), out.report);
  }
  const double margin = out.report.margin;
  if (margin != 0.0 && !std::holds_alternative<UrdfMesh>(element.shape))
    keep(*mesh, make_mesh(element, margin, source), out);
  else
    keep(*mesh, offset_surface(*mesh, margin), out);
}

void GeometryLoader::add(const ExtraMesh& extra, LinkGeometry& out) {
  out.report.sources.push_back(extra.mesh.string());
  out.report.reason += "; with an extra mesh";
  try {
    TriangleMesh placed = read_file(extra.mesh);
    place(Eigen::Vector3d::Ones(), Eigen::Isometry3d::Identity(), placed);
    const PreparedMesh mesh(placed);
    keep(mesh, offset_surface(mesh, out.report.margin), out);
  } catch (const InputError& error) {
    throw InputError("extra of link " + in_quotes(extra.link) + ": " + error.what());
  }
}

std::vector<std::string> GeometryLoader::notes() const {
  std::vector<std::string> all = locator_.notes();
  for (const auto& more : {file_notes_, size_notes_})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

PreparedMesh GeometryLoader::make_mesh(const UrdfElement& element, double margin,
                                       std::string& source) {
  const auto* file = std::get_if<UrdfMesh>(&element.shape);
  TriangleMesh placed = file != nullptr ? read_mesh(*file, source)
                                        : std::visit(PrimitiveMaker{source, margin}, element.shape);
  place(file != nullptr ? file->scale : Eigen::Vector3d::Ones(), element.origin, placed);
  PreparedMesh mesh(placed);
  if (mesh.triangles.empty())
    throw InputError(source + ": no triangle has an area; check the unit and the scale");
  return mesh;
}

TriangleMesh GeometryLoader::read_mesh(const UrdfMesh& mesh, std::string& source) {
  source = mesh.filename;
  const auto path = locator_.locate(mesh.filename);
  source = path.string();
  return read_file(path);
}

const TriangleMesh& GeometryLoader::read_file(const std::filesystem::path& file) {
  const auto [at, is_new] = files_.try_emplace(file);
  if (!is_new) return at->second;
  try {
    at->second = load_mesh(file, file_notes_);
  } catch (...) {
    files_.erase(at);
    throw;
  }
  return at->second;
}

}  // namespace penumbra::detail
