// apps/burr/window/mill/side_panel.h - the panel beside the tools, with three leaves: the task of
// the case, its steps, and the structures of the bone with their colours, which is the legend too.
// Here are its frame and the leaf of structures; task_panel.h and steps_panel.h have the others.
//
// Thread: main, between Ui::begin() and draw().
#pragma once

#include <optional>
#include <vector>

#include "window/mill/pinned_labels.h"
#include "window/mill/structures.h"
#include "window/ui/ui.h"

namespace burr::app {

enum class Leaf { none, task, steps, structures };

// Its place [points]: left edge, width, top of the row with the leaves' names, top of the leaf.
inline constexpr float kSideLeft = 104, kSideWide = 360, kSideTop = 10, kSideLeafTop = 52;
// Free above the strip, for the bar of views with its two rows [points].
inline constexpr float kSideFoot = 86;

// The names of the leaves that there are, and a cross. The leaf that was pressed; Leaf::none: the
// cross.
[[nodiscard]] std::optional<Leaf> draw_side_tabs(Ui& ui, Leaf now, bool task, bool steps,
                                                 bool structures);

struct StructuresPressed {
  std::optional<volume::TissueId> toggle;  // show or hide this one in see-through bone
  std::optional<volume::TissueId> pin;     // pin its name, or take the pin away
};
// distances: they may be shown.
[[nodiscard]] StructuresPressed draw_structures(Ui& ui, const Structures& structures,
                                                const PinnedLabels& pins, bool distances);

// The colour of a tissue as the list and the plates show it.
[[nodiscard]] ImU32 swatch_of(const volume::Tissue& tissue);

}  // namespace burr::app
