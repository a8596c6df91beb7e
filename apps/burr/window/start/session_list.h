// apps/burr/window/start/session_list.h - the sessions that burr kept, on the start page: one row each, with its picture and its
// name. A click continues the session; buttons name it, play it and show its marks.
//
// Thread: main; draw() between Ui::begin() and Ui::draw().
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "window/parts/kept_sessions.h"
#include "window/ui/desk.h"
#include "window/ui/texture.h"

namespace burr::app {

class SessionList {
 public:
  explicit SessionList(Desk& desk) : desk_(desk) {}

  void read();    // from the disk
  void rest();    // the page is left
  void forget();  // the GPU was lost

  struct Pressed {
    std::optional<KeptSession> go_on, marks_of, play;
  };
  // y: of its top; afterwards that of what comes below.
  [[nodiscard]] Pressed draw(float x, float& y, float w);

 private:
  void row(std::size_t n, float x, float y, float w, Pressed& pressed);
  void name_row(KeptSession& kept, float x, float y, float w);
  [[nodiscard]] unsigned picture(const KeptSession& kept);

  Desk& desk_;
  std::vector<KeptSession> kept_;
  std::map<std::string, Texture> pictures_;  // of these, by file
  std::optional<std::size_t> naming_;        // which of these is being given a name
  bool to_name_ = false;                     // the field gets the keyboard
  std::string name_;
};

}  // namespace burr::app
