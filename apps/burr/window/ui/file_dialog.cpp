#include "window/ui/file_dialog.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "shared/front_words.h"
#include "shared/word_names.h"
#include "window/ui/imgui_keys.h"
#include "window/ui/typed_path.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using Letter = Ui::Letter;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string size_text(std::uintmax_t bytes) {
  const double mb = static_cast<double>(bytes) / (1 << 20);
  return mb < 0.1 ? fmt::format("{:.0f} kB", std::ceil(1024 * mb)) : fmt::format("{:.1f} MB", mb);
}

fs::path home() {
  const char* set = std::getenv("HOME");
  return set != nullptr ? fs::path(set) : fs::path("/");
}

// a folder, or a sheet of paper
void sign(ImDrawList& draw, ImVec2 c, float u, bool folder) {
  if (folder) {
    draw.AddRectFilled({c.x - 7 * u, c.y - 6 * u}, {c.x - 1 * u, c.y - 2 * u}, ink::kWarn, u);
    draw.AddRectFilled({c.x - 7 * u, c.y - 4 * u}, {c.x + 7 * u, c.y + 6 * u}, ink::kWarn, u);
  } else {
    draw.AddRect({c.x - 5 * u, c.y - 7 * u}, {c.x + 5 * u, c.y + 7 * u}, ink::kDim, u, 0, 1.2F * u);
  }
}

}  // namespace

bool burr_reads(const std::string& name) {
  constexpr std::array kEndings = {".nrrd", ".nhdr", ".nii",  ".nii.gz", ".mha",
                                   ".mhd",  ".dcm",  ".ima",  ".adf",    ".yaml",
                                   ".yml",  ".toml", ".mcap", ".tif",    ".tiff"};
  const std::string small = lower(name);
  const std::size_t dot = small.rfind('.');
  // numbers behind the last dot are part of a DICOM name: 1.2.840.10008.4711
  if (dot == std::string::npos ||
      std::all_of(small.begin() + static_cast<std::ptrdiff_t>(dot) + 1, small.end(),
                  [](unsigned char c) { return std::isdigit(c) != 0; }))
    return true;
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](const char* ending) { return small.ends_with(ending); });
}

Result<std::vector<FolderEntry>> entries_of(const fs::path& folder, Listed listed) {
  constexpr std::size_t kMost = 20'000;
  std::vector<FolderEntry> entries;
  std::error_code trouble;
  for (fs::directory_iterator at(folder, trouble), end;
       !trouble && at != end && entries.size() < kMost; at.increment(trouble)) {
    FolderEntry entry;
    entry.name = at->path().filename().string();
    if (entry.name.empty() || entry.name[0] == '.') continue;
    std::error_code nobody_asks;
    entry.folder = at->is_directory(nobody_asks);
    if (!entry.folder && listed == Listed::burr_reads && !burr_reads(entry.name)) continue;
    if (!entry.folder && listed == Listed::recordings && !lower(entry.name).ends_with(".mcap"))
      continue;
    if (!entry.folder) entry.bytes = at->file_size(nobody_asks);
    if (nobody_asks) entry.bytes = 0;
    entries.push_back(std::move(entry));
  }
  if (trouble) return error(Trouble::io, say(Word::dialog_no_folder, folder.string()));
  std::sort(entries.begin(), entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    if (a.folder != b.folder) return a.folder;
    return std::pair(lower(a.name), a.name) < std::pair(lower(b.name), b.name);
  });
  return entries;
}

void FileDialog::ask(const std::string& title, Wanted wanted) {
  if (open_) return;
  open_ = true;
  saves_ = false;
  recordings_ = wanted == Wanted::recordings;
  title_ = title;
  go_to(folder_.empty() ? home() : folder_);
}

void FileDialog::ask_where(const std::string& suggested) {
  if (open_) return;
  open_ = saves_ = true;
  recordings_ = false;
  title_ = word(Word::dialog_save);
  std::error_code trouble;
  const fs::path path = fs::absolute(cleaned_path(suggested), trouble);
  name_ = path.filename().string();
  go_to(path.has_parent_path() ? path.parent_path() : home());
}

void FileDialog::cancel() {
  if (std::exchange(open_, false)) answer_ = std::string();
}

std::optional<std::string> FileDialog::answer() { return std::exchange(answer_, std::nullopt); }

void FileDialog::finish(const fs::path& path) {
  open_ = false;
  answer_ = path.string();
}

// Where it cannot be read, the old folder stays.
void FileDialog::go_to(fs::path folder) {
  std::error_code trouble;
  const fs::path whole = fs::weakly_canonical(folder, trouble);
  if (!trouble) folder = whole;
  auto entries = entries_of(folder, listed());
  trouble_ = entries ? std::string() : in_options(entries.error()).text;
  if (!entries && !entries_.empty()) return;
  entries_ = entries ? std::move(*entries) : std::vector<FolderEntry>();
  const std::string from = folder_.parent_path() == folder ? folder_.filename().string() : "";
  folder_ = std::move(folder);
  path_ = folder_.string();
  begun_.clear();
  show_chosen_ = true;
  chosen_ = 0;  // one level up: the folder where the user was
  for (std::size_t n = 0; n < entries_.size() && !from.empty(); ++n)
    if (entries_[n].name == from) chosen_ = n;
}

void FileDialog::read() { go_to(folder_); }

void FileDialog::take(std::size_t entry) {
  if (entry >= entries_.size()) return;
  const fs::path path = folder_ / entries_[entry].name;
  if (entries_[entry].folder)
    go_to(path);
  else if (saves_)
    name_ = entries_[entry].name;
  else
    finish(path);
}

void FileDialog::keys(bool typing) {
  if (typing) return;
  const auto move = [&](int by) {
    const auto last = static_cast<int>(entries_.size()) - 1;
    chosen_ =
        static_cast<std::size_t>(std::clamp(static_cast<int>(chosen_) + by, 0, std::max(0, last)));
    show_chosen_ = true;
  };
  if (key_pressed(ImGuiKey_DownArrow)) move(1);
  if (key_pressed(ImGuiKey_UpArrow)) move(-1);
  if (key_pressed(ImGuiKey_PageDown)) move(10);
  if (key_pressed(ImGuiKey_PageUp)) move(-10);
  if (key_pressed(ImGuiKey_Home)) move(-static_cast<int>(entries_.size()));
  if (key_pressed(ImGuiKey_End)) move(static_cast<int>(entries_.size()));
  if (key_pressed(ImGuiKey_Backspace)) return go_to(folder_.parent_path());
  if (key_pressed(ImGuiKey_Enter) || key_pressed(kKeypadEnter)) return take(chosen_);
  const ImGuiIO& io = ImGui::GetIO();
  constexpr double kPause = 1;  // after it a letter begins a new name [s]
  for (const ImWchar letter : io.InputQueueCharacters) {
    if (letter < ' ' || letter > 126) continue;
    if (ImGui::GetTime() - typed_at_ > kPause) begun_.clear();
    typed_at_ = ImGui::GetTime();
    begun_ += static_cast<char>(std::tolower(letter));
    for (std::size_t n = 0; n < entries_.size(); ++n)
      if (lower(entries_[n].name).starts_with(begun_)) {
        chosen_ = n;
        show_chosen_ = true;
        break;
      }
  }
}

void FileDialog::rows(const Ui& ui, float wide, float high) {
  const float u = ui.unit(), row = 26 * u;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  ImGui::BeginChild("##entries", {wide, high}, false, ImGuiWindowFlags_NoNav);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float inner = ImGui::GetContentRegionAvail().x;
  std::optional<std::size_t> taken;
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    const ImVec2 p = ImGui::GetCursorScreenPos();
    ImGui::PushID(static_cast<int>(n));
    if (ImGui::InvisibleButton("##entry", {inner, row})) {
      chosen_ = n;
      // a folder opens at once; a file needs a second click, or the button
      if (entries_[n].folder || saves_) taken = n;
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) taken = n;
    if (ImGui::IsItemHovered()) draw.AddRectFilled(p, {p.x + inner, p.y + row}, ink::kOver, 4 * u);
    if (n == chosen_) {
      draw.AddRectFilled(p, {p.x + inner, p.y + row}, ink::rgb(86, 180, 233, 50), 4 * u);
      draw.AddRect(p, {p.x + inner, p.y + row}, ink::kAccent, 4 * u, 0, 1.2F * u);
      if (std::exchange(show_chosen_, false)) ImGui::SetScrollHereY();
    }
    ImGui::PopID();
    sign(draw, {p.x + 16 * u, p.y + row / 2}, u, entries_[n].folder);
    draw.PushClipRect({p.x, p.y}, {p.x + inner - 90 * u, p.y + row}, true);
    ui.write(p.x + 32 * u, p.y + 5 * u, Letter::body, ink::kText, entries_[n].name);
    draw.PopClipRect();
    if (!entries_[n].folder)
      ui.write(p.x + inner - 10 * u, p.y + 6 * u, Letter::small, ink::kDim,
               size_text(entries_[n].bytes), 1);
  }
  if (entries_.empty())
    ui.write(ImGui::GetCursorScreenPos().x + 12 * u, ImGui::GetCursorScreenPos().y + 10 * u,
             Letter::body, ink::kDim,
             word(recordings_ ? Word::dialog_no_recording : Word::dialog_nothing));
  ImGui::EndChild();
  ImGui::PopStyleVar();
  if (taken) take(*taken);
}

void FileDialog::last_line(Ui& ui, float x, float y, float w) {
  const float u = ui.unit();
  ImGui::SetCursorScreenPos({x, y});
  if (saves_) {
    if (text_field("##name", word(Word::dialog_name), name_, 300 * u) && !name_.empty())
      return finish(folder_ / name_);
  } else {
    const Word some = recordings_ ? Word::dialog_recordings : Word::dialog_some;
    if (ImGui::RadioButton(word(some), !all_) && std::exchange(all_, false)) read();
    ImGui::SameLine();
    if (ImGui::RadioButton(word(Word::dialog_all), all_) && !std::exchange(all_, true)) read();
  }
  const auto button = [&](float right, Word name) {
    const float wide = ui.width_of(Letter::body, word(name)) + 28 * u;
    ImGui::SetCursorScreenPos({right - wide, y});
    return std::pair{ImGui::Button(word(name), {wide, 0}), right - wide - 10 * u};
  };
  const auto [take_it, left] = button(x + w, saves_ ? Word::dialog_write : Word::dialog_take);
  // a folder of slices is a scan, and never a recording
  const auto [whole, middle] =
      saves_ || recordings_ ? std::pair{false, left} : button(left, Word::dialog_folder);
  const auto [stop, rest] = button(middle, Word::dialog_cancel);
  static_cast<void>(rest);
  if (stop) return cancel();
  if (whole) return finish(folder_);
  if (!take_it) return;
  if (!saves_) return take(chosen_);
  if (!name_.empty()) finish(folder_ / name_);
}

void FileDialog::draw(Ui& ui) {
  if (!open_) return;
  const float u = ui.unit(), w = std::min(ui.width() - 60 * u, 860 * u),
              h = std::min(ui.height() - 60 * u, 620 * u);
  const float x = (ui.width() - w) / 2, y = (ui.height() - h) / 2, in = x + 24 * u,
              wide = w - 48 * u;
  ui.page("##dialog", x, y, w, h);
  ui.write(in, y + 18 * u, Letter::large, ink::kText, title_);
  ImGui::SetCursorScreenPos({in, y + 58 * u});
  if (ImGui::Button(word(Word::dialog_up), {80 * u, 0})) go_to(folder_.parent_path());
  ImGui::SetCursorScreenPos({in + 88 * u, y + 58 * u});
  if (ImGui::Button(word(Word::dialog_home), {80 * u, 0})) go_to(home());
  ImGui::SetCursorScreenPos({in + 176 * u, y + 58 * u});
  const bool entered =
      text_field("##path", word(Word::start_path), path_, wide - 176 * u, completed_path);
  const bool typing = ImGui::IsItemActive() || entered || ui.typing();
  if (entered) {
    const fs::path wanted = cleaned_path(path_);
    std::error_code trouble;
    if (fs::is_directory(wanted, trouble))
      go_to(wanted);
    else if (saves_ || fs::exists(wanted, trouble))
      finish(wanted);
    else
      trouble_ = say(Word::dialog_no_folder, path_);
  }
  ImGui::SetCursorScreenPos({in, y + 98 * u});
  const float room = h - 98 * u - 98 * u;
  ImGui::GetWindowDrawList()->AddRectFilled({in, y + 98 * u}, {in + wide, y + 98 * u + room},
                                            ink::rgb(28, 32, 37), 5 * u);
  if (open_) rows(ui, wide, room);
  ui.write(in, y + h - 92 * u, Letter::small, trouble_.empty() ? ink::kDim : ink::kWarn,
           trouble_.empty() ? word(Word::dialog_keys) : trouble_);
  if (open_) last_line(ui, in, y + h - 62 * u, wide);
  ImGui::End();
  if (open_) keys(typing);
}

}  // namespace burr::app
