#include "window/review/self_marks_page.h"

#include <fmt/format.h>

#include <array>

#include "shared/word_names.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr float kMargin = 40, kButton = 108, kGap = 6, kButtons = 3 * (kButton + kGap);  // [points]

// A button that stays down; its frame shows it, so that not only a colour does.
bool choice(const char* text, bool chosen, float wide, float u) {
  if (chosen) {
    ImGui::PushStyleColor(ImGuiCol_Button, ink::rgb(86, 180, 233, 90));
    ImGui::PushStyleColor(ImGuiCol_Border, ink::kAccent);
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 1.5F * u);
  }
  const bool pressed = ImGui::Button(text, {wide, 0});
  if (chosen) {
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(2);
  }
  return pressed;
}

}  // namespace

SelfMarksPage::SelfMarksPage(std::vector<report::QuestionPart> parts) : parts_(std::move(parts)) {
  for (const report::QuestionPart& part : parts_)
    marks_.emplace_back(part.items.size(), Mark::none);
}

std::size_t SelfMarksPage::count() const {
  std::size_t all = 0;
  for (const auto& part : marks_)
    for (const Mark mark : part) all += mark != Mark::none ? 1 : 0;
  return all;
}

SelfMarksPage::Marks SelfMarksPage::marks() const {
  constexpr std::array kWords = {"", "met", "unmet", "unknown"};
  Marks all;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for (std::size_t n = 0; n < parts_[p].items.size(); ++n)
      if (marks_[p][n] != Mark::none)
        all.emplace_back(parts_[p].items[n].id, kWords[static_cast<std::size_t>(marks_[p][n])]);
  return all;
}

void SelfMarksPage::row(Ui& ui, const report::Question& question, Mark& mark, float wide) {
  const float u = ui.unit(), high = ImGui::GetFrameHeight() + 4 * u;
  ImGui::PushID(question.id.c_str());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::IsMouseHoveringRect(at, {at.x + wide, at.y + high}))
    ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + wide, at.y + high}, ink::kTrough, 4 * u);
  float x = at.x + kGap * u;
  for (const auto& [one, text] : {std::pair{Mark::met, Word::report_verdict_met},
                                  std::pair{Mark::unmet, Word::report_verdict_unmet},
                                  std::pair{Mark::unknown, Word::report_self_unknown}}) {
    ImGui::SetCursorScreenPos({x, at.y + 2 * u});
    if (choice(word(text), mark == one, kButton * u, u)) mark = mark == one ? Mark::none : one;
    x += (kButton + kGap) * u;
  }
  const float line = at.y + (high - ui.height_of(Letter::body)) / 2;
  ui.write(x + kGap * u, line, Letter::body, ink::kText, question.text);
  if (question.gate)
    ui.write(x + 3 * kGap * u + ui.width_of(Letter::body, question.text), line, Letter::small,
             ink::kWarn, word(Word::report_gate));
  ImGui::PopID();
  ImGui::SetCursorScreenPos({at.x, at.y + high});
}

void SelfMarksPage::part(Ui& ui, std::size_t p, float wide) {
  const float u = ui.unit(), high = ImGui::GetFrameHeight() + 16 * u;
  ImGui::PushID(static_cast<int>(p));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = at.y + 10 * u + (ImGui::GetFrameHeight() - ui.height_of(Letter::body)) / 2;
  ui.write(at.x + (kButtons + 2 * kGap) * u, line, Letter::strong, ink::kAccent, parts_[p].title);
  // what nobody has marked yet, with one press, in the columns of the answers
  float x = at.x + kGap * u;
  for (const auto& [one, text] : {std::pair{Mark::met, Word::report_verdict_met},
                                  std::pair{Mark::unmet, Word::report_verdict_unmet}}) {
    ImGui::SetCursorScreenPos({x, at.y + 10 * u});
    if (ImGui::Button(word(text), {kButton * u, 0}))
      for (Mark& mark : marks_[p])
        if (mark == Mark::none) mark = one;
    x += (kButton + kGap) * u;
  }
  ui.write(x + kGap * u, line, Letter::small, ink::kDim, word(Word::self_rest));
  ImGui::SetCursorScreenPos({at.x, at.y + high});
  for (std::size_t n = 0; n < parts_[p].items.size(); ++n)
    row(ui, parts_[p].items[n], marks_[p][n], wide);
  ImGui::PopID();
}

SelfMarksPage::Pressed SelfMarksPage::draw(Ui& ui) {
  const float u = ui.unit(), x = kMargin * u, wide = ui.width() - 2 * x;
  Pressed pressed = Pressed::nothing;
  ui.page("##selfmarks", 0, 0, ui.width(), ui.height());
  ui.write(x, 26 * u, Letter::large, ink::kText, word(Word::self_title));
  ui.write(x, 60 * u, Letter::body, ink::kDim, word(Word::self_why));
  ImGui::SetCursorScreenPos({x, 92 * u});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * u, 0});
  ImGui::BeginChild("##items", {wide, ui.height() - 92 * u - 64 * u});
  const float inside = ImGui::GetContentRegionAvail().x - 4 * u;
  for (std::size_t p = 0; p < parts_.size(); ++p) part(ui, p, inside);
  ImGui::Dummy({inside, 2 * u});
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::SetCursorScreenPos({x, ui.height() - 50 * u});
  const std::string finish =
      fmt::format("{}  [{}]", word(Word::self_finish), word(Word::key_enter));
  if (ImGui::Button(finish.c_str())) pressed = Pressed::finished;
  ImGui::SameLine();
  if (ImGui::Button(word(Word::self_skip))) pressed = Pressed::skipped;
  std::size_t all = 0;
  for (const report::QuestionPart& one : parts_) all += one.items.size();
  ui.write(x + wide, ui.height() - 42 * u, Letter::body, ink::kDim,
           say(Word::self_count, count(), all), 1);
  ImGui::End();
  return pressed;
}

}  // namespace burr::app
