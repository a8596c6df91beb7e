// apps/burr/window/window.h - the plain window: look around a bone and mill it with the mouse.
//
// Main thread only: it owns window and GPU. The servo runs beside it; they meet at the doors of
// sim/session.h, and through the mouse's hand.
#pragma once

#include <functional>
#include <string>

#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "window/mouse_hand.h"

namespace burr::app {

struct WindowOptions {
  double seconds = 0;  // closes by itself after so long; 0: when the user closes it
  std::string folder;  // where P leaves pictures; empty: where the program was started
  std::function<std::string()> warning;  // asked often; what the user must be told, "" for nothing
};

// Runs until the window is closed; then the servo stands. `scene` has the bone's surface as
// `worker` made it, and the first view; it is left as last seen.
[[nodiscard]] Status run_window(sim::Session& session, MouseHand& hand, surface::Worker& worker,
                                render::Scene& scene, const WindowOptions& options);

// The flags of haptics/contact.h that a user should know of, in a few words; "" if there is none.
[[nodiscard]] std::string flag_words(std::uint32_t flags);

// A made patch into the scene.
void put_skin(render::Scene& scene, const surface::Skin& skin);

}  // namespace burr::app
