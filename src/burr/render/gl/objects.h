// render/gl/objects.h - owners of OpenGL objects: they free them when they go out of scope.
//
// Thread: main, with the context current in which they were made. For use of this room only.
#pragma once

#include <epoxy/gl.h>

#include <Eigen/Core>
#include <initializer_list>
#include <string>
#include <unordered_map>
#include <utility>

#include "burr/base/result.h"

namespace burr::render::gl {

// One OpenGL name; 0 is none.
template <void (*Make)(GLuint&), void (*Free)(GLuint)>
class Name {
 public:
  Name() = default;
  Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Name() {
    if (id_ != 0) Free(id_);
  }
  // makes it at the first call
  GLuint make() {
    if (id_ == 0) Make(id_);
    return id_;
  }
  [[nodiscard]] GLuint get() const { return id_; }

 private:
  GLuint id_ = 0;
};

inline void make_buffer(GLuint& id) { glGenBuffers(1, &id); }
inline void free_buffer(GLuint id) { glDeleteBuffers(1, &id); }
inline void make_array(GLuint& id) { glGenVertexArrays(1, &id); }
inline void free_array(GLuint id) { glDeleteVertexArrays(1, &id); }
inline void make_texture(GLuint& id) { glGenTextures(1, &id); }
inline void free_texture(GLuint id) { glDeleteTextures(1, &id); }
inline void make_framebuffer(GLuint& id) { glGenFramebuffers(1, &id); }
inline void free_framebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }

using Buffer = Name<make_buffer, free_buffer>;
using VertexArray = Name<make_array, free_array>;
using Texture = Name<make_texture, free_texture>;
using Framebuffer = Name<make_framebuffer, free_framebuffer>;

// A vertex and a fragment shader, linked. The sources lack the #version line, which depends on the
// API. They may consist of several parts, which begin with the #defines of the wanted variant.
class Program {
 public:
  Program() = default;
  [[nodiscard]] static Result<Program> link(bool es, std::initializer_list<const char*> vertex,
                                            std::initializer_list<const char*> fragment);
  Program(Program&& other) noexcept
      : id_(std::exchange(other.id_, 0)), places_(std::move(other.places_)) {}
  Program& operator=(Program&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(places_, other.places_);
    return *this;
  }
  ~Program() {
    if (id_ != 0) glDeleteProgram(id_);
  }

  void use() const { glUseProgram(id_); }
  // sets a uniform of the program in use; a name that the compiler removed is ignored
  void set(const char* name, int value) { glUniform1i(place(name), value); }
  void set(const char* name, float value) { glUniform1f(place(name), value); }
  void set(const char* name, int x, int y) { glUniform2i(place(name), x, y); }
  void set(const char* name, const Eigen::Vector2f& v) { glUniform2f(place(name), v.x(), v.y()); }
  void set(const char* name, const Eigen::Vector3f& v) {
    glUniform3f(place(name), v.x(), v.y(), v.z());
  }
  void set(const char* name, const Eigen::Vector4f& v) {
    glUniform4f(place(name), v.x(), v.y(), v.z(), v.w());
  }
  void set(const char* name, const Eigen::Matrix3f& m) {
    glUniformMatrix3fv(place(name), 1, GL_FALSE, m.data());
  }
  void set(const char* name, const Eigen::Matrix4f& m) {
    glUniformMatrix4fv(place(name), 1, GL_FALSE, m.data());
  }
  void set_pairs(const char* name, int count, const float* xy) {
    glUniform2fv(place(name), count, xy);
  }

 private:
  GLint place(const char* name);

  GLuint id_ = 0;
  std::unordered_map<std::string, GLint> places_;
};

}  // namespace burr::render::gl
