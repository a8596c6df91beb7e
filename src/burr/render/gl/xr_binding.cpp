#include "burr/render/gl/xr_binding.h"

#include <dlfcn.h>

#include <cstdint>
#include <cstring>

#include <EGL/egl.h>
#include <GL/glx.h>

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_XLIB
#define XR_USE_PLATFORM_EGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

namespace burr::render::gl {
namespace {

// A function of a library that is loaded already, because the context was made with it.
template <class Function>
Function* loaded(const char* library, const char* name) {
  void* const handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
  if (handle == nullptr) return nullptr;
  void* const found = dlsym(handle, name);
  dlclose(handle);  // only lowers its use count
  return reinterpret_cast<Function*>(found);
}

template <class Structure>
void put(XrBinding& binding, const Structure& structure) {
  static_assert(sizeof(Structure) <= sizeof(binding.bytes));
  std::memcpy(binding.bytes.data(), &structure, sizeof(Structure));
  binding.there = true;
}

bool by_glx(XrBinding& binding) {
  constexpr const char* kLibrary = "libGL.so.1";
  auto* const current = loaded<decltype(glXGetCurrentContext)>(kLibrary, "glXGetCurrentContext");
  auto* const display = loaded<decltype(glXGetCurrentDisplay)>(kLibrary, "glXGetCurrentDisplay");
  auto* const drawable = loaded<decltype(glXGetCurrentDrawable)>(kLibrary, "glXGetCurrentDrawable");
  auto* const query = loaded<decltype(glXQueryContext)>(kLibrary, "glXQueryContext");
  auto* const choose = loaded<decltype(glXChooseFBConfig)>(kLibrary, "glXChooseFBConfig");
  auto* const visual =
      loaded<decltype(glXGetVisualFromFBConfig)>(kLibrary, "glXGetVisualFromFBConfig");
  auto* const release = loaded<decltype(XFree)>("libX11.so.6", "XFree");
  if (current == nullptr || display == nullptr || drawable == nullptr || query == nullptr ||
      choose == nullptr || visual == nullptr || release == nullptr || current() == nullptr)
    return false;
  XrGraphicsBindingOpenGLXlibKHR x = {};
  x.type = XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR;
  x.xDisplay = display();
  x.glxContext = current();
  x.glxDrawable = drawable();
  int config = 0, screen = 0, count = 0;
  query(x.xDisplay, x.glxContext, GLX_FBCONFIG_ID, &config);
  query(x.xDisplay, x.glxContext, GLX_SCREEN, &screen);
  const int wanted[] = {GLX_FBCONFIG_ID, config, 0};
  GLXFBConfig* const configs = choose(x.xDisplay, screen, wanted, &count);
  if (configs != nullptr && count > 0) {
    x.glxFBConfig = configs[0];
    if (XVisualInfo* const info = visual(x.xDisplay, configs[0])) {
      x.visualid = static_cast<std::uint32_t>(info->visualid);
      release(info);
    }
  }
  if (configs != nullptr) release(configs);
  put(binding, x);
  return true;
}

bool by_egl(XrBinding& binding) {
  constexpr const char* kLibrary = "libEGL.so.1";
  auto* const current = loaded<decltype(eglGetCurrentContext)>(kLibrary, "eglGetCurrentContext");
  auto* const display = loaded<decltype(eglGetCurrentDisplay)>(kLibrary, "eglGetCurrentDisplay");
  auto* const query = loaded<decltype(eglQueryContext)>(kLibrary, "eglQueryContext");
  auto* const choose = loaded<decltype(eglChooseConfig)>(kLibrary, "eglChooseConfig");
  auto* const address = loaded<decltype(eglGetProcAddress)>(kLibrary, "eglGetProcAddress");
  if (current == nullptr || display == nullptr || query == nullptr || choose == nullptr ||
      address == nullptr || current() == nullptr)
    return false;
  XrGraphicsBindingEGLMNDX egl = {};
  egl.type = XR_TYPE_GRAPHICS_BINDING_EGL_MNDX;
  egl.getProcAddress = address;
  egl.display = display();
  egl.context = current();
  EGLint config = 0, count = 0;
  query(egl.display, egl.context, EGL_CONFIG_ID, &config);
  const EGLint wanted[] = {EGL_CONFIG_ID, config, EGL_NONE};
  choose(egl.display, wanted, &egl.config, 1, &count);
  binding.extension = XR_MNDX_EGL_ENABLE_EXTENSION_NAME;
  put(binding, egl);
  return true;
}

}  // namespace

XrBinding xr_binding() {
  XrBinding binding;
  if (!by_glx(binding)) by_egl(binding);
  return binding;
}

}  // namespace burr::render::gl
