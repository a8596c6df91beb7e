#include "burr/render/gl/objects.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace burr::render::gl {

namespace {

Result<GLuint> compile(bool es, GLenum kind, std::initializer_list<const char*> source) {
  const char* head = es ? "#version 300 es\nprecision highp float;\nprecision highp int;\n"
                          "precision highp sampler2D;\nprecision highp sampler3D;\n"
                        : "#version 330 core\n";
  std::vector<const char*> text = {head};
  text.insert(text.end(), source);
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, static_cast<GLsizei>(text.size()), text.data(), nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good != 0) return shader;

  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  return error(Trouble::io, fmt::format("the graphics driver refuses a shader: {}; please update "
                                        "the driver, or report it",
                                        log.data()));
}

}  // namespace

Result<Program> Program::link(bool es, std::initializer_list<const char*> vertex,
                              std::initializer_list<const char*> fragment) {
  const Result<GLuint> v = compile(es, GL_VERTEX_SHADER, vertex);
  if (!v) return v.error();
  const Result<GLuint> f = compile(es, GL_FRAGMENT_SHADER, fragment);
  if (!f) {
    glDeleteShader(*v);
    return f.error();
  }
  Program program;
  program.id_ = glCreateProgram();
  for (const GLuint shader : {*v, *f}) {
    glAttachShader(program.id_, shader);
    glDeleteShader(shader);  // stays alive while it is attached
  }
  glLinkProgram(program.id_);
  GLint good = 0;
  glGetProgramiv(program.id_, GL_LINK_STATUS, &good);
  if (good != 0) return program;

  std::array<char, 1024> log{};
  glGetProgramInfoLog(program.id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return error(Trouble::io, fmt::format("the graphics driver cannot link a shader: {}; please "
                                        "update the driver, or report it",
                                        log.data()));
}

GLint Program::place(const char* name) {
  const auto found = places_.find(name);
  if (found != places_.end()) return found->second;
  return places_.emplace(name, glGetUniformLocation(id_, name)).first->second;
}

}  // namespace burr::render::gl
