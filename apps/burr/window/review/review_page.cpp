#include "window/review/review_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shared/word_names.h"
#include "window/parts/hud.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr float kMargin = 40, kLeft = 400, kTop = 84, kFoot = 64;  // [points]

ImU32 colour_of(report::Tone tone) {
  switch (tone) {
    case report::Tone::good:
      return ink::kGood;
    case report::Tone::bad:
      return ink::kBad;
    case report::Tone::open:
      return ink::kAccent;
    case report::Tone::none:
      break;
  }
  return ink::kDim;
}

// A sign beside the word, so that not only a colour shows the mark: a tick, a cross, a ring, a dash.
void sign(ImDrawList& draw, ImVec2 c, float u, report::Tone tone) {
  const ImU32 shade = colour_of(tone);
  const float r = 5 * u;
  if (tone == report::Tone::good) {
    draw.AddLine({c.x - r, c.y}, {c.x - 0.2F * r, c.y + 0.8F * r}, shade, 2 * u);
    draw.AddLine({c.x - 0.2F * r, c.y + 0.8F * r}, {c.x + 1.2F * r, c.y - r}, shade, 2 * u);
  } else if (tone == report::Tone::bad) {
    draw.AddLine({c.x - r, c.y - r}, {c.x + r, c.y + r}, shade, 2 * u);
    draw.AddLine({c.x - r, c.y + r}, {c.x + r, c.y - r}, shade, 2 * u);
  } else if (tone == report::Tone::open) {
    draw.AddCircle(c, 0.8F * r, shade, 16, 1.5F * u);
  } else {
    draw.AddLine({c.x - r, c.y}, {c.x + r, c.y}, shade, 1.5F * u);
  }
}

// A page of text in a child window: paragraphs below each other.
class Column {
 public:
  explicit Column(const Ui& ui) : ui_(ui), u_(ui.unit()) {}

  void heading(const std::string& text) {
    gap(8);
    write(Letter::strong, ink::kAccent, text);
  }
  void write(Letter letter, ImU32 shade, const std::string& text) {
    if (text.empty()) return;
    ImGui::PushFont(ui_.font(letter));
    ImGui::PushStyleColor(ImGuiCol_Text, shade);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
  }
  // a sign, and the text right of it
  void marked(report::Tone tone, const std::string& text, const std::string& mark) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    sign(*ImGui::GetWindowDrawList(), {at.x + 8 * u_, at.y + 9 * u_}, u_, tone);
    ImGui::SetCursorScreenPos({at.x + 24 * u_, at.y});
    ImGui::BeginGroup();
    write(Letter::body, ink::kText, text);
    write(Letter::small, colour_of(tone), mark);
    ImGui::EndGroup();
  }
  void gap(float points) { ImGui::Dummy({1, points * u_}); }

 private:
  const Ui& ui_;
  float u_;
};

// Each item of safety that is not met, and how many are.
void draw_safety(Column& column, const report::Report& report) {
  if (report.gates.empty()) return;
  column.heading(word(Word::report_safety));
  std::size_t met = 0;
  for (const report::ReportGate& gate : report.gates) {
    if (gate.mark.tone == report::Tone::bad)
      column.marked(gate.mark.tone, gate.text,
                    gate.mark.word + (gate.when.empty() ? "" : ", " + gate.when));
    met += gate.mark.tone == report::Tone::good ? 1 : 0;
  }
  column.marked(met == report.gates.size() ? report::Tone::good : report::Tone::none, report.safety,
                "");
}

// What matters most, at the left: safety, totals, own marks, what to do next.
void draw_left(const Ui& ui, const report::Report& report) {
  Column column(ui);
  column.write(Letter::body, ink::kWarn, report.unfinished);
  draw_safety(column, report);
  column.heading(word(Word::report_totals));
  for (const report::ReportPart& part : report.parts) {
    column.write(Letter::small, ink::kDim, part.title);
    column.write(Letter::strong, ink::kText, part.met);
    column.write(Letter::small, ink::kWarn, part.note);
    column.gap(2);
  }
  if (!report.pieces.empty()) {
    column.heading(word(Word::report_pieces));
    for (const auto& [name, how] : report.pieces) {
      column.write(Letter::body, ink::kText, name);
      column.write(Letter::small, ink::kDim, how);
    }
    column.write(Letter::small, ink::kDim, word(Word::report_pieces_back));
  }
  column.heading(word(Word::report_next));
  int n = 0;
  for (const report::ReportAdvice& one : report.next) {
    column.write(Letter::body, ink::kText, fmt::format("{}. {}", ++n, one.say));
    column.write(Letter::small, ink::kDim, one.why);
    column.gap(2);
  }
  if (report.next.empty()) column.write(Letter::body, ink::kText, report.nothing_next);
  if (report.has_self) {
    column.heading(word(Word::report_self));
    column.write(Letter::body, ink::kText, report.self);
  }
  column.gap(8);
  column.write(Letter::small, ink::kDim, word(Word::report_no_grade));
  column.gap(2);
  column.write(Letter::small, ink::kDim, report.no_patient);
}

// The mark and its sign; nothing where there is none.
void mark_cell(const Ui& ui, const report::ReportMark& mark) {
  if (mark.word.empty()) return;
  const float u = ui.unit();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  sign(*ImGui::GetWindowDrawList(), {at.x + 7 * u, at.y + 8 * u}, u, mark.tone);
  ImGui::SetCursorScreenPos({at.x + 20 * u, at.y});
  Column(ui).write(Letter::small, ink::kText, mark.word);
}

bool item_row(const Ui& ui, const report::Report& report, const report::ReportItem& item) {
  Column column(ui);
  bool pressed = false;
  ImGui::PushID(item.id.c_str());
  ImGui::TableNextRow();
  if (report.has_self) {
    ImGui::TableNextColumn();
    mark_cell(ui, item.self);
  }
  ImGui::TableNextColumn();
  mark_cell(ui, item.machine);
  ImGui::TableNextColumn();
  column.write(Letter::body, ink::kText,
               item.gate ? item.text + "  (" + word(Word::report_gate) + ")" : item.text);
  std::string figures = item.figures;
  if (!item.default_word.empty()) figures += "  (" + item.default_word + ")";
  column.write(Letter::small, ink::kDim, figures);
  for (const std::string& remark : item.remarks) column.write(Letter::small, ink::kDim, remark);
  ImGui::TableNextColumn();
  if (item.at_s) {
    pressed = ImGui::Button(
        (item.at_end ? word(Word::review_show_end) : say(Word::review_show, minutes(*item.at_s)))
            .c_str(),
        {ImGui::GetContentRegionAvail().x, 0});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", word(Word::review_show_told));
  }
  ImGui::PopID();
  return pressed;
}

const report::ReportItem* draw_items(const Ui& ui, const report::Report& report) {
  const float u = ui.unit();
  const report::ReportItem* pressed = nullptr;
  const int columns = report.has_self ? 4 : 3;
  ImGui::PushStyleColor(ImGuiCol_TableHeaderBg, ink::rgb(30, 34, 39));
  ImGui::PushStyleColor(ImGuiCol_TableRowBgAlt, ink::rgb(255, 255, 255, 8));
  ImGui::PushStyleColor(ImGuiCol_TableBorderLight, ink::kLine);
  if (ImGui::BeginTable(
          "##items", columns,
          ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH)) {
    ImGui::TableSetupScrollFreeze(0, 1);
    if (report.has_self)
      ImGui::TableSetupColumn(report.you.c_str(), ImGuiTableColumnFlags_WidthFixed, 104 * u);
    ImGui::TableSetupColumn(report.machine.c_str(), ImGuiTableColumnFlags_WidthFixed, 124 * u);
    ImGui::TableSetupColumn(word(Word::report_item), ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn(word(Word::review_evidence), ImGuiTableColumnFlags_WidthFixed, 108 * u);
    ImGui::TableHeadersRow();
    for (const report::ReportPart& part : report.parts) {
      ImGui::TableNextRow();
      ImGui::TableSetColumnIndex(columns - 2);
      Column(ui).write(Letter::strong, ink::kAccent, part.title);
      for (const report::ReportItem& item : part.items)
        if (item_row(ui, report, item)) pressed = &item;
    }
    ImGui::EndTable();
  }
  ImGui::PopStyleColor(3);
  return pressed;
}

void draw_progress(const Ui& ui, double progress) {
  const float u = ui.unit(), x = kMargin * u, y = kTop * u, wide = 480 * u;
  ui.write(x, y, Letter::body, ink::kText, word(Word::review_waits));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float top = y + 30 * u, share = static_cast<float>(std::clamp(progress, 0.0, 1.0));
  draw.AddRectFilled({x, top}, {x + wide, top + 8 * u}, ink::kTrough, 4 * u);
  if (share > 0.01F)
    draw.AddRectFilled({x, top}, {x + share * wide, top + 8 * u}, ink::kAccent, 4 * u);
}

}  // namespace

ReviewPressed draw_review(Ui& ui, const ReviewState& state) {
  const float u = ui.unit(), x = kMargin * u, wide = ui.width() - 2 * x;
  const float high = ui.height() - (kTop + kFoot) * u;
  ReviewPressed pressed;
  ui.page("##review", 0, 0, ui.width(), ui.height());
  ui.write(x, 18 * u, Letter::large, ink::kText, word(Word::review_title));
  ui.write(x, 50 * u, Letter::body, ink::kDim, state.title);
  if (state.exam || !state.trouble.empty()) {
    ImGui::SetCursorScreenPos({x, kTop * u});
    ImGui::BeginChild("##told", {std::min(wide, 720 * u), high});
    Column(ui).write(Letter::body, ink::kText,
                     state.exam ? word(Word::review_exam) : state.trouble);
    ImGui::EndChild();
  } else if (state.report == nullptr) {
    draw_progress(ui, state.progress);
  } else {
    ImGui::SetCursorScreenPos({x, kTop * u});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {6 * u, 3 * u});
    ImGui::BeginChild("##left", {kLeft * u, high});
    draw_left(ui, *state.report);
    ImGui::EndChild();
    ImGui::SetCursorScreenPos({x + (kLeft + 24) * u, kTop * u});
    ImGui::BeginChild("##right", {wide - (kLeft + 24) * u, high});
    pressed.item = draw_items(ui, *state.report);
    ImGui::EndChild();
    ImGui::PopStyleVar();
  }
  ImGui::SetCursorScreenPos({x, ui.height() - 50 * u});
  // always there, so that no other button lies under a mouse that clicks twice on the page before
  const bool ready = state.report != nullptr && !state.writes;
  ImGui::BeginDisabled(!ready);
  pressed.full = ImGui::Button(word(Word::review_full), {170 * u, 0});
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (state.repeats) {
    pressed.again = ImGui::Button(word(Word::review_again));
    ImGui::SameLine();
  }
  pressed.close = ImGui::Button(fmt::format("{}  [Esc]", word(Word::review_close)).c_str());
  ImGui::SameLine(0, 16 * u);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(state.note.c_str());
  ImGui::End();
  return pressed;
}

}  // namespace burr::app
