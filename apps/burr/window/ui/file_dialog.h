// apps/burr/window/ui/file_dialog.h - burr's own dialog to choose a file or a folder. It looks the
// same on every desktop and needs no other program.
//
//     dialog.ask();                              // or ask_where(suggested), for a file to be written
//     if (dialog.open()) dialog.draw(ui);        // in each picture; mouse and keyboard
//     if (const auto path = dialog.answer()) ...  // once; "": the user cancelled
//
// Keyboard: arrows choose, Enter opens, Backspace goes to the folder above, letters find a name. Esc
// belongs to the page, which calls cancel(). Thread: main, between Ui::begin() and draw().
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "window/ui/ui.h"

namespace burr::app {

struct FolderEntry {
  std::string name;
  bool folder = false;
  std::uintmax_t bytes = 0;  // of a file
};
// Which files a list shows.
enum class Listed { all, burr_reads, recordings };
// Folders first, then files, by name; nothing hidden; at most 20 000. Error: the folder cannot be
// read.
[[nodiscard]] Result<std::vector<FolderEntry>> entries_of(const std::filesystem::path& folder,
                                                          Listed listed);
// By its name: a scan, a case, a recording, or a file without an ending, as DICOM files often are.
[[nodiscard]] bool burr_reads(const std::string& name);

class FileDialog {
 public:
  // For something to be opened. title: of the dialog. anything: a file, or a folder of slices.
  enum class Wanted { anything, recordings };
  void ask(const std::string& title, Wanted wanted = Wanted::anything);
  // For a file that will be written. The dialog does not ask whether it may replace another file.
  void ask_where(const std::string& suggested);
  [[nodiscard]] bool open() const { return open_; }
  void cancel();
  void draw(Ui& ui);
  // Returns the chosen path once; "" if the user chose none.
  [[nodiscard]] std::optional<std::string> answer();

  // What is shown, for tests.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  void go_to(std::filesystem::path folder);
  void read();
  void take(std::size_t entry);
  void finish(const std::filesystem::path& path);
  void keys(bool typing);
  void rows(const Ui& ui, float wide, float high);
  void last_line(Ui& ui, float x, float y, float w);

  [[nodiscard]] Listed listed() const {
    return all_ ? Listed::all : recordings_ ? Listed::recordings : Listed::burr_reads;
  }

  bool open_ = false, saves_ = false, all_ = false, show_chosen_ = false, recordings_ = false;
  std::string title_, path_, name_, trouble_, begun_;  // begun_: letters of a name, typed just now
  double typed_at_ = 0;                                // ImGui's clock [s]
  std::filesystem::path folder_;
  std::vector<FolderEntry> entries_;
  std::size_t chosen_ = 0;
  std::optional<std::string> answer_;
};

}  // namespace burr::app
