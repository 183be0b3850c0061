// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/mesh/mesh_formats.hpp>

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

namespace penumbra::mesh_formats {
namespace {

using Json = nlohmann::json;

constexpr int deepest_value = 200;
constexpr std::uint64_t largest_size = FileLimit::data;  // products of two do not overflow

template <typename T>
T value_at(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// An index into an array of the file.
std::size_t index_in(const Json& value) {
  if (!value.is_number_unsigned()) damaged("glTF: an index is not an integer");
  return value.get<std::size_t>();
}

/// A count, size or offset in bytes.
std::uint64_t size_in(const Json& object, const char* name, std::uint64_t otherwise) {
  if (!object.contains(name)) return otherwise;
  const Json& value = object.at(name);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > largest_size)
    damaged("glTF: " + std::string(name) + " is no size up to " + std::to_string(largest_size));
  return value.get<std::uint64_t>();
}

/// Whether an extension changes only the appearance of surfaces. Other extensions that a file
/// requires (compressed vertices, instances, levels of detail) change their geometry.
bool is_appearance(const std::string& extension) {
  constexpr std::array<std::string_view, 9> prefixes = {
      "KHR_materials_", "KHR_texture_", "KHR_lights_",   "KHR_xmp",         "KHR_techniques_webgl",
      "EXT_texture_",   "EXT_lights_",  "MSFT_texture_", "ADOBE_materials_"};
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return extension.starts_with(prefix); });
}

bool is_morphed(const Json& owner) {
  if (!owner.contains("weights")) return false;
  const auto weights = owner.at("weights").get<std::vector<double>>();
  return std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0.0; });
}

std::string from_base64(std::string_view text) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t word = 0;
  unsigned bits = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) damaged("glTF: a data URI is not base64");
    word = word << 6U | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(word >> bits & 0xFFU);
  }
  return bytes;
}

/// The parts of a file; a .gltf file has no binary part.
struct Parts {
  std::string_view json;
  std::string_view binary;
};

Parts parts_of_glb(std::string_view bytes) {
  constexpr std::size_t header_size = 12;
  const auto word_at = [&](std::size_t at) { return value_at<std::uint32_t>(bytes.data() + at); };
  if (bytes.size() < header_size || !bytes.starts_with("glTF"))
    damaged("GLB: it does not begin with 'glTF'");
  if (word_at(4) != 2)
    throw FormatError("GLB: version " + std::to_string(word_at(4)) +
                      " is not supported; export it as glTF 2.0");
  if (word_at(8) != bytes.size())
    damaged("GLB: its header promises " + std::to_string(word_at(8)) + " bytes, it has " +
            std::to_string(bytes.size()));
  Parts parts;
  for (std::size_t at = header_size; at < bytes.size();) {
    if (bytes.size() - at < 8 || word_at(at) > bytes.size() - at - 8)
      damaged("GLB: a chunk reaches beyond the file's end");
    const std::string_view chunk = bytes.substr(at + 8, word_at(at));
    const std::string_view type = bytes.substr(at + 4, 4);
    if (type == "JSON" && parts.json.empty()) parts.json = chunk;
    if (type == std::string_view("BIN\0", 4) && parts.binary.empty()) parts.binary = chunk;
    at += 8 + chunk.size();
  }
  return parts;
}

/// Reads the triangles of a scene.
class GltfReader {
 public:
  GltfReader(const Json& root, std::string_view binary, const std::filesystem::path& folder)
      : root_(root) {
    if (!root.contains("buffers")) return;
    for (const Json& buffer : root.at("buffers"))
      buffers_.push_back(read_buffer(buffer, binary, folder));
  }

  TriangleMesh read() {
    if (root_.contains("extensionsRequired"))
      for (const Json& name : root_.at("extensionsRequired"))
        if (!is_appearance(name.get<std::string>()))
          throw FormatError("glTF: it requires the extension " +
                            name.get<std::string>().substr(0, 60) +
                            ", which is not supported; export it without");
    struct Visit {
      std::size_t node;
      Eigen::Affine3d T_file_parent;
    };
    std::vector<Visit> todo;
    std::set<std::size_t> reached;  // nodes form trees
    const auto add = [&](const Json& nodes, const Eigen::Affine3d& T_file_parent) {
      for (const Json& node : nodes) {
        todo.push_back({index_in(node), T_file_parent});
        if (!reached.insert(todo.back().node).second)
          damaged("glTF: node " + std::to_string(todo.back().node) + " has two parents");
      }
    };
    const Json& scene = root_.at("scenes").at(size_in(root_, "scene", 0));
    if (scene.contains("nodes")) add(scene.at("nodes"), Eigen::Affine3d::Identity());
    while (!todo.empty()) {
      const Json& node = root_.at("nodes").at(todo.back().node);
      const Eigen::Affine3d T_file_node = todo.back().T_file_parent * pose_of(node);
      todo.pop_back();
      if (node.contains("mesh")) show(node, T_file_node);
      if (node.contains("children")) add(node.at("children"), T_file_node);
    }
    return std::move(mesh_);
  }

 private:
  static std::string read_buffer(const Json& buffer, std::string_view binary,
                                 const std::filesystem::path& folder) {
    const std::uint64_t size = size_in(buffer, "byteLength", 0);
    std::string bytes(binary);
    if (buffer.contains("uri")) {
      const auto uri = buffer.at("uri").get<std::string>();
      const std::size_t data = uri.starts_with("data:") ? uri.find(";base64,") : std::string::npos;
      bytes = data != std::string::npos ? from_base64(std::string_view(uri).substr(data + 8))
                                        : read_file(folder / uri);
    }
    if (bytes.size() < size)
      damaged("glTF: a buffer has " + std::to_string(bytes.size()) + " of " + std::to_string(size) +
              " bytes");
    bytes.resize(size);
    return bytes;
  }

  static std::string read_file(const std::filesystem::path& file) {
    try {
      return read_whole_file(file, FileLimit::data);
    } catch (const InputError& error) {
      throw FormatError(std::string("glTF: its buffer ") + error.what() +
                        "; copy it to the mesh's folder");
    }
  }

  static std::vector<double> numbers_in(const Json& node, const char* name, std::size_t count) {
    auto numbers = node.at(name).get<std::vector<double>>();
    if (numbers.size() != count)
      damaged("glTF: a node's " + std::string(name) + " has " + std::to_string(numbers.size()) +
              " of " + std::to_string(count) + " numbers");
    return numbers;
  }

  static Eigen::Quaterniond rotation_of(const Json& node) {
    constexpr double most_off = 1e-4;  // as for all rotations in files (docs/method.md)
    const auto n = numbers_in(node, "rotation", 4);
    const Eigen::Quaterniond rotation(n[3], n[0], n[1], n[2]);
    if (!(std::abs(rotation.norm() - 1.0) <= most_off))
      throw FormatError(
          "glTF: a node's rotation is no quaternion of length 1; normalise it, or export the file "
          "again");
    return rotation.normalized();
  }

  static Eigen::Affine3d pose_of(const Json& node) {
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    if (node.contains("matrix")) {
      const auto n = numbers_in(node, "matrix", 16);
      pose.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix4d>(n.data()).topRows<3>();
      return pose;
    }
    const auto vector = [&](const char* name) {
      return Eigen::Vector3d(numbers_in(node, name, 3).data());
    };
    if (node.contains("translation")) pose.translate(vector("translation"));
    if (node.contains("rotation")) pose.rotate(rotation_of(node));
    if (node.contains("scale")) pose.scale(vector("scale"));
    return pose;
  }

  /// Adds the mesh of a node. Refuses skins, morphs and instances.
  void show(const Json& node, const Eigen::Affine3d& T_file_node) {
    constexpr const char* instancing = "EXT_mesh_gpu_instancing";
    const Json& mesh = root_.at("meshes").at(index_in(node.at("mesh")));
    if (node.contains("skin") || is_morphed(node) || is_morphed(mesh))
      throw FormatError(
          "glTF: a mesh has a skin or morph weights, which are not supported; export it without");
    if (node.contains("extensions") && node.at("extensions").contains(instancing))
      throw FormatError(std::string("glTF: a node repeats its mesh by ") + instancing +
                        ", which is not supported; export every copy as a node of its own");
    for (const Json& primitive : mesh.at("primitives"))
      append_placed(triangles_of(primitive), T_file_node, mesh_);
  }

  /// The elements of an accessor in their buffer.
  struct Elements {
    const char* first;
    std::size_t count, stride;

    [[nodiscard]] const char* at(std::size_t i) const { return first + i * stride; }
  };

  [[nodiscard]] Elements elements_of(const Json& accessor, std::size_t element_size) const {
    if (accessor.contains("sparse"))
      throw FormatError(
          "glTF: it has a sparse accessor, which is not supported; export it without");
    const Json& view = root_.at("bufferViews").at(index_in(accessor.at("bufferView")));
    const std::size_t buffer = index_in(view.at("buffer"));
    const std::uint64_t stride = size_in(view, "byteStride", element_size);
    const std::uint64_t count = size_in(accessor, "count", 0);
    const std::uint64_t offset = size_in(accessor, "byteOffset", 0);
    const std::uint64_t view_offset = size_in(view, "byteOffset", 0);
    const std::uint64_t length = size_in(view, "byteLength", 0);
    if (stride < element_size) damaged("glTF: an element of a bufferView reaches into the next");
    if (offset + stride * count + element_size > length + stride)
      damaged("glTF: an accessor reaches beyond its bufferView of " + std::to_string(length) +
              " bytes");
    if (buffer >= buffers_.size() || view_offset + length > buffers_[buffer].size())
      damaged("glTF: a bufferView reaches beyond its buffer");
    return {buffers_[buffer].data() + view_offset + offset, count, stride};
  }

  [[nodiscard]] std::vector<Eigen::Vector3f> positions_of(const Json& accessor) const {
    constexpr int float32 = 5126;
    if (accessor.at("type") != "VEC3" || accessor.at("componentType") != float32)
      throw FormatError(
          "glTF: positions must be \"VEC3\" of component type 5126 (float); export it without "
          "quantisation");
    const Elements elements = elements_of(accessor, sizeof(Eigen::Vector3f));
    std::vector<Eigen::Vector3f> positions(elements.count);
    for (std::size_t i = 0; i < elements.count; ++i)
      std::memcpy(positions[i].data(), elements.at(i), sizeof(Eigen::Vector3f));
    return positions;
  }

  template <typename T>
  [[nodiscard]] std::vector<std::uint32_t> integers_of(const Json& accessor) const {
    const Elements elements = elements_of(accessor, sizeof(T));
    std::vector<std::uint32_t> integers(elements.count);
    for (std::size_t i = 0; i < elements.count; ++i) integers[i] = value_at<T>(elements.at(i));
    return integers;
  }

  [[nodiscard]] std::vector<std::uint32_t> indices_of(const Json& accessor) const {
    const std::uint64_t type = size_in(accessor, "componentType", 0);
    if (type == 5121) return integers_of<std::uint8_t>(accessor);
    if (type == 5123) return integers_of<std::uint16_t>(accessor);
    if (type == 5125) return integers_of<std::uint32_t>(accessor);
    damaged("glTF: indices are of component type " + std::to_string(type));
  }

  [[nodiscard]] TriangleMesh triangles_of(const Json& primitive) const {
    const std::uint64_t mode = size_in(primitive, "mode", 4);
    if (mode < 4) return {};  // points and lines
    if (mode > 6) damaged("glTF: a primitive has mode " + std::to_string(mode));
    const Json& accessors = root_.at("accessors");
    TriangleMesh mesh;
    mesh.vertices = positions_of(accessors.at(index_in(primitive.at("attributes").at("POSITION"))));
    std::vector<std::uint32_t> corners(mesh.vertices.size());
    std::iota(corners.begin(), corners.end(), 0U);
    if (primitive.contains("indices"))
      corners = indices_of(accessors.at(index_in(primitive.at("indices"))));
    for (const std::uint32_t corner : corners)
      static_cast<void>(vertex_index(corner, mesh.vertices.size(), "glTF"));
    if (mode == 4 && corners.size() % 3 != 0)
      damaged("glTF: " + std::to_string(corners.size()) + " corners do not make whole triangles");
    const std::size_t step = mode == 4 ? 3 : 1;
    for (std::size_t i = 2; i < corners.size(); i += step) {
      if (mode == 4) mesh.triangles.push_back({corners[i - 2], corners[i - 1], corners[i]});
      if (mode == 5)
        mesh.triangles.push_back({corners[i - 2], corners[i - 1 + i % 2], corners[i - i % 2]});
      if (mode == 6) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
    return mesh;
  }

  const Json& root_;
  std::vector<std::string> buffers_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_gltf(const std::filesystem::path& file, std::string_view bytes, bool binary) {
  const Parts parts = binary ? parts_of_glb(bytes) : Parts{bytes, {}};
  try {
    const Json root = Json::parse(parts.json, [](int depth, Json::parse_event_t, const Json&) {
      if (depth > deepest_value)
        damaged("glTF: values are nested more than " + std::to_string(deepest_value) + " deep");
      return true;
    });
    return GltfReader(root, parts.binary, file.parent_path()).read();
  } catch (const Json::exception& error) {
    damaged(std::string("glTF: ") + error.what());
  }
}

}  // namespace penumbra::mesh_formats
