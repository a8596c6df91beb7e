// apps/burr/window/mill/instructor_notes.h - messages of the instructor to this station: a panel above the strip of figures, and
// marks on the bone. They stay until the user closes them.
//
// Thread: main, between Ui::begin() and draw(). Frame: world. Units: m.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/render/camera.h"
#include "window/ui/ui.h"

namespace burr::app {

class InstructorNotes {
 public:
  static constexpr std::size_t kMost = 5;  // older ones go

  void say(std::string text) { add({std::move(text), {}}); }
  void mark(const math::Vec3& at, std::string text) { add({std::move(text), at}); }
  [[nodiscard]] bool empty() const { return notes_.empty(); }
  [[nodiscard]] std::size_t marks() const;
  [[nodiscard]] std::vector<std::string> texts() const;
  void close() { notes_.clear(); }

  // The panel takes clicks on its button; column: what is covered at the right [pixel].
  void draw(Ui& ui, const render::Camera& camera, float column);

 private:
  struct Note {
    std::string text;
    std::optional<math::Vec3> at;
  };
  void add(Note note);
  std::vector<Note> notes_;  // the oldest first
};

}  // namespace burr::app
