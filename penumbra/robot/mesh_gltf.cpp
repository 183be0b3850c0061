// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <cstring>
#include <set>

#include <nlohmann/json.hpp>

#include <penumbra/robot/mesh_formats-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

using Json = nlohmann::json;

constexpr int deepest = 200;  // Assimp's reader recurses

[[noreturn]] void damaged(const std::string& what) {
  throw FormatError(what + "; it is truncated or damaged; export or copy it again");
}

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

/// Nodes must be trees: Assimp would follow a cycle until the stack ends.
void check_nodes(const Json& root) {
  std::set<std::uint64_t> reached;
  const auto reach = [&](const Json& owner, const char* key) {
    if (!owner.contains(key)) return;
    for (const Json& node : owner.at(key))
      if (!reached.insert(node.get<std::uint64_t>()).second)
        damaged("glTF: node " + node.dump() + " has two parents");
  };
  for (const Json& node : array_of(root, "nodes")) reach(node, "children");
  // A node may be a root of several scenes, but not a root and a child.
  std::set<std::uint64_t> roots;
  for (const Json& scene : array_of(root, "scenes"))
    if (scene.contains("nodes"))
      for (const Json& node : scene.at("nodes")) roots.insert(node.get<std::uint64_t>());
  for (const std::uint64_t node : roots)
    if (reached.count(node) == 1)
      damaged("glTF: node " + std::to_string(node) + " is a scene's root and has a parent");
}

/// Triangles of a primitive as the file counts them.
std::size_t triangles_of(const Json& root, const Json& primitive) {
  const Json& accessor = primitive.contains("indices") ? primitive.at("indices")
                                                       : primitive.at("attributes").at("POSITION");
  const auto corners = root.at("accessors").at(accessor.get<std::size_t>()).at("count");
  const auto count = corners.get<std::size_t>();
  switch (primitive.value("mode", 4)) {
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
      if (depth > deepest)
        damaged("glTF: values are nested more than " + std::to_string(deepest) + " deep");
      return true;
    });
    check_nodes(root);
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
