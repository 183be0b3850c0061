// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <stdexcept>
#include <string>

#include <epoxy/gl.h>

#include <penumbra/render/gl/program.hpp>

namespace penumbra::gl {
namespace {

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
