// See fake_openxr.h. Numbers in brackets are sections of the OpenXR 1.0 specification.
#include "fake_openxr.h"

#include <SDL2/SDL_video.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <thread>

#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr_platform.h>

using burr::test::FakeXr;

namespace {

// never destroyed: a wait that hangs may last longer than the tests
FakeXr* g_fake = new FakeXr;

struct Chain {
  std::vector<GLuint> textures;
  std::uint32_t width = 0, height = 0;
  std::size_t next = 0;
  int acquired = -1, released = -1;
  bool waited = false;
};

// state of the one instance and the one session
struct World {
  bool requirements = false, running = false, attached = false;
  int frame_waited = 0;  // waited for and not begun
  bool frame_begun = false;
  bool focused_told = false;
  XrTime time = 1'000'000'000;
  std::vector<std::unique_ptr<Chain>> chains;
  std::map<std::string, XrPath> paths;
  std::map<XrAction, XrActionType> actions;
  bool pen = false;  // the extension of the pen was switched on
};
World* g_world = new World;

template <class Handle>
Handle handle(std::uint64_t number) {
  return reinterpret_cast<Handle>(number);
}
const auto kInstance = handle<XrInstance>(11);
const auto kSession = handle<XrSession>(12);
const auto kRoom = handle<XrSpace>(13);
const auto kWand = handle<XrSpace>(14);
const auto kActionSet = handle<XrActionSet>(15);

XrResult breach(XrResult code, const std::string& what) {
  g_fake->breaches.push_back(what);
  return code;
}
bool no_context() { return SDL_GL_GetCurrentContext() == nullptr; }

bool unit(const XrQuaternionf& q) {
  return std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 0.01F;
}

#define LOCKED const std::lock_guard lock(g_fake->mutex)
#define DEMAND(holds, code) \
  if (!(holds)) return breach(code, std::string(__func__) + ": " #holds)
#define ALIVE \
  if (g_fake->instance_lost) return XR_ERROR_INSTANCE_LOST
#define TYPED(pointer, kind) \
  DEMAND((pointer) != nullptr && (pointer)->type == (kind), XR_ERROR_VALIDATION_FAILURE)

template <class T>
XrResult two_calls(const std::vector<T>& all, std::uint32_t room, std::uint32_t* count, T* to) {
  *count = static_cast<std::uint32_t>(all.size());
  if (room == 0) return XR_SUCCESS;
  if (room < all.size()) return XR_ERROR_SIZE_INSUFFICIENT;
  std::copy(all.begin(), all.end(), to);
  return XR_SUCCESS;
}

// ---- instance and system (4, 5)

XrResult xrEnumerateInstanceExtensionProperties(const char*, std::uint32_t room,
                                                std::uint32_t* count, XrExtensionProperties* to) {
  LOCKED;
  if (g_fake->no_runtime) return XR_ERROR_RUNTIME_UNAVAILABLE;
  std::vector<const char*> names = {"XR_MNDX_egl_enable"};
  if (g_fake->pen) names.emplace_back("XR_LOGITECH_mx_ink_stylus_interaction");
  if (!g_fake->no_opengl) names.emplace_back(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  *count = static_cast<std::uint32_t>(names.size());
  if (room == 0) return XR_SUCCESS;
  if (room < names.size()) return XR_ERROR_SIZE_INSUFFICIENT;
  for (std::size_t n = 0; n < names.size(); ++n) {
    TYPED(to + n, XR_TYPE_EXTENSION_PROPERTIES);
    std::strcpy(to[n].extensionName, names[n]);
  }
  return XR_SUCCESS;
}

XrResult xrCreateInstance(const XrInstanceCreateInfo* info, XrInstance* to) {
  LOCKED;
  TYPED(info, XR_TYPE_INSTANCE_CREATE_INFO);
  DEMAND(g_fake->instances == 0, XR_ERROR_LIMIT_REACHED);
  DEMAND(XR_VERSION_MAJOR(info->applicationInfo.apiVersion) == 1, XR_ERROR_API_VERSION_UNSUPPORTED);
  DEMAND(info->applicationInfo.applicationName[0] != '\0', XR_ERROR_NAME_INVALID);
  bool opengl = false;
  for (std::uint32_t n = 0; n < info->enabledExtensionCount; ++n) {
    const std::string name = info->enabledExtensionNames[n];
    opengl = opengl || name == XR_KHR_OPENGL_ENABLE_EXTENSION_NAME;
    const bool pen = name == "XR_LOGITECH_mx_ink_stylus_interaction";
    DEMAND(!pen || g_fake->pen, XR_ERROR_EXTENSION_NOT_PRESENT);
    g_world->pen = g_world->pen || pen;
  }
  DEMAND(opengl, XR_ERROR_EXTENSION_NOT_PRESENT);
  ++g_fake->instances;
  *to = kInstance;
  return XR_SUCCESS;
}

XrResult xrDestroyInstance(XrInstance instance) {
  LOCKED;
  DEMAND(instance == kInstance && g_fake->instances == 1, XR_ERROR_HANDLE_INVALID);
  DEMAND(g_fake->sessions == 0, XR_ERROR_HANDLE_INVALID);
  --g_fake->instances;
  g_world->requirements = g_world->attached = false;
  g_world->actions.clear();
  return XR_SUCCESS;
}

XrResult xrGetSystem(XrInstance, const XrSystemGetInfo* info, XrSystemId* to) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_SYSTEM_GET_INFO);
  DEMAND(info->formFactor == XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY, XR_ERROR_FORM_FACTOR_UNSUPPORTED);
  if (g_fake->no_headset) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *to = 7;
  return XR_SUCCESS;
}

XrResult xrGetSystemProperties(XrInstance, XrSystemId system, XrSystemProperties* to) {
  LOCKED;
  DEMAND(system == 7, XR_ERROR_SYSTEM_INVALID);
  TYPED(to, XR_TYPE_SYSTEM_PROPERTIES);
  std::strcpy(to->systemName, "Fake headset");
  return XR_SUCCESS;
}

XrResult xrPollEvent(XrInstance, XrEventDataBuffer* to) {
  LOCKED;
  ALIVE;
  TYPED(to, XR_TYPE_EVENT_DATA_BUFFER);
  if (g_fake->instance_loss_pending) {
    to->type = XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING;
    return XR_SUCCESS;
  }
  if (g_fake->events.empty()) return XR_EVENT_UNAVAILABLE;
  XrEventDataSessionStateChanged changed = {};
  changed.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  changed.session = kSession;
  changed.state = g_fake->state = g_fake->events.front();
  g_fake->events.pop_front();
  std::memcpy(to, &changed, sizeof changed);
  return XR_SUCCESS;
}

// ---- session (9, 12.18)

XrResult xrGetOpenGLGraphicsRequirementsKHR(XrInstance, XrSystemId system,
                                            XrGraphicsRequirementsOpenGLKHR* to) {
  LOCKED;
  DEMAND(system == 7, XR_ERROR_SYSTEM_INVALID);
  TYPED(to, XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
  to->minApiVersionSupported = XR_MAKE_VERSION(3, 3, 0);
  to->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  g_world->requirements = true;
  return XR_SUCCESS;
}

XrResult xrCreateSession(XrInstance, const XrSessionCreateInfo* info, XrSession* to) {
  LOCKED;
  TYPED(info, XR_TYPE_SESSION_CREATE_INFO);
  DEMAND(info->systemId == 7, XR_ERROR_SYSTEM_INVALID);
  DEMAND(g_world->requirements, XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
  DEMAND(g_fake->sessions == 0, XR_ERROR_LIMIT_REACHED);
  const auto* const binding = static_cast<const XrBaseInStructure*>(info->next);
  DEMAND(binding != nullptr, XR_ERROR_GRAPHICS_DEVICE_INVALID);
  DEMAND(binding->type == XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR ||
             binding->type == XR_TYPE_GRAPHICS_BINDING_EGL_MNDX,
         XR_ERROR_GRAPHICS_DEVICE_INVALID);
  DEMAND(!no_context(), XR_ERROR_GRAPHICS_DEVICE_INVALID);
  ++g_fake->sessions;
  g_fake->events = {XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY};
  *to = kSession;
  return XR_SUCCESS;
}

XrResult xrDestroySession(XrSession session) {
  LOCKED;
  DEMAND(session == kSession && g_fake->sessions == 1, XR_ERROR_HANDLE_INVALID);
  --g_fake->sessions;
  g_world->running = false;
  return XR_SUCCESS;
}

XrResult xrBeginSession(XrSession, const XrSessionBeginInfo* info) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_SESSION_BEGIN_INFO);
  DEMAND(!g_world->running, XR_ERROR_SESSION_RUNNING);
  DEMAND(g_fake->state == XR_SESSION_STATE_READY, XR_ERROR_SESSION_NOT_READY);
  DEMAND(info->primaryViewConfigurationType == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
         XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
  g_world->running = true;
  g_world->focused_told = false;
  g_world->frame_waited = 0;
  return XR_SUCCESS;
}

XrResult xrEndSession(XrSession) {
  LOCKED;
  ALIVE;
  DEMAND(g_world->running, XR_ERROR_SESSION_NOT_RUNNING);
  DEMAND(g_fake->state == XR_SESSION_STATE_STOPPING, XR_ERROR_SESSION_NOT_STOPPING);
  g_world->running = false;
  g_fake->events.push_back(XR_SESSION_STATE_IDLE);
  return XR_SUCCESS;
}

XrResult xrCreateReferenceSpace(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* to) {
  LOCKED;
  TYPED(info, XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  DEMAND(unit(info->poseInReferenceSpace.orientation), XR_ERROR_POSE_INVALID);
  *to = kRoom;
  return XR_SUCCESS;
}
XrResult xrDestroySpace(XrSpace space) {
  LOCKED;
  DEMAND(space == kRoom || space == kWand, XR_ERROR_HANDLE_INVALID);
  return XR_SUCCESS;
}

XrResult xrEnumerateViewConfigurationViews(XrInstance, XrSystemId, XrViewConfigurationType type,
                                           std::uint32_t room, std::uint32_t* count,
                                           XrViewConfigurationView* to) {
  LOCKED;
  DEMAND(type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
         XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
  *count = 2;
  if (room == 0) return XR_SUCCESS;
  DEMAND(room >= 2, XR_ERROR_SIZE_INSUFFICIENT);
  for (int n = 0; n < 2; ++n) {
    TYPED(to + n, XR_TYPE_VIEW_CONFIGURATION_VIEW);
    to[n].recommendedImageRectWidth = to[n].maxImageRectWidth = g_fake->width;
    to[n].recommendedImageRectHeight = to[n].maxImageRectHeight = g_fake->height;
    to[n].recommendedSwapchainSampleCount = to[n].maxSwapchainSampleCount = 1;
  }
  return XR_SUCCESS;
}

XrResult xrEnumerateEnvironmentBlendModes(XrInstance, XrSystemId, XrViewConfigurationType,
                                          std::uint32_t room, std::uint32_t* count,
                                          XrEnvironmentBlendMode* to) {
  LOCKED;
  return two_calls<XrEnvironmentBlendMode>({XR_ENVIRONMENT_BLEND_MODE_OPAQUE}, room, count, to);
}

// ---- swapchains (10.1)

XrResult xrEnumerateSwapchainFormats(XrSession, std::uint32_t room, std::uint32_t* count,
                                     std::int64_t* to) {
  LOCKED;
  return two_calls<std::int64_t>({GL_RGBA16F, GL_SRGB8_ALPHA8, GL_RGBA8}, room, count, to);
}

XrResult xrCreateSwapchain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* to) {
  LOCKED;
  TYPED(info, XR_TYPE_SWAPCHAIN_CREATE_INFO);
  DEMAND(info->format == GL_SRGB8_ALPHA8, XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED);
  DEMAND(info->faceCount == 1 && info->arraySize == 1 && info->mipCount == 1 &&
             info->sampleCount == 1 && info->width == g_fake->width,
         XR_ERROR_VALIDATION_FAILURE);
  DEMAND(!no_context(), XR_ERROR_RUNTIME_FAILURE);
  auto chain = std::make_unique<Chain>();
  chain->width = info->width;
  chain->height = info->height;
  chain->textures.resize(3);
  glGenTextures(3, chain->textures.data());
  for (const GLuint texture : chain->textures) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, static_cast<GLsizei>(info->width),
                 static_cast<GLsizei>(info->height), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  }
  *to = reinterpret_cast<XrSwapchain>(chain.get());
  g_world->chains.push_back(std::move(chain));
  return XR_SUCCESS;
}

Chain* chain_of(XrSwapchain swapchain) {
  for (const auto& chain : g_world->chains)
    if (reinterpret_cast<XrSwapchain>(chain.get()) == swapchain) return chain.get();
  return nullptr;
}

XrResult xrDestroySwapchain(XrSwapchain swapchain) {
  LOCKED;
  Chain* const chain = chain_of(swapchain);
  DEMAND(chain != nullptr, XR_ERROR_HANDLE_INVALID);
  DEMAND(!no_context(), XR_ERROR_RUNTIME_FAILURE);
  glDeleteTextures(3, chain->textures.data());
  std::erase_if(g_world->chains, [chain](const auto& one) { return one.get() == chain; });
  return XR_SUCCESS;
}

XrResult xrEnumerateSwapchainImages(XrSwapchain swapchain, std::uint32_t room, std::uint32_t* count,
                                    XrSwapchainImageBaseHeader* to) {
  LOCKED;
  const Chain* const chain = chain_of(swapchain);
  DEMAND(chain != nullptr, XR_ERROR_HANDLE_INVALID);
  *count = 3;
  if (room == 0) return XR_SUCCESS;
  DEMAND(room >= 3, XR_ERROR_SIZE_INSUFFICIENT);
  auto* const images = reinterpret_cast<XrSwapchainImageOpenGLKHR*>(to);
  for (std::size_t n = 0; n < 3; ++n) {
    TYPED(images + n, XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR);
    images[n].image = chain->textures[n];
  }
  return XR_SUCCESS;
}

XrResult xrAcquireSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageAcquireInfo*,
                                 std::uint32_t* index) {
  LOCKED;
  ALIVE;
  Chain* const chain = chain_of(swapchain);
  DEMAND(chain != nullptr, XR_ERROR_HANDLE_INVALID);
  DEMAND(chain->acquired < 0, XR_ERROR_CALL_ORDER_INVALID);
  chain->acquired = static_cast<int>(chain->next++ % 3);
  chain->waited = false;
  *index = static_cast<std::uint32_t>(chain->acquired);
  return XR_SUCCESS;
}

XrResult xrWaitSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageWaitInfo* info) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
  Chain* const chain = chain_of(swapchain);
  DEMAND(chain != nullptr, XR_ERROR_HANDLE_INVALID);
  DEMAND(chain->acquired >= 0 && !chain->waited, XR_ERROR_CALL_ORDER_INVALID);
  chain->waited = true;
  return XR_SUCCESS;
}

XrResult xrReleaseSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageReleaseInfo*) {
  LOCKED;
  ALIVE;
  Chain* const chain = chain_of(swapchain);
  DEMAND(chain != nullptr, XR_ERROR_HANDLE_INVALID);
  DEMAND(chain->acquired >= 0 && chain->waited, XR_ERROR_CALL_ORDER_INVALID);
  chain->released = chain->acquired;
  chain->acquired = -1;
  return XR_SUCCESS;
}

// ---- frames (10.3 to 10.5)

XrResult xrWaitFrame(XrSession, const XrFrameWaitInfo*, XrFrameState* to) {
  {
    std::unique_lock lock(g_fake->mutex);
    ALIVE;
    TYPED(to, XR_TYPE_FRAME_STATE);
    DEMAND(g_world->running, XR_ERROR_SESSION_NOT_RUNNING);
    DEMAND(g_world->frame_waited == 0, XR_ERROR_CALL_ORDER_INVALID);
    g_fake->wakes.wait(lock, [mine = g_fake] { return !mine->hangs; });
    ++g_world->frame_waited;
    ++g_fake->waited;
    g_world->time += 11'111'111;
    to->predictedDisplayTime = g_world->time;
    to->predictedDisplayPeriod = 11'111'111;
    to->shouldRender = g_fake->shows ? XR_TRUE : XR_FALSE;
    if (!g_world->focused_told) {
      g_world->focused_told = true;
      for (const XrSessionState state :
           {XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED})
        g_fake->events.push_back(state);
    }
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return XR_SUCCESS;
}

XrResult xrBeginFrame(XrSession, const XrFrameBeginInfo*) {
  LOCKED;
  ALIVE;
  DEMAND(g_world->running, XR_ERROR_SESSION_NOT_RUNNING);
  DEMAND(!no_context(), XR_ERROR_RUNTIME_FAILURE);
  DEMAND(g_world->frame_waited == 1, XR_ERROR_CALL_ORDER_INVALID);
  --g_world->frame_waited;
  ++g_fake->begun;
  if (g_world->frame_begun) return breach(XR_FRAME_DISCARDED, "xrBeginFrame: without xrEndFrame");
  g_world->frame_begun = true;
  return XR_SUCCESS;
}

void read_back(const Chain& chain, FakeXr::Picture& picture) {
  picture.width = static_cast<int>(chain.width);
  picture.height = static_cast<int>(chain.height);
  picture.rgba.resize(std::size_t{4} * chain.width * chain.height);
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glBindTexture(GL_TEXTURE_2D, chain.textures[static_cast<std::size_t>(chain.released)]);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
}

XrResult xrEndFrame(XrSession, const XrFrameEndInfo* info) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_FRAME_END_INFO);
  DEMAND(!no_context(), XR_ERROR_RUNTIME_FAILURE);
  DEMAND(g_world->frame_begun, XR_ERROR_CALL_ORDER_INVALID);
  g_world->frame_begun = false;
  DEMAND(info->displayTime == g_world->time || g_world->frame_waited > 0, XR_ERROR_TIME_INVALID);
  DEMAND(info->environmentBlendMode == XR_ENVIRONMENT_BLEND_MODE_OPAQUE,
         XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED);
  ++g_fake->ended;
  if (info->layerCount == 0) return XR_SUCCESS;
  const auto* const layer = reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[0]);
  TYPED(layer, XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  DEMAND(layer->space == kRoom && layer->viewCount == 2, XR_ERROR_VALIDATION_FAILURE);
  for (std::size_t n = 0; n < 2; ++n) {
    const XrCompositionLayerProjectionView& view = layer->views[n];
    TYPED(&view, XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
    DEMAND(unit(view.pose.orientation), XR_ERROR_POSE_INVALID);
    const Chain* const chain = chain_of(view.subImage.swapchain);
    DEMAND(chain != nullptr, XR_ERROR_HANDLE_INVALID);
    DEMAND(chain->acquired < 0 && chain->released >= 0, XR_ERROR_LAYER_INVALID);
    const XrRect2Di& rect = view.subImage.imageRect;
    DEMAND(rect.offset.x == 0 && rect.offset.y == 0 &&
               rect.extent.width == static_cast<int>(chain->width) &&
               rect.extent.height == static_cast<int>(chain->height),
           XR_ERROR_SWAPCHAIN_RECT_INVALID);
    read_back(*chain, g_fake->pictures[n]);
    g_fake->pictures[n].pose = view.pose;
  }
  ++g_fake->with_pictures;
  return XR_SUCCESS;
}

XrVector3f turned(const XrQuaternionf& q, const XrVector3f& v) {
  const XrVector3f t = {2 * (q.y * v.z - q.z * v.y), 2 * (q.z * v.x - q.x * v.z),
                        2 * (q.x * v.y - q.y * v.x)};
  return {v.x + q.w * t.x + (q.y * t.z - q.z * t.y), v.y + q.w * t.y + (q.z * t.x - q.x * t.z),
          v.z + q.w * t.z + (q.x * t.y - q.y * t.x)};
}

XrResult xrLocateViews(XrSession, const XrViewLocateInfo* info, XrViewState* state,
                       std::uint32_t room, std::uint32_t* count, XrView* to) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_VIEW_LOCATE_INFO);
  TYPED(state, XR_TYPE_VIEW_STATE);
  DEMAND(info->displayTime > 0 && info->space == kRoom, XR_ERROR_TIME_INVALID);
  DEMAND(room >= 2, XR_ERROR_SIZE_INSUFFICIENT);
  *count = 2;
  state->viewStateFlags =
      g_fake->views_known ? XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT
                          : 0;
  for (std::size_t n = 0; n < 2; ++n) {
    TYPED(to + n, XR_TYPE_VIEW);
    const XrVector3f aside =
        turned(g_fake->head.orientation, {(n == 0 ? -0.5F : 0.5F) * g_fake->eyes_apart, 0, 0});
    to[n].pose = g_fake->head;
    to[n].pose.position.x += aside.x;
    to[n].pose.position.y += aside.y;
    to[n].pose.position.z += aside.z;
    to[n].fov = g_fake->fov[n];
  }
  return XR_SUCCESS;
}

// ---- actions (11)

XrResult xrCreateActionSet(XrInstance, const XrActionSetCreateInfo* info, XrActionSet* to) {
  LOCKED;
  TYPED(info, XR_TYPE_ACTION_SET_CREATE_INFO);
  *to = kActionSet;
  return XR_SUCCESS;
}
XrResult xrDestroyActionSet(XrActionSet set) {
  LOCKED;
  DEMAND(set == kActionSet, XR_ERROR_HANDLE_INVALID);
  return XR_SUCCESS;
}
XrResult xrCreateAction(XrActionSet, const XrActionCreateInfo* info, XrAction* to) {
  LOCKED;
  TYPED(info, XR_TYPE_ACTION_CREATE_INFO);
  DEMAND(!g_world->attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  *to = handle<XrAction>(100 + g_world->actions.size());
  g_world->actions[*to] = info->actionType;
  return XR_SUCCESS;
}
XrResult xrStringToPath(XrInstance, const char* text, XrPath* to) {
  LOCKED;
  DEMAND(text[0] == '/', XR_ERROR_PATH_FORMAT_INVALID);
  *to = g_world->paths.try_emplace(text, 1 + g_world->paths.size()).first->second;
  return XR_SUCCESS;
}
XrResult xrSuggestInteractionProfileBindings(XrInstance,
                                             const XrInteractionProfileSuggestedBinding* info) {
  LOCKED;
  TYPED(info, XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
  DEMAND(!g_world->attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  const auto name_of = [](XrPath wanted) {
    for (const auto& [name, path] : g_world->paths)
      if (path == wanted) return name;
    return std::string();
  };
  // it knows two kinds, and a pen; a real runtime also knows only some (6.4, and the page of Logitech's extension)
  static const std::map<std::string, std::map<std::string, XrActionType>> kKnown = {
      {"khr/simple_controller",
       {{"/input/aim/pose", XR_ACTION_TYPE_POSE_INPUT},
        {"/input/select/click", XR_ACTION_TYPE_FLOAT_INPUT},
        {"/output/haptic", XR_ACTION_TYPE_VIBRATION_OUTPUT}}},
      {"oculus/touch_controller",
       {{"/input/aim/pose", XR_ACTION_TYPE_POSE_INPUT},
        {"/input/trigger/value", XR_ACTION_TYPE_FLOAT_INPUT},
        {"/output/haptic", XR_ACTION_TYPE_VIBRATION_OUTPUT}}},
      {"logitech/mx_ink_stylus_logitech",
       {{"/input/tip_logitech/pose", XR_ACTION_TYPE_POSE_INPUT},
        {"/input/tip_logitech/force", XR_ACTION_TYPE_FLOAT_INPUT},
        {"/input/cluster_middle_logitech/force", XR_ACTION_TYPE_FLOAT_INPUT},
        {"/output/haptic", XR_ACTION_TYPE_VIBRATION_OUTPUT}}}};
  const std::string profile = name_of(info->interactionProfile);
  constexpr std::size_t kBefore = 22;  // "/interaction_profiles/"
  const auto known = kKnown.find(profile.size() > kBefore ? profile.substr(kBefore) : "");
  const bool pens = profile.find("mx_ink") != std::string::npos;
  DEMAND(!pens || g_world->pen, XR_ERROR_PATH_UNSUPPORTED);
  if (known == kKnown.end()) return XR_ERROR_PATH_UNSUPPORTED;
  for (std::uint32_t n = 0; n < info->countSuggestedBindings; ++n) {
    const XrActionSuggestedBinding& one = info->suggestedBindings[n];
    const std::string path = name_of(one.binding);
    const std::string hand =
        path.starts_with("/user/hand/left") ? "/user/hand/left" : "/user/hand/right";
    DEMAND(path.starts_with(hand), XR_ERROR_PATH_UNSUPPORTED);
    const auto part = known->second.find(path.substr(hand.size()));
    if (g_fake->no_haptic_path && path.ends_with("/output/haptic"))
      return XR_ERROR_PATH_UNSUPPORTED;
    DEMAND(part != known->second.end(), XR_ERROR_PATH_UNSUPPORTED);
    DEMAND(part->second == g_world->actions[one.action], XR_ERROR_ACTION_TYPE_MISMATCH);
    if (pens || !g_fake->pen) g_fake->bound.push_back(path);
  }
  return XR_SUCCESS;
}
XrResult xrAttachSessionActionSets(XrSession, const XrSessionActionSetsAttachInfo* info) {
  LOCKED;
  TYPED(info, XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
  DEMAND(!g_world->attached, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  g_world->attached = true;
  return XR_SUCCESS;
}
XrResult xrCreateActionSpace(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* to) {
  LOCKED;
  TYPED(info, XR_TYPE_ACTION_SPACE_CREATE_INFO);
  DEMAND(g_world->actions[info->action] == XR_ACTION_TYPE_POSE_INPUT,
         XR_ERROR_ACTION_TYPE_MISMATCH);
  DEMAND(unit(info->poseInActionSpace.orientation), XR_ERROR_POSE_INVALID);
  *to = kWand;
  return XR_SUCCESS;
}
XrResult xrSyncActions(XrSession, const XrActionsSyncInfo* info) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_ACTIONS_SYNC_INFO);
  DEMAND(g_world->attached && info->countActiveActionSets == 1, XR_ERROR_ACTIONSET_NOT_ATTACHED);
  return g_fake->state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}
XrResult xrGetActionStateFloat(XrSession, const XrActionStateGetInfo* info,
                               XrActionStateFloat* to) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_ACTION_STATE_GET_INFO);
  TYPED(to, XR_TYPE_ACTION_STATE_FLOAT);
  DEMAND(g_world->actions[info->action] == XR_ACTION_TYPE_FLOAT_INPUT,
         XR_ERROR_ACTION_TYPE_MISMATCH);
  to->isActive = XR_TRUE;
  to->currentState = g_fake->trigger;
  return XR_SUCCESS;
}
XrResult xrApplyHapticFeedback(XrSession, const XrHapticActionInfo* info,
                               const XrHapticBaseHeader* how) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_HAPTIC_ACTION_INFO);
  TYPED(how, XR_TYPE_HAPTIC_VIBRATION);
  DEMAND(g_world->actions[info->action] == XR_ACTION_TYPE_VIBRATION_OUTPUT,
         XR_ERROR_ACTION_TYPE_MISMATCH);
  const auto& vibration = *reinterpret_cast<const XrHapticVibration*>(how);
  DEMAND(vibration.amplitude >= 0 && vibration.amplitude <= 1, XR_ERROR_VALIDATION_FAILURE);
  DEMAND(vibration.duration > 0 || vibration.duration == XR_MIN_HAPTIC_DURATION,
         XR_ERROR_VALIDATION_FAILURE);
  if (g_fake->state != XR_SESSION_STATE_FOCUSED) return XR_SESSION_NOT_FOCUSED;
  if (XR_FAILED(g_fake->haptic_answer)) return g_fake->haptic_answer;
  ++g_fake->applied;
  g_fake->vibrates = vibration.amplitude;
  g_fake->most_vibration = std::max(g_fake->most_vibration, vibration.amplitude);
  g_fake->vibrates_for = 1e-9 * static_cast<double>(vibration.duration);
  return XR_SUCCESS;
}
XrResult xrStopHapticFeedback(XrSession, const XrHapticActionInfo* info) {
  LOCKED;
  ALIVE;
  TYPED(info, XR_TYPE_HAPTIC_ACTION_INFO);
  DEMAND(g_world->actions[info->action] == XR_ACTION_TYPE_VIBRATION_OUTPUT,
         XR_ERROR_ACTION_TYPE_MISMATCH);
  ++g_fake->stopped;
  g_fake->vibrates = 0;
  return XR_SUCCESS;
}
XrResult xrLocateSpace(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* to) {
  LOCKED;
  ALIVE;
  TYPED(to, XR_TYPE_SPACE_LOCATION);
  DEMAND(space == kWand && base == kRoom && time > 0, XR_ERROR_VALIDATION_FAILURE);
  to->locationFlags = g_fake->wand_tracked ? XR_SPACE_LOCATION_POSITION_VALID_BIT |
                                                 XR_SPACE_LOCATION_ORIENTATION_VALID_BIT |
                                                 XR_SPACE_LOCATION_POSITION_TRACKED_BIT |
                                                 XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT
                                           : XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  to->pose = g_fake->wand;
  return XR_SUCCESS;
}

}  // namespace

extern "C" FakeXr* fake_xr() { return g_fake; }
// The old objects stay alive, because a hanging wait of an earlier test may still use them.
extern "C" void fake_xr_forget() {
  g_fake = new FakeXr;
  g_world = new World;
}

extern "C" XrResult xrGetInstanceProcAddr(XrInstance instance, const char* name,
                                          PFN_xrVoidFunction* to) {
  *to = nullptr;
  if (instance == XR_NULL_HANDLE && std::strcmp(name, "xrCreateInstance") != 0 &&
      std::strcmp(name, "xrEnumerateInstanceExtensionProperties") != 0)
    return breach(XR_ERROR_HANDLE_INVALID, std::string("xrGetInstanceProcAddr: ") + name);
#define OFFER(function) \
  if (std::strcmp(name, #function) == 0) *to = reinterpret_cast<PFN_xrVoidFunction>(function);
  OFFER(xrEnumerateInstanceExtensionProperties)
  OFFER(xrCreateInstance)
  OFFER(xrDestroyInstance)
  OFFER(xrGetSystem)
  OFFER(xrGetSystemProperties)
  OFFER(xrPollEvent)
  OFFER(xrGetOpenGLGraphicsRequirementsKHR)
  OFFER(xrCreateSession)
  OFFER(xrDestroySession)
  OFFER(xrBeginSession)
  OFFER(xrEndSession)
  OFFER(xrCreateReferenceSpace)
  OFFER(xrDestroySpace)
  OFFER(xrEnumerateViewConfigurationViews)
  OFFER(xrEnumerateEnvironmentBlendModes)
  OFFER(xrEnumerateSwapchainFormats)
  OFFER(xrCreateSwapchain)
  OFFER(xrDestroySwapchain)
  OFFER(xrEnumerateSwapchainImages)
  OFFER(xrAcquireSwapchainImage)
  OFFER(xrWaitSwapchainImage)
  OFFER(xrReleaseSwapchainImage)
  OFFER(xrWaitFrame)
  OFFER(xrBeginFrame)
  OFFER(xrEndFrame)
  OFFER(xrLocateViews)
  OFFER(xrCreateActionSet)
  OFFER(xrDestroyActionSet)
  OFFER(xrCreateAction)
  OFFER(xrStringToPath)
  OFFER(xrSuggestInteractionProfileBindings)
  OFFER(xrAttachSessionActionSets)
  OFFER(xrCreateActionSpace)
  OFFER(xrSyncActions)
  OFFER(xrGetActionStateFloat)
  if (!g_fake->no_haptics) {
    OFFER(xrApplyHapticFeedback)
    OFFER(xrStopHapticFeedback)
  }
  OFFER(xrLocateSpace)
  return *to == nullptr ? XR_ERROR_FUNCTION_UNSUPPORTED : XR_SUCCESS;
}
