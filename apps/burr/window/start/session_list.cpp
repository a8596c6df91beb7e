#include "window/start/session_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "shared/front_words.h"
#include "shared/word_names.h"
#include "window/parts/hud.h"
#include "window/parts/small_picture.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr float kHigh = 44, kMost = 4 * kHigh;  // of a row, and of the list: it scrolls [point]

// The arrow keys go into the list and out of it, as if it were no window of its own.
void begin_list(ImVec2 size) {
#if IMGUI_VERSION_NUM >= 19090
  ImGui::BeginChild("##sessions", size, ImGuiChildFlags_NavFlattened);
#else
  ImGui::BeginChild("##sessions", size, false, ImGuiWindowFlags_NavFlattened);
#endif
}

// A button with a triangle, as that of the page that plays a recording.
bool play_button(float u, std::size_t number, ImVec2 p, ImVec2 size) {
  ImGui::SetCursorScreenPos(p);
  const bool pressed = ImGui::Button(fmt::format("##play{}", number).c_str(), size);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", word(Word::start_play_told));
  const ImVec2 c = {p.x + size.x / 2, p.y + size.y / 2};
  ImGui::GetWindowDrawList()->AddTriangleFilled(
      {c.x - 4 * u, c.y - 6 * u}, {c.x - 4 * u, c.y + 6 * u}, {c.x + 7 * u, c.y}, ink::kText);
  return pressed;
}

// A button with a pencil.
bool pencil_button(float u, std::size_t number, ImVec2 p, ImVec2 size) {
  ImGui::SetCursorScreenPos(p);
  const bool pressed = ImGui::Button(fmt::format("##pencil{}", number).c_str(), size);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", word(Word::start_name_told));
  const ImVec2 c = {p.x + size.x / 2, p.y + size.y / 2};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddLine({c.x - 5 * u, c.y + 5 * u}, {c.x + 5 * u, c.y - 5 * u}, ink::kText, 2.5F * u);
  draw.AddTriangleFilled({c.x - 8 * u, c.y + 8 * u}, {c.x - 6 * u, c.y + 3 * u},
                         {c.x - 3 * u, c.y + 6 * u}, ink::kText);
  return pressed;
}

}  // namespace

void SessionList::read() {
  kept_ = kept_sessions(desk_.places().state);
  pictures_.clear();
  naming_.reset();
}

void SessionList::rest() { pictures_.clear(); }

void SessionList::forget() {
  for (auto& [file, texture] : pictures_) texture.forget();
  pictures_.clear();
}

// Its last picture; 0: there is none.
unsigned SessionList::picture(const KeptSession& kept) {
  const auto [at, fresh] = pictures_.try_emplace(kept.file.string());
  render::Image image;
  if (fresh && read_small_picture(picture_of(kept.file), image))
    at->second.put(image.width, image.height, 3, image.rgb);
  return at->second.name();
}

// The field in place of the row. Enter keeps the name, Escape leaves it; so does a click elsewhere.
void SessionList::name_row(KeptSession& kept, float x, float y, float w) {
  const float u = desk_.ui().unit();
  ImGui::SetCursorScreenPos({x, y + 5 * u});
  const bool focus = std::exchange(to_name_, false);
  if (focus) focus_next();
  const bool entered = text_field("##name", word(Word::start_name_hint), name_, w);
  if (entered) {
    KeptSession unnamed = kept;
    unnamed.name.clear();
    const Status named = name_session(kept, name_ == shown_title(unnamed) ? "" : name_);
    if (!named) desk_.message = in_options(named.error()).text;
  }
  if (entered || (!focus && ImGui::IsItemDeactivated())) naming_.reset();
}

void SessionList::row(std::size_t n, float x, float top, float w, Pressed& pressed) {
  Ui& ui = desk_.ui();
  const float u = ui.unit(), h = (kHigh - 4) * u;
  KeptSession& kept = kept_[n];
  if (naming_ == n) return name_row(kept, x, top, w);
  const std::string title = shown_title(kept);
  std::string tip = title + "\n";
  if (!kept.clean) tip += fmt::format("{} - ", word(Word::start_unclean));
  if (kept.keep) tip += fmt::format("{} - ", word(Word::start_kept));
  tip += fmt::format("{} - {:.0f} mm³ - {}", minutes(kept.seconds), kept.removed_mm3, kept.when);
  // the marks of a session on a case, also of one that did not come to its end
  const float playing = 38 * u, naming = kept.has_account ? 34 * u : 0,
              beside = playing + naming + (kept.marks ? 84 * u : 0), wide = w - beside;
  ImGui::SetCursorScreenPos({x, top});
  if (ImGui::InvisibleButton(fmt::format("##kept{}", n).c_str(), {wide, h})) pressed.go_on = kept;
  const bool at = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s\n%s", word(Word::start_go_on_told), tip.c_str());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({x, top}, {x + wide, top + h}, at ? ink::kOver : ink::rgb(30, 34, 39), 5 * u);
  const float pictured = 64 * u;
  if (const unsigned texture = picture(kept); texture != 0)
    draw.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)),
                         {x + 2 * u, top + 2 * u}, {x + pictured, top + h - 2 * u}, {0, 0}, {1, 1},
                         ink::rgb(255, 255, 255), 4 * u);
  if (at) draw.AddRect({x, top}, {x + wide, top + h}, ink::kAccent, 5 * u, 0, 1.5F * u);
  float from = x + pictured + 10 * u;
  if (!kept.clean) {
    const float cx = from + 6 * u, cy = top + 13 * u, r = 6 * u;
    draw.AddTriangleFilled({cx - r, cy + 0.8F * r}, {cx + r, cy + 0.8F * r}, {cx, cy - 0.9F * r},
                           ink::kWarn);
    from += 18 * u;
  }
  draw.PushClipRect({from, top}, {x + wide - 6 * u, top + h}, true);
  ui.write(from, top + 4 * u, Letter::body, ink::kText, title);
  ui.write(x + pictured + 10 * u, top + 22 * u, Letter::small, ink::kDim, kept.when);
  draw.PopClipRect();
  if (kept.has_account &&
      pencil_button(u, n, {x + wide + 4 * u, top + 5 * u}, {naming - 4 * u, 28 * u})) {
    naming_ = n;
    name_ = title;
    to_name_ = true;
  }
  if (play_button(u, n, {x + wide + naming + 4 * u, top + 5 * u}, {playing - 4 * u, 28 * u}))
    pressed.play = kept;
  if (!kept.marks) return;
  ImGui::SetCursorScreenPos({x + wide + naming + playing + 4 * u, top + 5 * u});
  if (ImGui::Button(fmt::format("{}##marks{}", word(Word::start_marks), n).c_str(),
                    {beside - naming - playing - 4 * u, 28 * u}))
    pressed.marks_of = kept;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", word(Word::start_marks_told));
}

SessionList::Pressed SessionList::draw(float x, float& y, float w) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  Pressed pressed;
  ui.write(x, y, Letter::strong, ink::kAccent, word(Word::start_sessions));
  y += 26 * u;
  if (kept_.empty()) {
    ui.write(x, y, Letter::body, ink::kDim, word(Word::start_none));
    y += 26 * u;
    return pressed;
  }
  const float all = static_cast<float>(kept_.size()) * kHigh * u, high = std::min(all, kMost * u);
  ImGui::SetCursorScreenPos({x, y});
  begin_list({w + 14 * u, high});
  float at = y - ImGui::GetScrollY();
  for (std::size_t n = 0; n < kept_.size(); ++n, at += kHigh * u) row(n, x, at, w, pressed);
  ImGui::SetCursorScreenPos({x, at - 1});  // so that the list is as long as its rows
  ImGui::Dummy({1, 1});
  ImGui::EndChild();
  y += high;
  return pressed;
}

}  // namespace burr::app
