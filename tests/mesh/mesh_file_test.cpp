// SPDX-License-Identifier: Apache-2.0
#include "../support/test.hpp"
#include "mesh_oracle.hpp"
#include "mesh_samples.hpp"

#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/mesh/mesh_formats.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra::test {
namespace {

constexpr double float_rounding = 1e-5;  // of volumes of a few cubic metres from float corners

Vector3f upper_corner(const TriangleMesh& mesh) {
  Vector3f corner = mesh.vertices.front();
  for (const auto& v : mesh.vertices) corner = corner.cwiseMax(v);
  return corner;
}

/// The tetrahedron times `unit`.
void expect_tetrahedron(const TriangleMesh& mesh, double unit = 1.0) {
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_TRUE(PreparedMesh(mesh).watertight);
  const Vector3f corner = (Vector3d(2, 3, 4) * unit).cast<float>();
  EXPECT_TRUE(upper_corner(mesh).isApprox(corner, 1e-6F)) << upper_corner(mesh).transpose();
  EXPECT_NEAR(signed_volume(mesh) / (unit * unit * unit), tetrahedron_volume, float_rounding);
}

class MeshFile : public ::testing::Test {
 protected:
  TriangleMesh load(const std::string& name, const std::string& bytes) {
    return load_mesh(folder_.write(name, bytes));
  }
  TriangleMesh load_collada(const std::string& asset = "",
                            const std::string& nodes = collada_node()) {
    return load("a.dae", collada(asset, nodes));
  }
  TemporaryFolder folder_;
};

std::string upper(std::string text) {
  for (char& c : text) c = char(std::toupper(c));
  return text;
}

TEST_F(MeshFile, EveryFormatGivesTheSameSolid) {
  folder_.write("a.bin", gltf_buffer());
  for (const auto& [name, bytes] : samples())
    for (const std::string& file : {name, upper(name)}) {
      SCOPED_TRACE(file);
      expect_tetrahedron(load(file, bytes));
    }
}

/// The text with its lines ended otherwise.
std::string with_line_ends(const std::string& text, const std::string& line_end) {
  std::string result;
  for (const char c : text) result += c == '\n' ? line_end : std::string(1, c);
  return result;
}

TEST_F(MeshFile, AsciiStlTakesWhatExportersWrite) {
  const std::string text = ascii_stl(tetrahedron());
  expect_tetrahedron(load("upper.stl", upper(text)));
  expect_tetrahedron(load("crlf.stl", with_line_ends(text, "\r\n")));
  expect_tetrahedron(
      load("nan.stl", replaced(text, "normal 0 0 0", "normal nan -nan(ind) 1.#IND")));
  EXPECT_EQ(load("tiny.stl", replaced(text, "0.000000", "+1.0e-60")).triangles.size(), 4U);
  EXPECT_NEAR(signed_volume(load("two.stl", text + text)), 2 * tetrahedron_volume, float_rounding);
}

TEST_F(MeshFile, ObjNumbersAndLinesMayBeWrittenAsTheFormatAllows) {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const auto expect_half = [&](const std::string& vertices) {
    SCOPED_TRACE(vertices);
    expect_tetrahedron(load("a.obj", vertices + faces), 0.25);
  };
  expect_half("v 0 0 0\nv .5 0 0\nv 0 .75 0\nv 0 0 1.\n");
  expect_half("v 0 0 0\nv .5 0 0\nv 0 .75 0\nv 0 0 1\nv 9 9 9\nv 9 9 9\n");  // two unused
  expect_half("v -.0 0. 0\nv +.5 0 0\nv 0 75.e-2 0\nv 0 0 .1E+1\n");
  expect_half("  v  0 0 0\n\tv .5 0 0 \n v 0\t.75 0\nv 0 0 1 # the tip\n");
  for (const char* more : {"1", "1.0", ".2 .3 1", "0.2 0.3 1", ".2 .3 1 .5", "1 .2 .3 1"}) {
    const std::string end = std::string(" ") + more + "\n";
    std::string lines;
    for (const char* corner : {"0 0 0", ".5 0 0", "0 .75 0", "0 0 1"})
      lines.append("v ").append(corner).append(end);
    expect_half(lines);
  }
  for (const char* line_end : {"\r\n", "\r"})
    expect_tetrahedron(load("a.obj", with_line_ends(obj(), line_end)));
}

/// The tetrahedron with coordinates of type T and indices of type Index, among other data.
template <typename T, typename Index>
std::string ply_of(const std::string& type, const std::string& index_type, bool big_endian) {
  std::string bytes = std::string("ply\r\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\r\nelement camera 1\r\nproperty list uint double views\r\n" +
                      "element vertex 4\r\nproperty " + type + " z\r\nproperty short quality\r\n" +
                      "property " + type + " x\r\nproperty " + type + " y\r\nelement face 4\r\n" +
                      "property list ushort float uv\r\nproperty list uchar " + index_type +
                      " vertex_index\r\nproperty char flags\r\nend_header\r\n";
  const auto put = [&](auto value) {
    std::string raw;
    test::put(raw, value);
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  };
  const TriangleMesh mesh = tetrahedron();
  put(std::uint32_t{2});
  for (const double view : {0.5, 1.5}) put(view);
  for (const auto& v : mesh.vertices) {
    put(static_cast<T>(v.z()));
    put(std::int16_t{-7});
    for (int axis = 0; axis < 2; ++axis) put(static_cast<T>(v[axis]));
  }
  for (const auto& t : mesh.triangles) {
    put(std::uint16_t{1});
    put(0.25F);
    put(std::uint8_t{3});
    for (const std::uint32_t corner : t) put(static_cast<Index>(corner));
    put(std::int8_t{-1});
  }
  return bytes;
}

TEST_F(MeshFile, PlyOfAnyTypeAndByteOrder) {
  for (const bool big : {false, true}) {
    SCOPED_TRACE(big);
    expect_tetrahedron(load("a.ply", ply_of<float, std::int32_t>("float", "int", big)));
    expect_tetrahedron(load("b.ply", ply_of<double, std::uint32_t>("double", "uint32", big)));
    expect_tetrahedron(load("c.ply", ply_of<std::int16_t, std::int8_t>("int16", "char", big)));
    expect_tetrahedron(load("d.ply", ply_of<std::uint8_t, std::uint16_t>("uint8", "ushort", big)));
  }
}

TEST_F(MeshFile, FoldedQuadsAreRead) {
  const std::string corners = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv .5 2 0\n";
  EXPECT_EQ(load("quad.obj", corners + "f 1 2 3 4\nf 1 2 5\n").triangles.size(), 3U);
}

TEST_F(MeshFile, ColladaUnitIsAppliedOnceAndItsUpAxisIgnored) {
  const std::pair<const char*, double> assets[] = {
      {"", 1.0},
      {"<unit name=\"meter\" meter=\"1\"/>", 1.0},
      {"<unit name=\"meter\"/>", 1.0},
      {"<unit name=\"mm\" meter=\"0.001\"/>", 0.001},
      {"<up_axis>X_UP</up_axis>", 1.0},
      {"<unit meter=\"0.1\"/><up_axis>Y_UP</up_axis>", 0.1},
      {"<up_axis>Z_UP</up_axis>", 1.0}};
  for (const auto& [asset, unit] : assets) {
    SCOPED_TRACE(asset);
    expect_tetrahedron(load_collada(asset), unit);
  }
  const TriangleMesh moved = load_collada("<unit name=\"inch\" meter=\"0.0254\"/>",
                                          collada_node("<translate>10 0 0</translate>"));
  EXPECT_TRUE(upper_corner(moved).isApprox(Vector3f(12, 3, 4) * 0.0254F, 1e-6F));
}

TEST_F(MeshFile, MirroredNodesAreWoundAgain) {
  const TriangleMesh mesh = load_collada("", collada_node("<scale>-1 1 1</scale>"));
  EXPECT_NEAR(signed_volume(mesh), tetrahedron_volume, float_rounding);
  EXPECT_FLOAT_EQ(upper_corner(mesh).x(), 0.0F);
  const TriangleMesh twice = load_collada("", collada_node("<scale>-1 -1 1</scale>"));
  EXPECT_NEAR(signed_volume(twice), tetrahedron_volume, float_rounding);
  const TriangleMesh gltf = load("m.glb", glb(",\"scale\":[1,-1,1]"));
  EXPECT_NEAR(signed_volume(gltf), tetrahedron_volume, float_rounding);
}

TEST_F(MeshFile, GltfBuffersMayLieInTheFile) {
  const std::string buffer =
      "AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAQEAAAAAAAAAAAAAAAAAAAIBAAAACAA"
      "EAAAABAAMAAAADAAIAAQACAAMA";
  expect_tetrahedron(load(
      "a.gltf", gltf_json(",\"uri\":\"data:application/octet-stream;base64," + buffer + "\"")));
}

TEST_F(MeshFile, GltfStripsAndFansAreRead) {
  for (const std::string mode : {"5", "6"}) {
    std::string bytes =
        gltf_json(",\"uri\":\"a.bin\"", ",\"matrix\":[0,2,0,0,-2,0,0,0,0,0,2,0,1,0,0,1]");
    bytes.replace(bytes.find("\"indices\":1"), 11, "\"mode\":" + mode);
    folder_.write("a.bin", gltf_buffer());
    const TriangleMesh mesh = load("a.gltf", bytes);
    EXPECT_EQ(mesh.triangles.size(), 2U) << mode;
    EXPECT_TRUE(upper_corner(mesh).isApprox(Vector3f(1, 4, 8), 1e-6F));
    // Four corners without indices: the strip's second triangle is 1 3 2, the fan's 0 2 3.
    const Vector3f last = mesh.vertices[mesh.triangles[1][0]];
    EXPECT_TRUE(last.isApprox(mode == "5" ? Vector3f(1, 4, 0) : Vector3f(1, 0, 0)));
  }
}

using Points = std::vector<Vector2d>;

constexpr double area_rounding = 1e-5;  // of areas of a few square metres from float corners

/// The triangles are wound as the polygon is and together have its area: they cover it once.
void expect_covered(const Points& points, const Isometry3d& place) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> polygon;
  double twice = 0.0;  // the signed area
  for (const Vector2d& p : points) {
    polygon.push_back(std::uint32_t(polygon.size()));
    mesh.vertices.push_back((place * Vector3d(p.x(), p.y(), 0.0)).cast<float>());
    const Vector2d& next = points[polygon.size() % points.size()];
    twice += p.x() * next.y() - p.y() * next.x();
  }
  mesh_formats::append_polygon(polygon, mesh);
  EXPECT_EQ(mesh.triangles.size(), points.size() - 2);
  const Vector3d normal = place.linear().col(2) * (twice < 0.0 ? -1.0 : 1.0);
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = corners(mesh, i);
    const Vector3d across = (b - a).cross(c - a);
    EXPECT_GT(across.dot(normal), -area_rounding);
    area += across.norm() / 2.0;
  }
  EXPECT_NEAR(area, std::abs(twice / 2.0), area_rounding);
}

Isometry3d random_place(std::mt19937_64& random) {
  return Isometry3d(AngleAxisd(uniform(random, -M_PI, M_PI), random_direction(random)));
}

TEST(Polygon, RandomStarsAreCoveredOnce) {
  auto random = seeded_random(21);
  std::uniform_real_distribution<double> radius(0.1, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    Points points;
    const std::size_t corners = 3 + random() % 40;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * double(i) / double(corners);
      points.emplace_back(radius(random) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    if (trial % 2 == 0) std::reverse(points.begin(), points.end());
    SCOPED_TRACE(trial);
    expect_covered(points, random_place(random));
  }
}

TEST(Polygon, CombsAndCornersOnALineAreCoveredOnce) {
  auto random = seeded_random(22);
  Points comb;
  for (int i = 0; i < 50; ++i) comb.emplace_back(0.02 * i, i % 2 == 0 ? 0.0 : 0.9);
  comb.emplace_back(1.0, 1.0);
  comb.emplace_back(0.0, 1.0);
  expect_covered(comb, random_place(random));
  expect_covered({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}},
                 Isometry3d::Identity());
  expect_covered({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}}, Isometry3d::Identity());
}

}  // namespace
}  // namespace penumbra::test
