#include "window/parts/autosave.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "burr/report/questions.h"
#include "shared/front_words.h"
#include "window/parts/small_picture.h"

namespace burr::app {

namespace fs = std::filesystem;

Autosave::Autosave(const fs::path& state, WindowSession& ready, const WorkOptions& options,
                   const Settings& settings, const KeptSession* goes_on,
                   std::shared_ptr<record::Sealer> sealer)
    : ready_(ready), session_(*ready.session) {
  if (state.empty()) return;
  const fs::path folder = state / "sessions";
  Status made = make_own_folder(folder);
  if (made) {
    describe(options);
    recording_.remember_scan_in(scan_list_by(settings, state));
    recording_.belongs_to(ready.identity);
    if (goes_on == nullptr) recording_.sealed_by(std::move(sealer));
    made = begin(folder, goes_on);
    recording_now_ = made.ok();
  }
  if (made) made = write_account(kept_);
  if (!made) trouble_ = in_options(made.error()).text;
}

void Autosave::describe(const WorkOptions& options) {
  kept_.title = ready_.title;
  if (ready_.lesson) kept_.titles = ready_.lesson->title;
  kept_.options = options;
  kept_.options.identity = ready_.identity;
  kept_.earlier = ready_.earlier;
  kept_.suction = ready_.left.suction;
  kept_.marks =
      ready_.work_case && ready_.allowed.marks && !report::questions_on(*ready_.work_case).empty();
  std::error_code nobody_asks;
  if (ready_.work_case) kept_.rubric = report::rubric_of(*ready_.work_case);
  if (const fs::path there = fs::absolute(kept_.rubric, nobody_asks);
      fs::exists(kept_.rubric, nobody_asks))
    kept_.rubric = there.string();
  if (const fs::path there = fs::absolute(options.volume.source, nobody_asks);
      fs::exists(options.volume.source, nobody_asks))
    kept_.options.volume.source = there.string();
  kept_.when = time_now();
}

Status Autosave::begin(const fs::path& folder, const KeptSession* goes_on) {
  if (goes_on != nullptr) {
    kept_.name = goes_on->name;
    kept_.keep = goes_on->keep;
  }
  if (goes_on != nullptr && ready_.left.part != nullptr) {
    kept_.file = goes_on->file;
    kept_.earlier = goes_on->earlier;
    recording_.goes_on_with(ready_.left.part);
    const Status on = record();
    goes_on_ = on.ok();
    if (on || on.error().trouble != Trouble::usage) return on;
    apart_ = on.error().text;
    recording_.goes_on_with(nullptr);
    kept_.earlier = ready_.earlier;
  }
  embeds_ = goes_on != nullptr;
  std::error_code nobody_asks;
  const std::string name = name_now();
  kept_.file = folder / (name + ".mcap");
  for (int n = 2; fs::exists(kept_.file, nobody_asks); ++n)  // started in the same second
    kept_.file = folder / fmt::format("{}_{}.mcap", name, n);
  return record();
}

Status Autosave::record() {
  return recording_.start(session_, kept_.file.string(), ready_.volume, ready_.import,
                          session_.hand().spec().name, embeds_, ready_.spared, ready_.work_case);
}

std::optional<FilmSource> Autosave::film_source() const {
  if (!recording_now_) return std::nullopt;
  FilmSource source = film_of(session_, kept_.file.string(), kept_.options.volume);
  if (goes_on_)
    source.plan.until +=
        static_cast<double>(ready_.left.part->ticks) / ready_.left.part->info.rate_hz;
  if (embeds_) source.volume.source.clear();  // the bone is in the recording
  return source;
}

void Autosave::take_picture(const render::Image& small) {
  if (recording_now_) keep_small_picture(picture_of(kept_.file), small);
}

Status Autosave::finish() {
  if (!std::exchange(recording_now_, false))
    return trouble_.empty() ? fine() : error(Trouble::io, trouble_);
  Status done = recording_.finish(session_);
  const sim::Outcome outcome = session_.outcome();
  kept_.seconds = ready_.earlier.seconds + outcome.seconds;
  kept_.removed_mm3 =
      1e9 * (ready_.earlier.removed + outcome.ledger.removed - outcome.ledger.undone);
  kept_.clean = true;
  const Status written = write_account(kept_);
  if (done) done = written;
  if (!done) trouble_ = in_options(done.error()).text;
  is_kept_ = goes_on_ || outcome.ledger.removed > 0 || outcome.ledger.added > 0 || kept_.keep;
  if (is_kept_) return done;
  remove_session(kept_.file);  // nothing was done: there is nothing to continue
  return fine();
}

bool Autosave::keep() {
  if (!recording_now_ || !trouble().empty()) return false;
  kept_.keep = true;
  return write_account(kept_).ok();
}

std::string Autosave::trouble() const {
  return trouble_.empty() && recording_now_ ? recording_.trouble() : trouble_;
}

}  // namespace burr::app
