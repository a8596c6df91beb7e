// The session with a headset's OpenXR 1.0, as in the specification: events, frames, the end; headset_start.cpp begins it.
// The runtime in tests/render/openxr/fake_openxr.cpp checks the rules of each call.
#include "burr/render/headset.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "burr/render/gl/headset_work.h"

namespace burr::render {
namespace {

using openxr::made;

constexpr auto kPatience = std::chrono::seconds(2);  // longest wait for a runtime that does not
                                                     // return

math::Pose pose_of(const XrPosef& pose) {
  return {
      {pose.position.x, pose.position.y, pose.position.z},
      math::Quat(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z)};
}

bool known(XrFlags64 flags, XrFlags64 wanted) { return (flags & wanted) == wanted; }

}  // namespace

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
  if (!waiter->wakes.wait_for(lock, kPatience, [&] { return waiter->got.has_value(); }))
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
      w.waiter->wakes.notify_all();
    }
    if (!w.waiter->wakes.wait_for(lock, std::chrono::duration<double>(wait_s),
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

double vibration_of(double force) {
  if (!(force > kFeltForce)) return 0;  // a NaN too
  return kMostVibration * std::min(force / kFullForce, 1.0);
}

// Without vibration the headset is as good as before: only the motor is given up.
void Headset::Work::cannot_shake(const std::string& because) {
  shaker = XR_NULL_HANDLE;
  vibrates = false;
  missing = fmt::format(
      "The headset's runtime does not let the controller vibrate ({}); all else works. Update the "
      "runtime if the controller can.",
      because);
}

void Headset::Work::shaken(const char* call, XrResult code) {
  if (code == XR_ERROR_SESSION_LOST || code == XR_ERROR_INSTANCE_LOST || XR_SUCCEEDED(code))
    static_cast<void>(good(call, code));
  else
    cannot_shake(fmt::format("it refuses xr{}, {}", call, static_cast<int>(code)));
}

void Headset::vibrate(double amplitude) {
  Work& w = *work_;
  if (w.over || !w.running || !w.focused) {
    w.vibrates = false;  // the runtime ended it with the focus
    return;
  }
  if (w.shaker == XR_NULL_HANDLE) return;
  auto which = made<XrHapticActionInfo>(XR_TYPE_HAPTIC_ACTION_INFO);
  which.action = w.shaker;
  if (!(amplitude > 0)) {
    if (std::exchange(w.vibrates, false))
      w.shaken("StopHapticFeedback", w.xr.StopHapticFeedback(w.session, &which));
    return;
  }
  auto how = made<XrHapticVibration>(XR_TYPE_HAPTIC_VIBRATION);
  how.amplitude = static_cast<float>(std::min(amplitude, 1.0));
  how.duration = static_cast<XrDuration>(1e9 * kVibrates);
  how.frequency = XR_FREQUENCY_UNSPECIFIED;
  w.vibrates = true;
  w.shaken("ApplyHapticFeedback",
           w.xr.ApplyHapticFeedback(w.session, &which,
                                    reinterpret_cast<const XrHapticBaseHeader*>(&how)));
}

std::string Headset::take_missing() { return std::exchange(work_->missing, {}); }

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
    waiter->wakes.notify_all();
    came_back = waiter->wakes.wait_for(lock, kPatience, [&] { return waiter->gone; });
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
