// apps/burr/window/shell/file_dialog.h - the desktop's own dialog for choosing a file or a folder, where
// there is one (zenity, kdialog). It runs beside the window and is asked now and then.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "window/shell/loading.h"

namespace burr::app {

class FileDialog {
 public:
  [[nodiscard]] static bool there();  // on this machine

  void ask(bool folder);
  // For a file to be written; whether it may replace another is not asked here.
  void ask_where(const std::string& suggested);
  // The path chosen, once; "" when the user did not choose.
  [[nodiscard]] std::optional<std::string> answer();
  [[nodiscard]] bool open() const { return asked_ != nullptr; }

 private:
  std::unique_ptr<Loading<std::string>> asked_;
};

}  // namespace burr::app
