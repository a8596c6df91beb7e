#include "window/mill/mill_actions.h"

#include <utility>

#include "shared/word_names.h"

namespace burr::app {

// MillCase::allows() names every action, so that none is forgotten there. What belongs to the page that
// plays a recording does nothing here.
void MillActions::act(Action action) {
  if (!parts_.work_case.allows(action)) return parts_.work_case.say_refused();
  if (drive(action) || show(action)) return;
  switch (action) {
    case Action::undo:
      return command(tick::CommandKind::undo, Word::undone);
    case Action::redo:
      return command(tick::CommandKind::redo, Word::redone);
    case Action::reset:
      return command(tick::CommandKind::reset, Word::back_to_start);
    case Action::measure:
      return parts_.hand.next_measure();
    case Action::mirror:
      return parts_.tools.toggle_mirror();
    case Action::suction:
      return parts_.tools.toggle_suction();
    case Action::picture:
      picture_ = true;
      return;
    case Action::sound:
      return toggle_sound();
    case Action::keep:
      return keep();
    case Action::leave:
      return leave();
    default:
      return;
  }
}

// What the drill does; false: this is not for the drill.
bool MillActions::drive(Action action) {
  Drill& drill = parts_.tools.drill();
  const auto did = [this](std::string text) {
    notes_.note(std::move(text));
    return true;
  };
  switch (action) {
    case Action::cut:
      return did(drill.set_mode(tick::ToolMode::cut));
    case Action::add:
      return did(drill.set_mode(tick::ToolMode::add));
    case Action::touch:
      return did(drill.set_mode(tick::ToolMode::touch));
    case Action::back:
      return did(drill.set_mode(tick::ToolMode::restore));
    case Action::smooth:
      return did(drill.set_mode(tick::ToolMode::smooth));
    case Action::smaller:
      return did(drill.change_burr(-1));
    case Action::larger:
      return did(drill.change_burr(1));
    case Action::slower:
      return did(drill.slower());
    case Action::faster:
      return did(drill.faster());
    case Action::kind:
      return did(drill.toggle_kind());
    case Action::coolant:
      return did(drill.toggle_coolant());
    default:
      return false;
  }
}

// What is shown or hidden; false: this is for something else.
bool MillActions::show(Action action) {
  switch (action) {
    case Action::export_:
      over_.pages->toggle_export();
      return true;
    case Action::settings:
      over_.pages->toggle_settings();
      return true;
    case Action::help:
      over_.pages->toggle_help(false);
      return true;
    case Action::views:
      toggle_menu(Menu::views);
      return true;
    case Action::menu:
      toggle_menu(Menu::all);
      return true;
    case Action::rack:
      toggle_menu(Menu::rack);
      return true;
    case Action::slices:
      parts_.view.toggle_slices();
      return true;
    case Action::structures:
      parts_.side.show_structures();
      return true;
    case Action::task:
      parts_.side.show_task();
      return true;
    case Action::see_through:
      parts_.view.step_opacity(false);
      return true;
    default:
      return false;
  }
}

void MillActions::command(tick::CommandKind kind, Word says) {
  session_.command({kind, 0});
  notes_.note(word(says));
}

void MillActions::go_back() {
  if (over_.page()) {
    over_.pages->close();
  } else if (over_.menu) {
    over_.menu.reset();
  } else if (parts_.hand.measuring().on()) {
    parts_.hand.stop_measure();
  } else {
    leave();
  }
}

// Asks first, whatever the wish came from: the work of an hour hangs on it. A second wish of the same
// kind, while the question is open, is the answer.
void MillActions::leave() {
  if (over_.pages->asks_leave()) return end_as_left();
  parts_.hand.lift();
  over_.menu.reset();
  over_.pages->ask_leave();
}

void MillActions::end_as_left() {
  closed_ = Closed::page;
  open_ = false;
}

void MillActions::keep() {
  notes_.note(word(options_.keep && options_.keep() ? Word::session_kept : Word::session_not_kept));
}

void MillActions::toggle_menu(Menu menu) {
  const bool covered = over_.page();  // by help or settings: the menu is wanted, not they
  over_.pages->close();
  if (over_.menu == menu && !covered)
    over_.menu.reset();
  else
    over_.menu = menu;
}

void MillActions::hide_panels() {
  over_.panels = !over_.panels;
  if (!over_.panels) notes_.note(word(Word::panels_hidden));
}

void MillActions::toggle_sound() {
  if (options_.loudspeaker == nullptr) return;
  options_.loudspeaker->toggle();
  if (!options_.loudspeaker->trouble().empty()) return notes_.note(options_.loudspeaker->trouble());
  notes_.note(word(options_.loudspeaker->is_on() ? Word::sound_on : Word::sound_off));
}

void MillActions::change_loudness(int by) {
  if (options_.loudspeaker != nullptr)
    notes_.note(say(Word::sound_loudness, options_.loudspeaker->louder(by)));
}

void MillActions::declare_done() {
  switch (parts_.work_case.declare_done(over_.pages->asks_done())) {
    case MillCase::Done::answered:
      return;
    case MillCase::Done::asks:
      parts_.hand.lift();
      return over_.pages->ask_done();
    case MillCase::Done::ends:
      return end_as_done();
  }
}

void MillActions::answer() {
  if (over_.pages->asks_done()) return end_as_done();
  if (over_.pages->asks_leave()) end_as_left();
}

void MillActions::end_as_done() {
  parts_.work_case.mark_done();
  closed_ = Closed::done;
  open_ = false;
}

}  // namespace burr::app
