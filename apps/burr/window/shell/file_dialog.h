// apps/burr/window/shell/file_dialog.h - the desktop's own dialog to choose a file or a folder
// (zenity or kdialog), if one is installed. It runs as a program of its own; call answer() from
// time to time.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "window/shell/loading.h"

namespace burr::app {

class FileDialog {
 public:
  [[nodiscard]] static bool there();  // one is installed on this computer

  void ask(bool folder);
  // For a file that will be written. The dialog does not ask whether it may replace another file.
  void ask_where(const std::string& suggested);
  // Returns the chosen path once; "" if the user chose none.
  [[nodiscard]] std::optional<std::string> answer();
  [[nodiscard]] bool open() const { return asked_ != nullptr; }

 private:
  std::unique_ptr<Loading<std::string>> asked_;
};

}  // namespace burr::app
