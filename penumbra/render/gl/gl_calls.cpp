// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cassert>
#include <stdexcept>
#include <string_view>

#include <epoxy/gl.h>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/gl_calls.hpp>

namespace penumbra::gl {
namespace {

std::string name_of(GLenum error) {
  constexpr std::array<std::string_view, 8> names{"GL_INVALID_ENUM",
                                                  "GL_INVALID_VALUE",
                                                  "GL_INVALID_OPERATION",
                                                  "GL_STACK_OVERFLOW",
                                                  "GL_STACK_UNDERFLOW",
                                                  "GL_OUT_OF_MEMORY",
                                                  "GL_INVALID_FRAMEBUFFER_OPERATION",
                                                  "GL_CONTEXT_LOST"};
  const std::size_t code = error - GL_INVALID_ENUM;
  return code < names.size() ? std::string(names[code]) : "error " + std::to_string(error);
}

GLuint compiled(const ShaderSource& source) {
  const GLuint shader = glCreateShader(source.kind);
  glShaderSource(shader, 1, &source.text, nullptr);
  glCompileShader(shader);
  GLint status = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &status);
  if (status == GL_TRUE) return shader;
  std::array<char, 1024> words{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(words.size()), nullptr, words.data());
  throw std::runtime_error("OpenGL: a shader does not compile: " + std::string(words.data()));
}

}  // namespace

std::string text(unsigned name) {
  const GLubyte* const words = glGetString(name);
  return words == nullptr ? "" : reinterpret_cast<const char*>(words);
}

std::string take_error() {
  std::string first;
  // A lost context may answer with an error for ever.
  constexpr int most = 8;
  for (int i = 0; i < most; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    if (first.empty()) first = name_of(error);
  }
  return first;
}

void check_frame() {
  if (glGetGraphicsResetStatus() != GL_NO_ERROR) {
    throw DeviceError("OpenGL: the graphics device was reset");
  }
  const std::string error = take_error();
  if (!error.empty()) throw DeviceError("OpenGL: the frame failed with " + error);
}

unsigned make_buffer(std::size_t bytes, const void* data, unsigned flags, const std::string& what,
                     std::byte** mapped) {
  assert(((flags & GL_MAP_PERSISTENT_BIT) != 0) == (mapped != nullptr));
  const auto size = static_cast<GLsizeiptr>(bytes);
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferStorage(buffer, size, data, flags);
  std::string error = take_error();
  if (error.empty() && mapped != nullptr) {
    constexpr GLbitfield access =
        GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    *mapped = static_cast<std::byte*>(glMapNamedBufferRange(buffer, 0, size, flags & access));
    error = take_error();
    if (*mapped == nullptr && error.empty()) error = "it cannot be mapped";
  }
  if (error.empty()) return buffer;
  throw InputError("renderer 'gl': " + std::to_string((bytes + 999'999) / 1'000'000) + " MB for " +
                   what + " are more than " + text(GL_RENDERER) + " gives (" + error +
                   "); make it less or use the renderer 'cpu'");
}

unsigned make_program(std::initializer_list<ShaderSource> shaders) {
  const GLuint program = glCreateProgram();
  for (const ShaderSource& source : shaders) {
    const GLuint shader = compiled(source);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // with the program
  }
  glLinkProgram(program);
  GLint status = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &status);
  if (status == GL_TRUE) return program;
  std::array<char, 1024> words{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(words.size()), nullptr, words.data());
  throw std::runtime_error("OpenGL: the shaders do not link: " + std::string(words.data()));
}

}  // namespace penumbra::gl
