// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/temporary_folder.hpp"
#include "../support/test.hpp"

#include <penumbra/mesh/prepared_mesh.hpp>

/// Small mesh files of each format: a tetrahedron with corners 0, 2x, 3y, 4z metres (volume 4).
namespace penumbra::test {

inline constexpr double tetrahedron_volume = 4.0;

inline TriangleMesh tetrahedron(float x = 2, float y = 3, float z = 4) {
  return {{{0, 0, 0}, {x, 0, 0}, {0, y, 0}, {0, 0, z}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// The text with one place changed.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("no " + what);
  return text.replace(at, what.size(), by);
}

template <typename T>
void put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

inline std::string binary_stl(const TriangleMesh& mesh, std::string header = "binary") {
  header.resize(80, ' ');
  std::string bytes = header;
  put(bytes, std::uint32_t(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t corner : t)
      for (int axis = 0; axis < 3; ++axis) put(bytes, mesh.vertices[corner][axis]);
    bytes.append(2, '\0');
  }
  return bytes;
}

inline std::string ascii_stl(const TriangleMesh& mesh) {
  std::string text = "solid part\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const std::uint32_t corner : t) {
      text += "  vertex";
      for (int axis = 0; axis < 3; ++axis)
        text += " " + std::to_string(mesh.vertices[corner][axis]);
      text += "\n";
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

inline std::string obj() {
  return "# a tetrahedron\nmtllib nowhere.mtl\nv 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 4\n"
         "vn 0 0 1\nvt 0 0\nusemtl none\nf 1 3 2\nf 1/1 2/1 4/1\nf 1//1 4//1 3//1\nf -3 -2 -1\n";
}

inline std::string ascii_ply() {
  return "ply\nformat ascii 1.0\ncomment text\nelement vertex 4\nproperty float x\n"
         "property float y\nproperty float z\nelement face 4\n"
         "property list uchar int vertex_indices\nend_header\n"
         "0 0 0\n2 0 0\n0 3 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

inline std::string binary_ply() {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar red\nelement face 4\n"
      "property list uchar int vertex_indices\nend_header\n";
  const TriangleMesh mesh = tetrahedron();
  for (const auto& v : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) put(bytes, v[axis]);
    bytes += '\x7f';
  }
  for (const auto& t : mesh.triangles) {
    bytes += '\x03';
    for (const std::uint32_t corner : t) put(bytes, corner);
  }
  return bytes;
}

inline std::string collada_node(const std::string& transform = "", const std::string& id = "n") {
  return "<node id=\"" + id + "\">" + transform + "<instance_geometry url=\"#tet\"/></node>";
}

/// `asset` is the content of <asset>, `nodes` that of the scene.
inline std::string collada(const std::string& asset = "",
                           const std::string& nodes = collada_node()) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
         "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
         "<asset>" +
         asset +
         "</asset>\n"
         "<library_geometries><geometry id=\"tet\" name=\"tet\"><mesh>\n"
         "<source id=\"p\"><float_array id=\"pa\" count=\"12\">0 0 0 2 0 0 0 3 0 0 0 4"
         "</float_array><technique_common><accessor source=\"#pa\" count=\"4\" stride=\"3\">"
         "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
         "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\n"
         "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
         "<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>\n"
         "<library_visual_scenes><visual_scene id=\"s\">" +
         nodes +
         "</visual_scene></library_visual_scenes>\n"
         "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";
}

inline const std::string vertex_input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";

/// A Collada file whose primitive runs over the corners of a plane rectangle.
inline std::string with_primitive(const std::string& primitive) {
  std::string text = replaced(collada("<unit meter=\"0.5\"/>"), "0 0 0 2 0 0 0 3 0 0 0 4",
                              "0 0 1 2 0 1 2 3 2 0 3 2");
  const std::size_t begin = text.find("<triangles");
  return text.replace(begin, text.find("</mesh>") - begin, primitive);
}

inline std::string gltf_buffer() {
  std::string buffer;
  const TriangleMesh mesh = tetrahedron();
  for (const auto& v : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) put(buffer, v[axis]);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t corner : t) put(buffer, std::uint16_t(corner));
  return buffer;
}

/// `uri` is the buffer's key with its comma in front; empty for GLB.
inline std::string gltf_json(const std::string& uri, const std::string& node = "") {
  return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
         "\"nodes\":[{\"mesh\":0" +
         node +
         "}],"
         "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
         "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
         "\"min\":[0,0,0],\"max\":[2,3,4]},"
         "{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],"
         "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
         "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],"
         "\"buffers\":[{\"byteLength\":72" +
         uri + "}]}";
}

inline std::string glb(const std::string& node = "") {
  std::string json = gltf_json("", node);
  while (json.size() % 4 != 0) json += ' ';
  const std::string buffer = gltf_buffer();
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, std::uint32_t(12 + 8 + json.size() + 8 + buffer.size()));
  put(bytes, std::uint32_t(json.size()));
  bytes += "JSON" + json;
  put(bytes, std::uint32_t(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

struct Sample {
  std::string name;
  std::string bytes;
};

inline std::vector<Sample> samples() {
  return {{"a.stl", binary_stl(tetrahedron())},
          {"solid.stl", binary_stl(tetrahedron(), "solid made by a CAD")},
          {"ascii.stl", ascii_stl(tetrahedron())},
          {"a.obj", obj()},
          {"ascii.ply", ascii_ply()},
          {"a.ply", binary_ply()},
          {"a.dae", collada("<unit name=\"meter\" meter=\"1\"/>", collada_node())},
          {"a.glb", glb()},
          {"a.gltf", gltf_json(",\"uri\":\"a.bin\"")}};
}

}  // namespace penumbra::test
