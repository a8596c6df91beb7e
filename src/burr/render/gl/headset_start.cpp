// render/gl/headset_start.cpp - a headset is found and made ready: instance, system, session, two swapchains, one set of
// actions, as in the specification of OpenXR 1.0.
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "burr/render/gl/headset_work.h"
#include "burr/render/gl/xr_binding.h"

namespace burr::render {
namespace {

using openxr::made;

constexpr const char* kLoader = "libopenxr_loader.so.1";

Error no_headset(const std::string& why) { return error(Trouble::io, "no headset: " + why); }

Error refused(const char* call, XrResult code) {
  return no_headset(
      fmt::format("the runtime refuses xr{} ({}); restart the runtime, then switch the headset on "
                  "again in the settings (F2)",
                  call, static_cast<int>(code)));
}

// Logitech's MX Ink, a pen
constexpr const char* kPenExtension = "XR_LOGITECH_mx_ink_stylus_interaction";

void copy(char* to, std::size_t size, const char* from) {
  std::strncpy(to, from, size - 1);
  to[size - 1] = '\0';
}

}  // namespace

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

  has_pen = std::any_of(offered.begin(), offered.end(), [](const XrExtensionProperties& has) {
    return std::strcmp(has.extensionName, kPenExtension) == 0;
  });
  if (has_pen) wanted.push_back(kPenExtension);

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
#define BURR_XR_FIND_IF_THERE(called) static_cast<void>(get(instance, "xr" #called, xr.called));
  BURR_XR_HAPTIC_CALLS(BURR_XR_FIND_IF_THERE)
#undef BURR_XR_FIND_IF_THERE
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

// One hand: where it points, how far its trigger is pulled, and that it vibrates.
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
  if (xr.ApplyHapticFeedback == nullptr || xr.StopHapticFeedback == nullptr)
    cannot_shake("it lacks xrApplyHapticFeedback or xrStopHapticFeedback");
  else if (XR_FAILED(code = action(XR_ACTION_TYPE_VIBRATION_OUTPUT, "cutting", "Cutting of bone",
                                   shaker)))
    cannot_shake(fmt::format("it refuses xrCreateAction, {}", static_cast<int>(code)));
  if (const Status suggested = suggest_bindings(hand); !suggested) return suggested;
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

// What the actions are on each kind of controller. A runtime need not know all of them.
Status Headset::Work::suggest_bindings(const std::string& hand) {
  const auto path = [&](const std::string& text) {
    XrPath at = XR_NULL_PATH;
    xr.StringToPath(instance, text.c_str(), &at);
    return at;
  };
  struct Profile {
    const char *name, *points, *pulled;
    bool pen;
  };
  constexpr Profile kProfiles[] = {
      {"khr/simple_controller", "aim", "select/click", false},
      {"oculus/touch_controller", "aim", "trigger/value", false},
      {"valve/index_controller", "aim", "trigger/value", false},
      {"htc/vive_controller", "aim", "trigger/value", false},
      {"microsoft/motion_controller", "aim", "trigger/value", false},
      // the tip of the pen is the head of the burr; squeezed in the air, its middle button is the pedal
      {"logitech/mx_ink_stylus_logitech", "tip_logitech", "cluster_middle_logitech/force", true}};
  XrResult code = XR_SUCCESS;
  bool any = false, any_shakes = false;
  for (const Profile& one : kProfiles) {
    if (one.pen && !has_pen) continue;  // without the extension its names are not allowed
    const std::array<XrActionSuggestedBinding, 3> bindings = {
        {{pose, path(hand + "/input/" + one.points + "/pose")},
         {trigger, path(hand + "/input/" + one.pulled)},
         {shaker, path(hand + "/output/haptic")}}};
    auto suggested =
        made<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
    suggested.interactionProfile = path(std::string("/interaction_profiles/") + one.name);
    suggested.suggestedBindings = bindings.data();
    // a controller whose runtime refuses the vibration is still a hand
    for (const std::uint32_t count : {3U, 2U}) {
      if (count == 3 && shaker == XR_NULL_HANDLE) continue;
      suggested.countSuggestedBindings = count;
      code = xr.SuggestInteractionProfileBindings(instance, &suggested);
      if (XR_FAILED(code)) continue;
      any = true;
      any_shakes = any_shakes || count == 3;
      break;
    }
  }
  if (!any) return refused("SuggestInteractionProfileBindings", code);
  if (!any_shakes && shaker != XR_NULL_HANDLE) cannot_shake("it knows no controller that does");
  return fine();
}

void Headset::Work::start_waiter() {
  waiter->wait = xr.WaitFrame;
  waiter->session = session;
  thread = std::thread([w = waiter] {
    std::unique_lock lock(w->mutex);
    for (;;) {
      w->wakes.wait(lock, [&] { return w->wanted || w->quit; });
      if (w->quit) break;
      w->wanted = false;
      lock.unlock();
      auto info = made<XrFrameWaitInfo>(XR_TYPE_FRAME_WAIT_INFO);
      auto state = made<XrFrameState>(XR_TYPE_FRAME_STATE);
      const XrResult code = w->wait(w->session, &info, &state);
      lock.lock();
      w->got = {code, state};
      w->wakes.notify_all();
    }
    w->gone = true;
    w->wakes.notify_all();
  });
}

}  // namespace burr::render
