// SPDX-License-Identifier: Apache-2.0
// The arm as files: URDF, and meshes in the formats that real robots come in.
#include "arm.hpp"
#include "text.hpp"

#include <bit>
#include <cstring>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

namespace example {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

std::string stl(const Mesh& mesh, double unit) {
  std::string bytes(80, '\0');
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d normal = (mesh.vertices[b] - mesh.vertices[a])
                                .cross(mesh.vertices[c] - mesh.vertices[a])
                                .normalized();
    for (const Vector3d& v : {normal, Vector3d(mesh.vertices[a] / unit),
                              Vector3d(mesh.vertices[b] / unit), Vector3d(mesh.vertices[c] / unit)})
      for (int i = 0; i < 3; ++i) put(static_cast<float>(v[i]));
    put(std::uint16_t{0});
  }
  return bytes;
}

std::string obj(const Mesh& mesh) {
  std::ostringstream out;
  out << "# SPDX-License-Identifier: Apache-2.0\n";
  for (const auto& v : mesh.vertices) out << "v " << fixed(v, 6) << '\n';
  for (const auto& t : mesh.triangles)
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return out.str();
}

/// Collada in millimetres, drawn in another frame that the node's matrix undoes.
std::string collada(const Mesh& mesh) {
  Isometry3d T_link_drawn = Isometry3d::Identity();
  T_link_drawn.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T_link_drawn.translation() << 0.0, 0.115, 0.0;
  const Mesh drawn = moved(mesh, T_link_drawn.inverse());

  std::ostringstream positions, indices, matrix;
  for (const auto& v : drawn.vertices) positions << fixed(1000.0 * v, 3) << ' ';
  for (const auto& t : drawn.triangles) indices << t[0] << ' ' << t[1] << ' ' << t[2] << ' ';
  for (int r = 0; r < 3; ++r)
    matrix << fixed(Vector3d(T_link_drawn.linear().row(r).transpose()), 0) << ' '
           << 1000.0 * T_link_drawn.translation()[r] << ' ';
  const auto count = drawn.vertices.size();

  std::ostringstream out;
  out << R"(<?xml version="1.0" encoding="utf-8"?>
<!-- SPDX-License-Identifier: Apache-2.0 -->
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset>
    <created>2026-01-01T00:00:00</created><modified>2026-01-01T00:00:00</modified>
    <unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis>
  </asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p">
      <float_array id="pa" count=")"
      << 3 * count << "\">" << positions.str() << R"(</float_array>
      <technique_common><accessor source="#pa" count=")"
      << count << R"(" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common>
    </source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count=")"
      << drawn.triangles.size() << R"("><input semantic="VERTEX" source="#v" offset="0"/>
      <p>)"
      << indices.str() << R"(</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s">
    <node id="n"><matrix>)"
      << matrix.str() << R"(0 0 0 1</matrix><instance_geometry url="#g"/></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
  return out.str();
}

std::string origin_element(const Origin& origin) {
  return "<origin xyz=\"" + shortest(origin.xyz) + "\" rpy=\"" + shortest(origin.rpy) + "\"/>";
}

std::string geometry_element(const Part& part) {
  struct Writer {
    const Part& part;
    std::string operator()(const Sphere& s) const {
      return "<sphere radius=\"" + shortest(s.radius) + "\"/>";
    }
    std::string operator()(const Cylinder& c) const {
      return "<cylinder radius=\"" + shortest(c.radius) + "\" length=\"" + shortest(c.length) +
             "\"/>";
    }
    std::string operator()(const Capsule& c) const {
      return "<capsule radius=\"" + shortest(c.radius) + "\" length=\"" + shortest(c.length) +
             "\"/>";
    }
    std::string operator()(const Box& b) const {
      return "<box size=\"" + shortest(b.size) + "\"/>";
    }
    std::string operator()(const std::shared_ptr<const TracedMesh>&) const {
      const std::string scale =
          part.scale == Vector3d::Ones() ? "" : "\" scale=\"" + shortest(part.scale);
      return "<mesh filename=\"package://arm_description/meshes/" + part.file + scale + "\"/>";
    }
  };
  return "<geometry>" + std::visit(Writer{part}, part.shape) + "</geometry>";
}

void write_link(std::ostream& out, const std::string& link, const std::vector<Part>& parts) {
  out << "  <link name=\"" << link << "\">\n";
  for (const auto& part : parts) {
    if (part.link != link) continue;
    const std::string body = origin_element(part.origin) + geometry_element(part);
    out << "    <visual>" << body << "<material name=\"" << part.material << "\"/></visual>\n"
        << "    <collision>" << body << "</collision>\n";
  }
  out << "  </link>\n";
}

void write_joint(std::ostream& out, const ArmJoint& joint) {
  out << "  <joint name=\"" << joint.name << "\" type=\"" << joint.type << "\">\n    "
      << origin_element(joint.origin) << "<parent link=\"" << joint.parent << "\"/><child link=\""
      << joint.child << "\"/>\n";
  if (joint.type != "fixed") out << "    <axis xyz=\"" << shortest(joint.axis) << "\"/>";
  if (joint.type == "revolute")
    out << "<limit lower=\"-3.1\" upper=\"3.1\" effort=\"100\" velocity=\"3\"/>";
  if (joint.type == "prismatic")
    out << "<limit lower=\"0\" upper=\"0.045\" effort=\"50\" velocity=\"0.2\"/>";
  if (joint.mimics) out << "<mimic joint=\"gripper_left\" multiplier=\"1\" offset=\"0\"/>";
  out << "\n  </joint>\n";
}

}  // namespace

std::string Arm::urdf() const {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<!-- SPDX-License-Identifier: Apache-2.0 -->\n"
         "<robot name=\"six_axis_arm\">\n";
  std::set<std::string> materials;
  for (const auto& part : parts_) {
    if (materials.insert(part.material).second)
      out << "  <material name=\"" << part.material << "\"><color rgba=\""
          << shortest(part.colour()) << " 1\"/></material>\n";
  }
  write_link(out, "base_link", parts_);
  for (const auto& joint : joints_) {
    write_joint(out, joint);
    write_link(out, joint.child, parts_);
  }
  out << "</robot>\n";
  return out.str();
}

void Arm::write(const std::filesystem::path& folder) const {
  std::filesystem::create_directories(folder / "meshes");
  write_file(folder / "arm.urdf", urdf());
  for (const auto& part : parts_) {
    const auto* traced = std::get_if<std::shared_ptr<const TracedMesh>>(&part.shape);
    if (traced == nullptr || part.scale.y() < 0.0) continue;
    const Mesh& mesh = (*traced)->mesh();
    const std::string kind = std::filesystem::path(part.file).extension().string();
    write_file(folder / "meshes" / part.file, kind == ".stl"   ? stl(mesh, part.scale.x())
                                              : kind == ".obj" ? obj(mesh)
                                                               : collada(mesh));
  }
}

}  // namespace example
