// apps/burr/window/parts/export_page.h - writes bone, removed or added part, pieces, picture or film while
// the user mills, or picture or film while a recording is played. A page asks what to write and
// where; the work is done beside the session.
//
// Thread: main. The servo is stopped for a moment if the removed or added part is requested, because only
// the session knows the bone as it was before (Session::bone_before()).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "burr/edit/piece_store.h"
#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "window/parts/export_job.h"
#include "window/parts/film_job.h"
#include "window/ui/desk.h"
#include "window/ui/file_dialog.h"
#include "window/ui/loading.h"

namespace burr::app {

class ExportPage {
 public:
  // Gives the source for a film of the session so far, or of a part of the recording; none: nothing
  // is recorded. The page sets the size.
  using FilmOf = std::function<std::optional<FilmSource>()>;
  // The pieces that were moved so far; none: one is out of the bone now.
  using PiecesOf = std::function<std::optional<edit::PieceStore>()>;

  // Make it before the session starts, because it adds a watcher. session: nullptr if a recording
  // is played. folder: where files go at first; empty: the user's documents (documents_folder.h).
  ExportPage(Desk& desk, sim::Session* session, const render::Scene& scene,
             const std::string& folder, FilmOf film_of);
  ~ExportPage();  // a running export is stopped and leaves no file
  ExportPage(const ExportPage&) = delete;
  ExportPage& operator=(const ExportPage&) = delete;

  // Call it before the session starts, where pieces can be moved.
  void know_pieces(PiecesOf pieces_of) { pieces_of_ = std::move(pieces_of); }

  [[nodiscard]] bool shown() const { return shown_; }
  // The dialog for a path is open over it; it closes first.
  [[nodiscard]] bool choosing() const { return dialog_.open(); }
  void stop_choosing() { dialog_.cancel(); }
  void show(bool shown);
  void draw();
  // For the user; text: "" for none. stays: until it is clicked away, because somebody waited for it.
  struct Note {
    std::string text = {};
    bool stays = false;
  };
  // Call it in each frame.
  [[nodiscard]] Note step();
  // How far the export is, as text; "": nothing is being written.
  [[nodiscard]] std::string progress() const;
  // The reason that the page shows against the request; "": none, or the page is not shown.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void ask(bool may_replace);
  void write_film_asked();
  void write_asked();
  [[nodiscard]] std::optional<FilmSource> film() const;
  void draw_choices(float x, float y);
  void draw_endings(float x, float y);
  void draw_line(float x, float y, float wide, float foot);
  void draw_film_plan(float x, float y) const;
  void draw_buttons(float right, float y, bool entered);

  Desk& desk_;
  sim::Session* session_;
  const render::Scene& scene_;
  FilmOf film_of_;
  PiecesOf pieces_of_;
  rt::ChangedBits* changed_ = nullptr;
  bool shown_ = false, replaces_ = false;  // replaces_: the page asks whether it may
  ExportRequest request_, writing_;        // writing_: of work_, whatever the page shows by now
  std::optional<PictureSize> film_size_;   // as chosen
  std::string trouble_;
  FileDialog dialog_;
  std::shared_ptr<const volume::Bone> before_;
  std::unique_ptr<Loading<ExportDone>> work_;
};

}  // namespace burr::app
