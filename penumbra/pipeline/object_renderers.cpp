// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <span>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/target_views-inl.hpp>
#include <penumbra/robot/primitives.hpp>

namespace penumbra {
namespace {

void check_mesh(const TriangleMesh* mesh) {
  if (mesh == nullptr || mesh->triangles.empty())
    throw InputError("mesh has no triangles; one with some is wanted");
  const bool is_finite =
      std::all_of(mesh->vertices.begin(), mesh->vertices.end(),
                  [](const Eigen::Vector3f& vertex) { return vertex.allFinite(); });
  if (!is_finite) throw InputError("mesh has a vertex that is not finite; metres are wanted");
  for (const auto& triangle : mesh->triangles)
    for (const std::uint32_t corner : triangle)
      if (corner >= mesh->vertices.size())
        throw InputError("mesh has a triangle with corner " + std::to_string(corner) + " of " +
                         std::to_string(mesh->vertices.size()) + " vertices");
}

}  // namespace

/// A renderer and what it draws: a mesh, or a box of that size.
struct ObjectRenderers::Kept {
  std::shared_ptr<const TriangleMesh> mesh;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::unique_ptr<DepthRenderer> renderer;
  std::size_t last_use = 0;
};

ObjectRenderers::ObjectRenderers(const Intrinsics& intrinsics, Backend backend,
                                 const RendererOptions& options, const Rectification* rectification)
    : intrinsics_(intrinsics),
      backend_(backend),
      options_(options),
      rectification_(rectification) {}
ObjectRenderers::~ObjectRenderers() = default;

VirtualDepthView ObjectRenderers::box(const Eigen::Vector3d& size,
                                      const Eigen::Isometry3d& T_camera_box) {
  for (const auto& kept : kept_)
    if (!kept->mesh && kept->size == size) return render(*kept, T_camera_box);
  const TriangleMesh mesh = make_box(size);
  const Body body{"target", {&mesh, 1}};
  auto renderer = make_depth_renderer(backend_, intrinsics_, {&body, 1}, options_);
  Kept& kept = place();
  kept = {nullptr, size, std::move(renderer), 0};
  return render(kept, T_camera_box);
}

VirtualDepthView ObjectRenderers::mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                                       const Eigen::Isometry3d& T_camera_mesh) {
  for (const auto& kept : kept_)
    if (mesh && kept->mesh == mesh) return render(*kept, T_camera_mesh);
  check_mesh(mesh.get());
  const Body body{"target", {mesh.get(), 1}};
  auto renderer = make_depth_renderer(backend_, intrinsics_, {&body, 1}, options_);
  Kept& kept = place();
  kept = {mesh, Eigen::Vector3d::Zero(), std::move(renderer), 0};
  return render(kept, T_camera_mesh);
}

/// A new place, or that which was not used for longest.
ObjectRenderers::Kept& ObjectRenderers::place() {
  if (kept_.size() < max_kept) return *kept_.emplace_back(std::make_unique<Kept>());
  return **std::min_element(kept_.begin(), kept_.end(),
                            [](const auto& a, const auto& b) { return a->last_use < b->last_use; });
}

VirtualDepthView ObjectRenderers::render(Kept& kept, const Eigen::Isometry3d& T_camera_object) {
  kept.last_use = ++uses_;
  const VirtualDepthView rendered = kept.renderer->render({&T_camera_object, 1});
  if (rectification_ == nullptr) return rendered;
  if (!raw_images_) raw_images_.emplace(*rectification_);
  return raw_images_->virtual_depth(rendered);
}

}  // namespace penumbra
