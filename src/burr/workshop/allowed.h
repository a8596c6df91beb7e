// workshop/allowed.h - what a session offers the user while he works: one table, by the mode of the
// session, which the case may narrow.
//
//     const bool is_guided = guided_in(identity, lesson.feedback);
//     const Allowed allowed = allowed_in(identity.mode, lesson.feedback, is_guided);
//
// In no mode is a score shown while somebody works; nothing here could offer one. What a drill shows
// as well (force, size and speed of the burr) is not in the table. docs/use/window_steps.md
// explains it to users. Pure functions. Thread: any. Units: SI.
#pragma once

#include "burr/record/identity.h"
#include "burr/scenario/lesson.h"

namespace burr::workshop {

enum class Offer { never, on_demand, always };

// What happens when a turning burr is in a structure that must be spared.
enum class Injury {
  silent,  // no signal
  sound,   // a tone at once
  stop,    // also a sentence, and the burr is lifted: stop and look
};

struct Allowed {
  Offer steps = Offer::never;  // the steps of the case, and the text of the current one
  bool target = false;         // what the current step is about may be lit, on demand
  bool distance = false;       // to the nearest structure to spare, as a figure and a colour
  double tone_below = 0;       // a tone sounds when that distance is below this; 0: never [m]
  Injury injury = Injury::silent;
  bool technique = false;  // one sentence where the technique stays out of its band
  bool back = false;       // undo, redo, everything back, the original back, smoothing, the mirror
  bool measure = false;    // distances, angles, the thickness under the burr
  bool colours = false, see_through = false;  // of the tissues
  bool marks = false;  // what the rubric says, after the work; in an exam an examiner releases it
  bool operator==(const Allowed& other) const = default;
};

// A list of the case ([feedback], docs/use/cases.md) leaves out what it does not name. To an exam
// it can only add colours and see-through. Without guidance there is no target, distance, tone or
// technique. Mode free: everything but technique, whatever the case says.
[[nodiscard]] Allowed allowed_in(record::Mode mode, const scenario::Feedback& feedback,
                                 bool is_guided);

// By the rule `fade` of the case and the number of the attempt; true without such a rule.
[[nodiscard]] bool guided_in(const record::Identity& identity, const scenario::Feedback& feedback);

}  // namespace burr::workshop
