// apps/burr/window/replay/comparison.h - two recordings beside each other, in numbers and colours: a
// table of what both took away and how near they came to what must not be cut, and where they cut
// differently.
//
//     Comparison comparison(left, right);                 // starts to measure, on threads of its own
//     each frame:   comparison.step();
//                   comparison.colour(left_view, right_view);     // if the colours are wanted
//                   comparison.draw(ui, x, y, colours)            // true: the button was pressed
//
// Thread: main; the measuring runs beside it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/render/slice.h"
#include "window/replay/difference.h"
#include "window/replay/facts.h"
#include "window/replay/replay_view.h"
#include "window/ui/loading.h"
#include "window/ui/ui.h"

namespace burr::app {

// Facts of one recording, measured beside the window.
class FactsJob {
 public:
  explicit FactsJob(const Recorded& recorded);
  void step();
  [[nodiscard]] const Facts* facts() const { return facts_ ? &*facts_ : nullptr; }
  [[nodiscard]] bool busy() const { return work_ != nullptr; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }  // "": none

 private:
  std::unique_ptr<Loading<Facts>> work_;
  std::optional<Facts> facts_;
  std::string trouble_;
};

class Comparison {
 public:
  // The views must outlive it.
  Comparison(ReplayView& left, ReplayView& right);
  ~Comparison();
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;

  // left: the facts of the left recording; nullptr: not yet.
  void step(const Facts* left);
  [[nodiscard]] const Facts* right() const { return right_facts_.facts(); }
  // Shows the difference in colour, or not. It appears on the bones as soon as both views are at rest.
  void colour(bool on);
  // True: the bones show the difference of this moment.
  [[nodiscard]] bool coloured() const { return difference_ && difference_->painted(); }
  [[nodiscard]] const Difference* difference() const {
    return difference_ ? &*difference_ : nullptr;
  }
  // The same bone in both, and it is known how it was before.
  [[nodiscard]] bool comparable() const { return difference_.has_value(); }

  static constexpr float kWide = 356;  // of the table [points]
  // Draws the table; returns true if the button for the colours was pressed.
  [[nodiscard]] bool draw(Ui& ui, float x, float y, const Facts* left, bool colours) const;

 private:
  class InSlices;
  ReplayView &left_, &right_;
  FactsJob right_facts_;
  std::optional<Difference> difference_;
  std::unique_ptr<InSlices> in_slices_;
  double left_t_ = -1, right_t_ = -1;  // moments that are painted [s]
};

}  // namespace burr::app
