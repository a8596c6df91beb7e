// A canvas of the page as the renderer's window. In place of render/gl/context.cpp, which asks SDL.
#include "burr/render/gl/context.h"

#include <emscripten.h>
#include <emscripten/html5.h>

#include <memory>

namespace burr::render::gl {
namespace {

// The name of the graphics card, where the browser tells it.
EM_JS(char*, burr_name_of_gpu, (), {
  const own = GLctx.getExtension("WEBGL_debug_renderer_info");
  const name = GLctx.getParameter(own ? own.UNMASKED_RENDERER_WEBGL : GLctx.RENDERER);
  const length = lengthBytesUTF8(name) + 1;
  const text = _malloc(length);
  stringToUTF8(name, text, length);
  return text;
});

// A page may have several canvases, each with a module of its own: after it is made, this one may get another name.
EM_JS(int, burr_width_of_canvas, (), { return GLctx.canvas.width; });
EM_JS(int, burr_height_of_canvas, (), { return GLctx.canvas.height; });

constexpr const char* kCanvas = "#picture";

}  // namespace

Result<std::unique_ptr<Context>> Context::offscreen(Api) {
  return error(Trouble::usage, "a page has no picture without a canvas");
}

Result<std::unique_ptr<Context>> Context::window(const std::string& title, int width, int height,
                                                 bool) {
  std::unique_ptr<Context> context(new Context());
  const Status made = context->create(title, width, height, true, Api::es);
  if (!made) return made.error();
  return context;
}

Status Context::create(const std::string&, int width, int height, bool visible, Api, bool) {
  emscripten_set_canvas_element_size(kCanvas, width, height);
  EmscriptenWebGLContextAttributes wanted;
  emscripten_webgl_init_context_attributes(&wanted);
  wanted.majorVersion = 2;
  wanted.alpha = wanted.depth = wanted.stencil = wanted.antialias = EM_FALSE;
  wanted.powerPreference = EM_WEBGL_POWER_PREFERENCE_HIGH_PERFORMANCE;
  const EMSCRIPTEN_WEBGL_CONTEXT_HANDLE made = emscripten_webgl_create_context(kCanvas, &wanted);
  if (made <= 0)
    return error(Trouble::io, "this browser gives no WebGL 2; use another browser, or update it");
  window_ = nullptr;  // what only SDL's context has
  sdl_ = quad_buffer_ = false;
  gl_ = reinterpret_cast<void*>(made);
  visible_ = visible;
  es_ = true;
  make_current();
  char* const name = burr_name_of_gpu();
  gpu_ = name;
  std::free(name);
  return fine();
}

Context::~Context() {
  if (gl_ != nullptr)
    emscripten_webgl_destroy_context(reinterpret_cast<EMSCRIPTEN_WEBGL_CONTEXT_HANDLE>(gl_));
}

bool Context::software() const {
  for (const char* name : {"llvmpipe", "softpipe", "SwiftShader", "Software"})
    if (gpu_.find(name) != std::string::npos) return true;
  return false;
}

void Context::make_current() {
  emscripten_webgl_make_context_current(reinterpret_cast<EMSCRIPTEN_WEBGL_CONTEXT_HANDLE>(gl_));
}
void Context::swap() {}                 // the browser shows the canvas when the page has drawn
void Context::wait_for_screen(bool) {}  // it always does
void Context::title(const std::string&) {}
void Context::size(int& width, int& height) const {
  width = burr_width_of_canvas();
  height = burr_height_of_canvas();
}

}  // namespace burr::render::gl
