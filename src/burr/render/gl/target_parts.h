// render/gl/target_parts.h - parts of a target, in samples: one rectangle, or several that must be
// redrawn. For use of this room only.
//
// Thread: any.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace burr::render::gl {

// samples [x0, x1) x [y0, y1), y up
struct Rect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
  [[nodiscard]] Rect grown(int by) const { return {x0 - by, y0 - by, x1 + by, y1 + by}; }
  [[nodiscard]] Rect in(const Rect& o) const {
    return {std::max(x0, o.x0), std::max(y0, o.y0), std::min(x1, o.x1), std::min(y1, o.y1)};
  }
  [[nodiscard]] Rect with(const Rect& o) const {
    if (empty()) return o;
    if (o.empty()) return *this;
    return {std::min(x0, o.x0), std::min(y0, o.y0), std::max(x1, o.x1), std::max(y1, o.y1)};
  }
  // the four parts outside the other rectangle: below, above, left and right of it
  [[nodiscard]] std::array<Rect, 4> without(const Rect& o) const {
    const Rect both = in(o);
    if (both.empty()) return {*this};
    return {{{x0, y0, x1, both.y0},
             {x0, both.y1, x1, y1},
             {x0, both.y0, both.x0, both.y1},
             {both.x1, both.y0, x1, both.y1}}};
  }
  [[nodiscard]] double area() const {
    return empty() ? 0 : static_cast<double>(x1 - x0) * static_cast<double>(y1 - y0);
  }
};

// Several rectangles to redraw. They may overlap: each is drawn whole, so an overlap only costs
// time.
class Region {
 public:
  void add(const Rect& rect) {
    if (!rect.empty()) rects_.push_back(rect);
  }
  void add(const Region& other) {
    for (const Rect& rect : other.rects_) add(rect);
  }
  // Joins rectangles that are cheaper to draw as one.
  void join() {
    for (std::size_t i = 0; i < rects_.size(); ++i)
      for (std::size_t j = i + 1; j < rects_.size(); ++j) {
        const Rect both = rects_[i].with(rects_[j]);
        if (both.area() > 1.15 * (rects_[i].area() + rects_[j].area())) continue;
        rects_[i] = both;
        rects_.erase(rects_.begin() + static_cast<std::ptrdiff_t>(j));
        j = i;  // the larger one is compared with all others again
      }
  }
  [[nodiscard]] Region grown(int by, const Rect& within) const {
    Region region;
    for (const Rect& rect : rects_) region.add(rect.grown(by).in(within));
    region.join();
    return region;
  }
  [[nodiscard]] double area() const {
    double sum = 0;
    for (const Rect& rect : rects_) sum += rect.area();
    return sum;
  }
  [[nodiscard]] bool empty() const { return rects_.empty(); }
  [[nodiscard]] const std::vector<Rect>& rects() const { return rects_; }

 private:
  std::vector<Rect> rects_;
};

}  // namespace burr::render::gl
