// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/mesh/mesh_formats-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

using Json = nlohmann::json;

constexpr int deepest_value = 200;  // Assimp's reader recurses

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little, "GLB is read as it lies");
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// An array of the top level; empty if there is none.
Json array_of(const Json& root, const char* name) {
  return root.contains(name) ? root.at(name) : Json::array();
}

/// Of an array of the file.
std::size_t index_in(const Json& value) {
  if (!value.is_number_unsigned()) damaged("glTF: " + value.dump().substr(0, 60) + " is no index");
  return value.get<std::size_t>();
}

/// Nodes must be trees: Assimp would follow a cycle until the stack ends.
void check_nodes(const Json& root) {
  std::set<std::uint64_t> reached;
  const auto reach = [&](const Json& owner, const char* key) {
    if (!owner.contains(key)) return;
    for (const Json& node : owner.at(key))
      if (!reached.insert(index_in(node)).second)
        damaged("glTF: node " + node.dump() + " has two parents");
  };
  for (const Json& node : array_of(root, "nodes")) reach(node, "children");
  // A node may be a root of several scenes, but not a root and a child.
  std::set<std::uint64_t> roots;
  for (const Json& scene : array_of(root, "scenes"))
    if (scene.contains("nodes"))
      for (const Json& node : scene.at("nodes")) roots.insert(index_in(node));
  for (const std::uint64_t node : roots)
    if (reached.count(node) == 1)
      damaged("glTF: node " + std::to_string(node) + " is a scene's root and has a parent");
}

/// Extensions that say how a surface looks, not where it is; what else a file requires (compressed
/// or quantised vertices, instances, levels of detail) changes what is to be drawn.
bool is_about_looks(const std::string& extension) {
  constexpr std::array<std::string_view, 9> prefixes = {
      "KHR_materials_", "KHR_texture_", "KHR_lights_",   "KHR_xmp",         "KHR_techniques_webgl",
      "EXT_texture_",   "EXT_lights_",  "MSFT_texture_", "ADOBE_materials_"};
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return extension.starts_with(prefix); });
}

void check_extensions(const Json& root) {
  for (const Json& name : array_of(root, "extensionsRequired"))
    if (!is_about_looks(name.get<std::string>()))
      throw FormatError("glTF: it requires the extension " + name.get<std::string>().substr(0, 60) +
                        ", which is not read; export it without");
}

/// Joints bend a skin, and its node's transform does not apply; morph weights move vertices.
void check_rigid(const Json& root) {
  const auto moved = [](const Json& owner) {
    for (const Json& weight : array_of(owner, "weights"))
      if (weight.get<double>() != 0.0) return true;
    return false;
  };
  for (const Json& node : array_of(root, "nodes"))
    if (node.contains("mesh") && (node.contains("skin") || moved(node)))
      throw FormatError(
          "glTF: a node bends its mesh by a skin or by morph weights; "
          "export the mesh as it stands, without them");
  for (const Json& mesh : array_of(root, "meshes"))
    if (moved(mesh))
      throw FormatError("glTF: a mesh is moved by morph weights; export it without them");
}

/// Assimp makes a rotation's length, squared, a scale, and shows one of a node's instances.
void check_transforms(const Json& root) {
  constexpr double most_off = 1e-4;  // of a rotation, as of all that are read (docs/method.md)
  constexpr const char* instancing = "EXT_mesh_gpu_instancing";
  for (const Json& node : array_of(root, "nodes")) {
    if (node.contains("extensions") && node.at("extensions").contains(instancing))
      throw FormatError(std::string("glTF: a node repeats its mesh by ") + instancing +
                        ", which is not read; export every copy as a node of its own");
    if (!node.contains("rotation")) continue;
    const auto rotation = node.at("rotation").get<std::vector<double>>();
    double squared = 0.0;
    for (const double value : rotation) squared += value * value;
    if (rotation.size() != 4 || !(std::abs(std::sqrt(squared) - 1.0) <= most_off))
      throw FormatError("glTF: a node's rotation " + node.at("rotation").dump().substr(0, 80) +
                        " is no quaternion of length 1; normalise it, or export the file again");
  }
}

constexpr std::uint64_t largest_size = FileLimit::data;  // products of two do not overflow

/// A count, size or offset in bytes.
std::uint64_t size_in(const Json& object, const char* name, std::uint64_t otherwise) {
  if (!object.contains(name)) return otherwise;
  const Json& value = object.at(name);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > largest_size)
    damaged("glTF: " + std::string(name) + " " + value.dump() + " is no size up to " +
            std::to_string(largest_size));
  return value.get<std::uint64_t>();
}

std::size_t size_of_element(const Json& accessor) {
  static const std::map<std::string, std::size_t> components = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  static const std::map<std::uint64_t, std::size_t> bytes = {{5120, 1}, {5121, 1}, {5122, 2},
                                                             {5123, 2}, {5125, 4}, {5126, 4}};
  const auto shape = components.find(accessor.at("type").get<std::string>());
  const auto type = bytes.find(size_in(accessor, "componentType", 0));
  if (shape == components.end() || type == bytes.end())
    damaged("glTF: an accessor is " + accessor.at("type").dump() + " of " +
            accessor.at("componentType").dump());
  return shape->second * type->second;
}

/// Assimp reads behind the view, or buffer, of an accessor with an offset or a stride, and patches
/// sparse ones without looking where.
void check_accessor(const Json& root, const Json& accessor) {
  if (accessor.contains("sparse"))
    throw FormatError("glTF: it has a sparse accessor, which is not read; export it without");
  const std::size_t element = size_of_element(accessor);
  if (!accessor.contains("bufferView")) return;  // zeros
  const Json& view = root.at("bufferViews").at(index_in(accessor.at("bufferView")));
  const std::uint64_t stride = size_in(view, "byteStride", element);
  const std::uint64_t count = size_in(accessor, "count", 0);
  const std::uint64_t needed = size_in(accessor, "byteOffset", 0) + stride * count;
  const std::uint64_t length = size_in(view, "byteLength", 0);
  const Json& buffer = root.at("buffers").at(index_in(view.at("buffer")));
  if (stride < element) damaged("glTF: an element reaches into the next: " + view.dump());
  if (count > 0 && needed - stride + element > length)
    damaged("glTF: an accessor reaches beyond its bufferView of " + std::to_string(length) +
            " bytes");
  if (size_in(view, "byteOffset", 0) + length > size_in(buffer, "byteLength", 0))
    damaged("glTF: a bufferView reaches beyond its buffer");
}

/// Assimp takes the bits of any component type for those of a float.
void check_positions(const Json& accessor) {
  constexpr int float32 = 5126;
  const Json& type = accessor.at("type");
  const Json& component = accessor.at("componentType");
  if (type != "VEC3" || component != float32)
    throw FormatError("glTF: positions are " + type.dump() + " of component type " +
                      component.dump() +
                      "; \"VEC3\" of 5126 (float) can be read: export it without "
                      "quantisation");
}

/// Triangles of a primitive as the file counts them.
std::size_t triangles_of(const Json& root, const Json& primitive) {
  const Json& accessors = root.at("accessors");
  const Json& positions = primitive.at("attributes").at("POSITION");
  check_positions(accessors.at(index_in(positions)));
  const Json& corners = primitive.contains("indices") ? primitive.at("indices") : positions;
  const auto count = size_in(accessors.at(index_in(corners)), "count", 0);
  switch (size_in(primitive, "mode", 4)) {
    case 4:
      return count / 3;
    case 5:
    case 6:
      return count < 2 ? 0 : count - 2;
    default:
      return 0;  // points and lines
  }
}

std::string_view json_of_glb(std::string_view bytes) {
  constexpr std::size_t header_size = 12;
  constexpr std::uint32_t magic = 0x46546C67;  // "glTF"
  constexpr std::uint32_t json = 0x4E4F534A;   // "JSON"
  if (bytes.size() < header_size || word_at(bytes, 0) != magic)
    damaged("GLB: it does not begin with 'glTF'");
  if (word_at(bytes, 4) != 2)
    throw FormatError("GLB: version " + std::to_string(word_at(bytes, 4)) +
                      "; version 2 can be read: export it as glTF 2.0");
  if (word_at(bytes, 8) != bytes.size())
    damaged("GLB: its header promises " + std::to_string(word_at(bytes, 8)) + " bytes, it has " +
            std::to_string(bytes.size()));
  std::string_view text;
  for (std::size_t at = header_size; at < bytes.size();) {
    if (bytes.size() - at < 8 || word_at(bytes, at) > bytes.size() - at - 8)
      damaged("GLB: a chunk reaches beyond the file's end");
    const std::size_t size = word_at(bytes, at);
    if (text.empty() && word_at(bytes, at + 4) == json) text = bytes.substr(at + 8, size);
    at += 8 + size;
  }
  return text;
}

}  // namespace

std::size_t check_gltf(std::string_view bytes, bool binary) {
  const std::string_view text = binary ? json_of_glb(bytes) : bytes;
  try {
    const Json root = Json::parse(text, [](int depth, Json::parse_event_t, const Json&) {
      if (depth > deepest_value)
        damaged("glTF: values are nested more than " + std::to_string(deepest_value) + " deep");
      return true;
    });
    check_extensions(root);
    check_nodes(root);
    check_rigid(root);
    check_transforms(root);
    for (const Json& buffer : array_of(root, "buffers")) size_in(buffer, "byteLength", 0);
    for (const Json& accessor : array_of(root, "accessors")) check_accessor(root, accessor);
    std::size_t triangles = 0;
    for (const Json& mesh : array_of(root, "meshes"))
      for (const Json& primitive : mesh.at("primitives"))
        triangles += triangles_of(root, primitive);
    return triangles;
  } catch (const Json::exception& error) {
    damaged(std::string("glTF: ") + error.what());
  }
}

}  // namespace penumbra::mesh_formats
