#include "window/start/start_page.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "burr/scenario/case.h"
#include "burr/workshop/hand_device.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "shared/work.h"
#include "window/parts/hud.h"
#include "window/start/can_rate.h"
#include "window/ui/settings_page.h"
#include "window/ui/typed_path.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using Letter = Ui::Letter;

constexpr std::size_t kRecentsShown = 3;

// the cases, easiest first
std::vector<std::string> cases() {
  std::vector<std::string> names = {"temporal-bone", "jaw", "spine", "tooth", "block"};
  const std::vector<std::string> known = scenario::built_in_cases();
  std::erase_if(names, [&](const std::string& name) {
    return std::find(known.begin(), known.end(), name) == known.end();
  });
  for (const std::string& name : known)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

}  // namespace

StartPage::StartPage(Desk& desk, HelpRows help_rows, const workshop::HandRequest& hand,
                     record::Identity identity)
    : desk_(desk),
      help_rows_(std::move(help_rows)),
      thumbnails_(desk.places().cache, cases()),
      renewed_(desk.renewed()),
      sessions_(desk),
      hand_([&] {
        workshop::HandRequest request = hand;
        if (request.device.empty()) request.device = desk.settings.device;
        return request;
      }()),
      identity_(std::move(identity)) {}

Result<StartPage::Choice> StartPage::ask(const std::string& trouble, double seconds) {
  using Clock = std::chrono::steady_clock;
  desk_.message = in_options(trouble);
  for (const std::string& one : std::exchange(desk_.troubles, {}))
    desk_.message += (desk_.message.empty() ? "" : "\n") + in_options(one);
  choice_.reset();
  sessions_.read();
  recent_ = recent(desk_.places().state);
  rates_ = can_rate(desk_);
  help_ = settings_ = false;
  desk_.page = Page::start;
  desk_.renderer().title("burr");
  SDL_StartTextInput();
  const render::Scene empty;
  const Clock::time_point start = Clock::now();
  while (!choice_) {
    const Clock::time_point frame = Clock::now();
    take_events();
    thumbnails_.step(desk_.renderer());  // before the page: the last picture stays visible
    const Status shown = desk_.show(
        empty, [this] { draw(); }, !dialog_.open());  // it has keys of its own
    if (!shown) return shown.error();
    if (std::exchange(renewed_, desk_.renewed()) != desk_.renewed()) {
      thumbnails_.forget();
      sessions_.forget();
    }
    if (const auto chosen = dialog_.answer(); chosen && !chosen->empty()) open(*chosen);
    const bool over = seconds > 0 && Clock::now() - start >= std::chrono::duration<double>(seconds);
    if (interrupted() || over)
      choice_ = Choice{.open = {}, .go_on = {}, .marks_of = {}, .quit = true};
    // nothing moves by itself on this page: thirty pictures a second are enough
    const auto left = std::chrono::milliseconds(33) - (Clock::now() - frame);
    if (left.count() > 0)
      SDL_Delay(
          static_cast<Uint32>(std::chrono::duration_cast<std::chrono::milliseconds>(left).count()));
  }
  SDL_StopTextInput();
  sessions_.rest();
  hand_.rest();
  return *choice_;
}

void StartPage::take_events() {
  const auto quit = [this] {
    choice_ = Choice{.open = {}, .go_on = {}, .marks_of = {}, .quit = true};
  };
  SDL_Event event;
  while (desk_.next(event)) switch (event.type) {
      case SDL_QUIT:
        quit();
        break;
      case SDL_DROPFILE:
        if (event.drop.file != nullptr) dropped_.emplace_back(event.drop.file);
        SDL_free(event.drop.file);
        break;
      case SDL_KEYDOWN: {
        const SDL_Keycode key = event.key.keysym.sym;
        if (desk_.ui().typing()) break;
        if (key == SDLK_F1 && !dialog_.open()) help_ = !help_;
        if (key == SDLK_F2 && !dialog_.open()) settings_ = !settings_;
        if (key != SDLK_ESCAPE) break;
        if (dialog_.open())
          dialog_.cancel();
        else if (help_ || settings_)
          help_ = settings_ = false;
        else
          quit();
        break;
      }
      default:
        break;
    }
  if (dropped_.empty()) return;
  // many slices dropped together: open their folder
  const std::string first = dropped_.front();
  const bool many = dropped_.size() > 1;
  dropped_.clear();
  open(many ? fs::path(first).parent_path().string() : first);
}

void StartPage::open(std::string path) {
  WorkOptions options;
  options.volume.source = cleaned_path(std::move(path));
  options.identity = identity_;
  options.other_bones = other_bone_;
  // a scan without a case has no steps that these two could be about; an exam stays one
  const bool guided =
      identity_.mode == record::Mode::learn || identity_.mode == record::Mode::practise;
  if (guided && names_a_scan(options)) options.identity.mode = record::Mode::free;
  if (!options.volume.source.empty())
    choice_ = Choice{.open = std::move(options), .go_on = {}, .marks_of = {}, .quit = false};
}

// ---- what is drawn

void StartPage::draw() {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  if (help_ && !draw_help(ui, help_rows_(desk_.settings.left_handed), help_pads_)) help_ = false;
  if (settings_) {
    const fs::path& config = desk_.places().config;
    const SettingsPage page = draw_settings(
        ui, desk_.settings, config.empty() ? std::string() : (config / "settings.toml").string(),
        settings_pads_);
    if (page.changed) desk_.settings_changed();
    if (page.done) settings_ = false;
  }
  if (help_ || settings_) return;
  if (dialog_.open()) return dialog_.draw(ui);

  ui.page("##start", 0, 0, ui.width(), ui.height());
  // on a large screen everything is centred
  const float x = std::max(40 * u, (ui.width() - 1180 * u) / 2);
  const float top = std::max(0.0F, (ui.height() - 720 * u) / 2);
  ui.write(x, top + 30 * u, Letter::title, ink::kText, "burr");
  ui.write(x + 86 * u, top + 45 * u, Letter::body, ink::kDim, word(Word::start_hello));
  ui.write(x, top + 96 * u, Letter::strong, ink::kAccent, word(Word::start_cases));
  modes(x + 256 * u, top + 88 * u);
  cards(x, top + 124 * u);
  other_bone(x + 526 * u, top + 330 * u, 226 * u);
  draw_message(x, top + 528 * u, 752 * u);
  draw_news(x, top + 622 * u, 752 * u);

  const float right = x + 788 * u, w = 392 * u;
  own_scan(right, top + 96 * u, w);
  float y = top + 314 * u;
  SessionList::Pressed pressed = sessions_.draw(right, y, w);
  if (pressed.go_on || pressed.marks_of)
    choice_ = Choice{.open = {},
                     .go_on = std::move(pressed.go_on),
                     .marks_of = std::move(pressed.marks_of),
                     .quit = false};
  if (pressed.play) play(*pressed.play);
  y += 12 * u;
  recents(right, y, w);
  if (hand_.draw(ui, right, top + 632 * u, w)) {
    desk_.settings.device = hand_.request().device;
    desk_.settings_changed();
  }

  ImGui::SetCursorScreenPos({x, std::min(top + 660 * u, ui.height() - 48 * u)});
  if (ImGui::Button(fmt::format("{}  [F2]", word(Word::settings_title)).c_str())) settings_ = true;
  ImGui::SameLine();
  if (ImGui::Button(fmt::format("{}  [F1]", word(Word::help)).c_str())) help_ = true;
  ImGui::SameLine();
  if (ImGui::Button(fmt::format("{}  [Esc]", word(Word::start_quit)).c_str()))
    choice_ = Choice{.open = {}, .go_on = {}, .marks_of = {}, .quit = true};
  if (rates_) {  // last, so that nothing moves where there is no store
    ImGui::SameLine(0, 24 * u);
    if (ImGui::Button(word(Word::rate_title)))
      choice_ = Choice{.open = {}, .go_on = {}, .marks_of = {}, .quit = false, .rate = true};
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", word(Word::rate_how));
  }
  ImGui::End();
}

void StartPage::cards(float x, float y) {
  Ui& ui = desk_.ui();
  const float u = ui.unit(), w = 240 * u, h = 186 * u, gap = 16 * u, pictured = 137 * u;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const std::vector<std::string> names = cases();
  for (std::size_t n = 0; n < names.size(); ++n) {
    const ImVec2 p = {x + static_cast<float>(n % 3) * (w + gap),
                      y + static_cast<float>(n / 3) * (h + gap)};
    ImGui::SetCursorScreenPos(p);
    if (ImGui::InvisibleButton(fmt::format("##card{}", n).c_str(), {w, h})) open(names[n]);
    const bool at = ImGui::IsItemHovered() || ImGui::IsItemFocused();
    const ImVec2 q = {p.x + w, p.y + h};
    draw.AddRectFilled(p, q, at ? ink::kOver : ink::rgb(30, 34, 39), 8 * u);
    if (const unsigned texture = thumbnails_.texture(n); texture != 0)
      draw.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)), p,
                           {q.x, p.y + pictured}, {0, 0}, {1, 1}, ink::rgb(255, 255, 255), 8 * u,
                           ImDrawFlags_RoundCornersTop);
    else
      draw.AddRectFilled(p, {q.x, p.y + pictured}, ink::rgb(40, 45, 52), 8 * u,
                         ImDrawFlags_RoundCornersTop);
    if (at) draw.AddRect(p, q, ink::kAccent, 8 * u, 0, 2 * u);
    ui.write(p.x + 14 * u, p.y + pictured + 15 * u, Letter::strong, ink::kText,
             name_of_case(names[n]));
  }
}

// What the next session is for, and a line that says what this mode offers.
void StartPage::modes(float x, float y) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  struct One {
    record::Mode mode;
    Word name, help;
  };
  ui.write(x, y + 8 * u, Letter::strong, ink::kAccent, word(Word::mode_title));
  float at = x + 90 * u;
  for (const One& one : {One{record::Mode::free, Word::mode_free, Word::mode_told_free},
                         One{record::Mode::learn, Word::mode_learn, Word::mode_told_learn},
                         One{record::Mode::practise, Word::mode_practise, Word::mode_told_practise},
                         One{record::Mode::exam, Word::mode_exam, Word::mode_told_exam}}) {
    ImGui::SetCursorScreenPos({at, y});
    if (ImGui::RadioButton(word(one.name), identity_.mode == one.mode)) choose(one.mode);
    at += ImGui::GetItemRectSize().x + 14 * u;
    if (identity_.mode == one.mode)
      ui.write(x + 90 * u, y - 16 * u, Letter::small, ink::kDim, word(one.help));
  }
}

// Also for the next start of burr.
void StartPage::choose(record::Mode mode) {
  identity_.mode = mode;
  desk_.settings.mode = record::word_of(mode);
  desk_.settings_changed();
}

void StartPage::other_bone(float x, float y, float w) {
  const Ui& ui = desk_.ui();
  ImGui::SetCursorScreenPos({x, y});
  ImGui::Checkbox(word(Word::bone_other), &other_bone_);
  ImGui::SetCursorScreenPos({x, y + 34 * ui.unit()});
  ImGui::PushTextWrapPos(x + w);
  ImGui::PushStyleColor(ImGuiCol_Text, ink::kDim);
  ImGui::TextUnformatted(word(Word::bone_told_other));
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
}

void StartPage::own_scan(float x, float y, float w) {
  Ui& ui = desk_.ui();
  const float u = ui.unit(), high = 88 * u;
  ui.write(x, y, Letter::strong, ink::kAccent, word(Word::start_own));
  y += 28 * u;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({x, y}, {x + w, y + high}, ink::rgb(30, 34, 39), 8 * u);
  for (float at = 0; at < w; at += 12 * u)  // a dashed frame: files may be dropped here
    for (const float edge : {y, y + high})
      draw.AddLine({x + at, edge}, {std::min(x + at + 7 * u, x + w), edge}, ink::kDim, 1.2F * u);
  for (float at = 0; at < high; at += 12 * u)
    for (const float edge : {x, x + w})
      draw.AddLine({edge, y + at}, {edge, std::min(y + at + 7 * u, y + high)}, ink::kDim, 1.2F * u);
  const std::string drop = word(Word::start_drop);
  const std::size_t cut = drop.find('\n');
  ui.write(x + w / 2, y + 24 * u, Letter::body, ink::kText, drop.substr(0, cut), 0.5F);
  if (cut != std::string::npos)
    ui.write(x + w / 2, y + 46 * u, Letter::body, ink::kDim, drop.substr(cut + 1), 0.5F);
  y += high + 12 * u;
  ImGui::SetCursorScreenPos({x, y});
  const bool entered =
      text_field("##path", word(Word::start_path), typed_, w - 96 * u, completed_path);
  ImGui::SetCursorScreenPos({x + w - 86 * u, y});
  if (ImGui::Button(word(Word::start_open), {86 * u, 0}) || entered) open(typed_);
  y += 40 * u;
  ImGui::SetCursorScreenPos({x, y});
  if (ImGui::Button(word(Word::start_choose), {w, 0})) dialog_.ask(word(Word::dialog_open));
}

// A line that can be clicked; mark: a triangle before it, as a sign of a problem.
bool StartPage::row(const char* id, float x, float& y, float w, const std::string& left,
                    const std::string& right, bool mark) {
  Ui& ui = desk_.ui();
  const float u = ui.unit(), h = 30 * u;
  ImGui::SetCursorScreenPos({x, y});
  const bool pressed = ImGui::InvisibleButton(id, {w, h - 2 * u});
  const bool at = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({x, y}, {x + w, y + h - 2 * u}, at ? ink::kOver : ink::rgb(30, 34, 39), 5 * u);
  if (at) draw.AddRect({x, y}, {x + w, y + h - 2 * u}, ink::kAccent, 5 * u, 0, 1.5F * u);
  float from = x + 10 * u;
  if (mark) {
    const float cx = from + 6 * u, cy = y + 14 * u, r = 6 * u;
    draw.AddTriangleFilled({cx - r, cy + 0.8F * r}, {cx + r, cy + 0.8F * r}, {cx, cy - 0.9F * r},
                           ink::kWarn);
    from += 18 * u;
  }
  const float end = x + w - 10 * u - ui.width_of(Letter::small, right);
  draw.PushClipRect({from, y}, {end - 8 * u, y + h}, true);
  ui.write(from, y + 6 * u, Letter::body, ink::kText, left);
  draw.PopClipRect();
  ui.write(end, y + 8 * u, Letter::small, ink::kDim, right);
  y += h;
  return pressed;
}

void StartPage::play(const KeptSession& kept) {
  WorkOptions options;
  options.volume.source = kept.file.string();
  choice_ = Choice{.open = std::move(options), .go_on = {}, .marks_of = {}, .quit = false};
}

void StartPage::recents(float x, float& y, float w) {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  if (recent_.empty()) return;
  ui.write(x, y, Letter::strong, ink::kAccent, word(Word::start_recent));
  y += 26 * u;
  for (std::size_t n = 0; n < std::min(recent_.size(), kRecentsShown); ++n) {
    const Recent& one = recent_[n];
    // the name of a file may contain the name of a patient
    const std::string name = desk_.settings.recent_names ? fs::path(one.path).filename().string()
                             : one.titles.empty()        ? name_of_work(one.title)
                                                         : one.titles.in(spoken().code);
    if (row(fmt::format("##recent{}", n).c_str(), x, y, w, name, one.when, false)) open(one.path);
  }
}

// What is no error: a frame without a warning sign. A click takes it away.
void StartPage::draw_news(float x, float y, float w) {
  if (desk_.news.empty()) return;
  const Ui& ui = desk_.ui();
  const float u = ui.unit(), h = 30 * u;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImGui::SetCursorScreenPos({x, y});
  const bool away = ImGui::InvisibleButton("##newsaway", {w, h});
  draw.AddRectFilled({x, y}, {x + w, y + h}, ImGui::IsItemHovered() ? ink::kOver : ink::kButton,
                     6 * u);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s\n%s", desk_.news.c_str(), word(Word::line_close));
  draw.PushClipRect({x, y}, {x + w - 10 * u, y + h}, true);
  ui.write(x + 14 * u, y + 7 * u, Letter::body, ink::kText, desk_.news);
  draw.PopClipRect();
  if (away) desk_.news.clear();
}

void StartPage::draw_message(float x, float y, float w) {
  if (desk_.message.empty()) return;
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  const ImFont* font = ui.font(Letter::body);
  const float pad = 14 * u;
  const ImVec2 size =
      font->CalcTextSizeA(font->FontSize, 1e9F, w - 2 * pad - 40 * u, desk_.message.c_str());
  const float h = std::min(size.y, 70 * u) + 2 * pad + 22 * u;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({x, y}, {x + w, y + h}, ink::rgb(50, 38, 22), 8 * u);
  draw.AddRect({x, y}, {x + w, y + h}, ink::kWarn, 8 * u, 0, 1.2F * u);
  const float cx = x + pad + 8 * u, cy = y + pad + 8 * u, r = 8 * u;
  draw.AddTriangleFilled({cx - r, cy + 0.8F * r}, {cx + r, cy + 0.8F * r}, {cx, cy - 0.9F * r},
                         ink::kWarn);
  ui.write(x + pad + 24 * u, y + pad, Letter::strong, ink::kText, word(Word::start_trouble));
  draw.PushClipRect({x, y}, {x + w, y + h}, true);
  draw.AddText(font, font->FontSize, {x + pad, y + pad + 22 * u}, ink::kText, desk_.message.c_str(),
               nullptr, w - 2 * pad - 40 * u);
  draw.PopClipRect();
  ImGui::SetCursorScreenPos({x + w - 50 * u, y + pad - 4 * u});
  if (ImGui::Button("x##told", {34 * u, 0})) desk_.message.clear();
}

}  // namespace burr::app
