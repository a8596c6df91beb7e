// scoring/measure.h - the measure of one item becomes its outcome. For use of this room only.
//
// `requires` is not applied here. Thread: one at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/process.h"
#include "burr/record/player.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/outcome.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/scene.h"
#include "burr/scoring/shown.h"

namespace burr::scoring {

[[nodiscard]] Outcome not_assessable(const Item& item, std::string reason);
// The number that decided.
[[nodiscard]] Outcome decided(const Item& item, const metrics::Mark& mark, const char* what,
                              bool at_least);

// An item about the shape of the cut: a planned axis, plane or cavity; none: it is about something else.
[[nodiscard]] std::optional<Outcome> measure_shape(const Item& item, Scene& scene);
// An item about the manner of work; none: it is about something else.
[[nodiscard]] std::optional<Outcome> measure_manner(const Item& item,
                                                    const metrics::Process& process,
                                                    const scenario::Lesson& lesson);
// An item that the two bones decide.
[[nodiscard]] Outcome measure_bone(const Item& item, Scene& scene);
// Those that the recording decides, in the order of the rubric; `shown` gets the way of the burr.
// Error: interrupted.
[[nodiscard]] Result<std::vector<Outcome>> measure_recording(const Rubric& rubric, Scene& scene,
                                                             record::Player& player, Shown& shown,
                                                             Progress& progress);

}  // namespace burr::scoring
