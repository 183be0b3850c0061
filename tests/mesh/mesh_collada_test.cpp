// SPDX-License-Identifier: Apache-2.0
// The Collada reader: files that it refuses, and a comparison with Assimp on valid files.
#include "../support/data.hpp"
#include "mesh_oracle.hpp"
#include "mesh_samples.hpp"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra::test {
namespace {

// Assimp reads decimal numbers with an error of some units in the last place.
constexpr double reading_error = 1e-5;  // relative

struct Measures {
  std::size_t triangles = 0;
  double area = 0.0;
  double volume = 0.0;  // that of the cone to the origin, signed
  Eigen::AlignedBox3d bounds;
};

Measures measure(const TriangleMesh& mesh) {
  Measures m;
  m.triangles = mesh.triangles.size();
  for (std::size_t i = 0; i < m.triangles; ++i) {
    const std::array<Vector3d, 3> p = corners(mesh, i);
    for (const Vector3d& corner : p) m.bounds.extend(corner);
    m.area += (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2.0;
    m.volume += p[0].dot(p[1].cross(p[2])) / 6.0;
  }
  return m;
}

TriangleMesh read_by_assimp(const std::filesystem::path& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* const scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (scene == nullptr) throw std::runtime_error(importer.GetErrorString());
  TriangleMesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& part = *scene->mMeshes[i];
    const auto first = std::uint32_t(mesh.vertices.size());
    for (unsigned k = 0; k < part.mNumVertices; ++k)
      mesh.vertices.emplace_back(part.mVertices[k].x, part.mVertices[k].y, part.mVertices[k].z);
    for (unsigned k = 0; k < part.mNumFaces; ++k) {
      const aiFace& face = part.mFaces[k];
      if (face.mNumIndices == 3)
        mesh.triangles.push_back(
            {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  return weld(mesh);
}

void expect_as_assimp(const std::filesystem::path& file) {
  SCOPED_TRACE(file);
  const Measures ours = measure(load_mesh(file));
  const Measures theirs = measure(read_by_assimp(file));
  const double length = theirs.bounds.diagonal().norm();
  EXPECT_EQ(ours.triangles, theirs.triangles);
  EXPECT_NEAR(ours.area, theirs.area, reading_error * theirs.area);
  EXPECT_NEAR(ours.volume, theirs.volume, reading_error * length * theirs.area);
  EXPECT_LT((ours.bounds.min() - theirs.bounds.min()).norm(), reading_error * length);
  EXPECT_LT((ours.bounds.max() - theirs.bounds.max()).norm(), reading_error * length);
}

class Collada : public ::testing::Test {
 protected:
  void expect_refused(const std::string& text, const std::string& why) {
    const auto file = folder_.write("a.dae", text);
    test::expect_refused([&] { (void)load_mesh(file); }, {why, ";"});  // a remedy follows it
  }
  /// The sample with one place changed.
  void expect_refused(const std::string& what, const std::string& by, const std::string& why) {
    expect_refused(replaced(collada(), what, by), why);
  }
  TemporaryFolder folder_;
};

TEST_F(Collada, ReadsAsAssimpDoes) {
  const std::string nodes =
      "<node id=\"a\"><matrix>0 -1 0 3  1 0 0 4  0 0 2 5  0 0 0 1</matrix>"
      "<rotate>0.6 0 0.8 40</rotate><node><scale>1 2 3</scale><translate>1 2 3</translate>"
      "<instance_geometry url=\"#tet\"/></node></node><node><translate>9 0 0</translate>"
      "<instance_node url=\"#a\"/></node>";
  expect_as_assimp(folder_.write("t.dae", collada("<unit meter=\"0.0254\"/>", nodes)));
  const std::string uv =
      "<input semantic=\"TEXCOORD\" source=\"#p\" offset=\"0\" set=\"0\"/>"
      "<input semantic=\"VERTEX\" source=\"#v\" offset=\"1\"/>";
  const std::vector<std::string> primitives{
      "<triangles count=\"2\">" + uv + "<p>3 0 2 2 1 1 0 0 1 1 0 3</p></triangles>",
      "<polylist count=\"3\">" + vertex_input +
          "<vcount>3 2 4</vcount><p>0 2 1 0 1 0 1 2 3</p></polylist>",
      "<polygons count=\"2\">" + vertex_input + "<p>0 2 1</p><p>0 1 3</p></polygons>",
      "<tristrips count=\"2\">" + vertex_input + "<p>0 1 2 3 0</p><p>3 2 1</p></tristrips>",
      "<lines count=\"1\">" + vertex_input + "<p>0 1</p></lines><triangles count=\"0\">" +
          vertex_input + "</triangles><triangles count=\"1\">" + vertex_input +
          "<p>0 1 2</p></triangles>"};
  for (const std::string& primitive : primitives)
    expect_as_assimp(folder_.write("p.dae", with_primitive(primitive)));
}

TEST_F(Collada, RealFilesReadAsAssimpDoes) {
  expect_as_assimp(std::filesystem::path(PENUMBRA_SOURCE_DIR) /
                   "examples/arm_over_table/arm_description/meshes/upper_arm.dae");
  PENUMBRA_REQUIRE_DATA();
  const auto folder = data_folder() / "robots/ur5e/ur_description/meshes/ur5e/visual";
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    expect_as_assimp(entry.path());
}

TEST_F(Collada, FansAndCommentsBetweenNumbersAreRead) {
  const auto fan =
      load_mesh(folder_.write("f.dae", with_primitive("<trifans count=\"1\">" + vertex_input +
                                                      "<p>0 2 <!-- x --> 1 3 2</p></trifans>")));
  EXPECT_EQ(fan.triangles.size(), 3U);
  EXPECT_EQ(fan.vertices.size(), 4U);
}

TEST_F(Collada, TransformsThatAreNotReadMatterOnlyToGeometry) {
  const std::string look = "<lookat>0 0 9 0 0 0 0 1 0</lookat>";
  const std::string skew = "<skew>45 0 1 0 1 0 0</skew>";
  for (const std::string& transform : {look, skew}) {
    expect_refused(collada("", collada_node(transform)), "it moves geometry");
    expect_refused(collada("", "<node>" + transform + collada_node() + "</node>"),
                   "it moves geometry");
    const std::string camera =
        "<node id=\"c\">" + transform + "<node/><instance_camera url=\"#x\"/></node>";
    EXPECT_EQ(
        load_mesh(folder_.write("c.dae", collada("", camera + collada_node()))).triangles.size(),
        4U);
  }
  for (const std::string bad : {"<translate>1 2</translate>", "<translate>1 2 3 4</translate>",
                                "<translate>1 2 nan</translate>", "<rotate>0 0 0 90</rotate>",
                                "<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1</matrix>",
                                "<scale>1 1 x</scale>", "<translat>1 2 3</translat>"})
    expect_refused(collada("", collada_node(bad)), "damaged");
}

TEST_F(Collada, WhatASceneShowsMustBeThereAndRigid) {
  const std::string text = collada();
  expect_refused(replaced(text, "<scene>", "<scenery>"), "XML");
  expect_refused(replaced(text, "url=\"#s\"", "url=\"#t\""), "#t");
  expect_refused(replaced(text, "<geometry ", "<geometry id=\"tet\"><mesh/></geometry><geometry "),
                 "two elements have the id");
  expect_refused(replaced(text, "instance_geometry", "instance_controller"), "skin");
  expect_refused(replaced(text, "#tet", "#a\nb"), "#a b");
  expect_refused("<html></html>", "a Collada file has <COLLADA>");
}

}  // namespace
}  // namespace penumbra::test
