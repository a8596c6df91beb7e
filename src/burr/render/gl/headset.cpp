// OpenXR 1.0 as in the specification: instance, system, session, two swapchains, one set of
// actions. The runtime in tests/support/fake_openxr.cpp checks the rules of each call.
#include "burr/render/headset.h"

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "burr/render/gl/xr_binding.h"

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

namespace burr::render {

using math::Vec3;

namespace {

constexpr const char* kLoader = "libopenxr_loader.so.1";
constexpr auto kPatience = std::chrono::seconds(2);  // longest wait for a runtime that does not
                                                     // return

// The functions of OpenXR, found by name: the loader is not linked.
struct Calls {
#define BURR_XR_CALLS(call) call(EnumerateInstanceExtensionProperties) call(CreateInstance)
#define BURR_XR_INSTANCE_CALLS(call)                                                            \
  call(DestroyInstance) call(GetSystem) call(GetSystemProperties) call(PollEvent)               \
      call(CreateSession) call(DestroySession) call(BeginSession) call(EndSession)              \
          call(CreateReferenceSpace) call(DestroySpace) call(EnumerateViewConfigurationViews)   \
              call(EnumerateEnvironmentBlendModes) call(EnumerateSwapchainFormats)              \
                  call(CreateSwapchain) call(DestroySwapchain) call(EnumerateSwapchainImages)   \
                      call(AcquireSwapchainImage) call(WaitSwapchainImage)                      \
                          call(ReleaseSwapchainImage) call(WaitFrame) call(BeginFrame)          \
                              call(EndFrame) call(LocateViews) call(CreateActionSet)            \
                                  call(DestroyActionSet) call(CreateAction) call(StringToPath)  \
                                      call(SuggestInteractionProfileBindings)                   \
                                          call(AttachSessionActionSets) call(CreateActionSpace) \
                                              call(SyncActions) call(GetActionStateFloat)       \
                                                  call(LocateSpace)                             \
                                                      call(GetOpenGLGraphicsRequirementsKHR)
#define BURR_XR_MEMBER(name) PFN_xr##name name = nullptr;
  BURR_XR_CALLS(BURR_XR_MEMBER)
  BURR_XR_INSTANCE_CALLS(BURR_XR_MEMBER)
#undef BURR_XR_MEMBER
};

Error no_headset(const std::string& why) { return error(Trouble::io, "no headset: " + why); }

Error refused(const char* call, XrResult code) {
  return no_headset(
      fmt::format("the runtime refuses xr{} ({}); restart the runtime, then switch the headset on "
                  "again in the settings (F2)",
                  call, static_cast<int>(code)));
}

template <class Structure>
Structure made(XrStructureType type) {
  Structure structure{};
  structure.type = type;
  return structure;
}

void copy(char* to, std::size_t size, const char* from) {
  std::strncpy(to, from, size - 1);
  to[size - 1] = '\0';
}

math::Pose pose_of(const XrPosef& pose) {
  return {
      {pose.position.x, pose.position.y, pose.position.z},
      math::Quat(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z)};
}

bool known(XrFlags64 flags, XrFlags64 wanted) { return (flags & wanted) == wanted; }

}  // namespace

struct Headset::Work {
  explicit Work(Renderer& shows) : renderer(shows) {}

  Renderer& renderer;
  Calls xr;
  XrInstance instance = XR_NULL_HANDLE;
  XrSystemId system = XR_NULL_SYSTEM_ID;
  XrSession session = XR_NULL_HANDLE;
  XrSpace room = XR_NULL_HANDLE, wand = XR_NULL_HANDLE;
  XrActionSet actions = XR_NULL_HANDLE;
  XrAction pose = XR_NULL_HANDLE, trigger = XR_NULL_HANDLE;
  XrEnvironmentBlendMode blend = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  struct Screen {
    XrSwapchain chain = XR_NULL_HANDLE;
    int width = 0, height = 0;
    std::vector<XrSwapchainImageOpenGLKHR> images;
    std::optional<std::uint32_t> acquired;  // acquired and not yet released
  };
  std::array<Screen, 2> screens;
  bool running = false, focused = false, over = false, begun = false;
  std::string why, name;
  XrTime due = 0;      // display time of the present frame
  bool shown = false;  // the frame will be shown
  std::array<XrView, 2> views = {};
  bool eyes = false;  // the poses of the eyes are known

  // The runtime's wait on a thread of its own, which may never return: that thread uses only this.
  struct Waiter {
    std::mutex mutex;
    std::condition_variable told;
    PFN_xrWaitFrame wait = nullptr;
    XrSession session = XR_NULL_HANDLE;
    bool wanted = false, quit = false, gone = false;
    std::optional<std::pair<XrResult, XrFrameState>> got;
  };
  std::shared_ptr<Waiter> waiter = std::make_shared<Waiter>();
  std::thread thread;
  bool waiting = false;  // a wait was requested and its result not taken yet

  Status open();
  Status find_system();
  Status make_session();
  Status make_screens();
  Status make_actions(bool left_handed);
  void start_waiter();
  void look_at_events();
  void changed(XrSessionState state);
  void end_session();
  bool good(const char* call, XrResult code);
  void end_with(std::string because);
  void locate(Headset::Now& now);
  bool draw(int eye, const Scene& scene);
  void end_frame(const std::array<XrCompositionLayerProjectionView, 2>* parts);
  bool stop_waiting();
  void close();
};

// ---- start

Status Headset::Work::open() {
  const char* given = std::getenv("BURR_OPENXR_LOADER");
  const char* file = given != nullptr && *given != '\0' ? given : kLoader;
  // never closed again: a runtime may leave threads running
  void* const loader = dlopen(file, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (loader == nullptr)
    return no_headset(fmt::format(
        "{} cannot be loaded; install libopenxr-loader1 and the headset's runtime, such as Monado",
        file));
  auto* const find =
      reinterpret_cast<PFN_xrGetInstanceProcAddr>(dlsym(loader, "xrGetInstanceProcAddr"));
  if (find == nullptr)
    return no_headset(fmt::format(
        "{} is not an OpenXR loader; install libopenxr-loader1, or unset BURR_OPENXR_LOADER",
        file));
  const auto get = [&](XrInstance of, const char* called, auto& to) {
    PFN_xrVoidFunction found = nullptr;
    if (XR_FAILED(find(of, called, &found)) || found == nullptr) return false;
    to = reinterpret_cast<std::remove_reference_t<decltype(to)>>(found);
    return true;
  };
  const Error old =
      no_headset(fmt::format("{} does not support OpenXR 1.0; install a newer one", file));
#define BURR_XR_FIND(called) \
  if (!get(instance, "xr" #called, xr.called)) return old;
  BURR_XR_CALLS(BURR_XR_FIND)

  const gl::XrBinding binding = gl::xr_binding();
  std::vector<const char*> wanted = {XR_KHR_OPENGL_ENABLE_EXTENSION_NAME};
  if (binding.extension != nullptr) wanted.push_back(binding.extension);
  std::uint32_t count = 0;
  constexpr const char* kNoRuntime =
      "OpenXR finds no runtime; install and start the headset's runtime, such as Monado or "
      "SteamVR, then switch the headset on again (F2)";
  if (XR_FAILED(xr.EnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr)))
    return no_headset(kNoRuntime);
  std::vector<XrExtensionProperties> offered(
      count, made<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
  if (XR_FAILED(xr.EnumerateInstanceExtensionProperties(nullptr, count, &count, offered.data())))
    return no_headset(kNoRuntime);
  for (const char* one : wanted)
    if (std::none_of(offered.begin(), offered.end(), [one](const XrExtensionProperties& has) {
          return std::strcmp(has.extensionName, one) == 0;
        }))
      return no_headset(
          fmt::format("the runtime does not offer {}, which this window needs; use another "
                      "runtime, or start burr with SDL_VIDEODRIVER=x11",
                      one));

  auto info = made<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  copy(info.applicationInfo.applicationName, XR_MAX_APPLICATION_NAME_SIZE, "burr");
  copy(info.applicationInfo.engineName, XR_MAX_ENGINE_NAME_SIZE, "burr");
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = static_cast<std::uint32_t>(wanted.size());
  info.enabledExtensionNames = wanted.data();
  const XrResult created = xr.CreateInstance(&info, &instance);
  if (created == XR_ERROR_RUNTIME_UNAVAILABLE || created == XR_ERROR_RUNTIME_FAILURE)
    return no_headset(kNoRuntime);
  if (XR_FAILED(created)) return refused("CreateInstance", created);
  BURR_XR_INSTANCE_CALLS(BURR_XR_FIND)
#undef BURR_XR_FIND
  return fine();
}

Status Headset::Work::find_system() {
  auto info = made<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  info.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  const XrResult found = xr.GetSystem(instance, &info, &system);
  if (found == XR_ERROR_FORM_FACTOR_UNAVAILABLE || found == XR_ERROR_FORM_FACTOR_UNSUPPORTED)
    return no_headset(
        "OpenXR's runtime finds none; connect the headset and power it on, then switch it on again "
        "in the settings (F2)");
  if (XR_FAILED(found)) return refused("GetSystem", found);
  auto properties = made<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  if (XR_SUCCEEDED(xr.GetSystemProperties(instance, system, &properties)))
    name = properties.systemName;
  return fine();
}

Status Headset::Work::make_session() {
  // the runtime demands this question, whatever the answer
  auto needs = made<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
  XrResult code = xr.GetOpenGLGraphicsRequirementsKHR(instance, system, &needs);
  if (XR_FAILED(code)) return refused("GetOpenGLGraphicsRequirementsKHR", code);
  if (renderer.es() || XR_MAKE_VERSION(epoxy_gl_version() / 10, epoxy_gl_version() % 10, 0) <
                           needs.minApiVersionSupported)
    return no_headset(
        fmt::format("the runtime needs OpenGL {}.{}, but the graphics driver offers an older "
                    "version; update the driver",
                    XR_VERSION_MAJOR(needs.minApiVersionSupported),
                    XR_VERSION_MINOR(needs.minApiVersionSupported)));
  const gl::XrBinding binding = gl::xr_binding();
  if (!binding.there)
    return no_headset("the OpenGL of this window uses neither GLX nor EGL; start burr under X11");
  auto info = made<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
  info.next = binding.next();
  info.systemId = system;
  code = xr.CreateSession(instance, &info, &session);
  if (XR_FAILED(code)) return refused("CreateSession", code);

  auto space = made<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  space.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;  // every runtime has it
  space.poseInReferenceSpace.orientation.w = 1;
  code = xr.CreateReferenceSpace(session, &space, &room);
  if (XR_FAILED(code)) return refused("CreateReferenceSpace", code);

  std::uint32_t count = 0;
  constexpr auto kTwo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  code = xr.EnumerateEnvironmentBlendModes(instance, system, kTwo, 0, &count, nullptr);
  std::vector<XrEnvironmentBlendMode> blends(count);
  if (XR_SUCCEEDED(code))
    code = xr.EnumerateEnvironmentBlendModes(instance, system, kTwo, count, &count, blends.data());
  if (XR_FAILED(code) || blends.empty()) return refused("EnumerateEnvironmentBlendModes", code);
  if (std::find(blends.begin(), blends.end(), blend) == blends.end()) blend = blends.front();
  return fine();
}

Status Headset::Work::make_screens() {
  std::uint32_t count = 0;
  std::array<XrViewConfigurationView, 2> sizes;
  sizes.fill(made<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
  XrResult code = xr.EnumerateViewConfigurationViews(
      instance, system, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, 2, &count, sizes.data());
  if (XR_FAILED(code) || count != 2) return refused("EnumerateViewConfigurationViews", code);

  code = xr.EnumerateSwapchainFormats(session, 0, &count, nullptr);
  std::vector<std::int64_t> formats(count);
  if (XR_SUCCEEDED(code))
    code = xr.EnumerateSwapchainFormats(session, count, &count, formats.data());
  if (XR_FAILED(code)) return refused("EnumerateSwapchainFormats", code);
  // the pictures are sRGB already
  std::int64_t format = 0;
  for (const std::int64_t wanted : {std::int64_t{GL_RGBA8}, std::int64_t{GL_SRGB8_ALPHA8}})
    if (std::find(formats.begin(), formats.end(), wanted) != formats.end()) format = wanted;
  if (format == 0)
    return no_headset(
        "the runtime accepts no pictures with 8 bits per colour; use another runtime");

  for (std::size_t eye = 0; eye < 2; ++eye) {
    Screen& screen = screens[eye];
    auto info = made<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
    info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    info.format = format;
    info.sampleCount = 1;
    info.width = sizes[eye].recommendedImageRectWidth;
    info.height = sizes[eye].recommendedImageRectHeight;
    info.faceCount = info.arraySize = info.mipCount = 1;
    code = xr.CreateSwapchain(session, &info, &screen.chain);
    if (XR_FAILED(code)) return refused("CreateSwapchain", code);
    screen.width = static_cast<int>(info.width);
    screen.height = static_cast<int>(info.height);
    code = xr.EnumerateSwapchainImages(screen.chain, 0, &count, nullptr);
    screen.images.assign(count,
                         made<XrSwapchainImageOpenGLKHR>(XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR));
    if (XR_SUCCEEDED(code))
      code = xr.EnumerateSwapchainImages(
          screen.chain, count, &count,
          reinterpret_cast<XrSwapchainImageBaseHeader*>(screen.images.data()));
    if (XR_FAILED(code)) return refused("EnumerateSwapchainImages", code);
  }
  return fine();
}

// One hand: where it points, and how far its trigger is pulled.
Status Headset::Work::make_actions(bool left_handed) {
  const std::string hand = left_handed ? "/user/hand/left" : "/user/hand/right";
  auto set = made<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
  copy(set.actionSetName, XR_MAX_ACTION_SET_NAME_SIZE, "milling");
  copy(set.localizedActionSetName, XR_MAX_LOCALIZED_ACTION_SET_NAME_SIZE, "Milling");
  XrResult code = xr.CreateActionSet(instance, &set, &actions);
  if (XR_FAILED(code)) return refused("CreateActionSet", code);
  const auto action = [&](XrActionType type, const char* called, const char* says, XrAction& to) {
    auto info = made<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
    info.actionType = type;
    copy(info.actionName, XR_MAX_ACTION_NAME_SIZE, called);
    copy(info.localizedActionName, XR_MAX_LOCALIZED_ACTION_NAME_SIZE, says);
    return xr.CreateAction(actions, &info, &to);
  };
  code = action(XR_ACTION_TYPE_POSE_INPUT, "tool", "Where the tool is", pose);
  if (XR_FAILED(code)) return refused("CreateAction", code);
  code = action(XR_ACTION_TYPE_FLOAT_INPUT, "pedal", "Spindle", trigger);
  if (XR_FAILED(code)) return refused("CreateAction", code);

  const auto path = [&](const std::string& text) {
    XrPath at = XR_NULL_PATH;
    xr.StringToPath(instance, text.c_str(), &at);
    return at;
  };
  constexpr std::pair<const char*, const char*> kProfiles[] = {
      {"khr/simple_controller", "select/click"},
      {"oculus/touch_controller", "trigger/value"},
      {"valve/index_controller", "trigger/value"},
      {"htc/vive_controller", "trigger/value"},
      {"microsoft/motion_controller", "trigger/value"}};
  bool any = false;
  for (const auto& [profile, pulled] : kProfiles) {
    const std::array<XrActionSuggestedBinding, 2> bindings = {
        {{pose, path(hand + "/input/aim/pose")}, {trigger, path(hand + "/input/" + pulled)}}};
    auto suggested =
        made<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
    suggested.interactionProfile = path(std::string("/interaction_profiles/") + profile);
    suggested.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    suggested.suggestedBindings = bindings.data();
    // a runtime need not know all of them
    code = xr.SuggestInteractionProfileBindings(instance, &suggested);
    any = any || XR_SUCCEEDED(code);
  }
  if (!any) return refused("SuggestInteractionProfileBindings", code);
  auto attach = made<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
  attach.countActionSets = 1;
  attach.actionSets = &actions;
  code = xr.AttachSessionActionSets(session, &attach);
  if (XR_FAILED(code)) return refused("AttachSessionActionSets", code);
  auto space = made<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
  space.action = pose;
  space.poseInActionSpace.orientation.w = 1;
  code = xr.CreateActionSpace(session, &space, &wand);
  if (XR_FAILED(code)) return refused("CreateActionSpace", code);
  return fine();
}

void Headset::Work::start_waiter() {
  waiter->wait = xr.WaitFrame;
  waiter->session = session;
  thread = std::thread([w = waiter] {
    std::unique_lock lock(w->mutex);
    for (;;) {
      w->told.wait(lock, [&] { return w->wanted || w->quit; });
      if (w->quit) break;
      w->wanted = false;
      lock.unlock();
      auto info = made<XrFrameWaitInfo>(XR_TYPE_FRAME_WAIT_INFO);
      auto state = made<XrFrameState>(XR_TYPE_FRAME_STATE);
      const XrResult code = w->wait(w->session, &info, &state);
      lock.lock();
      w->got = {code, state};
      w->told.notify_all();
    }
    w->gone = true;
    w->told.notify_all();
  });
}

// ---- events of the runtime

void Headset::Work::end_with(std::string because) {
  if (over) return;
  over = true;
  running = focused = false;
  why = std::move(because);
}

bool Headset::Work::good(const char* call, XrResult code) {
  if (code == XR_SESSION_LOSS_PENDING || code == XR_ERROR_SESSION_LOST ||
      code == XR_ERROR_INSTANCE_LOST)
    end_with(
        "The headset was disconnected; the window continues. Connect it, then switch it on again "
        "in the settings (F2).");
  else if (XR_FAILED(code))
    end_with(fmt::format(
        "The headset's runtime refuses xr{} ({}); the window continues without the headset.", call,
        static_cast<int>(code)));
  return !over;
}

void Headset::Work::look_at_events() {
  while (!over) {
    auto event = made<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    const XrResult code = xr.PollEvent(instance, &event);
    if (code == XR_EVENT_UNAVAILABLE || !good("PollEvent", code)) return;
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
      static_cast<void>(good("PollEvent", XR_ERROR_INSTANCE_LOST));
    } else if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
      XrEventDataSessionStateChanged state;
      std::memcpy(&state, &event, sizeof state);
      if (state.session == session) changed(state.state);
    }
  }
}

void Headset::Work::changed(XrSessionState state) {
  focused = state == XR_SESSION_STATE_FOCUSED;
  if (state == XR_SESSION_STATE_READY) {
    auto info = made<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
    info.primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    running = good("BeginSession", xr.BeginSession(session, &info));
  } else if (state == XR_SESSION_STATE_STOPPING) {
    end_session();
  } else if (state == XR_SESSION_STATE_LOSS_PENDING) {
    static_cast<void>(good("PollEvent", XR_ERROR_SESSION_LOST));
  } else if (state == XR_SESSION_STATE_EXITING) {
    end_with("The headset's runtime has ended; the window continues without the headset.");
  }
}

// Waits for the end of a requested wait and drops its frame. False: it does not return.
bool Headset::Work::stop_waiting() {
  if (!waiting) return true;
  std::unique_lock lock(waiter->mutex);
  if (!waiter->told.wait_for(lock, kPatience, [&] { return waiter->got.has_value(); }))
    return false;
  waiter->got.reset();
  waiting = false;
  return true;
}

void Headset::Work::end_session() {
  running = focused = false;
  if (!stop_waiting()) {
    end_with("The headset's runtime does not answer; the window continues without the headset.");
    return;
  }
  static_cast<void>(good("EndSession", xr.EndSession(session)));
}

// ---- frames

void Headset::Work::locate(Headset::Now& now) {
  auto info = made<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
  info.viewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  info.displayTime = due;
  info.space = room;
  auto state = made<XrViewState>(XR_TYPE_VIEW_STATE);
  views.fill(made<XrView>(XR_TYPE_VIEW));
  std::uint32_t count = 0;
  eyes = false;
  if (!good("LocateViews", xr.LocateViews(session, &info, &state, 2, &count, views.data()))) return;
  eyes = shown && count == 2 &&
         known(state.viewStateFlags,
               XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT);
  for (std::size_t n = 0; n < 2; ++n) {
    PlacedEye& eye = now.room_from_eye[n];
    const XrFovf& fov = views[n].fov;
    eye.world_from_eye = pose_of(views[n].pose);
    eye.left = std::tan(static_cast<double>(fov.angleLeft));
    eye.right = std::tan(static_cast<double>(fov.angleRight));
    eye.bottom = std::tan(static_cast<double>(fov.angleDown));
    eye.top = std::tan(static_cast<double>(fov.angleUp));
    // written so that a NaN is refused too
    const bool sees = eye.world_from_eye.finite() &&
                      std::abs(eye.world_from_eye.q.norm() - 1) < 0.01 &&
                      eye.right - eye.left > 1e-3 && eye.top - eye.bottom > 1e-3;
    eyes = eyes && sees;
  }
  now.eyes = eyes;

  if (!focused) return;  // another program has the input of the hands
  const XrActiveActionSet active = {actions, XR_NULL_PATH};
  auto sync = made<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
  sync.countActiveActionSets = 1;
  sync.activeActionSets = &active;
  const XrResult synced = xr.SyncActions(session, &sync);
  if (!good("SyncActions", synced) || synced == XR_SESSION_NOT_FOCUSED) return;
  auto where = made<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
  if (!good("LocateSpace", xr.LocateSpace(wand, room, due, &where))) return;
  now.wand.tracked = known(where.locationFlags, XR_SPACE_LOCATION_POSITION_VALID_BIT |
                                                    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT |
                                                    XR_SPACE_LOCATION_POSITION_TRACKED_BIT |
                                                    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT);
  if (now.wand.tracked) now.wand.room_from_wand = pose_of(where.pose);
  auto get = made<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
  get.action = trigger;
  auto pulled = made<XrActionStateFloat>(XR_TYPE_ACTION_STATE_FLOAT);
  if (good("GetActionStateFloat", xr.GetActionStateFloat(session, &get, &pulled)) &&
      pulled.isActive == XR_TRUE)
    now.wand.trigger = std::clamp(static_cast<double>(pulled.currentState), 0.0, 1.0);
}

std::optional<Headset::Now> Headset::begin(double wait_s) {
  Work& w = *work_;
  w.look_at_events();
  if (w.over || !w.running) return std::nullopt;
  std::pair<XrResult, XrFrameState> got;
  {
    std::unique_lock lock(w.waiter->mutex);
    if (!std::exchange(w.waiting, true)) {
      w.waiter->wanted = true;
      w.waiter->told.notify_all();
    }
    if (!w.waiter->told.wait_for(lock, std::chrono::duration<double>(wait_s),
                                 [&] { return w.waiter->got.has_value(); }))
      return std::nullopt;
    got = *std::exchange(w.waiter->got, std::nullopt);
    w.waiting = false;
  }
  if (!w.good("WaitFrame", got.first)) return std::nullopt;
  const auto info = made<XrFrameBeginInfo>(XR_TYPE_FRAME_BEGIN_INFO);
  if (!w.good("BeginFrame", w.xr.BeginFrame(w.session, &info))) return std::nullopt;
  w.begun = true;
  w.due = got.second.predictedDisplayTime;
  w.shown = got.second.shouldRender == XR_TRUE;
  Now now;
  now.period = 1e-9 * static_cast<double>(got.second.predictedDisplayPeriod);
  w.locate(now);
  return now;
}

// Draws one eye's picture into the free image. False: there is none to show.
bool Headset::Work::draw(int eye, const Scene& scene) {
  Screen& screen = screens[static_cast<std::size_t>(eye)];
  if (!screen.acquired) {
    const auto info = made<XrSwapchainImageAcquireInfo>(XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO);
    std::uint32_t index = 0;
    if (!good("AcquireSwapchainImage", xr.AcquireSwapchainImage(screen.chain, &info, &index)))
      return false;
    screen.acquired = index;
  }
  auto wait = made<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
  wait.timeout = 50'000'000;  // [ns]
  const XrResult free = xr.WaitSwapchainImage(screen.chain, &wait);
  // the image stays acquired; the next frame waits for it again
  if (!good("WaitSwapchainImage", free) || free == XR_TIMEOUT_EXPIRED) return false;
  const std::uint32_t index = *std::exchange(screen.acquired, std::nullopt);
  const bool drawn =
      index < screen.images.size() &&
      renderer.eye(scene, eye, screen.images[index].image, screen.width, screen.height).ok();
  const auto info = made<XrSwapchainImageReleaseInfo>(XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO);
  return good("ReleaseSwapchainImage", xr.ReleaseSwapchainImage(screen.chain, &info)) && drawn;
}

void Headset::end(const Scene& scene, const std::array<Camera, 2>& cameras) {
  Work& w = *work_;
  if (!std::exchange(w.begun, false) || w.over) return;
  std::array<XrCompositionLayerProjectionView, 2> parts;
  bool drawn = w.eyes;
  if (drawn) {
    Scene seen = scene;
    for (std::size_t eye = 0; eye < 2; ++eye) {
      seen.camera = cameras[eye];
      drawn = w.draw(static_cast<int>(eye), seen) && drawn;
      XrCompositionLayerProjectionView& part = parts[eye];
      part = made<XrCompositionLayerProjectionView>(XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
      part.pose = w.views[eye].pose;
      part.fov = w.views[eye].fov;
      part.subImage.swapchain = w.screens[eye].chain;
      part.subImage.imageRect.extent = {w.screens[eye].width, w.screens[eye].height};
    }
  }
  if (!w.over) w.end_frame(drawn ? &parts : nullptr);
}

// Ends the frame, with these pictures; nullptr: without. Every frame that was begun must be ended.
void Headset::Work::end_frame(const std::array<XrCompositionLayerProjectionView, 2>* parts) {
  auto layer = made<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  layer.space = room;
  layer.viewCount = 2;
  layer.views = parts != nullptr ? parts->data() : nullptr;
  const auto* const layers = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
  auto info = made<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
  info.displayTime = due;
  info.environmentBlendMode = blend;
  info.layerCount = parts != nullptr ? 1 : 0;
  info.layers = parts != nullptr ? &layers : nullptr;
  static_cast<void>(good("EndFrame", xr.EndFrame(session, &info)));
}

// ---- the object

Headset::Headset(std::unique_ptr<Work> work) : work_(std::move(work)) {}

Result<std::unique_ptr<Headset>> Headset::start(Renderer& renderer, bool left_handed) {
  renderer.make_current();
  std::unique_ptr<Headset> headset(new Headset(std::make_unique<Work>(renderer)));
  Work& w = *headset->work_;
  if (const Status s = w.open(); !s) return s.error();
  if (const Status s = w.find_system(); !s) return s.error();
  if (const Status s = w.make_session(); !s) return s.error();
  if (const Status s = w.make_screens(); !s) return s.error();
  if (const Status s = w.make_actions(left_handed); !s) return s.error();
  w.start_waiter();
  return headset;
}

void Headset::Work::close() {
  renderer.make_current();
  bool came_back = true;
  if (thread.joinable()) {
    std::unique_lock lock(waiter->mutex);
    waiter->quit = true;
    waiter->told.notify_all();
    came_back = waiter->told.wait_for(lock, kPatience, [&] { return waiter->gone; });
    lock.unlock();
    if (came_back)
      thread.join();
    else
      thread.detach();  // what the thread waits for must then stay alive
  }
  if (std::exchange(begun, false) && !over) end_frame(nullptr);
  if (!came_back || instance == XR_NULL_HANDLE || xr.DestroyInstance == nullptr) return;
  if (wand != XR_NULL_HANDLE) xr.DestroySpace(wand);
  if (room != XR_NULL_HANDLE) xr.DestroySpace(room);
  for (const Screen& screen : screens)
    if (screen.chain != XR_NULL_HANDLE) xr.DestroySwapchain(screen.chain);
  if (session != XR_NULL_HANDLE) xr.DestroySession(session);
  if (actions != XR_NULL_HANDLE) xr.DestroyActionSet(actions);
  xr.DestroyInstance(instance);
}

Headset::~Headset() {
  if (work_ != nullptr) work_->close();
}

bool Headset::running() const { return work_->running; }
bool Headset::over() const { return work_->over; }
const std::string& Headset::why() const { return work_->why; }
const std::string& Headset::name() const { return work_->name; }

}  // namespace burr::render
