// web/gaps/epoxy/gl.h - OpenGL ES 3.0, which a browser gives as WebGL 2, under the name by which the
// renderer includes it.
#pragma once

#include <GLES3/gl3.h>
#include <emscripten/html5.h>

// Of desktop OpenGL the renderer names these; nothing calls them on a canvas, which has one buffer.
#define GL_BACK_LEFT 0x0402
#define GL_BACK_RIGHT 0x0403
#define GL_CONTEXT_LOST 0x0507
inline void glDrawBuffer(GLenum buffer) { static_cast<void>(buffer); }

// In a browser, glGetError waits for the process that draws, in every picture. The only error that
// the renderer acts on while it draws a window is a lost context.
inline GLenum burr_gl_error() {
  return emscripten_is_webgl_context_lost(emscripten_webgl_get_current_context()) != 0
             ? GLenum{GL_CONTEXT_LOST}
             : GLenum{GL_NO_ERROR};
}
#define glGetError burr_gl_error
