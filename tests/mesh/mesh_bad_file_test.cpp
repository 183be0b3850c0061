// SPDX-License-Identifier: Apache-2.0
#include "mesh_samples.hpp"

#include <penumbra/mesh/mesh_file.hpp>

namespace penumbra::test {
namespace {

std::string refusal(const std::filesystem::path& file) {
  return test::refusal([&] { (void)load_mesh(file); });
}

class MeshBadFile : public ::testing::Test {
 protected:
  void expect_refused(const std::string& name, const std::string& bytes, const std::string& why) {
    const std::string message = refusal(folder_.write(name, bytes));
    SCOPED_TRACE(name);
    EXPECT_TRUE(holds(message, {name, why, ";"}));  // a remedy follows a semicolon
  }
  TemporaryFolder folder_;
};

TEST_F(MeshBadFile, NoMesh) {
  for (const char* name : {"e.stl", "e.dae", "e.obj", "e.ply", "e.gltf", "e.glb", "e.step"})
    expect_refused(name, "", "empty");
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
  for (const char* name : {"p.stl", "p.dae", "p.obj", "p.ply", "p.gltf", "p.glb"})
    expect_refused(name, pointer, "git lfs pull");
  expect_refused("a.step", "ISO-10303-21;", "no known mesh format");
  expect_refused("noending", "text", "no known mesh format");
}

TEST_F(MeshBadFile, NoTriangles) {
  expect_refused("a.stl", binary_stl({}), "no triangles");
  expect_refused("b.stl", "solid x\nendsolid x\n", "no triangles");
  expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n", "triangles");
  const std::string in_library = "<library_nodes>" + collada_node() + "</library_nodes>";
  for (const char* scene : {"", "<node id=\"n\"/>"}) {
    expect_refused("a.dae", collada("", scene), "shows no geometry");
    expect_refused("b.dae",
                   replaced(collada("", scene), "<library_visual_scenes>",
                            in_library + "<library_visual_scenes>"),
                   "shows no geometry");
  }
  TriangleMesh line = tetrahedron();
  for (auto& v : line.vertices) v = {v.x(), 0, 0};
  expect_refused("line.stl", binary_stl(line), "zero area");
}

TEST_F(MeshBadFile, CoordinatesThatAreNoPlaces) {
  for (const double bad : {nan, inf, -inf}) {
    TriangleMesh mesh = tetrahedron();
    mesh.vertices[2].y() = float(bad);
    expect_refused("a.stl", binary_stl(mesh), "not finite");
  }
  for (const float far : {1e30F, -1.1e6F}) {
    TriangleMesh mesh = tetrahedron();
    mesh.vertices[1].z() = far;
    expect_refused("far.stl", binary_stl(mesh), "beyond 1e6");
  }
  for (const char* bad : {"nan", "inf", "1e39", "1e30", "1e999", "abc"}) {
    expect_refused("a.obj", replaced(obj(), "v 2 0 0", std::string("v ") + bad + " 0 0"), "");
    expect_refused("a.ply", replaced(ascii_ply(), "\n2 0 0", std::string("\n") + bad + " 0 0"), "");
    expect_refused("b.stl", replaced(ascii_stl(tetrahedron()), "2.000000", bad), "");
    expect_refused("a.dae",
                   replaced(collada(), "0 2 0 0 0 3", std::string("0 ") + bad + " 0 0 0 3"), "");
  }
}

TEST_F(MeshBadFile, IndicesBeyondTheVertices) {
  expect_refused("a.obj", replaced(obj(), "f 1 3 2", "f 1 3 5"), "names vertex 5 of 4");
  expect_refused("b.obj", replaced(obj(), "f 1 3 2", "f 1 3 0"), "vertex's number");
  expect_refused("c.obj", replaced(obj(), "f -3 -2 -1", "f -5 -2 -1"), "vertex's number");
  expect_refused("d.obj", replaced(obj(), "f 1 3 2", "f 1 3"), "third corner");
  expect_refused("a.ply", replaced(ascii_ply(), "3 0 2 1", "3 0 4 1"), "names vertex 4");
  expect_refused("b.ply", replaced(ascii_ply(), "3 0 2 1", "3 0 -1 1"), "names vertex -1");
  expect_refused("a.dae", replaced(collada(), "<p>0 2 1", "<p>0 4 1"), "");
  std::string wild = glb();
  wild[wild.size() - 24] = '\x05';
  expect_refused("a.glb", wild, "");
}

TEST_F(MeshBadFile, CountsThatDoNotFit) {
  const std::string stl = binary_stl(tetrahedron());
  std::string more = stl;
  more[80] = '\x05';
  expect_refused("a.stl", more, "promises 5 triangles");
  more[83] = '\x7f';
  expect_refused("b.stl", more, "promises");
  expect_refused("c.stl", stl + "x", "but the file has");
  expect_refused("d.stl", stl + "# made by\r\n", "but the file has");
  expect_refused("e.stl", stl.substr(0, stl.size() - 3), "but the file has");
  expect_refused("a.ply", replaced(ascii_ply(), "face 4", "face 5"), "less data");
  expect_refused("b.ply", replaced(ascii_ply(), "face 4", "face 3"), "more data");
  expect_refused("c.ply", replaced(ascii_ply(), "vertex 4", "vertex 999999999999"), "");
  expect_refused("d.ply", replaced(binary_ply(), "face 4", "face 5"), "less data");
  expect_refused("a.glb", glb() + "x", "promises");
  expect_refused("a.dae", replaced(collada(), "count=\"12\"", "count=\"15\""), "");
}

TEST_F(MeshBadFile, ObjVerticesThatReadersTakeForDifferentThings) {
  const auto expect = [&](const std::string& by, const std::string& why) {
    expect_refused("a.obj", replaced(obj(), "v 2 0 0", by), why);
  };
  expect("v 2 0 0 2", "line 4: a vertex has a fourth coordinate, which is not 1");
  expect("v 2 0 0 .5", "fourth coordinate");
  expect("v 2 0", "instead of three coordinates");
  expect("v 2 0 # 0", "instead of three coordinates");
  expect("v 2 0 0 red", "instead of a colour's number");
  expect("v 2 nan 0", "instead of three coordinates");
  expect("v 2,0 0 0", "2,0");
  std::string cr = replaced(obj(), "f 1 3 2", "f 1 3 5");
  for (char& c : cr) c = c == '\n' ? '\r' : c;
  expect_refused("cr.obj", cr, "line 10: a corner names vertex 5 of 4");
}

TEST_F(MeshBadFile, GltfThatWouldBeMisread) {
  const std::string whole = gltf_json(",\"uri\":\"a.bin\"");
  folder_.write("a.bin", gltf_buffer());
  const auto expect = [&](const std::string& what, const std::string& by, const std::string& why) {
    expect_refused("a.gltf", replaced(whole, what, by), why);
  };
  expect("\"count\":12", "\"count\":11", "11 corners");
  for (const char* component : {"5120", "5121", "5122", "5123", "5125"})
    expect("\"componentType\":5126", std::string("\"componentType\":") + component,
           "export it without quantisation");
  expect("VEC3", "VEC4", "");
  expect("VEC3", "VEC2", "export it without quantisation");
  for (const char* extension :
       {"KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing", "KHR_node_visibility", "MSFT_lod", "ACME_anything"})
    expect("{\"asset\"",
           std::string("{\"extensionsRequired\":[\"KHR_materials_unlit\",\"") + extension +
               "\"],\"asset\"",
           std::string("requires the extension ") + extension);
  expect("{\"mesh\":0", "{\"mesh\":0,\"skin\":0", "skin");
  expect("{\"mesh\":0", "{\"mesh\":0,\"weights\":[0,0.5]", "morph weights");
  for (const char* rotation : {"[0,0,0.7,0.9]", "[0,0,0,0]", "[0,0,0.7073,0.7073]"})
    expect("{\"mesh\":0", std::string("{\"mesh\":0,\"rotation\":") + rotation,
           "is no quaternion of length 1");
  expect("{\"mesh\":0", "{\"mesh\":0,\"rotation\":[\"a\",0,0,1]", "glTF");
  expect("{\"mesh\":0", "{\"mesh\":0,\"rotation\":[0,0,1]", "3 of 4 numbers");
  expect("\"uri\":\"a.bin\"", "\"uri\":\"data:;base64,AA*A\"", "not base64");
  expect("{\"mesh\":0",
         "{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{}}}",
         "repeats its mesh by EXT_mesh_gpu_instancing");
  expect("{\"primitives\"", "{\"weights\":[1],\"primitives\"", "morph weights");
  expect("\"count\":4", "\"count\":4,\"sparse\":{\"count\":1}", "sparse");
  expect("\"count\":4", "\"count\":4,\"byteOffset\":4", "beyond its bufferView");
  expect("\"count\":12", "\"count\":18446744073709551615", "is no size");
  expect("\"byteLength\":72", "\"byteLength\":5000000000", "is no size");
  expect("\"byteLength\":48", "\"byteStride\":16,\"byteLength\":48", "beyond its bufferView");
  expect("\"byteLength\":48", "\"byteStride\":8,\"byteLength\":48", "into the next");
  expect("\"byteOffset\":48", "\"byteOffset\":49", "beyond its buffer");
}

TEST_F(MeshBadFile, PartsThatAreElsewhere) {
  expect_refused("a.gltf", gltf_json(",\"uri\":\"nowhere.bin\""), "");
  folder_.write("short.bin", gltf_buffer().substr(0, 60));
  expect_refused("b.gltf", gltf_json(",\"uri\":\"short.bin\""), "");
  expect_refused("a.dae", collada("", replaced(collada_node(), "#tet", "#other")), "#other");
  expect_refused("b.dae", collada("", replaced(collada_node(), "#tet", "b.dae#tet")), "refers to");
}

TEST_F(MeshBadFile, DeepNestingEndsInAnError) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<node>";
  expect_refused("a.dae", collada("", deep), "DEPTH");
  expect_refused("a.gltf", std::string(100000, '['), "nested");
  expect_refused("cycle.dae",
                 collada("",
                         "<node id=\"n\"><instance_geometry url=\"#tet\"/>"
                         "<instance_node url=\"#n\"/></node>"),
                 "");
}

/// Bytes at a sample's end without which it still says everything.
std::size_t spare_bytes(const std::string& name) {
  if (name == "ascii.stl") return 6;  // " part\n" behind endsolid
  if (name == "a.dae") return 1;
  return 0;
}

TEST_F(MeshBadFile, TruncationIsAnErrorAtEveryByte) {
  folder_.write("a.bin", gltf_buffer());
  for (const auto& [name, bytes] : samples()) {
    if (name == "a.obj") continue;  // see below
    for (std::size_t size = 0; size < bytes.size() - spare_bytes(name); ++size)
      EXPECT_FALSE(refusal(folder_.write(name, bytes.substr(0, size))).empty())
          << name << " " << size;
  }
}

TEST_F(MeshBadFile, ObjOdditiesAreRead) {
  const std::string whole = obj();  // names a material file that is not there
  const auto expect_read = [&](const std::string& text) {
    EXPECT_EQ(refusal(folder_.write("a.obj", text)), "") << text;
  };
  expect_read(whole + "a 1/1 2/1 4/1\naniso 1\nd 1\n");
  expect_read(whole + "v 9 9 9\nv 9 9 8\nl 5 6\np 5\n");
  expect_read(replaced(whole, "f 1 3 2\n", "f 1 \\\n3 2\r\n"));
  expect_read("f 1 3 2\n" + replaced(whole, "f 1 3 2\n", ""));
  expect_read(whole + "# end");
  expect_refused("b.obj", whole + "v 9 9 9", "1 of 5 vertices are part of no face");
}

}  // namespace
}  // namespace penumbra::test
