// apps/burr/window/import/import_page.h - a scan before it becomes bone: which series, where its surface
// lies, which part, which labels, what it will take.
//
// Everything chosen is a number of a scenario::Recipe, as the command line makes one, so that
// recordings and kept sessions need to know nothing of this page.
// Thread: main.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands/work.h"
#include "window/import/import_choice.h"
#include "window/import/import_preview.h"
#include "window/mill/make_ready.h"
#include "window/shell/desk.h"
#include "window/shell/loading.h"
#include "window/shell/texture.h"

namespace burr::app {

// Where the page's parts lie, in pixels of the drawing area.
struct ImportLayout {
  struct Part {
    float x = 0, y = 0, w = 0, h = 0;
  };
  std::array<Part, 3> views;          // axial, coronal, sagittal
  Part level, plot, facts, bone;      // below: histogram or labels, the scan, what is made
  Part series, iso, roi, voxel, all;  // fields and buttons
  Part told, as_it_is, back, start;   // last line
};
[[nodiscard]] ImportLayout import_layout(float width, float height, float unit);

class ImportPage {
 public:
  ImportPage(Desk& desk, OpenedScan opened);
  ~ImportPage();
  ImportPage(const ImportPage&) = delete;
  ImportPage& operator=(const ImportPage&) = delete;

  enum class Answer { start, back, other_series, closed };
  // Until the user has decided. told: what went wrong before; "" for nothing. seconds: as of
  // StartPage::ask.
  [[nodiscard]] Result<Answer> ask(const std::string& told, double seconds);

  // What was chosen.
  [[nodiscard]] const scenario::Recipe& volume() const { return volume_; }
  [[nodiscard]] const std::string& series() const { return series_; }
  [[nodiscard]] const std::shared_ptr<const io::Scan>& scan() const { return opened_.scan; }

 private:
  struct View {
    PlaneView plane;
    PlaneValues values;
    int sampled = -1;  // the slice in values
    bool coloured = false;
    Texture texture;
    int grabbed = 0;  // sides of the frame in the hand: 1 left 2 right 4 top 8 bottom 16 none
  };

  void take_events();
  void work();  // the plan, beside the window
  void changed();
  void decide(Answer answer);
  void set_level(double level);
  void take_level();
  void take_roi();
  void show_region();
  void take_voxel();
  [[nodiscard]] bool asked() const;  // the scan leaves open what only the user can answer
  void take_as_it_is();
  void set_box(const Box& box);
  void forget_table();
  void set_kind(std::size_t label, volume::TissueKind kind);
  [[nodiscard]] std::optional<double> level() const;
  [[nodiscard]] std::string unit_of_values() const;

  void draw();
  void draw_view(std::size_t which, const ImportLayout::Part& part);
  void picture(View& view, int width, int height);
  int frame(View& view, float x, float y, float w, float h);
  void histogram(const ImportLayout& at);
  void labels(const ImportLayout& at);
  void facts(const ImportLayout::Part& part);
  void bone(const ImportLayout& at);
  void last_line(const ImportLayout& at);

  Desk& desk_;
  OpenedScan opened_;
  scenario::Recipe volume_;
  std::string series_;  // wanted instead, "#2"
  std::optional<double> level_;
  Box box_;
  std::array<int, 3> slice_ = {0, 0, 0};  // by axis of the scan
  std::vector<volume::TissueKind> kinds_;
  std::string iso_text_, roi_text_, voxel_text_;
  std::string trouble_;              // of a field, or of what was tried
  std::string plan_trouble_;         // of what is chosen
  std::filesystem::path own_table_;  // made here, of no use unless it is started with
  std::optional<Planned> planned_;
  std::unique_ptr<Loading<Planned>> planning_;
  bool stale_ = false, starting_ = false;
  std::array<View, 3> views_;
  int renewed_ = 0;  // as often as the desk had made its window anew when they were drawn
  std::vector<std::uint8_t> pixels_;
  std::optional<Answer> answer_;
};

// The whole way from a path to a session: reading, this page, the bone. What was chosen is in
// `options` then. Error: as of load(); Trouble::interrupted also when the user went back.
[[nodiscard]] Result<Ready> open_by_page(Desk& desk, WorkOptions& options, const std::string& title,
                                         double seconds, bool& closed);

}  // namespace burr::app
