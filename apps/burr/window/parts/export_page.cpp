#include "window/parts/export_page.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "burr/render/picture.h"
#include "shared/front_words.h"
#include "shared/helper_process.h"
#include "shared/piece_files.h"
#include "shared/word_names.h"
#include "window/parts/documents_folder.h"
#include "window/parts/hud.h"
#include "window/ui/loading.h"
#include "window/ui/typed_path.h"

namespace burr::app {

namespace fs = std::filesystem;
using Letter = Ui::Letter;

ExportPage::ExportPage(Desk& desk, sim::Session* session, const render::Scene& scene,
                       const std::string& folder, FilmOf film_of)
    : desk_(desk), session_(session), scene_(scene), film_of_(std::move(film_of)) {
  const fs::path where = folder.empty() ? documents_folder() : fs::path(folder);
  if (session_ != nullptr) {
    changed_ = &session_->bone().add_watcher();
    request_.path = (where / "bone.stl").string();
  } else {
    // without ffmpeg only pictures are possible
    const bool pictures = program_in_path("ffmpeg").empty();
    request_ = {ExportWhat::film, (where / (pictures ? "film" : "film.mp4")).string()};
  }
}

ExportPage::~ExportPage() { show(false); }

void ExportPage::show(bool shown) {
  if (shown == shown_) return;
  shown_ = shown;
  trouble_.clear();
  replaces_ = false;
  if (shown)
    SDL_StartTextInput();
  else
    SDL_StopTextInput();
}

std::string ExportPage::progress() const {
  if (!work_) return {};
  const SharedProgress::Now now = work_->progress().now();
  std::string text =
      say(Word::export_writing, fs::path(writing_.path).filename().string(), 100 * now.fraction);
  if (!now.stage.empty()) text += ", " + stage_words(now.stage);
  return text;
}

std::optional<FilmSource> ExportPage::film() const {
  std::optional<FilmSource> source = film_of_ ? film_of_() : std::nullopt;
  if (!source) return source;
  if (film_size_) source->plan.size = *film_size_;
  source->plan.one_file = is_film_file(request_.path);
  return source;
}

// Starts what the page shows, if it is possible.
void ExportPage::ask(bool may_replace) {
  request_.path = cleaned_path(request_.path);
  trouble_.clear();
  replaces_ = false;
  if (const Status possible = check_request(request_); !possible) {
    trouble_ = in_options(possible.error()).text;
    return;
  }
  if (!may_replace && already_there(request_)) {
    replaces_ = true;
    return;
  }
  writing_ = request_;
  if (request_.what == ExportWhat::film)
    write_film_asked();
  else
    write_asked();
}

void ExportPage::write_film_asked() {
  const std::optional<FilmSource> source = film();
  if (!source) {
    trouble_ = word(Word::film_of_nothing);
    return;
  }
  if (const Status possible = check_film(request_.path, source->plan.size); !possible) {
    trouble_ = in_options(possible.error()).text;
    return;
  }
  work_ = std::make_unique<Loading<ExportDone>>(
      [source = *source, path = request_.path](Progress& progress) -> Result<ExportDone> {
        const Result<int> made = write_film(source, path, progress);
        if (!made) return made.error();
        return ExportDone{.path = path, .pictures = *made};
      });
  show(false);
}

void ExportPage::write_asked() {
  std::optional<edit::PieceStore> store;
  if (request_.what == ExportWhat::pieces) {
    store = pieces_of_ ? pieces_of_() : edit::PieceStore();
    if (!store) {
      trouble_ = word(Word::export_piece_out);
      return;
    }
  }
  before_.reset();
  if (needs_before(request_.what)) {
    const bool ran = session_->running();
    session_->stop();
    before_ = session_->bone_before();
    if (ran) session_->start();
  }
  std::shared_ptr<const render::Image> picture;
  if (request_.what == ExportWhat::picture) {
    render::Scene scene = scene_;
    scene.insets.clear();
    scene.quality = {};
    auto image = desk_.renderer().image(scene, desk_.renderer().width(), desk_.renderer().height());
    if (!image) {
      trouble_ = in_options(image.error()).text;
      return;
    }
    picture = std::make_shared<const render::Image>(std::move(*image));
  }
  work_ = std::make_unique<Loading<ExportDone>>(
      [this, request = request_, before = std::exchange(before_, nullptr),
       store = store.value_or(edit::PieceStore()),
       picture](Progress& progress) -> Result<ExportDone> {
        if (session_ == nullptr) {
          const Status written = render::write_png(*picture, request.path);
          return written ? Result<ExportDone>(ExportDone{.path = request.path}) : written.error();
        }
        return write_export(request, session_->bone(), *changed_, before.get(), store,
                            picture.get(), progress);
      });
  show(false);
}

ExportPage::Note ExportPage::step() {
  if (const auto chosen = dialog_.answer(); chosen && !chosen->empty()) request_.path = *chosen;
  if (!work_ || !work_->finished()) return {};
  const Result<ExportDone> done = work_->take();
  work_.reset();
  if (!done) {
    // shows the page again with the reason, so that the user can correct it
    if (done.error().trouble == Trouble::interrupted)
      return {word(writing_.what != ExportWhat::film || is_film_file(writing_.path)
                       ? Word::export_stopped
                       : Word::film_stopped)};
    request_ = writing_;
    show(true);
    trouble_ = in_options(done.error()).text;
    return {};
  }
  if (done->pictures > 0) return {say(Word::film_done, done->path, done->pictures), true};
  if (done->pieces > 0)
    return {say(Word::export_pieces_done, done->pieces, done->path, 1e9 * done->volume), true};
  if (done->triangles > 0)
    return {say(Word::export_mesh, done->path, 1e9 * done->volume, done->triangles), true};
  if (done->volume > 0) return {say(Word::export_volume, done->path, 1e9 * done->volume), true};
  return {say(Word::export_done, done->path), true};
}

namespace {

// A button in a row of choices, framed if it is the chosen one. at: its left end, then that of the
// next.
bool choice(float u, float& at, float top, const char* text, bool chosen, float wide) {
  ImGui::SetCursorScreenPos({at, top});
  if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ink::rgb(86, 180, 233, 90));
  const bool pressed = ImGui::Button(text, {wide, 0});
  if (chosen) {
    ImGui::PopStyleColor();
    ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                        ink::kAccent, 6 * u, 0, 1.5F * u);
  }
  at += wide + 8 * u;
  return pressed;
}

constexpr PictureSize kFilmSizes[] = {{1280, 720}, {1920, 1080}, {3840, 2160}};

}  // namespace

// What is to be written.
void ExportPage::draw_choices(float x, float y) {
  const float u = desk_.ui().unit();
  float at = x;
  for (const auto& [what, name] : {std::pair{ExportWhat::bone, Word::export_bone},
                                   {ExportWhat::removed, Word::export_removed},
                                   {ExportWhat::added, Word::export_added},
                                   {ExportWhat::pieces, Word::export_pieces},
                                   {ExportWhat::picture, Word::export_picture},
                                   {ExportWhat::film, Word::export_film}}) {
    const ExportWhat one = what;  // a lambda may not capture a structured binding
    if (session_ == nullptr && one != ExportWhat::picture && one != ExportWhat::film) continue;
    if (!choice(u, at, y, word(name), request_.what == one, 116 * u)) continue;
    std::string ending = ending_of(request_.path, one);
    if (ending.empty() && !endings_of(one).empty()) ending = endings_of(one).front();
    if (one == ExportWhat::film && program_in_path("ffmpeg").empty()) ending.clear();
    request_.what = one;
    request_.path = path_for(request_.path, one, ending);
    replaces_ = false;
    trouble_.clear();
  }
}

// The reason against the request, how far the export is, or what pieces are. foot: it ends there.
void ExportPage::draw_line(float x, float y, float wide, float foot) {
  const bool warns = replaces_ || !trouble_.empty();
  const std::string name = fs::path(request_.path).filename().string();
  std::string line = replaces_          ? say(Word::export_exists, name)
                     : trouble_.empty() ? progress()
                                        : trouble_;
  const bool pieces = request_.what == ExportWhat::pieces;
  if (line.empty() && pieces) line = say(Word::export_pieces_told, numbered(name, 1));
  if (line.empty()) return;
  const float u = desk_.ui().unit();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  float from = x;
  if (warns) {
    const float cx = from + 8 * u, cy = y + 9 * u, r = 8 * u;
    draw.AddTriangleFilled({cx - r, cy + 0.8F * r}, {cx + r, cy + 0.8F * r}, {cx, cy - 0.9F * r},
                           ink::kWarn);
    from += 26 * u;
  }
  const ImFont* font = desk_.ui().font(Letter::body);
  draw.PushClipRect({x, y}, {x + wide, foot}, true);
  draw.AddText(font, font->FontSize, {from, y}, ink::kText, line.c_str(), nullptr, x + wide - from);
  draw.PopClipRect();
}

// The row of endings; for a film also pictures, and sizes.
void ExportPage::draw_endings(float x, float y) {
  const float u = desk_.ui().unit();
  float at = x;
  const auto take = [&](const std::string& ending) {
    request_.path = path_for(request_.path, request_.what, ending);
    replaces_ = false;
    trouble_.clear();
  };
  const std::string now = ending_of(request_.path, request_.what);
  for (const std::string& ending : endings_of(request_.what))
    if (choice(u, at, y, ending.c_str(), now == ending, (ending.size() > 5 ? 96 : 70) * u))
      take(ending);
  if (request_.what != ExportWhat::film) return;
  if (choice(u, at, y, word(Word::film_pictures), now.empty(), 150 * u)) take("");
  const auto source = film();
  for (const PictureSize& size : kFilmSizes) {
    const bool chosen =
        source && source->plan.size.width == size.width && source->plan.size.height == size.height;
    if (choice(u, at, y, fmt::format("{} × {}", size.width, size.height).c_str(), chosen, 124 * u))
      film_size_ = size;
  }
}

// What the film will be: which part, how many pictures, how large; from where it looks.
void ExportPage::draw_film_plan(float x, float y) const {
  const auto source = film();
  if (!source) return;
  const FilmPlan& plan = source->plan;
  desk_.ui().write(
      x, y, Letter::body, ink::kDim,
      say(Word::film_told, clock_of(plan.from), clock_of(plan.until), plan.seconds(), plan.frames(),
          plan.size.width, plan.size.height, in_megabytes(plan.bytes())));
  desk_.ui().write(x, y + 21 * desk_.ui().unit(), Letter::body, ink::kDim,
                   word(source->as_seen ? Word::film_as_seen : Word::film_aside));
}

// Stop, close, write. What is written goes on when the page is closed.
void ExportPage::draw_buttons(float right, float y, bool entered) {
  const float u = desk_.ui().unit();
  const bool busy = work_ != nullptr;
  ImGui::SetCursorScreenPos({right - 320 * u, y});
  if (ImGui::Button(word(busy ? Word::review_close : Word::cancel), {150 * u, 0})) show(false);
  if (busy) {
    ImGui::SetCursorScreenPos({right - 480 * u, y});
    if (ImGui::Button(word(Word::export_stop), {150 * u, 0})) work_->progress().cancel();
  }
  ImGui::SetCursorScreenPos({right - 160 * u, y});
  ImGui::BeginDisabled(busy);
  const bool go =
      ImGui::Button(word(replaces_ ? Word::export_replace : Word::export_write), {160 * u, 0});
  ImGui::EndDisabled();
  if ((go || entered) && !busy) ask(replaces_ && go);
}

void ExportPage::draw() {
  Ui& ui = desk_.ui();
  if (dialog_.open()) return dialog_.draw(ui);
  const bool is_film = request_.what == ExportWhat::film;
  const float u = ui.unit(), w = 800 * u, h = (is_film ? 352 : 330) * u;
  const float x = (ui.width() - w) / 2, y = std::max(6 * u, (ui.height() - h) / 2 - 40 * u);
  ui.page("##export", x, y, w, h);
  ui.write(x + 28 * u, y + 22 * u, Letter::large, ink::kText, word(Word::export_title));

  draw_choices(x + 28 * u, y + 66 * u);
  draw_endings(x + 28 * u, y + 112 * u);

  ImGui::SetCursorScreenPos({x + 28 * u, y + 160 * u});
  const float other = 132 * u;
  const std::string was = request_.path;
  const bool entered = text_field("##where", word(Word::start_path), request_.path,
                                  w - 56 * u - other, completed_path);
  if (request_.path != was) replaces_ = false;
  ImGui::SetCursorScreenPos({x + w - 28 * u - 120 * u, y + 160 * u});
  if (ImGui::Button(word(Word::start_file), {120 * u, 0})) dialog_.ask_where(request_.path);

  if (is_film) draw_film_plan(x + 28 * u, y + 202 * u);

  draw_line(x + 28 * u, y + (is_film ? 250 : 204) * u, w - 56 * u, y + h - 60 * u);
  draw_buttons(x + w - 28 * u, y + h - 54 * u, entered);
  ImGui::End();
}

}  // namespace burr::app
