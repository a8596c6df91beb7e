#include "burr/report/make_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string_view>
#include <system_error>
#include <utility>

#include "burr/base/version.h"
#include "burr/report/advice.h"
#include "burr/report/evidence.h"
#include "burr/report/evidence_strip.h"
#include "burr/report/report_pictures.h"
#include "burr/report/report_words.h"
#include "burr/report/time_line.h"
#include "burr/rt/thread.h"
#include "burr/scenario/case.h"
#include "burr/words/words.h"

namespace burr::report {

using words::say;
using words::spoken;
using words::Word;
using words::word;

namespace {

using record::CourseKind;
using scoring::Part;

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string title_of(const Scored& scored) {
  const std::string& title = scored.judged.lesson.title.in(spoken().code);
  return title.empty() ? scored.judged.work.title : title;
}

std::string file_hash(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  std::string bytes(none ? 0 : static_cast<std::size_t>(size), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return record::hex(scenario::text_hash(bytes));
}

std::string unfinished_of(const scoring::Score& score) {
  if (!score.unfinished) return {};
  const Word how = score.ending == record::word_of(record::Ending::time_up) ? Word::report_time_up
                   : score.ending == record::word_of(record::Ending::broke_off)
                       ? Word::report_broke_off
                       : Word::report_no_end;
  return say(Word::report_unfinished, word(how));
}

std::vector<TextPair> head_of(const Scored& scored) {
  const record::Player& player = *scored.judged.player;
  const record::SessionInfo& info = player.info();
  const scoring::Rubric& rubric = scored.judged.rubric;
  std::vector<TextPair> rows;
  const auto row = [&](Word name, std::string value) {
    if (value.empty()) value = word(Word::report_not_said);
    rows.emplace_back(word(name), std::move(value));
  };
  const record::Identity identity = info.identity.value_or(record::Identity{});
  row(Word::report_case, title_of(scored));
  row(Word::report_learner, identity.learner);
  row(Word::report_attempt, identity.attempt > 0 ? std::to_string(identity.attempt) : "");
  row(Word::report_mode, info.identity ? mode_word(identity.mode) : "");
  const auto device = info.words.find("device");
  row(Word::report_device, device != info.words.end() ? device->second : "");
  row(Word::report_voxel, fmt::format("{:.3g} mm", 1e3 * info.volume.grid.voxel));
  row(Word::report_duration, fmt::format("{}:{:02} min", static_cast<int>(player.seconds()) / 60,
                                         static_cast<int>(player.seconds()) % 60));
  row(Word::report_gone, fmt::format("{:.0f} %", 100 * scored.score.worked));
  const auto helps = std::count_if(player.course().begin(), player.course().end(), [](auto& event) {
    return event.kind == CourseKind::help_shown;
  });
  row(Word::report_help, say(Word::report_help_times, helps));
  row(Word::report_rubric, say(Word::report_version, rubric.name, rubric.version));
  const auto calibrated = std::count_if(rubric.items.begin(), rubric.items.end(),
                                        [](auto& item) { return item.calibrated; });
  row(Word::report_calibrated, say(Word::report_n_of_m, calibrated, rubric.items.size()));
  return rows;
}

// What did harm comes first.
std::vector<ReportGate> gates_of(const Scored& scored, const Scored* beside) {
  std::vector<ReportGate> gates;
  const scoring::Rubric& rubric = scored.judged.rubric;
  std::vector<std::size_t> numbers = in_order(rubric, scored.score.outcomes, Part::product);
  for (const std::size_t n : in_order(rubric, scored.score.outcomes, Part::process))
    numbers.push_back(n);
  std::stable_partition(numbers.begin(), numbers.end(), [&](std::size_t n) {
    return scoring::did_harm(rubric.items[n], scored.score.outcomes[n]);
  });
  for (const std::size_t n : numbers) {
    const scoring::Item& item = rubric.items[n];
    const scoring::Outcome& outcome = scored.score.outcomes[n];
    if (!item.gate) continue;
    ReportGate& gate = gates.emplace_back();
    gate.text = item.say.in(spoken().code);
    gate.mark = mark_of(outcome);
    if (gate.mark.tone == Tone::bad && outcome.tick)
      gate.when = fmt::format(
          "{:.1f} s", static_cast<double>(*outcome.tick) / scored.judged.player->info().rate_hz);
    if (beside != nullptr) gate.beside = mark_of(beside->score.outcomes[n]);
  }
  return gates;
}

std::string met_of(const scoring::Total& total) {
  if (total.assessable == 0) return say(Word::report_none_open, total.items);
  const bool decided = total.too_early < total.assessable;
  std::string text = decided ? say(Word::report_met, total.met, total.assessable) : "";
  if (total.too_early > 0)
    text += (decided ? ", " : "") + say(Word::report_more_early, total.too_early);
  if (total.items > total.assessable)
    text += ", " + say(Word::report_more_open, total.items - total.assessable);
  return text;
}

// Of the items of safety alone.
scoring::Total total_of_gates(const Scored& scored) {
  scoring::Total total;
  for (std::size_t n = 0; n < scored.score.outcomes.size(); ++n) {
    if (!scored.judged.rubric.items[n].gate) continue;
    const scoring::Standing standing = scoring::standing_of(scored.score.outcomes[n]);
    ++total.items;
    total.assessable += standing == scoring::Standing::not_assessable ? 0 : 1;
    total.met += standing == scoring::Standing::met ? 1 : 0;
    total.too_early += standing == scoring::Standing::too_early ? 1 : 0;
  }
  return total;
}

std::string no_mark_of(const Scored& scored) {
  const scoring::NoMark& none = scored.score.no_mark;
  if (none.why != scoring::NoMark::Why::part)
    return say(none.why == scoring::NoMark::Why::gone ? Word::report_no_mark_gone
                                                      : Word::report_no_mark_added,
               1e9 * none.elsewhere, 100 * none.share, 100 * scoring::kMostElsewhere);
  const scenario::CaseRegion* part = scored.judged.lesson.region(none.part);
  const std::string title = part != nullptr ? part->title.in(spoken().code) : "";
  return say(Word::report_no_mark_part, title.empty() ? none.part : title, 100 * none.share,
             100 * metrics::kLeastWork);
}

// Points only where somebody has compared every threshold with people.
std::string note_of(const scoring::Rubric& rubric, Part part, const scoring::Total& total) {
  const bool calibrated = std::all_of(rubric.items.begin(), rubric.items.end(), [&](auto& item) {
    return item.part != part || item.calibrated;
  });
  if (!calibrated) return word(Word::report_default);
  return total.points ? say(Word::report_points, *total.points) : "";
}

std::optional<ReportScale> scale_of(const scoring::Outcome& outcome) {
  if (!outcome.value || !std::isfinite(*outcome.value)) return std::nullopt;
  ReportScale scale{*outcome.value, outcome.error, outcome.threshold, 1, outcome.at_least};
  if (outcome.quantity != scoring::Quantity::share)
    scale.end = std::max(2 * scale.threshold, 1.2 * (scale.value + scale.error));
  if (!(scale.end > 0)) scale.end = 1;
  return scale;
}

// When, how hard and how near: of the way of the burr at 100 Hz.
std::string moment_words(const Scored& scored, std::uint64_t tick) {
  const double t = static_cast<double>(tick) / scored.judged.player->info().rate_hz;
  const auto& samples = scored.score.shown.track.samples;
  const auto at = std::min_element(samples.begin(), samples.end(), [t](auto& a, auto& b) {
    return std::abs(a.t - t) < std::abs(b.t - t);
  });
  if (at == samples.end()) return {};
  std::string text = say(Word::report_moment, t, at->force);
  if (std::isfinite(at->d)) text += say(Word::report_moment_near, 1e3 * at->d);
  return text + ".";
}

ReportItem item_of(const Scored& scored, std::size_t n, const ReportSettings& settings) {
  const scoring::Item& item = scored.judged.rubric.items[n];
  const scoring::Outcome& outcome = scored.score.outcomes[n];
  ReportItem out;
  out.id = item.id;
  out.text = item.say.in(spoken().code);
  out.gate = item.gate;
  const Evidence seen = evidence_of(scored, n);
  out.place = seen.place;
  out.at_s = seen.at_s;
  out.at_end = seen.at_end;
  out.harm = scoring::did_harm(item, outcome);
  out.machine = mark_of(outcome);
  if (const auto self = settings.self.find(item.id); self != settings.self.end())
    out.self = mark_of(self->second);
  out.figures = figures_of(outcome);
  if (!item.calibrated && outcome.value) out.default_word = word(Word::report_default);
  out.scale = scale_of(outcome);
  out.strip = strip_of(scored, n);
  if (settings.beside != nullptr) {
    out.beside = mark_of(settings.beside->score.outcomes[n]);
    out.beside_figures = figures_of(settings.beside->score.outcomes[n]);
  }
  if (outcome.borderline) out.remarks.emplace_back(word(Word::report_borderline));
  if (std::string why = reason_of(item, outcome); !why.empty()) out.remarks.push_back(why);
  if (scoring::standing_of(outcome) == scoring::Standing::not_met) {
    if (outcome.tick) out.remarks.push_back(moment_words(scored, *outcome.tick));
    out.remarks.push_back(measure_word(item.how->name));
  }
  return out;
}

std::vector<ReportPart> parts_of(const Scored& scored, const ReportSettings& settings) {
  std::vector<ReportPart> parts;
  const scoring::Rubric& rubric = scored.judged.rubric;
  for (const Part part : {Part::product, Part::process}) {
    const auto total_of = [part](const scoring::Score& score) {
      return part == Part::product ? score.product : score.process;
    };
    if (total_of(scored.score).items == 0) continue;
    ReportPart& out = parts.emplace_back();
    out.title = word(part == Part::product ? Word::report_product : Word::report_process);
    out.met = met_of(total_of(scored.score));
    out.note =
        scored.score.no_mark ? no_mark_of(scored) : note_of(rubric, part, total_of(scored.score));
    if (settings.beside != nullptr) out.beside_met = met_of(total_of(settings.beside->score));
    for (const std::size_t n : in_order(rubric, scored.score.outcomes, part))
      out.items.push_back(item_of(scored, n, settings));
  }
  return parts;
}

std::vector<TextPair> hashes_of(const Scored& scored, const std::string& of_file) {
  const record::SessionInfo& info = scored.judged.player->info();
  const auto labels = info.identity ? info.identity->labels_hash : 0;
  return {{word(Word::report_hash_recording), of_file},
          {word(Word::report_case), record::hex(scenario::text_hash(scored.judged.work.text))},
          {word(Word::report_rubric), record::hex(scored.judged.rubric.text_hash)},
          {word(Word::report_hash_labels),
           record::hex(labels != 0 ? labels : record::labels_hash(*scored.before))},
          {word(Word::report_hash_bone), record::hex(info.volume.content_hash)},
          {word(Word::report_engine), fmt::format("burr {} ({})", base::version(), base::build())}};
}

std::vector<std::string> small_of(const Scored& scored) {
  std::vector<std::string> small = {word(Word::report_no_grade), word(Word::report_not_valid),
                                    word(Word::report_one_session)};
  if (scenario::is_phantom(scored.judged.player->info().volume.recipe.source))
    small.emplace_back(word(Word::report_formula));
  if (spoken().code != "en") small.emplace_back(word(Word::report_english));
  return small;
}

// The four sides; with room for more, the evidence of the items that need it most.
Status add_pictures(Scored& scored, const std::string& whose, std::size_t most, Report& report,
                    bool evidence, const ReportSettings& settings, Progress& progress) {
  if (most < kSides) return fine();
  auto artist = ReportArtist::make(scored, progress);
  if (!artist) return artist.error();
  ReportSides& sides = report.sides.emplace_back();
  sides.whose = whose;
  for (std::size_t n = 0; n < kSides; ++n) {
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
    progress.report(static_cast<double>(n) / static_cast<double>(most), "drawing the pictures");
    auto side = (*artist)->side(n);
    if (!side) return side.error();
    sides.pictures.push_back(std::move(*side));
  }
  if (!evidence) return fine();
  const auto made = (*artist)->evidence(by_importance(scored, settings.self), most - kSides);
  if (!made) return made.error();
  for (ReportPart& part : report.parts)
    for (ReportItem& item : part.items)
      for (const auto& [n, pictures] : *made)
        if (scored.judged.rubric.items[n].id == item.id) item.pictures = pictures;
  progress.report(1, "drawing the pictures");
  return fine();
}

// Rows of two sessions as one: where they differ, both values.
std::vector<TextPair> joined(std::vector<TextPair> a, const std::vector<TextPair>& b) {
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n)
    if (a[n].second != b[n].second)
      a[n].second = fmt::format("A {}, B {}", a[n].second, b[n].second);
  return a;
}

std::vector<TextPair> figures_of(const Scored& scored) {
  std::vector<TextPair> rows;
  if (!scored.score.shown.figures) return rows;
  const scoring::Figures& f = *scored.score.shown.figures;
  const auto row = [&](Word name, bool known, std::string value) {
    rows.emplace_back(word(name), known ? std::move(value) : word(Word::report_verdict_open));
  };
  const auto text = [](const char* format, double value) {
    return fmt::format(fmt::runtime(format), value);
  };
  row(Word::figure_cutting, true,
      fmt::format("{}:{:02} min", static_cast<int>(f.times.cutting) / 60,
                  static_cast<int>(f.times.cutting) % 60));
  row(Word::figure_way, true, text("{:.1f} m", f.paths.all));
  row(Word::figure_strokes, f.strokes.ok(),
      f.strokes ? say(Word::figure_strokes_of, f.strokes->rate, 1e3 * f.strokes->median_length)
                : "");
  const metrics::Economy& economy = f.economy;
  row(Word::figure_density, economy.strokes_per_volume.ok(),
      economy.strokes_per_volume ? text("{:.0f}", 1e-6 * *economy.strokes_per_volume) : "");
  row(Word::figure_per_way, economy.per_path.ok(),
      economy.per_path ? text("{:.0f} mm³", 1e9 * *economy.per_path) : "");
  row(Word::figure_outside, economy.outside_share.ok(),
      economy.outside_share ? text("{:.0f} %", 100 * *economy.outside_share) : "");
  const bool slower = f.speed && f.speed->ratio;
  row(Word::figure_speed, slower, slower ? text("{:.2f}", *f.speed->ratio) : "");
  row(Word::figure_shaft, f.shaft.ok(), f.shaft ? text("{:.1f} s", f.shaft->seconds) : "");
  row(Word::figure_dwell, f.dwell.ok(), f.dwell ? text("{:.1f} s", f.dwell->longest) : "");
  row(Word::figure_slowed, f.motor.ok(),
      f.motor ? text("{:.0f} %", 100 * f.motor->slowed / f.motor->contact) : "");
  row(Word::figure_reaction, f.reaction.ok(),
      f.reaction ? text("{:.2f} s", f.reaction->median) : "");
  return rows;
}

// whose: "A"; empty: there is one session only.
std::vector<TextPair> pieces_of(const Scored& scored, const std::string& whose) {
  std::vector<TextPair> rows;
  for (const MovedPiece& piece : scored.pieces) {
    constexpr double kDegree = std::numbers::pi / 180;
    std::string text = say(Word::report_piece_moved, 1e9 * piece.volume, 1e3 * piece.by.norm(),
                           piece.turned / kDegree);
    if (piece.out) text = say(Word::report_piece_out, 1e9 * piece.volume);
    if (piece.fit.facing > 0) text += say(Word::report_piece_gap, 1e3 * piece.fit.gap);
    if (piece.fit.has_step) text += say(Word::report_piece_step, 1e3 * piece.fit.step);
    if (piece.plan)
      text += say(Word::report_piece_plan, 1e3 * piece.plan->off.off,
                  piece.plan->off.turned_off / kDegree);
    const std::string name = say(Word::report_piece, piece.number + 1);
    rows.emplace_back(whose.empty() ? name : whose + ", " + name, text);
  }
  return rows;
}

// What both kinds of page have.
Report common(const Scored& scored, const ReportSettings& settings) {
  Report report;
  report.language = spoken().code;
  report.no_patient = word(Word::report_no_patient);
  report.head = head_of(scored);
  report.gates = gates_of(scored, settings.beside);
  if (!report.gates.empty()) report.safety = met_of(total_of_gates(scored));
  report.parts = parts_of(scored, settings);
  report.you = word(Word::report_you);
  report.machine = word(Word::report_machine);
  report.sides_legend = sides_legend();
  report.spots_legend = spots_legend();
  report.lines.push_back(time_line_of(scored));
  report.figures = figures_of(scored);
  report.pieces = pieces_of(scored, "");
  if (!scored.judged.lesson.approach.empty())
    report.towards = scored.judged.lesson.approach.front();
  report.small = small_of(scored);
  return report;
}

std::string with_rubric(const ReportSettings& settings) {
  return settings.rubric.empty() ? "" : " --rubric " + name_of(settings.rubric);
}

}  // namespace

Status comparable(const Scored& a, const Scored& b) {
  if (a.judged.rubric.text_hash == b.judged.rubric.text_hash) return fine();
  return error(Trouble::usage,
               fmt::format("{} and {} are of different cases, \"{}\" and \"{}\"; give two "
                           "recordings of one case",
                           name_of(a.judged.player->path()), name_of(b.judged.player->path()),
                           a.judged.work.name, b.judged.work.name));
}

Result<Report> report_on(Scored& scored, const ReportSettings& settings, Progress& progress) {
  if (settings.beside != nullptr)
    if (const Status same = comparable(scored, *settings.beside); !same) return same.error();
  // a recording may be large; meanwhile the pictures are drawn
  std::string of_file;
  rt::Thread hashes({.name = "hash", .stack_bytes = 0},
                    [&of_file, path = scored.judged.player->path()] { of_file = file_hash(path); });
  Report report = common(scored, settings);
  report.title = word(Word::report_title);
  report.unfinished = unfinished_of(scored.score);
  report.has_self = !settings.self.empty();
  report.self = agreement(scored, settings.self);
  report.next = advice(scored, settings.self);
  const std::size_t early = scored.score.product.too_early + scored.score.process.too_early;
  if (report.next.empty())
    report.nothing_next = word(early > 0 ? Word::report_next_early : Word::report_next_none);
  const std::string file = name_of(scored.judged.player->path());
  report.commands = {fmt::format("burr score {}{}", file, with_rubric(settings))};
  std::string mine;
  if (settings.beside != nullptr) {
    mine = word(Word::report_you);
    report.beside = word(Word::report_beside);
    report.lines.push_back(time_line_of(*settings.beside));
    report.lines.front().whose = mine;
    report.lines.back().whose = report.beside;
  }
  if (const Status drawn =
          add_pictures(scored, mine, settings.most_pictures, report, true, settings, progress);
      !drawn)
    return drawn.error();
  if (settings.beside != nullptr)
    if (const Status drawn = add_pictures(*settings.beside, report.beside, settings.most_pictures,
                                          report, false, settings, progress);
        !drawn)
      return drawn.error();
  hashes.join();
  report.hashes = hashes_of(scored, of_file);
  return report;
}

Result<Report> comparison(Scored& a, Scored& b, const ReportSettings& settings,
                          Progress& progress) {
  if (const Status same = comparable(a, b); !same) return same.error();
  ReportSettings both = settings;
  both.beside = &b;
  Report report = common(a, both);
  report.title = word(Word::compare_title);
  report.machine = "A";
  report.beside = "B";
  const std::string first = name_of(a.judged.player->path());
  const std::string second = name_of(b.judged.player->path());
  report.lines.push_back(time_line_of(b));
  report.lines.front().whose = "A: " + first;
  report.lines.back().whose = "B: " + second;
  report.head = joined(std::move(report.head), head_of(b));
  report.figures = joined(std::move(report.figures), figures_of(b));
  report.pieces = pieces_of(a, "A");
  for (TextPair& row : pieces_of(b, "B")) report.pieces.push_back(std::move(row));
  report.head.insert(report.head.begin(), {{"A", first}, {"B", second}});
  report.hashes = joined(hashes_of(a, file_hash(a.judged.player->path())),
                         hashes_of(b, file_hash(b.judged.player->path())));
  report.commands = {fmt::format("burr score {}{}", first, with_rubric(settings)),
                     fmt::format("burr score {}{}", second, with_rubric(settings))};
  for (const auto& [scored, whose] : {std::pair{&a, "A"}, std::pair{&b, "B"}}) {
    const std::string unfinished = unfinished_of(scored->score);
    if (!unfinished.empty())
      report.unfinished +=
          fmt::format("{}{}: {}", report.unfinished.empty() ? "" : " ", whose, unfinished);
    if (const Status drawn =
            add_pictures(*scored, whose, settings.most_pictures, report, false, settings, progress);
        !drawn)
      return drawn.error();
  }
  return report;
}

}  // namespace burr::report
