// The panels of the import page, and what the mouse does on them; its views: import_views.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "burr/base/printable.h"
#include "shared/word_names.h"
#include "window/import/import_page.h"
#include "window/import/notice_words.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;
using volume::TissueKind;
using Part = ImportLayout::Part;

constexpr float kLabelButtons = 3 * 53 + 64;  // width of the buttons of a label

const char* way(PatientDirection which) {
  constexpr Word kWays[] = {Word::way_left,     Word::way_right, Word::way_backwards,
                            Word::way_forwards, Word::way_up,    Word::way_down};
  return word(kWays[static_cast<std::size_t>(which)]);
}

std::string memory_text(double mb) {
  return mb < 1000 ? fmt::format("{:.0f} MB", mb) : fmt::format("{:.1f} GB", mb / 1024);
}

// true when Enter was pressed, or when the user left the field after typing
bool changed_field(const char* id, const char* hint, std::string& text, float width) {
  const bool entered = text_field(id, hint, text, width);
  return entered || ImGui::IsItemDeactivatedAfterEdit();
}

void warning_sign(const Ui& ui, float x, float y) {
  const float r = 7 * ui.unit();
  ImGui::GetWindowDrawList()->AddTriangleFilled({x, y + 2 * r}, {x + 2 * r, y + 2 * r}, {x + r, y},
                                                ink::kWarn);
}

// several lines of text in a box; what does not fit is cut off
void wrapped(const Ui& ui, Letter letter, ImU32 ink, const Part& part, const std::string& text) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImFont* font = ui.font(letter);
  draw.PushClipRect({part.x, part.y}, {part.x + part.w, part.y + part.h}, true);
  draw.AddText(font, font->FontSize, {part.x, part.y}, ink, text.c_str(), nullptr, part.w);
  draw.PopClipRect();
}

}  // namespace

ImportLayout import_layout(float width, float height, float unit, std::size_t doubts) {
  const float u = unit, margin = 28 * u, gap = 14 * u, wide = width - 2 * margin;
  const float top = 66 * u, low = 262 * u, foot = 60 * u;
  ImportLayout at;
  const float line = 34 * u, lines = line * static_cast<float>(doubts);
  const float view_w = (wide - 2 * gap) / 3, view_h = height - top - low - foot - 2 * gap - lines;
  for (std::size_t n = 0; n < 3; ++n)
    at.views[n] = {margin + static_cast<float>(n) * (view_w + gap), top, view_w, view_h};
  for (std::size_t n = 0; n < doubts; ++n)
    at.doubts.push_back(
        {margin, top + view_h + 0.5F * gap + line * static_cast<float>(n), wide, line - 4 * u});
  const float y = top + view_h + gap + lines;
  at.level = {margin, y, view_w, low};
  at.facts = {margin + view_w + gap, y, view_w, low};
  at.bone = {margin + 2 * (view_w + gap), y, view_w, low};
  at.plot = {at.level.x, y + 42 * u, at.level.w, low - 74 * u};
  at.iso = {at.level.x + at.level.w - 150 * u, y, 110 * u, 30 * u};
  at.roi = {at.bone.x + 110 * u, y + 34 * u, at.bone.w - 110 * u, 30 * u};
  at.all = {at.bone.x + at.bone.w - 150 * u, y, 150 * u, 30 * u};
  at.voxel = {at.bone.x + 110 * u, y + 72 * u, 110 * u, 30 * u};
  at.series = {margin + wide - 560 * u, 20 * u, 560 * u, 30 * u};
  const float last = height - foot + 4 * u;
  at.start = {margin + wide - 210 * u, last, 210 * u, 36 * u};
  at.back = {at.start.x - 150 * u - gap, last, 150 * u, 36 * u};
  at.as_it_is = {at.back.x - 200 * u - gap, last, 200 * u, 36 * u};
  at.message = {margin, last, at.back.x - margin - gap, 46 * u};
  return at;
}

void ImportPage::draw() {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  const std::vector<Doubt> all = doubts();
  const ImportLayout at = import_layout(ui.width(), ui.height(), u, all.size());
  ui.page("##import", 0, 0, ui.width(), ui.height());
  ui.write(at.views[0].x, 14 * u, Letter::large, ink::kText, word(Word::import_title));
  ui.write(at.views[0].x, 42 * u, Letter::small, ink::kDim, word(Word::import_hint));
  const io::Scan& scan = *opened_.scan;
  if (!scan.series.empty()) {
    const auto taken = static_cast<std::size_t>(scan.series_taken);
    ui.write(at.series.x - 10 * u, at.series.y + 7 * u, Letter::body, ink::kText,
             word(Word::import_series), 1);
    ImGui::SetCursorScreenPos({at.series.x, at.series.y});
    ImGui::SetNextItemWidth(at.series.w);
    if (ImGui::BeginCombo("##series", scan.series[taken].c_str())) {
      for (std::size_t n = 0; n < scan.series.size(); ++n)
        if (ImGui::Selectable(scan.series[n].c_str(), n == taken) && n != taken) {
          series_ = fmt::format("#{}", n + 1);
          decide(Answer::other_series);
        }
      ImGui::EndCombo();
    }
  }
  if (std::exchange(renewed_, desk_.renewed()) != desk_.renewed())
    for (View& view : views_) {
      view.texture.forget();
      view.coloured = false;
    }
  for (std::size_t n = 0; n < 3; ++n) draw_view(n, at.views[n]);
  if (scan.values.empty())
    labels(at);
  else
    histogram(at);
  facts(at.facts);
  bone(at);
  lines(at, all);
  last_line(at);
  ImGui::End();
}

void ImportPage::histogram(const ImportLayout& at) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  const Greys& greys = opened_.greys;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ui.write(at.level.x, at.level.y + 6 * u, Letter::strong, ink::kAccent, word(Word::import_level));
  ImGui::SetCursorScreenPos({at.iso.x, at.iso.y});
  if (changed_field("##iso", "", iso_text_, at.iso.w)) take_level();
  ui.write(at.iso.x + at.iso.w + 8 * u, at.iso.y + 7 * u, Letter::body, ink::kText,
           unit_of_values());

  const Part& p = at.plot;
  draw.AddRectFilled({p.x, p.y}, {p.x + p.w, p.y + p.h}, ink::rgb(30, 34, 39), 4 * u);
  const auto place = [&](double value) {
    return p.x + p.w * static_cast<float>(
                           std::clamp((value - greys.from) / (greys.to - greys.from), 0.0, 1.0));
  };
  const auto now = level();
  const double most = std::log1p(static_cast<double>(greys.most));
  const float wide = p.w / static_cast<float>(greys.counts.size());
  const float line = now ? place(*now) : p.x + 2 * p.w;
  for (std::size_t n = 0; n < greys.counts.size(); ++n) {
    const float left = p.x + wide * static_cast<float>(n);
    const float high =
        (p.h - 8 * u) * static_cast<float>(std::log1p(static_cast<double>(greys.counts[n])) / most);
    draw.AddRectFilled({left, p.y + p.h - high}, {left + std::max(wide, 1.0F), p.y + p.h},
                       left + wide / 2 >= line ? ink::rgb(230, 159, 0) : ink::rgb(120, 128, 137));
  }
  ImGui::SetCursorScreenPos({p.x, p.y});
  ImGui::InvisibleButton("##levelline", {p.w, p.h});
  const bool held = ImGui::IsItemActive(), over = held || ImGui::IsItemHovered();
  if (held) {
    const float share = std::clamp((ImGui::GetIO().MousePos.x - p.x) / p.w, 0.0F, 1.0F);
    const double wanted = greys.from + static_cast<double>(share) * (greys.to - greys.from);
    if (!now || std::abs(wanted - *now) >= 0.5 * greys.step()) set_level(wanted);
  }
  if (now) {
    draw.AddLine({line + u, p.y}, {line + u, p.y + p.h}, ink::rgb(0, 0, 0), 3 * u);
    draw.AddLine({line, p.y}, {line, p.y + p.h}, ink::kText, (over ? 3.0F : 2.0F) * u);
    draw.AddTriangleFilled({line - 8 * u, p.y}, {line + 8 * u, p.y}, {line, p.y + 11 * u},
                           over ? ink::kAccent : ink::kText);
    ui.write(
        p.x, p.y + p.h + 8 * u, Letter::body, ink::kText,
        say(Word::import_share, number_text(*now), unit_of_values(), 100 * greys.share_from(*now)));
  }
  const auto ends = [&](double value, float aligned) {
    ui.write(aligned == 0 ? p.x + 4 * u : p.x + p.w - 4 * u, p.y + 4 * u, Letter::small, ink::kDim,
             fmt::format("{:.4g}{}", value, unit_of_values()), aligned);
  };
  ends(greys.from, 0);
  ends(greys.to, 1);
}

void ImportPage::labels(const ImportLayout& at) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  ui.write(at.level.x, at.level.y + 6 * u, Letter::strong, ink::kAccent, word(Word::import_labels));
  ImGui::SetCursorScreenPos({at.plot.x, at.level.y + 34 * u});
  ImGui::BeginChild("##labels", {at.plot.w, at.level.h - 40 * u}, false);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float high = 32 * u;
  const bool bar = high * static_cast<float>(labels_.size()) > at.level.h - 40 * u;
  const float wide = at.plot.w - (bar ? 14 * u : 0);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  std::optional<std::vector<LabelChoice>> wanted;
  for (std::size_t n = 0; n < labels_.size(); ++n) {
    const volume::Tissue& tissue = opened_.labels[n].tissue;
    const float y = from.y + high * static_cast<float>(n);
    const std::string name = base::printable(tissue.name, 60);
    const auto part = [](float c) {
      return static_cast<unsigned>(255 * std::clamp(c, 0.0F, 1.0F));
    };
    draw.AddRectFilled(
        {from.x, y + 6 * u}, {from.x + 18 * u, y + 24 * u},
        ink::rgb(part(tissue.colour[0]), part(tissue.colour[1]), part(tissue.colour[2])), 3 * u);
    const float choices = from.x + wide - kLabelButtons * u;
    if (labels_[n].assumed) warning_sign(ui, from.x + 2 * u, y + 8 * u);
    draw.PushClipRect({from.x, y}, {choices - 6 * u, y + high}, true);
    ui.write(from.x + 26 * u, y + 6 * u, Letter::body, ink::kText,
             fmt::format("{}  {}", tissue.label, name));
    draw.PopClipRect();
    const float room = choices - 6 * u - from.x;
    if (ui.width_of(Letter::body, name) > room - 50 * u && ImGui::IsWindowHovered() &&
        Part{from.x, y, room, high}.holds(ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y))
      ImGui::SetTooltip("%s", name.c_str());
    float x = choices;
    const auto choice = [&](Word says, float button, bool on, const LabelChoice& then) {
      ImGui::SetCursorScreenPos({x, y + 1 * u});
      ImGui::PushStyleColor(ImGuiCol_Button, on ? ink::rgb(30, 96, 138) : ink::kButton);
      ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 4 * u});
      const std::string text =
          fmt::format("{}##{}{}", word(says), tissue.label, static_cast<int>(says));
      if (ImGui::Button(text.c_str(), {button * u, 28 * u}) && then != labels_[n]) {
        wanted = labels_;
        (*wanted)[n] = then;
      }
      ImGui::PopStyleVar();
      ImGui::PopStyleColor();
      if (on) {  // the selected one also has a dot
        draw.AddRect({x, y + 1 * u}, {x + button * u, y + 29 * u}, ink::kText, 6 * u, 0, 1.5F * u);
        draw.AddCircleFilled({x + 0.5F * button * u, y + 26 * u}, 2.2F * u, ink::kText);
      }
      x += (button + 3) * u;
    };
    const LabelChoice& now = labels_[n];
    choice(Word::kind_solid, 50, now.kind == TissueKind::solid,
           {TissueKind::solid, now.spare, false});
    choice(Word::kind_soft, 50, now.kind == TissueKind::soft, {TissueKind::soft, now.spare, false});
    choice(Word::kind_air, 50, now.kind == TissueKind::air, {TissueKind::air, now.spare, false});
    choice(Word::kind_spare, 64, now.spare, {now.kind, !now.spare, now.assumed});
  }
  ImGui::SetCursorScreenPos({from.x, from.y + high * static_cast<float>(labels_.size())});
  ImGui::Dummy({1, 1});
  ImGui::EndChild();
  if (wanted) take_labels(std::move(*wanted));
}

void ImportPage::facts(const Part& part) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  const io::Scan& scan = *opened_.scan;
  ui.write(part.x, part.y + 6 * u, Letter::strong, ink::kAccent, word(Word::import_scan));
  float y = part.y + 36 * u;
  const auto line = [&](const std::string& text) {
    ui.write(part.x, y, Letter::body, ink::kText, text);
    y += 23 * u;
  };
  line(say(Word::import_voxels, scan.format, scan.size.x(), scan.size.y(), scan.size.z()));
  const float label = ui.width_of(Letter::body, word(Word::import_voxel)) + 10 * u;
  ui.write(part.x, y + 3 * u, Letter::body, ink::kText, word(Word::import_voxel));
  ImGui::SetCursorScreenPos({part.x + label, y - 3 * u});
  if (changed_field("##spacing", "", spacing_text_, 176 * u)) take_spacing();
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s", say(Word::import_spacing, scan.spacing_mm.x(), scan.spacing_mm.y(),
                                scan.spacing_mm.z())
                                .c_str());
  ui.write(part.x + label + 184 * u, y + 3 * u, Letter::body, ink::kText, "mm");
  y += 32 * u;
  const math::Vec3 cm = 0.1 * scan.size.cast<double>().cwiseProduct(scan.spacing_mm);
  line(say(Word::import_extent, cm.x(), cm.y(), cm.z()));
  const auto ways = directions(scan.axes);
  const bool about = ways[0].about || ways[1].about || ways[2].about;
  line(say(about ? Word::import_about : Word::import_ways, way(ways[0].way), way(ways[1].way),
           way(ways[2].way)));
  if (!scan.values.empty())
    line(say(Word::import_values, opened_.greys.low, opened_.greys.high, unit_of_values()));

  // the sentences of the reader; the one about the series is left out, because the chooser above
  // shows it
  std::string notices;
  const std::vector<std::string>& all = planned_ ? planned_->import.notices : scan.notices;
  for (const std::string& notice : all)
    if (scan.series.empty() || notice.find("choose with --series") == std::string::npos)
      notices += (notices.empty() ? "" : "\n") + notice_words(notice);
  if (notices.empty()) return;
  ImGui::SetCursorScreenPos({part.x, y + 4 * u});
  ImGui::BeginChild("##notices", {part.w, part.y + part.h - y - 4 * u}, false);
  ImGui::PushFont(ui.font(Letter::small));
  ImGui::PushStyleColor(ImGuiCol_Text, ink::kDim);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(notices.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::PopFont();
  ImGui::EndChild();
}

void ImportPage::bone(const ImportLayout& at) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  const Part& part = at.bone;
  ui.write(part.x, part.y + 6 * u, Letter::strong, ink::kAccent, word(Word::import_bone));
  ImGui::SetCursorScreenPos({at.all.x, at.all.y});
  if (ImGui::Button(word(Word::import_whole), {at.all.w, 0})) set_box(whole(*opened_.scan));
  ui.write(part.x, at.roi.y + 7 * u, Letter::body, ink::kText, word(Word::import_region));
  ImGui::SetCursorScreenPos({at.roi.x, at.roi.y});
  if (changed_field("##roi", word(Word::import_all), roi_text_, at.roi.w)) take_roi();
  ui.write(part.x, at.voxel.y + 7 * u, Letter::body, ink::kText, word(Word::import_voxel));
  ImGui::SetCursorScreenPos({at.voxel.x, at.voxel.y});
  if (changed_field("##voxel", word(Word::import_by_itself), voxel_text_, at.voxel.w)) take_voxel();
  ui.write(at.voxel.x + at.voxel.w + 8 * u, at.voxel.y + 7 * u, Letter::body, ink::kText, "mm");

  float y = at.voxel.y + 42 * u;
  const bool counting = stale_ || planning_;
  if (!planned_ || !plan_trouble_.empty()) {
    ui.write(part.x, y, Letter::body, ink::kDim, counting ? word(Word::import_counting) : "");
    return;
  }
  const importing::ImportSummary& plan = planned_->import;
  const auto line = [&](const std::string& text) {
    ui.write(part.x, y, Letter::body, counting ? ink::kDim : ink::kText, text);
    y += 23 * u;
  };
  line(say(Word::import_made, plan.size.x(), plan.size.y(), plan.size.z(), plan.voxel_mm));
  const SessionMemory& memory = planned_->memory;
  line(say(Word::import_memory, memory_text(memory.making), memory_text(memory.working)));
  const double free = free_memory_mb();
  if (memory.making <= free) return;
  y += 4 * u;
  warning_sign(ui, part.x, y);
  wrapped(ui, Letter::body, ink::kText, {part.x + 24 * u, y, part.w - 24 * u, part.y + part.h - y},
          say(Word::import_too_much, memory_text(free)));
}

void ImportPage::lines(const ImportLayout& at, const std::vector<Doubt>& all) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const std::function<void()>* act = nullptr;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const Part& p = at.doubts[n];
    const Doubt& doubt = all[n];
    draw.AddRectFilled({p.x, p.y}, {p.x + p.w, p.y + p.h},
                       doubt.open ? ink::rgb(50, 38, 22) : ink::rgb(30, 34, 39), 6 * u);
    if (doubt.open) warning_sign(ui, p.x + 10 * u, p.y + 8 * u);
    float x = p.x + p.w - 4 * u;
    for (std::size_t r = doubt.remedies.size(); r-- > 0;) {
      const Remedy& remedy = doubt.remedies[r];
      const float wide = ui.width_of(Letter::body, remedy.text) + 24 * u;
      x -= wide;
      ImGui::SetCursorScreenPos({x, p.y + 2 * u});
      ImGui::PushStyleColor(ImGuiCol_Button, remedy.on ? ink::rgb(30, 96, 138) : ink::kButton);
      if (ImGui::Button(fmt::format("{}##doubt{}_{}", remedy.text, n, r).c_str(),
                        {wide, p.h - 4 * u}))
        act = &remedy.act;
      ImGui::PopStyleColor();
      if (remedy.on)
        draw.AddRect({x, p.y + 2 * u}, {x + wide, p.y + p.h - 2 * u}, ink::kText, 6 * u, 0,
                     1.5F * u);
      x -= 8 * u;
    }
    const float from = p.x + (doubt.open ? 34 : 10) * u, room = x - from;
    const bool fits = ui.width_of(Letter::body, doubt.text) <= room;
    if (fits)
      ui.write(from, p.y + (p.h - ui.height_of(Letter::body)) / 2, Letter::body, ink::kText,
               doubt.text);
    else  // in two lines of small letters
      wrapped(ui, Letter::small, ink::kText, {from, p.y + 1 * u, room, p.h}, doubt.text);
  }
  if (act != nullptr) (*act)();
}

void ImportPage::last_line(const ImportLayout& at) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  const bool asks = asked();
  if (!desk_.message.empty()) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    Part p = at.message;
    if (asks) p.w = at.as_it_is.x - p.x - 14 * u;
    draw.AddRectFilled({p.x, p.y}, {p.x + p.w, p.y + p.h}, ink::rgb(50, 38, 22), 6 * u);
    draw.AddRect({p.x, p.y}, {p.x + p.w, p.y + p.h}, ink::kWarn, 6 * u, 0, 1.2F * u);
    warning_sign(ui, p.x + 10 * u, p.y + 10 * u);
    wrapped(ui, Letter::body, ink::kText, {p.x + 34 * u, p.y + 4 * u, p.w - 44 * u, p.h - 4 * u},
            desk_.message);
  }
  if (asks) {
    ImGui::SetCursorScreenPos({at.as_it_is.x, at.as_it_is.y});
    if (ImGui::Button(word(Word::import_as_it_is), {at.as_it_is.w, at.as_it_is.h})) take_as_it_is();
  }
  ImGui::SetCursorScreenPos({at.back.x, at.back.y});
  if (ImGui::Button(fmt::format("{}  [Esc]", word(Word::import_back)).c_str(),
                    {at.back.w, at.back.h}))
    decide(Answer::back);
  ImGui::SetCursorScreenPos({at.start.x, at.start.y});
  ImGui::PushStyleColor(ImGuiCol_Button, ink::rgb(20, 92, 140));
  const std::string text =
      starting_ ? word(Word::import_counting)
                : fmt::format("{}  [{}]", word(Word::import_start), word(Word::key_enter));
  if (ImGui::Button(fmt::format("{}##start", text).c_str(), {at.start.w, at.start.h}))
    decide(Answer::start);
  ImGui::PopStyleColor();
}

}  // namespace burr::app
