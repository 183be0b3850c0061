// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <epoxy/gl.h>

#include <penumbra/base/error.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/gl/gl_calls.hpp>
#include <penumbra/render/gl/shaders-inl.hpp>
#include <penumbra/render/gl/target.hpp>

namespace penumbra::gl {
namespace {

[[noreturn]] void refuse(int width, int height, const std::string& limit) {
  throw InputError("renderer 'gl': an image of " + std::to_string(width) + " x " +
                   std::to_string(height) + " pixels is larger than " + text(GL_RENDERER) +
                   " takes (" + limit + "); use a smaller image or the renderer 'cpu'");
}

void check_size(int width, int height) {
  std::array<GLint, 2> viewport{};
  GLint texture = 0;
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  const int most_width = std::min(texture, viewport[0]);
  const int most_height = std::min(texture, viewport[1]);
  if (width <= most_width && height <= most_height) return;
  refuse(width, height, std::to_string(most_width) + " x " + std::to_string(most_height));
}

}  // namespace

Target::Target(const Intrinsics& intrinsics) {
  check_size(intrinsics.width(), intrinsics.height());
  make_images(intrinsics.width(), intrinsics.height());
  program_ =
      make_program({{GL_VERTEX_SHADER, vertex_shader}, {GL_FRAGMENT_SHADER, fragment_shader}});
  constexpr GLint near_location = 0;
  glProgramUniform1f(program_, near_location, static_cast<float>(DepthRenderer::near_plane));
  glViewport(0, 0, intrinsics.width(), intrinsics.height());
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glEnable(GL_SCISSOR_TEST);
  glFrontFace(GL_CW);  // v runs with OpenGL's y, which mirrors the image
}

void Target::make_images(int width, int height) {
  std::array<GLuint, 2> images{};  // textures: metres, links
  GLuint depth = 0;
  glCreateTextures(GL_TEXTURE_2D, 2, images.data());
  glTextureStorage2D(images[0], 1, GL_R32F, width, height);
  glTextureStorage2D(images[1], 1, GL_R16UI, width, height);
  glCreateRenderbuffers(1, &depth);
  glNamedRenderbufferStorage(depth, GL_DEPTH_COMPONENT32F, width, height);
  glCreateFramebuffers(1, &framebuffer_);
  glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, images[0], 0);
  glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT1, images[1], 0);
  glNamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  constexpr std::array<GLenum, 2> drawn{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(framebuffer_, 2, drawn.data());
  const GLenum status = glCheckNamedFramebufferStatus(framebuffer_, GL_DRAW_FRAMEBUFFER);
  const std::string error = take_error();
  if (!error.empty()) refuse(width, height, error);
  if (status != GL_FRAMEBUFFER_COMPLETE) refuse(width, height, "its framebuffer stays incomplete");
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
}

void Target::begin(const PixelRectangle& rectangle) const {
  constexpr std::array<GLfloat, 4> no_depth{};
  constexpr std::array<GLuint, 4> no_link{};
  constexpr GLfloat infinitely_far = 0.0F;
  glUseProgram(program_);
  glScissor(rectangle.u0, rectangle.v0, rectangle.width(), rectangle.height());
  glClearBufferfv(GL_COLOR, 0, no_depth.data());
  glClearBufferuiv(GL_COLOR, 1, no_link.data());
  glClearBufferfv(GL_DEPTH, 0, &infinitely_far);
}

}  // namespace penumbra::gl
