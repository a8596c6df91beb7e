// apps/burr/window/start/start_page.h - the first page: the built-in cases, the user's own scan, or
// an earlier session to continue.
//
// Thread: main.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "burr/record/identity.h"
#include "burr/workshop/hand_device.h"
#include "shared/work.h"
#include "window/parts/kept_sessions.h"
#include "window/start/hand_choice.h"
#include "window/start/session_list.h"
#include "window/start/thumbnails.h"
#include "window/ui/desk.h"
#include "window/ui/file_dialog.h"
#include "window/ui/help.h"

namespace burr::app {

class StartPage {
 public:
  // The keys and the mouse while milling, which this page's help shows; left_handed: the mouse
  // buttons are exchanged.
  using HelpRows = std::function<std::vector<HelpRow>(bool left_handed)>;
  // hand: from the command line; if it names no device, that of the settings is taken. identity:
  // mode, learner and attempt from the command line; the user may choose another mode
  StartPage(Desk& desk, HelpRows help_rows, const workshop::HandRequest& hand,
            record::Identity identity = {});

  // What the user chose; exactly one is set.
  struct Choice {
    std::optional<WorkOptions> open;
    std::optional<KeptSession> go_on;
    std::optional<KeptSession> marks_of = {};
    bool quit = false;
    bool rate = false;  // products of others
  };
  // Returns when the user has chosen, the program is interrupted, or `seconds` have passed (0: no
  // limit). trouble: a sentence about an earlier error; "" for none.
  [[nodiscard]] Result<Choice> ask(const std::string& trouble, double seconds = 0);
  // The hand that moves the burr; no device: the mouse.
  [[nodiscard]] const workshop::HandRequest& hand() const { return hand_.request(); }

 private:
  void take_events();
  void draw();
  void cards(float x, float y);
  void own_scan(float x, float y, float w);
  void recents(float x, float& y, float w);
  void modes(float x, float y);
  void choose(record::Mode mode);
  void other_bone(float x, float y, float w);
  void draw_message(float x, float y, float w);
  void draw_news(float x, float y, float w);
  void play(const KeptSession& kept);
  [[nodiscard]] bool row(const char* id, float x, float& y, float w, const std::string& left,
                         const std::string& right, bool mark);
  void open(std::string path);

  Desk& desk_;
  HelpRows help_rows_;
  Thumbnails thumbnails_;
  int renewed_ = 0;  // desk_.renewed() when thumbnails_ was last made
  FileDialog dialog_;
  SessionList sessions_;
  HandChoice hand_;
  record::Identity identity_;
  bool other_bone_ = false;  // each session of a case is on another bone
  std::vector<Recent> recent_;
  std::vector<std::string> dropped_;
  std::string typed_;
  std::optional<Choice> choice_;
  bool help_ = false, help_pads_ = false, settings_ = false, settings_pads_ = false;
  bool rates_ = false;  // there is a store whose products can be marked
};

}  // namespace burr::app
