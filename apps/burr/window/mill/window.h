// apps/burr/window/mill/window.h - the page one works on: look around a bone and mill it with the mouse.
//
// Main thread only: it owns window and GPU. The servo runs beside it; they meet at the doors of
// sim/session.h, and through the mouse's hand.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "burr/render/scene.h"
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "burr/volume/greys.h"
#include "window/hands/mouse_hand.h"
#include "window/replay/film_job.h"
#include "window/shell/desk.h"
#include "workshop/loudspeaker.h"
#include "workshop/spared_distance.h"

namespace burr::app {

struct WindowOptions {
  double seconds = 0;           // closes by itself after so long; 0: when the user closes it
  std::string folder = {};      // where P leaves pictures; empty: where the program was started
  std::string screenshot = {};  // a PNG of the window, panels and all, as it was last; empty: none
  bool sound = true;            // if there is a loudspeaker
  // asked often; what the user must be told, "" for nothing
  std::function<std::string()> warning = {};
  // the user wants this session kept for good; false: there is nothing to keep
  std::function<bool()> keep = {};
  // the session's recording as it is now, for a film; none: it is not recorded
  std::function<std::optional<FilmSource>()> film_of = {};
  const SparedDistance* spared_distance = nullptr;  // what must not be cut; nullptr: nothing
  Loudspeaker* loudspeaker = nullptr;               // nullptr: no sound
  std::shared_ptr<const volume::Greys> greys = {};  // of the scan; none: slices show the bone
  std::optional<scenario::Case> work_case = {};     // what is to be done; none: no case
};

// How the page was left.
enum class Left {
  page,    // the user is done with this bone
  window,  // ... with burr, or the time is over
};

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
