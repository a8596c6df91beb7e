#include "window/replay/replay_bar.h"

#include "shared/word_names.h"
#include "window/ui/printed_keys.h"

namespace burr::app {
namespace {

std::vector<BarLine> lines() {
  return {
      {Word::time,
       {Action::step_back, Word::replay_back, "←"},
       BarButton{Action::step_on, Word::replay_on, "→"}},
      {{},
       {Action::stroke_back, Word::replay_stroke_back, "Ctrl + ←"},
       BarButton{Action::stroke_on, Word::replay_stroke_on, "Ctrl + →"}},
      {Word::replay_bar_beside,
       {Action::beside, Word::replay_help_beside, "B"},
       BarButton{Action::compare, Word::replay_help_compare, "C"}},
      {{},
       {Action::earlier, Word::replay_earlier, smaller_key()},
       BarButton{Action::later, Word::replay_later, larger_key()}},
      {Word::help_view,
       {Action::slices, Word::replay_help_slices, "V"},
       BarButton{Action::see_through, Word::help_see_through, "T"}},
      {{},
       {Action::first_view, Word::help_first_view, "F"},
       BarButton{Action::labels, Word::help_labels, "L"}},
      {Word::bar_session,
       {Action::picture, Word::help_picture, "P"},
       BarButton{Action::export_, Word::film_help, "E"}},
      {{}, {Action::hide, Word::help_hide, "Tab"}, BarButton{Action::help, Word::help, "F1"}},
      {{}, {Action::leave, Word::leave, "Esc"}, {}},
  };
}

}  // namespace

std::vector<Action> replay_bar_actions() {
  std::vector<Action> all;
  for (const BarLine& line : lines()) {
    all.push_back(line.left.action);
    if (line.right) all.push_back(line.right->action);
  }
  return all;
}

std::optional<Action> draw_replay_bar(Ui& ui, const ReplayBarState& state, float free,
                                      std::vector<BarPlace>& places) {
  constexpr float kHigh = 362;  // [points]
  const auto is_on = [&state](Action action) {
    switch (action) {
      case Action::beside:
        return state.beside;
      case Action::compare:
        return state.compares;
      case Action::slices:
        return state.slices;
      case Action::see_through:
        return state.see_through;
      case Action::labels:
        return state.labels;
      default:
        return false;
    }
  };
  return draw_bar(ui, lines(), kHigh, free, is_on, &places);
}

}  // namespace burr::app
