// render/gl/headset_work.h - what a headset holds of OpenXR: the functions of the runtime, and the session with its screens
// and actions. headset_start.cpp makes it, headset.cpp runs and ends it. For use of this room only.
//
// Thread: that of the pictures; the runtime's wait has a thread of its own.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "burr/render/headset.h"

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

namespace burr::render {

namespace openxr {

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
// a runtime without them moves no motor in a controller, but shows pictures
#define BURR_XR_HAPTIC_CALLS(call) call(ApplyHapticFeedback) call(StopHapticFeedback)
#define BURR_XR_MEMBER(name) PFN_xr##name name = nullptr;
  BURR_XR_CALLS(BURR_XR_MEMBER)
  BURR_XR_INSTANCE_CALLS(BURR_XR_MEMBER)
  BURR_XR_HAPTIC_CALLS(BURR_XR_MEMBER)
#undef BURR_XR_MEMBER
};

// A structure of OpenXR that says which it is; the rest is zero.
template <class Structure>
Structure made(XrStructureType type) {
  Structure structure{};
  structure.type = type;
  return structure;
}

}  // namespace openxr

struct Headset::Work {
  explicit Work(Renderer& shows) : renderer(shows) {}

  Renderer& renderer;
  openxr::Calls xr;
  XrInstance instance = XR_NULL_HANDLE;
  XrSystemId system = XR_NULL_SYSTEM_ID;
  XrSession session = XR_NULL_HANDLE;
  XrSpace room = XR_NULL_HANDLE, wand = XR_NULL_HANDLE;
  XrActionSet actions = XR_NULL_HANDLE;
  XrAction pose = XR_NULL_HANDLE, trigger = XR_NULL_HANDLE;
  XrAction shaker = XR_NULL_HANDLE;  // none: the runtime cannot vibrate
  bool has_pen = false;              // the runtime knows Logitech's MX Ink
  bool vibrates = false;             // the last command to the controller was to vibrate
  XrEnvironmentBlendMode blend = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  struct Screen {
    XrSwapchain chain = XR_NULL_HANDLE;
    int width = 0, height = 0;
    std::vector<XrSwapchainImageOpenGLKHR> images;
    std::optional<std::uint32_t> acquired;  // acquired and not yet released
  };
  std::array<Screen, 2> screens;
  bool running = false, focused = false, over = false, begun = false;
  std::string why, name, missing;
  XrTime due = 0;      // display time of the present frame
  bool shown = false;  // the frame will be shown
  std::array<XrView, 2> views = {};
  bool eyes = false;  // the poses of the eyes are known

  // The runtime's wait on a thread of its own, which may never return: that thread uses only this.
  struct Waiter {
    std::mutex mutex;
    std::condition_variable wakes;
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
  Status suggest_bindings(const std::string& hand);
  void start_waiter();
  void look_at_events();
  void changed(XrSessionState state);
  void end_session();
  bool good(const char* call, XrResult code);
  void shaken(const char* call, XrResult code);
  void cannot_shake(const std::string& because);
  void end_with(std::string because);
  void locate(Headset::Now& now);
  bool draw(int eye, const Scene& scene);
  void end_frame(const std::array<XrCompositionLayerProjectionView, 2>* parts);
  bool stop_waiting();
  void close();
};

}  // namespace burr::render
