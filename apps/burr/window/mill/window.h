// apps/burr/window/mill/window.h - the page on which the user looks at a bone and mills it.
//
// Thread: main only, because it owns window and GPU. The servo runs beside it; they exchange data
// through the doors of sim/session.h and through the mouse's hand.
#pragma once

#include <string>

#include "burr/mouse/mouse_hand.h"
#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "window/mill/window_options.h"
#include "window/ui/desk.h"

namespace burr::app {

// Runs until the user leaves; then the servo is stopped. `scene` must contain the bone's surface as
// `worker` made it, and the first view; afterwards it contains the last view.
[[nodiscard]] Result<Closed> mill(Desk& desk, sim::Session& session, const mouse::Hands& hands,
                                  surface::Worker& worker, render::Scene& scene,
                                  const WindowOptions& options);

// The same in a window of its own, without any files of the user.
[[nodiscard]] Status run_window(sim::Session& session, const mouse::Hands& hands,
                                surface::Worker& worker, render::Scene& scene,
                                const WindowOptions& options);

// The flags of rt/flags.h that the user should know, in a few English words; "" if there are none.
[[nodiscard]] std::string flag_words(std::uint32_t flags);

}  // namespace burr::app
