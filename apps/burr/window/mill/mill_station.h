// apps/burr/window/mill/mill_station.h - the station on the instructor's page while the user mills:
// what it shows there, and what the instructor says or marks in a picture.
//
// Thread: main, after a picture. Frame: world.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "window/mill/instructor_notes.h"
#include "window/mill/mill_case.h"
#include "window/mill/mill_site.h"

namespace burr::app {

class MillStation {
 public:
  MillStation(const MillSite& site, const MillCase& work_case)
      : desk_(site.desk),
        session_(site.session),
        scene_(site.scene),
        options_(site.options),
        row_(site.row),
        notes_(site.notes),
        case_(work_case) {}

  // Offers the picture to whoever looks, and takes words and marks. Nothing without an instructor.
  void talk();
  [[nodiscard]] InstructorNotes& marks() { return marks_; }
  [[nodiscard]] bool has_marks() const { return !marks_.empty(); }

 private:
  struct Shown {
    std::uint64_t number = 0;  // of the picture that was offered
    render::Camera camera;
    int width = 1, height = 1;
  };

  Desk& desk_;
  sim::Session& session_;
  render::Scene& scene_;
  const WindowOptions& options_;
  const tick::TickRow& row_;
  MillNotes& notes_;
  const MillCase& case_;
  std::array<Shown, 64> shown_;  // the last ones: a mark of the instructor is in one of them
  InstructorNotes marks_;
  bool was_watched_ = false;
  std::string trouble_;  // the last one
};

}  // namespace burr::app
