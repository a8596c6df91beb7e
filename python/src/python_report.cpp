#include "python_report.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/report/make_report.h"
#include "burr/report/report_page.h"
#include "burr/report/scored.h"
#include "burr/report/self_marks.h"
#include "burr/words/words.h"
#include "python_eye.h"

namespace burr::python {
namespace {

constexpr int kMostPictures = 100;

Result<report::Scored> scored_file(const std::string& file, const ReportWish& wish, Work& work) {
  auto judged = report::judged_by(file, wish.rubric);
  if (!judged) return judged.error();
  scenario::BoneRecipe volume;
  volume.source = wish.volume;
  return report::scored(std::move(*judged), volume, work);
}

Status write(const ReportWish& wish, Work& work) {
  static std::mutex one_language;
  const std::lock_guard lock(one_language);
  words::speak(wish.language);
  auto mine = scored_file(wish.recording, wish, work);
  if (!mine) return mine.error();
  report::ReportSettings settings;
  settings.most_pictures = static_cast<std::size_t>(wish.pictures);
  settings.rubric = wish.rubric;
  settings.self = report::recorded_self_marks(*mine->judged.player, mine->judged.rubric);
  std::optional<report::Scored> expert;
  if (!wish.beside.empty()) {
    auto made = scored_file(wish.beside, wish, work);
    if (!made) return made.error();
    expert = std::move(*made);
    settings.beside = &*expert;
  }
  const auto made = report::report_on(*mine, settings, work);
  if (!made) return made.error();
  auto file = base::NewFile::create(wish.out);
  if (!file) return file.error();
  file->write(report::page_of(*made));
  return file->put_in_place();
}

}  // namespace

void write_report(const ReportWish& wish, Work& work) {
  if (std::filesystem::path(wish.out).extension() != ".html")
    raise(fmt::format("{}: a report is a page; give a name that ends in .html",
                      base::printable(wish.out)));
  if (words::language_of(wish.language) == nullptr) {
    std::string known;
    for (const words::Language& one : words::languages())
      known += (known.empty() ? "" : ", ") + one.code;
    raise(fmt::format("language: there is no {}; there are {}", base::printable(wish.language),
                      known));
  }
  if (wish.pictures < 0 || wish.pictures > kMostPictures)
    raise(fmt::format("pictures: {} is not possible; use 0 to {}", wish.pictures, kMostPictures));
  if (wish.pictures > 0) only_main_thread();
  check(work.run([&] { return write(wish, work); }));
}

}  // namespace burr::python
