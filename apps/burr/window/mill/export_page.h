// apps/burr/window/mill/export_page.h - bone, removed part, picture or film into a file, while one mills
// or watches a recording (then only picture and film): what and where is asked on a page, the work
// goes on beside the session.
//
// Thread: main. The servo stands for a moment when what was removed is asked for: only it knows
// what was there before (Session::bone_before()).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "burr/render/scene.h"
#include "burr/sim/session.h"
#include "window/mill/export_job.h"
#include "window/replay/film_job.h"
#include "window/shell/desk.h"
#include "window/shell/file_dialog.h"
#include "window/shell/loading.h"

namespace burr::app {

class ExportPage {
 public:
  // What a film is made of, now; none: nothing is recorded.
  using FilmOf = std::function<std::optional<FilmSource>()>;

  // Before the session starts: it adds a watcher. nullptr: a recording is watched. folder: where
  // files go at first; empty: where the program was started.
  ExportPage(Desk& desk, sim::Session* session, const render::Scene& scene,
             const std::string& folder, FilmOf film_of);
  ~ExportPage();  // an export that is under way is stopped, and leaves nothing
  ExportPage(const ExportPage&) = delete;
  ExportPage& operator=(const ExportPage&) = delete;

  [[nodiscard]] bool shown() const { return shown_; }
  void show(bool shown);
  void draw();
  // Each frame: what is to be told now; "" for nothing.
  [[nodiscard]] std::string step();
  // How far it is, in words; "": nothing is being written.
  [[nodiscard]] std::string progress() const;
  // What the page says speaks against it; "": nothing, or it is not shown.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void ask(bool may_replace);

  Desk& desk_;
  sim::Session* session_;
  const render::Scene& scene_;
  FilmOf film_of_;
  rt::ChangedBits* changed_ = nullptr;
  bool shown_ = false, replaces_ = false;  // asks whether it may
  ExportRequest request_;
  std::string trouble_;
  FileDialog dialog_;
  std::shared_ptr<const volume::Bone> before_;
  std::unique_ptr<Loading<ExportDone>> work_;
};

}  // namespace burr::app
