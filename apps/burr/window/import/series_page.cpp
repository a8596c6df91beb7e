#include "window/import/series_page.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "window/import/import_preview.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;
constexpr int kPicture = 160;  // longest side [pixel]

}  // namespace

render::Image middle_of(const OpenedScan& opened, int most) {
  const io::Scan& scan = *opened.scan;
  const PlaneView plane = planes_of(scan.axes)[0];
  const std::array<double, 2> mm = extent_mm(scan, plane);
  const double scale = most / std::max(mm[0], mm[1]);
  const auto pixels = [&](double along) { return std::max(2, static_cast<int>(along * scale)); };
  PlaneValues values;
  sample(scan, plane, scan.size[plane.through] / 2, pixels(mm[0]), pixels(mm[1]), values);
  std::vector<std::uint8_t> rgba;
  if (scan.values.empty()) {
    std::array<LabelLook, 256> looks;
    for (const importing::TissueFound& one : opened.labels)
      looks[static_cast<std::size_t>(one.tissue.label)] = {one.tissue.kind, one.tissue.colour};
    draw_labels(values, looks, 1, {}, rgba);
  } else {
    constexpr double kWhite = 1800;  // as on the import page [HU]
    const double to = scan.hounsfield ? std::min(opened.greys.to, kWhite) : opened.greys.to;
    draw_greys(values, opened.greys.from, to, std::nullopt, 1, {}, rgba);
  }
  render::Image image{values.width, values.height, {}};
  for (std::size_t n = 0; n + 3 < rgba.size(); n += 4)
    image.rgb.insert(image.rgb.end(), {rgba[n], rgba[n + 1], rgba[n + 2]});
  return image;
}

SeriesPage::SeriesPage(Desk& desk, const OpenedScan& opened)
    : desk_(desk),
      recipe_(opened.volume),
      lines_(opened.scan->series),
      dates_(opened.scan->series_dates),
      pictures_(lines_.size()),
      chosen_(static_cast<std::size_t>(opened.scan->series_taken)),
      show_chosen_(true),
      renewed_(desk.renewed()) {
  textures_.resize(lines_.size());
  if (chosen_ < pictures_.size()) pictures_[chosen_] = middle_of(opened, kPicture);
}

SeriesPage::~SeriesPage() { making_.reset(); }

void SeriesPage::work() {
  if (making_ && making_->finished()) {
    auto made = making_->take();
    making_.reset();
    pictures_[makes_] = made ? std::move(*made) : render::Image{};
  }
  if (making_) return;
  const auto next = std::find(pictures_.begin(), pictures_.end(), std::nullopt);
  if (next == pictures_.end()) return;
  makes_ = static_cast<std::size_t>(next - pictures_.begin());
  scenario::BoneRecipe one = recipe_;
  one.series = fmt::format("#{}", makes_ + 1);
  one.allow_missing = one.as_it_is = true;  // only for the picture
  making_ =
      std::make_unique<Loading<render::Image>>([one](Progress& progress) -> Result<render::Image> {
        auto opened = open_scan(one, progress);
        if (!opened) return opened.error();
        return middle_of(*opened, kPicture);
      });
}

Result<SeriesPage::Choice> SeriesPage::ask(double seconds) {
  using Clock = std::chrono::steady_clock;
  choice_.reset();
  desk_.page = Page::import;
  const render::Scene empty;
  const Clock::time_point start = Clock::now();
  while (!choice_) {
    take_events();
    work();
    const Status shown = desk_.show(empty, [this] { draw(); });
    if (!shown) return shown.error();
    const bool over = seconds > 0 && Clock::now() - start >= std::chrono::duration<double>(seconds);
    if (interrupted() || over) choice_ = Choice{std::nullopt, true};
    constexpr Uint32 kPause = 25;  // nothing moves by itself [ms]
    SDL_Delay(kPause);
  }
  return *choice_;
}

void SeriesPage::move(int by) {
  chosen_ = static_cast<std::size_t>(
      std::clamp(static_cast<int>(chosen_) + by, 0, static_cast<int>(lines_.size()) - 1));
  show_chosen_ = true;
}

void SeriesPage::take_events() {
  SDL_Event event;
  while (desk_.next(event)) {
    if (event.type == SDL_QUIT) choice_ = Choice{std::nullopt, true};
    if (event.type == SDL_DROPFILE) SDL_free(event.drop.file);
    if (event.type != SDL_KEYDOWN) continue;
    const SDL_Keycode key = event.key.keysym.sym;
    if (key == SDLK_ESCAPE) choice_ = Choice{};
    if (key == SDLK_DOWN) move(1);
    if (key == SDLK_UP) move(-1);
    if (key == SDLK_d) dates_shown_ = !dates_shown_;
    if (key == SDLK_RETURN || key == SDLK_KP_ENTER) choice_ = Choice{chosen_, false};
  }
}

void SeriesPage::draw() {
  Ui& ui = desk_.ui();
  const float u = ui.unit(), x = kLeft * u, wide = ui.width() - 2 * x, row = kRow * u;
  if (std::exchange(renewed_, desk_.renewed()) != desk_.renewed())
    for (Texture& texture : textures_) texture.forget();
  ui.page("##series", 0, 0, ui.width(), ui.height());
  ui.write(x, 26 * u, Letter::large, ink::kText, word(Word::series_title));
  ui.write(x, 64 * u, Letter::body, ink::kDim, word(Word::series_told));
  ImGui::SetCursorScreenPos({x, kTop * u});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  ImGui::BeginChild("##rows", {wide, ui.height() - kTop * u - 70 * u}, false,
                    ImGuiWindowFlags_NoNav);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float inner = ImGui::GetContentRegionAvail().x;
  for (std::size_t n = 0; n < lines_.size(); ++n) {
    const ImVec2 p = ImGui::GetCursorScreenPos(), q = {p.x + inner, p.y + row - 6 * u};
    ImGui::PushID(static_cast<int>(n));
    if (ImGui::InvisibleButton("##one", {inner, row})) choice_ = Choice{n, false};
    ImGui::PopID();
    const bool over = ImGui::IsItemHovered();
    if (n == chosen_ && std::exchange(show_chosen_, false)) ImGui::SetScrollHereY();
    draw.AddRectFilled(p, q, over ? ink::kOver : ink::rgb(30, 34, 39), 6 * u);
    if (over || n == chosen_) draw.AddRect(p, q, ink::kAccent, 6 * u, 0, 1.5F * u);
    const float edge = row - 14 * u;
    draw.AddRectFilled({p.x + 4 * u, p.y + 4 * u}, {p.x + 4 * u + edge, p.y + 4 * u + edge},
                       ink::rgb(0, 0, 0));
    if (pictures_[n] && pictures_[n]->width > 0) {
      const render::Image& image = *pictures_[n];
      if (textures_[n].name() == 0) textures_[n].put(image.width, image.height, 3, image.rgb);
      const float scale = edge / static_cast<float>(std::max(image.width, image.height));
      const float w = scale * static_cast<float>(image.width),
                  h = scale * static_cast<float>(image.height);
      const ImVec2 at = {p.x + 4 * u + (edge - w) / 2, p.y + 4 * u + (edge - h) / 2};
      draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(textures_[n].name())),
                    at, {at.x + w, at.y + h});
    } else {
      ui.write(p.x + 4 * u + edge / 2, p.y + row / 2 - 12 * u, Letter::small, ink::kDim,
               pictures_[n] ? word(Word::series_none) : "...", 0.5F);
    }
    const ImFont* font = ui.font(Letter::body);
    draw.AddText(font, font->FontSize, {p.x + edge + 22 * u, p.y + 26 * u}, ink::kText,
                 lines_[n].c_str(), nullptr, inner - edge - 40 * u);
    if (!dates_shown_) continue;
    const bool stated = n < dates_.size() && !dates_[n].empty();
    ui.write(p.x + edge + 22 * u, p.y + row - 30 * u, Letter::small, ink::kDim,
             stated ? say(Word::series_date, dates_[n]) : word(Word::series_no_date));
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::SetCursorScreenPos({x, ui.height() - kFoot * u});
  if (ImGui::Button(fmt::format("{}  [Esc]", word(Word::import_back)).c_str())) choice_ = Choice{};
  ImGui::SetCursorScreenPos({x + kDates * u, ui.height() - kFoot * u});
  ImGui::Checkbox(fmt::format("{}  [D]", word(Word::series_dates)).c_str(), &dates_shown_);
  ImGui::End();
}

}  // namespace burr::app
