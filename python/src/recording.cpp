// Recordings: their ticks as columns, the bone at any moment, measures and the score.
#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "burr/metrics/process.h"
#include "burr/metrics/tremor.h"
#include "burr/record/chain.h"
#include "burr/record/player.h"
#include "burr/record/schema.h"
#include "burr/scoring/score.h"
#include "burr/sim/replay.h"
#include "burr/sim/session_words.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/law_file.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "burr/workshop/spared.h"
#include "common.h"
#include "python_report.h"
#include "python_rows.h"

namespace burr::python {
namespace {

using namespace py::literals;

class Recording {
 public:
  Recording(const std::string& path, std::string source)
      : player_(take(record::Player::open(path))), path_(path) {
    given_.source = std::move(source);
    NoProgress quiet;
    check(record::check_chain(*player_, quiet));
  }

  // While it lives, no other thread of Python reads this file.
  class Use {
   public:
    explicit Use(Recording& recording) : recording_(recording) {
      if (recording.busy_.exchange(true)) raise("this recording is in use by another thread");
    }
    ~Use() { recording_.busy_.store(false); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    record::Player* operator->() const { return recording_.player_.get(); }
    record::Player& operator*() const { return *recording_.player_; }

   private:
    Recording& recording_;
  };

  py::array ticks();
  py::list commands();
  BonePtr before(const py::object& call);
  BonePtr bone(const py::object& t, const py::object& call);
  py::dict removed_mm3(const py::object& call);
  py::dict process(const py::object& call);
  py::dict score(const std::string& rubric, const py::object& call);
  py::dict replay(const std::string& law, const std::string& settings, const py::object& call);
  [[nodiscard]] const record::Player& player() const { return *player_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& volume() const { return given_.source; }

 private:
  const volume::Bone& first(record::Player& player, Work& work);

  std::unique_ptr<record::Player> player_;
  std::string path_;
  scenario::BoneRecipe given_;
  std::unique_ptr<volume::Bone> before_;  // opened when first needed
  py::object ticks_;                      // read when first needed
  std::atomic<bool> busy_ = false;
};

py::array Recording::ticks() {
  Use use(*this);
  if (ticks_) return ticks_;
  Work work;
  std::vector<Row> all = work.run([&] {
    std::vector<tick::TickRow> part;
    std::vector<Row> rows;
    record::Step step;
    record::StepCursor steps = use->steps();
    while (steps.next(step)) {
      part.push_back(step.row);
      if (part.size() < 4096) continue;
      const std::vector<Row> made = rows_of(part);
      rows.insert(rows.end(), made.begin(), made.end());
      part.clear();
      if (work.cancelled()) break;
    }
    const std::vector<Row> made = rows_of(part);
    rows.insert(rows.end(), made.begin(), made.end());
    return rows;
  });
  const py::array made = rows_array(std::move(all));
  py::detail::array_proxy(made.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  ticks_ = made;
  return made;
}

py::list Recording::commands() {
  Use use(*this);
  const py::object loads = py::module_::import("json").attr("loads");
  py::list out;
  record::Step step;
  for (record::StepCursor steps = use->steps(); steps.next(step);)
    for (const tick::Command& command : step.commands)
      out.append(loads(record::to_json(tick::CommandRow{step.row.tick, command})));
  return out;
}

const volume::Bone& Recording::first(record::Player& player, Work& work) {
  if (!before_) before_ = take(work.run([&] { return workshop::bone_of(player, given_, work); }));
  return *before_;
}

BonePtr Recording::before(const py::object& call) {
  Use use(*this);
  Work work(call);
  const volume::Bone& bone = first(*use, work);
  return box(work.run([&] { return volume::copy_of(bone); }));
}

BonePtr Recording::bone(const py::object& t, const py::object& call) {
  Use use(*this);
  Work work(call);
  const volume::Bone& bone = first(*use, work);
  const double when = t.is_none() ? use->seconds() : t.cast<double>();
  auto made = volume::copy_of(bone);
  check(work.run([&] { return use->bone_at(when, *made); }));
  return box(std::move(made));
}

py::dict Recording::removed_mm3(const py::object& call) {
  Use use(*this);
  Work work(call);
  const volume::Bone& bone = first(*use, work);
  auto now = volume::copy_of(bone);
  check(work.run([&] { return use->bone_at(use->seconds(), *now); }));
  py::dict out;
  for (const workshop::TissueLoss& loss : work.run([&] { return workshop::losses(bone, *now); }))
    out[py::str(loss.name)] = 1e9 * loss.removed;
  return out;
}

py::object or_none(const std::optional<double>& value) {
  return value ? py::object(py::float_(*value)) : py::object(py::none());
}

py::dict Recording::process(const py::object& call) {
  Use use(*this);
  Work work(call);
  const auto made = take(work.run([&] { return metrics::process_of(*use, {}, work); }));
  py::dict out("seconds"_a = made.times.total, "cutting_s"_a = made.times.cutting,
               "free_s"_a = made.times.free, "path_m"_a = made.paths.all,
               "free_path_m"_a = made.paths.free, "strokes"_a = made.strokes.size(),
               "unusable_ticks"_a = made.unusable, "not_assessable"_a = py::dict());
  // a measure that gives no number says why
  const auto put = [&](const char* name, const auto& measured, const auto& number) {
    if (measured) {
      out[name] = number(*measured);
    } else {
      out[name] = py::none();
      out["not_assessable"][name] = measured.reason();
    }
  };
  put("mean_force_n", made.force, [](const auto& force) { return force.mean; });
  put("p95_force_n", made.force, [](const auto& force) { return force.p95; });
  put("peak_force_n", made.force, [](const auto& force) { return force.peak; });
  put("contact_s", made.force, [](const auto& force) { return force.seconds; });
  const auto tremor = metrics::tremor_of(made.track);
  put("tremor_m", tremor, [](const auto& one) { return one.rms; });
  const auto smooth = metrics::smoothness_of(made.moves);
  put("sparc", smooth, [](const auto& one) { return one.sparc; });
  put("ldlj", smooth, [](const auto& one) { return one.ldlj; });
  const auto strokes = metrics::figures_of(made.strokes);
  put("stroke_s", strokes, [](const auto& one) { return one.median_seconds; });
  put("stroke_m", strokes, [](const auto& one) { return one.median_length; });
  return out;
}

py::dict total_of(const scoring::Total& total) {
  return py::dict("points"_a = or_none(total.points), "met"_a = total.met,
                  "too_early"_a = total.too_early, "assessable"_a = total.assessable,
                  "items"_a = total.items);
}

py::dict item_of(const scoring::Item& item, const scoring::Outcome& outcome) {
  py::dict row(
      "id"_a = item.id, "part"_a = scoring::word_of(item.part), "weight"_a = item.weight,
      "gate"_a = item.gate, "verdict"_a = scoring::word_of(outcome.verdict),
      "outcome"_a = scoring::word_of(scoring::standing_of(outcome)),
      "harm"_a = scoring::did_harm(item, outcome), "borderline"_a = outcome.borderline,
      "earned"_a = outcome.earned, "reason"_a = outcome.reason, "measure"_a = item.how->name,
      "calibrated"_a = item.calibrated, "what"_a = outcome.what, "value"_a = or_none(outcome.value),
      "threshold"_a = outcome.threshold, "error"_a = outcome.error, "at_least"_a = outcome.at_least,
      "credit"_a = py::none(), "place_m"_a = py::none(), "tick"_a = py::none());
  if (outcome.verdict != scoring::Verdict::not_assessable)
    row["credit"] = scoring::credit_of(item, outcome);
  if (outcome.place) row["place_m"] = array_of(*outcome.place);
  if (outcome.tick) row["tick"] = *outcome.tick;
  return row;
}

bool moves_pieces(record::Player& player) {
  record::Step step;
  for (record::StepCursor steps = player.steps(); steps.next(step);)
    for (const tick::Command& command : step.commands)
      if (command.kind == tick::CommandKind::move_piece ||
          command.kind == tick::CommandKind::lift_piece)
        return true;
  return false;
}

py::dict Recording::score(const std::string& name, const py::object& call) {
  Use use(*this);
  if (!use->info().work_case && name.empty()) raise("the recording names no case; name a rubric");
  scoring::Rubric rubric;
  scenario::Case work_case;
  if (use->info().work_case) {
    work_case = take(record::case_of(use->info()));
    rubric = take(scoring::read_rubric(name.empty() ? work_case.name : name));
  } else {
    rubric = take(scoring::read_rubric(name));
    work_case = take(scenario::read_case(rubric.case_source));
  }
  if (rubric.case_name != work_case.name)
    raise(fmt::format("{} is a rubric for the case \"{}\", but the recording is of \"{}\"",
                      rubric.file, rubric.case_name, work_case.name));
  const auto lesson = take(workshop::placed_lesson(work_case));
  check(scoring::check(rubric, lesson));
  Work work(call);
  if (work.run([&] { return moves_pieces(*use); }))
    raise(
        "a piece of bone was moved in this recording; `burr score` judges it, the module does not");
  const volume::Bone& before = first(*use, work);
  auto after = volume::copy_of(before);
  check(work.run([&] { return use->bone_at(use->seconds(), *after); }));
  const auto score =
      take(work.run([&] { return scoring::score(rubric, lesson, before, *after, &*use, work); }));
  py::list items;
  for (std::size_t n = 0; n < rubric.items.size(); ++n)
    items.append(item_of(rubric.items[n], score.outcomes[n]));
  return py::dict("rubric"_a = rubric.name, "version"_a = rubric.version,
                  "case"_a = rubric.case_name, "unfinished"_a = score.unfinished,
                  "ending"_a = score.ending, "removed_share_of_target"_a = score.worked,
                  "no_mark"_a = scoring::text_of(score.no_mark),
                  "product"_a = total_of(score.product), "process"_a = total_of(score.process),
                  "items"_a = items);
}

py::dict Recording::replay(const std::string& law, const std::string& settings,
                           const py::object& call) {
  Use use(*this);
  const auto own = law.empty() ? nullptr : take(workshop::LawFile::open(law, settings));
  check(sim::check_law(use->info(), own.get(), use->path()));
  Work work(call);
  auto bone = volume::copy_of(first(*use, work));
  const auto outcome =
      take(work.run([&] { return sim::replay(*use, std::move(bone), work, nullptr, own.get()); }));
  return py::dict("ticks"_a = outcome.ticks, "bricks"_a = outcome.bricks, "gaps"_a = outcome.gaps,
                  "same"_a = !outcome.first_different_tick && outcome.gaps == 0,
                  "difference"_a = outcome.difference);
}

}  // namespace

void add_recording(py::module_& module) {
  py::class_<Recording> recording(module, "Recording", "A recording (.mcap).");
  recording.def(py::init<const std::string&, std::string>(), "path"_a, py::kw_only(),
                "volume"_a = "", "volume: the scan it was made from, if burr does not find it.");
  recording.def_property_readonly("path", &Recording::path);
  recording.def_property_readonly("volume", &Recording::volume);
  recording.def_property_readonly("seconds",
                                  [](const Recording& self) { return self.player().seconds(); });
  recording.def_property_readonly(
      "rate_hz", [](const Recording& self) { return self.player().info().rate_hz; });
  recording.def_property_readonly("finished",
                                  [](const Recording& self) { return self.player().finished(); });
  recording.def_property_readonly("notices",
                                  [](const Recording& self) { return self.player().notices(); });
  recording.def_property_readonly("case", [](const Recording& self) -> py::object {
    const auto& known = self.player().info().work_case;
    return known ? py::object(py::str(known->name)) : py::object(py::none());
  });
  recording.def_property_readonly("spare", [](const Recording& self) {
    const record::SessionInfo& info = self.player().info();
    py::list names;
    for (const volume::TissueId id : workshop::read_spared(info))
      names.append(info.volume.tissues[id].name);
    return names;
  });
  recording.def_property_readonly("info", [](const Recording& self) {
    return py::module_::import("json").attr("loads")(record::to_json(self.player().info()));
  });
  recording.def_property_readonly("ticks", &Recording::ticks,
                                  "All ticks, a structured array that cannot be written.");
  recording.def(
      "__getitem__",
      [](Recording& self, const std::string& column) -> py::object {
        return self.ticks()[py::str(column)];
      },
      "column"_a);
  recording.def("__len__", [](const Recording& self) {
    return self.player().end_tick() - self.player().first_tick();
  });
  recording.def("commands", &Recording::commands,
                "The commands that the session received, in order.");
  recording.def("before", &Recording::before, py::kw_only(), "progress"_a = py::none(),
                "The bone before the first tick.");
  recording.def("bone", &Recording::bone, "t"_a = py::none(), py::kw_only(),
                "progress"_a = py::none(), "The bone at t [s]; None: at the end.");
  recording.def("removed_mm3", &Recording::removed_mm3, py::kw_only(), "progress"_a = py::none());
  recording.def("process", &Recording::process, py::kw_only(), "progress"_a = py::none(),
                "Measures of how the work was done (docs/teach/metrics.md).");
  recording.def("score", &Recording::score, "rubric"_a = "", py::kw_only(),
                "progress"_a = py::none(), "As `burr score`.");
  recording.def(
      "report",
      [](const Recording& self, const std::string& out, const std::string& rubric,
         const std::string& language, int pictures, const std::string& beside,
         const py::object& call) {
        Work work(call);
        write_report({self.path(), self.volume(), out, rubric, language, pictures, beside}, work);
      },
      "out"_a, py::kw_only(), "rubric"_a = "", "language"_a = "en", "pictures"_a = 12,
      "beside"_a = "", "progress"_a = py::none(),
      "One page (.html) on the session, as `burr report`. beside: a recording of an expert on the "
      "same case.");
  recording.def("replay", &Recording::replay, py::kw_only(), "law"_a = "", "law_settings"_a = "",
                "progress"_a = py::none(), "Simulates it again and compares every tick and brick.");
}

}  // namespace burr::python
