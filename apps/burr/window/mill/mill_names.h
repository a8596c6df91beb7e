// apps/burr/window/mill/mill_names.h - the names of structures on the page for milling: of the one
// under the pointer, and those that the user pinned.
//
// Thread: main; draw_*() between Ui::begin() and Ui::draw(). Frame: world. Units: m; points and
// pixels of the picture where it says so.
#pragma once

#include <chrono>
#include <optional>

#include "window/mill/mill_case.h"
#include "window/mill/mill_site.h"
#include "window/mill/mill_view.h"
#include "window/mill/pinned_labels.h"
#include "window/mill/pointer.h"

namespace burr::app {

class MillNames {
 public:
  MillNames(const MillSite& site, MillCase& work_case, const Pointer& pointer, MillView& view);

  // In each picture; ten times a second it finds what lies under the pointer. lists: the list of
  // structures is open, so it measures their distances. pressing: the burr works.
  void look(bool lists, bool pressing);

  void pin(volume::TissueId id);  // at the voxel nearest to the structure's middle
  void pin_under_pointer();  // where the pointer is, so that the line ends at what the user sees
  [[nodiscard]] const PinnedLabels& pins() const { return pins_; }

  // Beside the pointer, and never while the burr works.
  void draw_name(const Ui& ui, bool pressing) const;
  // left: free from there on, beside the tools [points].
  void draw_pins(const Ui& ui, float left) const;

 private:
  using Clock = std::chrono::steady_clock;

  render::Scene& scene_;
  const WindowOptions& options_;
  MillNotes& notes_;
  MillOver& over_;
  MillCase& case_;
  const Pointer& pointer_;
  MillView& view_;
  std::optional<Structures::Seen> under_;  // the pointer, in the bone
  std::optional<volume::TissueId> under_in_slice_;
  Clock::time_point looked_{};
  PinnedLabels pins_;
};

}  // namespace burr::app
