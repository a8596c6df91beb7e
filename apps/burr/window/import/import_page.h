// apps/burr/window/import/import_page.h - the page on which the user prepares a scan: which series,
// the grey level of the surface, the region, the labels, and how much memory it needs.
//
// Every choice is a value of a scenario::BoneRecipe, the same as from the command line. So recordings
// and kept sessions do not depend on this page.
// Thread: main.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shared/window_session.h"
#include "shared/work.h"
#include "window/import/import_choice.h"
#include "window/import/import_preview.h"
#include "window/ui/desk.h"
#include "window/ui/loading.h"
#include "window/ui/texture.h"

namespace burr::app {

// Position of the parts of the page, in pixels of the drawing area.
struct ImportLayout {
  struct Part {
    float x = 0, y = 0, w = 0, h = 0;
    [[nodiscard]] bool holds(float px, float py) const {
      return px >= x && px < x + w && py >= y && py < y + h;
    }
  };
  std::array<Part, 3> views;            // axial, coronal, sagittal
  Part level, plot, facts, bone;        // below: histogram or labels, scan, planned bone
  Part series, iso, roi, voxel, all;    // fields and buttons
  Part message, as_it_is, back, start;  // last line of the page
  std::vector<Part> doubts;             // lines between the views and the panels
};
[[nodiscard]] ImportLayout import_layout(float width, float height, float unit,
                                         std::size_t doubts = 0);

class ImportPage {
 public:
  ImportPage(Desk& desk, OpenedScan opened);
  ~ImportPage();
  ImportPage(const ImportPage&) = delete;
  ImportPage& operator=(const ImportPage&) = delete;

  enum class Answer { start, back, other_series, other_spacing, closed };
  // Returns when the user has decided. told: a sentence about an earlier error; "" for none.
  // seconds: as in StartPage::ask.
  [[nodiscard]] Result<Answer> ask(const std::string& ask, double seconds);

  // The recipe that the user chose.
  [[nodiscard]] const scenario::BoneRecipe& volume() const { return volume_; }
  [[nodiscard]] const std::string& series() const { return series_; }
  [[nodiscard]] const std::shared_ptr<const io::Scan>& scan() const { return opened_.scan; }

 private:
  struct View {
    PlaneView plane;
    PlaneValues values;
    int sampled = -1;  // number of the slice that `values` holds
    bool coloured = false;
    Texture texture;
    int grabbed = 0;  // sides of the frame that are dragged: 1 left 2 right 4 top 8 bottom 16 none
  };

  void take_events();
  void work();  // plans the import, on a thread of its own
  void changed();
  void decide(Answer answer);
  void set_level(double level);
  void take_level();
  void take_roi();
  void show_region();
  void take_voxel();
  void take_spacing();
  void show_spacing();
  [[nodiscard]] bool asked() const;  // the scan leaves open what only the user can answer
  void take_as_it_is();
  // What burr assumed about this scan and cannot know, or what the user chose about it: a sentence,
  // and what the user can do about it.
  struct Remedy {
    std::string text;
    std::function<void()> act;
    bool on = false;  // of a choice that holds until it is taken back
  };
  struct Doubt {
    std::string text;
    bool open = true;  // false: decided, and shown only because it can be taken back
    std::vector<Remedy> remedies;
  };
  [[nodiscard]] std::vector<Doubt> doubts();
  void add_parts(std::vector<Doubt>& all);
  void count();  // looks for separate parts, on a thread of its own
  void choose_parts();
  void keep(const scenario::Keep& parts, double drop_islands_mm3);
  void keep_here(const math::Vec3& voxel);
  void take_labels(std::vector<LabelChoice> wanted);
  void set_box(const Box& box);
  void forget_table();
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
  void lines(const ImportLayout& at, const std::vector<Doubt>& all);

  Desk& desk_;
  OpenedScan opened_;
  scenario::BoneRecipe volume_;
  std::string series_;  // another series that the user wants, "#2"
  std::optional<double> level_;
  Box box_;
  std::array<int, 3> slice_ = {0, 0, 0};  // for each axis of the scan
  std::vector<LabelChoice> labels_;
  std::optional<importing::FoundParts> parts_;  // of the present choice; none: not counted yet
  std::optional<importing::ChosenParts> chosen_;
  std::unique_ptr<Loading<importing::FoundParts>> counting_;
  bool recount_ = true;   // parts_ is not of the present choice
  bool picking_ = false;  // a click into a view keeps the part there
  std::string parts_trouble_;
  std::string iso_text_, roi_text_, voxel_text_, spacing_text_;
  std::string trouble_;              // about a field, or about something that failed
  std::string plan_trouble_;         // why this choice cannot be imported
  std::filesystem::path own_table_;  // written by this page; removed unless used at start
  std::optional<Planned> planned_;
  std::unique_ptr<Loading<Planned>> planning_;
  bool stale_ = false, starting_ = false;
  std::array<View, 3> views_;
  int renewed_ = 0;  // number of times the desk had renewed its window when the textures were made
  std::vector<std::uint8_t> pixels_;
  std::optional<Answer> answer_;
};

// All steps from a path to a session: read the scan, show this page, make the bone. Afterwards
// `options` contains what the user chose. Error: as load(); also Trouble::interrupted if the user
// went back.
[[nodiscard]] Result<WindowSession> open_by_page(Desk& desk, WorkOptions& options,
                                                 const std::string& title, double seconds,
                                                 bool& closed);

}  // namespace burr::app
