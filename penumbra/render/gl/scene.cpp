// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstring>

#include <epoxy/gl.h>

#include <penumbra/render/gl/gl_calls.hpp>
#include <penumbra/render/gl/scene.hpp>

namespace penumbra::gl {
namespace {

// Vertex attributes, as in the vertex shader.
constexpr GLuint position_attribute = 0;
constexpr GLuint first_row_attribute = 1;
constexpr GLuint body_attribute = 4;
constexpr GLuint depths_attribute = 5;

// Where the attributes come from.
constexpr GLuint vertex_binding = 0;
constexpr GLuint placement_binding = 1;
constexpr GLuint body_binding = 2;

/// Of a depth: more than the device's arithmetic is off by, where a face is not edge-on.
constexpr double depth_slack = 1e-4;

template <typename T>
GLuint make_buffer_of(const std::vector<T>& values, const char* what) {
  return make_buffer(values.size() * sizeof(T), values.data(), 0, what);
}

}  // namespace

Scene::Scene(const Intrinsics& intrinsics, std::span<const Body> bodies, std::size_t frames)
    : intrinsics_(intrinsics), side_rule_(intrinsics) {
  glCreateVertexArrays(1, &vertex_array_);
  upload(bodies);
  make_stream(bodies.size(), frames);
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, stream_);
}

void Scene::upload(std::span<const Body> bodies) {
  std::vector<Eigen::Vector3f> vertices(1, Eigen::Vector3f::Zero());  // no buffer may be empty
  std::vector<std::uint32_t> indices(1, 0);
  std::vector<std::uint32_t> body_indices(1, 0);
  body_bounds_.resize(bodies.size());
  for (std::uint32_t body = 0; body < bodies.size(); ++body) {
    body_indices.push_back(body);
    for (const PreparedMesh& mesh : bodies[body].meshes) {
      body_bounds_[body].extend(mesh.bounds);
      for (const TriangleGroup& group : groups_of(mesh)) {
        Part part{body, group.solid, !group.holes.empty(), group.bounds, 0, 0, 0};
        part.index_count = static_cast<std::uint32_t>(group.indices.size());
        part.first_index = static_cast<std::uint32_t>(indices.size());
        part.first_vertex = static_cast<std::uint32_t>(vertices.size());
        indices.insert(indices.end(), group.indices.begin(), group.indices.end());
        parts_.push_back(part);
      }
      vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    }
  }
  body_indices.erase(body_indices.begin());
  if (body_indices.empty()) body_indices.push_back(0);
  const GLuint vao = vertex_array_;
  glVertexArrayVertexBuffer(vao, vertex_binding, make_buffer_of(vertices, "the meshes' vertices"),
                            0, sizeof(vertices[0]));
  glEnableVertexArrayAttrib(vao, position_attribute);
  glVertexArrayAttribFormat(vao, position_attribute, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vao, position_attribute, vertex_binding);
  glVertexArrayElementBuffer(vao, make_buffer_of(indices, "the meshes' triangles"));
  glVertexArrayVertexBuffer(vao, body_binding, make_buffer_of(body_indices, "the links"), 0,
                            sizeof(body_indices[0]));
  glEnableVertexArrayAttrib(vao, body_attribute);
  glVertexArrayAttribIFormat(vao, body_attribute, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(vao, body_attribute, body_binding);
  glVertexArrayBindingDivisor(vao, body_binding, 1);
}

void Scene::make_stream(std::size_t bodies, std::size_t frames) {
  commands_at_ = aligned(bodies * sizeof(Placement));
  frame_size_ = aligned(commands_at_ + parts_.size() * sizeof(Command)) + buffer_alignment;
  constexpr GLbitfield access = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  stream_ = make_buffer(frames * frame_size_, nullptr, access, "the links' poses", &stream_data_);
  const auto add_attribute = [&](GLuint attribute, GLint floats, std::size_t offset) {
    glEnableVertexArrayAttrib(vertex_array_, attribute);
    glVertexArrayAttribFormat(vertex_array_, attribute, floats, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(vertex_array_, attribute, placement_binding);
  };
  for (GLuint row = 0; row < 3; ++row) {
    add_attribute(first_row_attribute + row, 4,
                  offsetof(Placement, to_clip) + row * 4 * sizeof(float));
  }
  add_attribute(depths_attribute, 2, offsetof(Placement, depths));
  glVertexArrayBindingDivisor(vertex_array_, placement_binding, 1);
}

/// OpenGL samples a pixel at its index + 1/2, our pixels have their centres at their index. Rows
/// are stored as they come, so that v runs with OpenGL's y.
Scene::Placement Scene::placement(std::size_t body, const Eigen::Isometry3d& T_camera_body) const {
  const Intrinsics& k = intrinsics_;
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(0, 0) = 2.0 * k.fx() / k.width();
  m(0, 2) = 2.0 * (k.cx() + 0.5) / k.width() - 1.0;
  m(1, 1) = 2.0 * k.fy() / k.height();
  m(1, 2) = 2.0 * (k.cy() + 0.5) / k.height() - 1.0;
  m(2, 2) = 1.0;
  const Eigen::Matrix<double, 3, 4> rows = m * T_camera_body.matrix().topRows<3>();
  Placement out{};
  for (std::size_t i = 0; i < out.to_clip.size(); ++i) {
    out.to_clip[i] = static_cast<float>(
        rows(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)));
  }
  const Eigen::AlignedBox3d& box = body_bounds_[body];
  if (box.isEmpty()) return out;
  const Eigen::RowVector3d to_depth = T_camera_body.linear().row(2);
  const double middle = to_depth.dot(box.center()) + T_camera_body.translation().z();
  const double half = to_depth.cwiseAbs().dot(box.sizes()) / 2.0;
  const double slack = depth_slack * (std::abs(middle) + half);
  out.depths = {static_cast<float>(middle - half - slack),
                static_cast<float>(middle + half + slack)};
  return out;
}

PixelRectangle Scene::place(std::span<const Eigen::Isometry3d> T_camera_body, std::size_t slot) {
  slot_ = slot;
  std::byte* const frame = stream_data_ + slot * frame_size_;
  for (std::size_t i = 0; i < T_camera_body.size(); ++i) {
    const Placement placed = placement(i, T_camera_body[i]);
    std::memcpy(frame + i * sizeof(Placement), &placed, sizeof(Placement));
  }
  front_count_ = both_count_ = 0;
  PixelRectangle all;
  for (const Part& part : parts_) {
    const Eigen::Isometry3d& T = T_camera_body[part.body];
    const PixelRectangle pixels = pixels_of(part.bounds, T, intrinsics_);
    if (pixels.empty()) continue;
    all = all.united(pixels);
    const Eigen::Vector3d centre = -(T.linear().transpose() * T.translation());
    const Sides sides = side_rule_.sides(part.solid, part.has_holes, part.bounds, centre);
    // Through holes backs are seen too: the whole part is drawn from both sides.
    const std::size_t at = sides == Sides::front ? front_count_++ : parts_.size() - ++both_count_;
    const Command command{part.index_count, 1, part.first_index, part.first_vertex, part.body};
    std::memcpy(frame + commands_at_ + at * sizeof(Command), &command, sizeof(Command));
  }
  return all;
}

void Scene::draw() const {
  glVertexArrayVertexBuffer(vertex_array_, placement_binding, stream_,
                            static_cast<GLintptr>(slot_ * frame_size_), sizeof(Placement));
  const auto draw_commands = [&](std::size_t first, std::size_t count) {
    const std::size_t at = slot_ * frame_size_ + commands_at_ + first * sizeof(Command);
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, as_address(at),
                                static_cast<GLsizei>(count), 0);
  };
  if (front_count_ > 0) {
    glEnable(GL_CULL_FACE);
    draw_commands(0, front_count_);
  }
  if (both_count_ > 0) {
    glDisable(GL_CULL_FACE);
    draw_commands(parts_.size() - both_count_, both_count_);
  }
}

}  // namespace penumbra::gl
