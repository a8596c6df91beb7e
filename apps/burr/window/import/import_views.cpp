// The three views of the import page, the frame of the region in them, and what the mouse does there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "shared/word_names.h"
#include "window/import/import_page.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;
using Part = ImportLayout::Part;

constexpr Word kNames[] = {Word::axial, Word::coronal, Word::sagittal};
constexpr int kMostPixels = 720;  // longest side of a preview; a larger one is stretched
constexpr int kFree = 16;         // value of `grabbed`: the mouse moves the slices, not the frame

}  // namespace

void ImportPage::picture(View& view, int width, int height) {
  const io::Scan& scan = *opened_.scan;
  const int slice = slice_[static_cast<std::size_t>(view.plane.through)];
  if (view.sampled != slice || view.values.width != width || view.values.height != height) {
    sample(scan, view.plane, slice, width, height, view.values);
    view.sampled = slice;
    view.coloured = false;
  }
  if (view.coloured) return;
  const int line = std::max(1, std::max(width, height) / 300);
  const LeftOut out = parts_ && chosen_ && !recount_
                          ? left_out(scan, view.plane, slice, view.values, *parts_, chosen_->kept)
                          : LeftOut{};
  if (scan.values.empty()) {
    std::array<LabelLook, 256> looks;
    for (std::size_t n = 0; n < labels_.size(); ++n) {
      const volume::Tissue& tissue = opened_.labels[n].tissue;
      looks[static_cast<std::size_t>(tissue.label)] = {labels_[n].kind, tissue.colour};
    }
    draw_labels(view.values, looks, line, out, pixels_);
  } else {
    const Greys& greys = opened_.greys;
    draw_greys(view.values, greys.from, std::min(greys.to, scan.hounsfield ? 1800 : greys.to),
               level(), line, out, pixels_);
  }
  view.texture.put(width, height, 4, pixels_);
  view.coloured = true;
}

void ImportPage::draw_view(std::size_t which, const Part& part) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  View& view = views_[which];
  const io::Scan& scan = *opened_.scan;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({part.x, part.y}, {part.x + part.w, part.y + part.h}, ink::rgb(0, 0, 0),
                     4 * u);
  const std::array<double, 2> mm = extent_mm(scan, view.plane);
  // the letters of the patient's sides are written outside the picture
  const float border = 24 * u, room_w = part.w - 2 * border, room_h = part.h - 2 * border;
  const auto ratio = static_cast<float>(mm[0] / mm[1]);
  const float w = std::floor(std::min(room_w, room_h * ratio)), h = std::floor(w / ratio);
  const float x = std::round(part.x + (part.w - w) / 2), y = std::round(part.y + (part.h - h) / 2);
  if (w < 2 || h < 2) return;
  const float fine = std::min(1.0F, static_cast<float>(kMostPixels) / std::max(w, h));
  picture(view, std::max(2, static_cast<int>(w * fine)), std::max(2, static_cast<int>(h * fine)));
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(view.texture.name())),
                {x, y}, {x + w, y + h});

  const auto axis = static_cast<std::size_t>(view.plane.through);
  int& slice = slice_[axis];
  const auto side = [&](bool down, double voxels) {
    return (down ? y : x) +
           (down ? h : w) * static_cast<float>(place_of(scan, view.plane, down, voxels));
  };
  // lines where the other two planes cut this one
  const auto across = static_cast<std::size_t>(view.plane.across),
             down = static_cast<std::size_t>(view.plane.down);
  const float cx = side(false, slice_[across] + 0.5), cy = side(true, slice_[down] + 0.5);
  for (const ImU32 ink : {ink::rgb(0, 0, 0, 110), ink::rgb(86, 180, 233, 130)}) {
    const float by = ink == ink::rgb(0, 0, 0, 110) ? u : 0;
    draw.AddLine({cx + by, y}, {cx + by, y + h}, ink, u);
    draw.AddLine({x, cy + by}, {x + w, cy + by}, ink, u);
  }
  const int over = frame(view, x, y, w, h);

  ImGui::SetCursorScreenPos({part.x, part.y});
  ImGui::PushID(static_cast<int>(which));
  ImGui::InvisibleButton("##view", {part.w, part.h});
  ImGui::PopID();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto voxels = [&](bool vertical) {
    const float place = vertical ? (mouse.y - y) / h : (mouse.x - x) / w;
    return voxels_at(scan, view.plane, vertical, std::clamp(static_cast<double>(place), 0.0, 1.0));
  };
  const auto point = [&] {  // under the mouse, in voxels
    math::Vec3 at;
    at[view.plane.across] = voxels(false) - 0.5;
    at[view.plane.down] = voxels(true) - 0.5;
    at[view.plane.through] = slice;
    return at;
  };
  if (ImGui::IsItemActivated()) view.grabbed = over != 0 ? over : kFree;
  if (ImGui::IsItemActive() && view.grabbed == kFree) {
    slice_[across] =
        std::clamp(static_cast<int>(voxels(false)), 0, scan.size[view.plane.across] - 1);
    slice_[down] = std::clamp(static_cast<int>(voxels(true)), 0, scan.size[view.plane.down] - 1);
    if (picking_ && ImGui::IsItemActivated()) keep_here(point());
  } else if (ImGui::IsItemActive() && view.grabbed != 0) {
    Box box = box_;
    const auto pull = [&](bool vertical, bool far_side) {
      const int a = vertical ? view.plane.down : view.plane.across;
      const bool flip = vertical ? view.plane.flip_down : view.plane.flip_across;
      const int edge = static_cast<int>(std::lround(voxels(vertical)));
      // a frame always keeps a few voxels
      const int least = std::min(4, scan.size[a]);
      if (far_side != flip)
        box.to[a] =
            std::clamp(edge - 1, std::min(box.from[a] + least, scan.size[a]) - 1, scan.size[a] - 1);
      else
        box.from[a] = std::clamp(edge, 0, std::max(box.to[a] + 1 - least, 0));
    };
    if ((view.grabbed & 3) != 0) pull(false, (view.grabbed & 2) != 0);
    if ((view.grabbed & 12) != 0) pull(true, (view.grabbed & 8) != 0);
    set_box(box);
  } else if (!ImGui::IsItemActive()) {
    view.grabbed = 0;
  }
  const float wheel = ImGui::GetIO().MouseWheel;
  if (wheel != 0 && part.holds(mouse.x, mouse.y) && ImGui::IsWindowHovered())
    slice = std::clamp(slice + static_cast<int>(wheel), 0, scan.size[view.plane.through] - 1);

  ui.write(part.x + 8 * u, part.y + 4 * u, Letter::strong, ink::kText, word(kNames[which]));
  ui.write(part.x + part.w - 8 * u, part.y + 5 * u, Letter::small, ink::kDim,
           fmt::format("{} / {}", slice + 1, scan.size[view.plane.through]), 1);
  const auto letter = [&](float lx, float ly, char c) {
    ui.write(lx, ly, Letter::small, ink::kText, std::string(1, c), 0.5F);
  };
  const float high = ui.height_of(Letter::small);
  letter(x - 13 * u, y + (h - high) / 2, view.plane.left);
  letter(x + w + 13 * u, y + (h - high) / 2, view.plane.right);
  letter(x + w / 2, y - high - 6 * u, view.plane.top);
  letter(x + w / 2, y + h + 5 * u, view.plane.bottom);
}

// Draws the region: its frame, handles, and everything outside it dimmed. Returns the sides of the
// frame under the mouse.
int ImportPage::frame(View& view, float x, float y, float w, float h) {
  const float u = desk_.ui().unit();
  const io::Scan& scan = *opened_.scan;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto range = [&](bool down) {
    const int a = down ? view.plane.down : view.plane.across;
    double first = place_of(scan, view.plane, down, box_.from[a]),
           last = place_of(scan, view.plane, down, box_.to[a] + 1);
    if (first > last) std::swap(first, last);
    return std::pair{static_cast<float>(first), static_cast<float>(last)};
  };
  const auto [left, right] = range(false);
  const auto [top, bottom] = range(true);
  const float x0 = x + left * w, x1 = x + right * w, y0 = y + top * h, y1 = y + bottom * h;
  constexpr ImU32 kOutside = ink::rgb(0, 0, 0, 150);
  draw.AddRectFilled({x, y}, {x + w, y0}, kOutside);
  draw.AddRectFilled({x, y1}, {x + w, y + h}, kOutside);
  draw.AddRectFilled({x, y0}, {x0, y1}, kOutside);
  draw.AddRectFilled({x1, y0}, {x + w, y1}, kOutside);
  draw.AddRect({x0, y0}, {x1, y1}, ink::rgb(0, 0, 0, 160), 0, 0, 3 * u);
  draw.AddRect({x0, y0}, {x1, y1}, ink::kText, 0, 0, 1.3F * u);

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float reach = 8 * u;
  int over = 0;
  if (mouse.x > x0 - reach && mouse.x < x1 + reach && mouse.y > y0 - reach &&
      mouse.y < y1 + reach) {
    if (std::abs(mouse.x - x0) < reach)
      over |= 1;
    else if (std::abs(mouse.x - x1) < reach)
      over |= 2;
    if (std::abs(mouse.y - y0) < reach)
      over |= 4;
    else if (std::abs(mouse.y - y1) < reach)
      over |= 8;
  }
  const int lit = view.grabbed != 0 ? view.grabbed : over;
  const float mx = (x0 + x1) / 2, my = (y0 + y1) / 2, r = 4 * u;
  for (const auto& [hx, hy, sides] : {std::tuple{x0, y0, 5},
                                      {x1, y0, 6},
                                      {x0, y1, 9},
                                      {x1, y1, 10},
                                      {x0, my, 1},
                                      {x1, my, 2},
                                      {mx, y0, 4},
                                      {mx, y1, 8}}) {
    const bool on = lit == sides;
    const float grown = on ? 1.5F * r : r;
    draw.AddRectFilled({hx - grown, hy - grown}, {hx + grown, hy + grown},
                       on ? ink::kAccent : ink::kText);
    draw.AddRect({hx - grown, hy - grown}, {hx + grown, hy + grown}, ink::rgb(0, 0, 0, 200));
  }
  return over;
}

}  // namespace burr::app
