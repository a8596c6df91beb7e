// apps/burr/window/mill/window.h - the page one works on: look around a bone and mill it with the mouse.
//
// Main thread only: it owns window and GPU. The servo runs beside it; they meet at the doors of
// sim/session.h, and through the mouse's hand.
#pragma once

#include <string>

#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "window/hands/mouse_hand.h"
#include "window/mill/window_options.h"
#include "window/shell/desk.h"

namespace burr::app {

// Runs until it is left; then the servo stands. `scene` has the bone's surface as `worker` made it,
// and the first view; it is left as last seen.
[[nodiscard]] Result<Left> mill(Desk& desk, sim::Session& session, const Hands& hands,
                                surface::Worker& worker, render::Scene& scene,
                                const WindowOptions& options);

// The same in a window of its own, which keeps nothing of the user's.
[[nodiscard]] Status run_window(sim::Session& session, const Hands& hands, surface::Worker& worker,
                                render::Scene& scene, const WindowOptions& options);

// The flags of rt/flags.h that a user should know of, in a few words; "" if there is none.
[[nodiscard]] std::string flag_words(std::uint32_t flags);

}  // namespace burr::app
