// apps/burr/window/parts/action.h - what a button of the bars or a key does. Plain value.
#pragma once

namespace burr::app {

enum class Action {
  cut,
  add,
  touch,
  back,
  smooth,
  undo,
  redo,
  reset,
  measure,
  mirror,
  export_,
  smaller,
  larger,
  slower,
  faster,
  settings,
  help,
  leave,
  kind,     // cutting burr, diamond burr
  coolant,  // on, off
  slices,
  see_through,
  keep,
  suction,     // on, off
  views,       // the menu of views, open or not
  structures,  // the list of structures
  task,        // the text of the case, its steps
  picture,
  sound,  // on, off
  rack,   // the tools, open or not
  menu,   // everything that has no button of its own
  // of the page that plays a recording
  beside,   // a second recording, or none
  compare,  // table of both, difference in colour
  earlier,  // the second recording begins earlier, later
  later,
  step_back,  // one second
  step_on,
  stroke_back,  // to the stroke before, after
  stroke_on,
  first_view,
  labels,  // colours of tissues, on or off
  hide,    // all panels
  play,    // in the strip below the picture: play or pause; the film begins, ends here
  film_from,
  film_until,
};

}  // namespace burr::app
