// SPDX-License-Identifier: Apache-2.0
#include "llvmpipe.hpp"

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <epoxy/gl.h>

#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_calls.hpp>

namespace penumbra::bench {
namespace {

constexpr double near_plane = DepthRenderer::near_plane;

constexpr const char* vertex_shader = R"(#version 450 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_body;
void main() { gl_Position = clip_from_body * vec4(position, 1.0); }
)";
constexpr const char* fragment_shader = R"(#version 450 core
void main() {}
)";

/// Clip coordinates from the optical frame. OpenGL samples a pixel at its index + 1/2, our pixels
/// have their centres at their index; rows are stored as they come, so that v runs with OpenGL's y.
/// Depth is near / z: floating-point numbers keep its precision.
Eigen::Matrix4d projection(const Intrinsics& k) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 2.0 * k.fx() / k.width();
  m(0, 2) = 2.0 * (k.cx() + 0.5) / k.width() - 1.0;
  m(1, 1) = 2.0 * k.fy() / k.height();
  m(1, 2) = 2.0 * (k.cy() + 0.5) / k.height() - 1.0;
  m(2, 3) = near_plane;
  m(3, 2) = 1.0;
  return m;
}

void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(std::string("llvmpipe: ") + what);
}

/// Returns a context of the first device that is llvmpipe.
std::unique_ptr<gl::EglContext> open_llvmpipe() {
  for (std::size_t i = 0; i < gl::EglContext::device_count(); ++i) {
    auto context = std::make_unique<gl::EglContext>(i);
    if (context->device().name.find("llvmpipe") != std::string::npos) return context;
  }
  throw std::runtime_error("llvmpipe: no OpenGL device is llvmpipe");
}

}  // namespace

struct LlvmpipeRenderer::State {
  struct Drawable {
    std::size_t body;
    GLuint vertex_array;
    GLsizei indices;
  };

  std::unique_ptr<gl::EglContext> context = open_llvmpipe();
  GLint matrix_location = -1;
  Eigen::Matrix4d clip_from_camera;
  std::vector<Drawable> drawables;
  Image<float> depth;

  void make_target(const Intrinsics& k) {
    depth = Image<float>(k.width(), k.height());
    clip_from_camera = projection(k);
    GLuint framebuffer = 0;
    GLuint renderbuffer = 0;
    glCreateFramebuffers(1, &framebuffer);
    glCreateRenderbuffers(1, &renderbuffer);
    glNamedRenderbufferStorage(renderbuffer, GL_DEPTH_COMPONENT32F, k.width(), k.height());
    glNamedFramebufferRenderbuffer(framebuffer, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, renderbuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "no framebuffer");
    glViewport(0, 0, k.width(), k.height());
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0.0);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CW);  // v runs with OpenGL's y, which mirrors the image
  }

  void make_program() {
    const GLuint program = gl::make_program(
        {{GL_VERTEX_SHADER, vertex_shader}, {GL_FRAGMENT_SHADER, fragment_shader}});
    glUseProgram(program);
    matrix_location = glGetUniformLocation(program, "clip_from_body");
  }

  void upload(const TriangleMesh& mesh, std::size_t body) {
    if (mesh.triangles.empty()) return;
    std::array<GLuint, 2> buffers{};
    GLuint vertex_array = 0;
    glCreateBuffers(2, buffers.data());
    glNamedBufferStorage(buffers[0],
                         static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(mesh.vertices[0])),
                         mesh.vertices.data(), 0);
    glNamedBufferStorage(buffers[1],
                         static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(mesh.triangles[0])),
                         mesh.triangles.data(), 0);
    glCreateVertexArrays(1, &vertex_array);
    glVertexArrayVertexBuffer(vertex_array, 0, buffers[0], 0, sizeof(mesh.vertices[0]));
    glVertexArrayElementBuffer(vertex_array, buffers[1]);
    glEnableVertexArrayAttrib(vertex_array, 0);
    glVertexArrayAttribFormat(vertex_array, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vertex_array, 0, 0);
    drawables.push_back({body, vertex_array, static_cast<GLsizei>(3 * mesh.triangles.size())});
  }
};

LlvmpipeRenderer::LlvmpipeRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies) {
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LP_NUM_THREADS", "0", 1);
  state_ = std::make_unique<State>();
  const gl::EglContext::Current current(*state_->context);
  state_->make_target(intrinsics);
  state_->make_program();
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    for (const PreparedMesh& mesh : bodies[body].meshes) state_->upload(mesh, body);
  }
  gl::check_frame();
}

LlvmpipeRenderer::~LlvmpipeRenderer() = default;

std::string LlvmpipeRenderer::description() const {
  const GlDevice& device = state_->context->device();
  return device.name + ", OpenGL " + device.version;
}

ImageView<const float> LlvmpipeRenderer::render(std::span<const Eigen::Isometry3d> T_camera_body) {
  State& s = *state_;
  const gl::EglContext::Current current(*s.context);
  glClear(GL_DEPTH_BUFFER_BIT);
  for (const State::Drawable& drawable : s.drawables) {
    const Eigen::Matrix4f matrix =
        (s.clip_from_camera * T_camera_body[drawable.body].matrix()).cast<float>();
    glUniformMatrix4fv(s.matrix_location, 1, GL_FALSE, matrix.data());
    glBindVertexArray(drawable.vertex_array);
    glDrawElements(GL_TRIANGLES, drawable.indices, GL_UNSIGNED_INT, nullptr);
  }
  glReadPixels(0, 0, s.depth.width(), s.depth.height(), GL_DEPTH_COMPONENT, GL_FLOAT,
               s.depth.data());
  float* const z = s.depth.data();
  constexpr auto near = static_cast<float>(near_plane);
  for (std::size_t i = 0; i < s.depth.size(); ++i) {
    const float metres = near / z[i];
    z[i] = z[i] > 0.0F ? metres : 0.0F;
  }
  return s.depth.view();
}

}  // namespace penumbra::bench
