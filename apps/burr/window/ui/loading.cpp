#include "window/ui/loading.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "burr/base/one_bar.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"

namespace burr::app {

void SharedProgress::report(double fraction, std::string_view stage) {
  const std::lock_guard lock(mutex_);
  now_.fraction = fraction;
  if (now_.stage != stage) now_.stage = stage;
}

SharedProgress::Now SharedProgress::now() const {
  const std::lock_guard lock(mutex_);
  return now_;
}

std::string stage_words(const std::string& stage) {
  if (const auto numbered = base::numbered_stage(stage))
    return say(Word::stage_of, numbered->number, numbered->of,
               stage_words(std::string(numbered->words)));
  constexpr std::pair<std::string_view, Word> kKnown[] = {
      {"reading", Word::stage_reading},
      {"counting values", Word::stage_counting},
      {"straightening the slices", Word::stage_straightening},
      {"smoothing", Word::stage_smoothing},
      {"making voxels cubic", Word::stage_cubic},
      {"looking for bone", Word::stage_bone},
      {"looking for separate parts", Word::stage_parts},
      {"shaping bone", Word::stage_shaping},
      {"filling bone", Word::stage_filling},
      {"finding the surface", Word::stage_finding},
      {"making the surface", Word::stage_making},
      {"measuring the distance to structures to spare", Word::nearest_far},
      {"reading what happened", Word::stage_taking},
      {"comparing before and after", Word::stage_comparing},
      {"writing the mesh", Word::stage_writing},
      {"writing the volume", Word::stage_writing},
      {"writing DICOM", Word::stage_writing},
      {"measuring", Word::stage_measuring},
      {"copying the bone", Word::stage_copying}};
  for (const auto& [known, says] : kKnown)
    if (stage == known) return word(says);
  return stage;
}

namespace {

// returns true if the user cancels
bool draw_loading(Ui& ui, const std::string& title, const SharedProgress::Now& now, bool stopping) {
  const float u = ui.unit(), w = 520 * u, h = 170 * u;
  const float x = (ui.width() - w) / 2, y = (ui.height() - h) / 2;
  ui.page("##loading", x, y, w, h);
  ui.write(x + 28 * u, y + 22 * u, Ui::Letter::large, ink::kText, title);
  const float top = y + 70 * u;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float wide = w - 56 * u;
  draw.AddRectFilled({x + 28 * u, top}, {x + 28 * u + wide, top + 8 * u}, ink::kTrough, 4 * u);
  const auto share = static_cast<float>(std::clamp(now.fraction, 0.0, 1.0));
  if (share > 0.01F)
    draw.AddRectFilled({x + 28 * u, top}, {x + 28 * u + share * wide, top + 8 * u}, ink::kAccent,
                       4 * u);
  ui.write(x + 28 * u, top + 18 * u, Ui::Letter::body, ink::kDim,
           stopping ? std::string(word(Word::stopping))
                    : fmt::format("{}  {:.0f} %", stage_words(now.stage),
                                  100 * static_cast<double>(share)));
  ImGui::SetCursorScreenPos({x + w - 148 * u, y + h - 50 * u});
  const bool cancel = ImGui::Button(word(Word::cancel), {120 * u, 0});
  ImGui::End();
  return cancel;
}

}  // namespace

Result<bool> watch_loading(Desk& desk, const std::string& title, SharedProgress& progress,
                           const std::function<bool()>& finished, bool& closed) {
  const render::Scene empty;
  bool stopping = false;
  closed = false;
  desk.page = Page::loading;
  desk.renderer().title("burr");
  while (!finished()) {
    SDL_Event event;
    while (desk.next(event)) {
      closed = closed || event.type == SDL_QUIT;
      if (event.type == SDL_QUIT ||
          (event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE))
        stopping = true;
    }
    const Status shown = desk.show(
        empty,
        [&] {
          if (draw_loading(desk.ui(), title, progress.now(), stopping)) stopping = true;
        },
        true);
    if (!shown) return shown.error();
    if (stopping || interrupted()) progress.cancel();
    // the work has priority: where the processor draws, each picture takes its time
    for (int n = 0; n < 8 && !finished(); ++n) {
      SDL_Delay(30);
      SDL_PumpEvents();
      if (SDL_HasEvents(SDL_FIRSTEVENT, SDL_LASTEVENT) == SDL_TRUE) break;
    }
  }
  return !stopping;
}

}  // namespace burr::app
