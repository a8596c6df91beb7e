#include "window/mill/task_panel.h"

#include <algorithm>
#include <cfloat>
#include <string>
#include <vector>

#include "shared/word_names.h"
#include "window/mill/side_panel.h"
#include "window/parts/hud.h"

namespace burr::app {
namespace {

struct Line {
  Ui::Letter letter;
  ImU32 ink;
  std::string text;
};

Word word_of(const scenario::Target& target) {
  switch (target.goal) {
    case scenario::Goal::open:
      break;
    case scenario::Goal::expose:
      return Word::task_expose;
    case scenario::Goal::remove:
      return target.share < 1 ? Word::task_remove_share : Word::task_remove;
  }
  return Word::task_open;
}

std::vector<Line> lines_of(const scenario::Case& work, const scenario::CaseLesson* lesson) {
  using Letter = Ui::Letter;
  std::vector<Line> lines;
  const std::string title = lesson != nullptr ? lesson->title.in(spoken().code) : work.title,
                    description = lesson != nullptr ? lesson->description.in(spoken().code)
                                                    : work.description;
  lines.push_back({Letter::strong, ink::kAccent, title});
  if (!description.empty()) lines.push_back({Letter::body, ink::kText, description});
  for (const scenario::Target& target : work.targets) {
    const Word says = word_of(target);
    lines.push_back({Letter::body, ink::kText,
                     says == Word::task_remove_share
                         ? say(says, 100 * target.share, anatomy(target.tissue))
                         : say(says, anatomy(target.tissue))});
  }
  if (!work.spare.empty()) {
    lines.push_back({Letter::body, ink::kWarn, say(Word::task_spare, anatomy_list(work.spare))});
  }
  lines.push_back({Letter::small, ink::kDim, word(Word::task_key)});
  return lines;
}

// Joins the lines of a paragraph: the panel's width decides where lines break, not the file.
std::string flowing(std::string text) {
  for (std::size_t n = 0; n + 1 < text.size(); ++n)
    if (text[n] == '\n' && text[n + 1] != '\n' && (n == 0 || text[n - 1] != '\n')) text[n] = ' ';
  return text;
}

}  // namespace

bool draw_task(Ui& ui, const scenario::Case& work, const scenario::CaseLesson* lesson) {
  const float u = ui.unit(), wide = kSideWide * u, inside = wide - 28 * u, gap = 6 * u;
  std::vector<Line> lines = lines_of(work, lesson);
  float high = 2 * 12 * u - gap;
  for (Line& line : lines) {
    line.text = flowing(std::move(line.text));
    const ImFont* font = ui.font(line.letter);
    high += gap + font->CalcTextSizeA(font->FontSize, FLT_MAX, inside, line.text.c_str()).y;
  }
  const float x = kSideLeft * u, y = kSideLeafTop * u;
  high = std::min(high, ui.height() - hud_height(ui) - y - kSideFoot * u);
  ui.panel("##task", x, y, wide, high);
  ImGui::SetCursorScreenPos({x, y});
  const bool clicked = ImGui::InvisibleButton("##read", {wide, high});
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect({x, y}, {x + wide, y + high}, true);
  float at = y + 12 * u;
  for (const Line& line : lines) {
    const ImFont* font = ui.font(line.letter);
    draw.AddText(font, font->FontSize, {x + 14 * u, at}, line.ink, line.text.c_str(), nullptr,
                 inside);
    at += gap + font->CalcTextSizeA(font->FontSize, FLT_MAX, inside, line.text.c_str()).y;
  }
  draw.PopClipRect();
  ImGui::End();
  return clicked;
}

}  // namespace burr::app
