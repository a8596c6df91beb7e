#include "window/mill/instructor_notes.h"

#include <algorithm>
#include <utility>

#include "shared/word_names.h"
#include "window/parts/hud.h"
#include "window/parts/measuring.h"

namespace burr::app {

void InstructorNotes::add(Note note) {
  notes_.push_back(std::move(note));
  if (notes_.size() > kMost) notes_.erase(notes_.begin());
}

std::size_t InstructorNotes::marks() const {
  return static_cast<std::size_t>(std::count_if(
      notes_.begin(), notes_.end(), [](const Note& one) { return one.at.has_value(); }));
}

std::vector<std::string> InstructorNotes::texts() const {
  std::vector<std::string> out;
  for (const Note& one : notes_) out.push_back(one.text);
  return out;
}

void InstructorNotes::draw(Ui& ui, const render::Camera& camera, float column) {
  if (notes_.empty()) return;
  const float u = ui.unit();
  ImDrawList& over = *ImGui::GetBackgroundDrawList();
  for (std::size_t n = 0; n < notes_.size(); ++n) {
    const Note& one = notes_[n];
    if (!one.at) continue;
    const auto at = on_picture(camera, *one.at, ui.width(), ui.height());
    if (!at) continue;
    // a ring and a number: seen on bright and dark bone
    over.AddCircle(*at, 14 * u, ink::rgb(0, 0, 0, 200), 0, 5 * u);
    over.AddCircle(*at, 14 * u, ink::kWarn, 0, 2.5F * u);
    // outside of a window of ImGui: Ui::write() would open one
    over.AddText(ui.font(Ui::Letter::strong), ui.height_of(Ui::Letter::strong),
                 {at->x + 18 * u, at->y - 0.5F * ui.height_of(Ui::Letter::strong)}, ink::kWarn,
                 std::to_string(n + 1).c_str());
  }
  std::string text = std::string(word(Word::instructor_says)) + ": ";
  for (std::size_t n = 0; n < notes_.size(); ++n) {
    const Note& one = notes_[n];
    if (n > 0) text += "\n";
    if (one.at) text += std::to_string(n + 1) + " ";
    text += one.text.empty() ? word(Word::instructor_marks) : one.text;
  }
  // between the panels at the left and the slices, above the line of messages
  const float left = 500 * u, right = ui.width() - column - 10 * u;
  const float wide = std::clamp(right - left, 260 * u, 560 * u), button = 110 * u;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wide - button - 30 * u);
  const float high = std::max(size.y, 30 * u) + 20 * u;
  const float x = std::max(10 * u, 0.5F * (left + right - wide));
  ui.panel("##instructor", x, ui.height() - hud_height(ui) - 60 * u - high, wide, high);
  ImGui::PushTextWrapPos(wide - button - 20 * u);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::SetCursorPos({wide - button - 8 * u, 8 * u});
  if (ImGui::Button(word(Word::instructor_close), {button, 0})) close();
  ImGui::End();
}

}  // namespace burr::app
