// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <utility>
#include <vector>

#include <penumbra/mesh/prepared_mesh.hpp>

#include <io/files/json.hpp>
#include <io/web/scene.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {
namespace {

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

Json add_mesh(const TriangleMesh& mesh, std::string& geometry) {
  Json json{{"vertices", mesh.vertices.size()},
            {"triangles", mesh.triangles.size()},
            {"position_offset", geometry.size()},
            {"index_offset", geometry.size() + mesh.vertices.size() * sizeof(Eigen::Vector3f)}};
  geometry.append(reinterpret_cast<const char*>(mesh.vertices.data()),
                  mesh.vertices.size() * sizeof(Eigen::Vector3f));
  geometry.append(reinterpret_cast<const char*>(mesh.triangles.data()),
                  mesh.triangles.size() * sizeof(mesh.triangles.front()));
  return json;
}

Scene scene_of(std::uint64_t version, const std::string& root, Json links, std::string geometry) {
  const Json json{
      {"server", server_id()}, {"version", version}, {"root", root}, {"links", std::move(links)}};
  return {version, shared_bytes(json_text(json)), shared_bytes(std::move(geometry))};
}

}  // namespace

Scene make_scene(const Robot& robot, std::uint64_t version) {
  std::string geometry;
  Json links = Json::array();
  for (std::size_t i = 0; i < robot.links().size(); ++i) {
    Json meshes = Json::array();
    for (const TriangleMesh& mesh : robot.meshes(i)) meshes.push_back(add_mesh(mesh, geometry));
    links.push_back({{"name", robot.links()[i]}, {"meshes", std::move(meshes)}});
  }
  return scene_of(version, robot.links().front(), std::move(links), std::move(geometry));
}

Scene make_scene(std::span<const std::string> names) {
  Json links = Json::array();
  for (const std::string& name : names)
    links.push_back({{"name", name}, {"meshes", Json::array()}});
  return scene_of(1, names.empty() ? "" : names.front(), std::move(links), {});
}

std::string poses_json(std::span<const Eigen::Isometry3d> T_root_link,
                       const std::optional<Eigen::Isometry3d>& T_root_camera, std::size_t links) {
  Json poses = Json::array();
  for (std::size_t i = 0; i < links; ++i)
    poses.push_back(i < T_root_link.size() && T_root_link[i].matrix().allFinite()
                        ? pose_json(T_root_link[i])
                        : Json(nullptr));
  return "\"link_poses\": " + json_text(poses) + ", \"camera_pose\": " +
         json_text(T_root_camera ? pose_json(*T_root_camera) : Json(nullptr));
}

}  // namespace penumbra::io
