#include "burr/report/report_words.h"

#include <array>
#include <cctype>
#include <utility>

#include "burr/words/words.h"

namespace burr::report {

using words::english;
using words::say;
using words::Word;
using words::word;

namespace {

using scoring::Standing;

constexpr std::array kValues = {
    Word::what_seen,      Word::what_bare,        Word::what_even,       Word::what_lost,
    Word::what_area,      Word::what_walls,       Word::what_shut,       Word::what_way,
    Word::what_under,     Word::what_removed,     Word::what_deep,       Word::what_choice,
    Word::what_restraint, Word::what_entry,       Word::what_end,        Word::what_axis_angle,
    Word::what_too_deep,  Word::what_too_shallow, Word::what_too_wide,   Word::what_too_narrow,
    Word::what_plane_off, Word::what_plane_angle, Word::what_face,       Word::what_floor,
    Word::what_rim,       Word::what_clear,       Word::what_stroke_far, Word::what_stroke,
    Word::what_along,     Word::what_coolant,     Word::what_outside,    Word::what_shaft,
    Word::what_dwell,     Word::what_slowed,      Word::what_reaction,   Word::what_touched,
    Word::what_order,     Word::what_divided,     Word::what_axis_tilt,  Word::what_screw_out,
    Word::what_screw_in};

constexpr std::array<std::pair<std::string_view, Word>, 39> kMeasures = {
    {{"identified", Word::explain_identified},
     {"skeletonised", Word::explain_skeletonised},
     {"intact_solid", Word::explain_intact_solid},
     {"intact_soft", Word::explain_intact_soft},
     {"intact_plate", Word::explain_intact_plate},
     {"no_cells", Word::explain_no_cells},
     {"opened", Word::explain_opened},
     {"overhang", Word::explain_overhang},
     {"removed", Word::explain_removed},
     {"filled", Word::explain_filled},
     {"filled_beside", Word::explain_filled_beside},
     {"kept", Word::explain_kept},
     {"burr_choice", Word::explain_burr_choice},
     {"restraint", Word::explain_restraint},
     {"order", Word::explain_order},
     {"untouched", Word::explain_untouched},
     {"clearance", Word::explain_clearance},
     {"divided", Word::explain_divided},
     {"axis_entry", Word::explain_axis_entry},
     {"axis_apex", Word::explain_axis_apex},
     {"axis_angle", Word::explain_axis_angle},
     {"axis_tilt", Word::explain_axis_tilt},
     {"axis_breach", Word::explain_axis_breach},
     {"axis_depth", Word::explain_axis_depth},
     {"axis_width", Word::explain_axis_width},
     {"plane_offset", Word::explain_plane_offset},
     {"plane_angle", Word::explain_plane_angle},
     {"plane_even", Word::explain_plane_even},
     {"cavity_depth", Word::explain_cavity_depth},
     {"cavity_floor", Word::explain_cavity_floor},
     {"cavity_outline", Word::explain_cavity_outline},
     {"strokes", Word::explain_strokes},
     {"stroke_direction", Word::explain_stroke_direction},
     {"coolant", Word::explain_coolant},
     {"economy", Word::explain_economy},
     {"shaft", Word::explain_shaft},
     {"dwell", Word::explain_dwell},
     {"motor_load", Word::explain_motor_load},
     {"reaction", Word::explain_reaction}}};

const char* standing_word(Standing standing) {
  switch (standing) {
    case Standing::met:
      return word(Word::report_verdict_met);
    case Standing::not_met:
      return word(Word::report_verdict_unmet);
    case Standing::too_early:
      return word(Word::report_verdict_early);
    case Standing::not_assessable:
      return word(Word::report_verdict_open);
  }
  return "";
}

// "mm2", "mm3" and degrees as people of all languages write them.
std::string amount(scoring::Quantity quantity, double value) {
  std::string text = scoring::text_of(quantity, value);
  for (const auto& [plain, raised] :
       {std::pair{std::string_view("mm2"), "mm²"}, std::pair{std::string_view("mm3"), "mm³"},
        std::pair{std::string_view(" degrees"), "°"}})
    if (const auto at = text.find(plain); at != text.npos) text.replace(at, plain.size(), raised);
  return text;
}

// A phrase of the library as a sentence.
std::string sentence(std::string text) {
  if (text.empty()) return text;
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  if (text.back() != '.') text += '.';
  return text;
}

}  // namespace

std::string value_word(std::string_view what) {
  for (const Word one : kValues)
    if (what == english(one)) return word(one);
  return std::string(what);
}

std::string measure_word(std::string_view measure) {
  for (const auto& [name, text] : kMeasures)
    if (name == measure) return word(text);
  return {};
}

std::string mode_word(record::Mode mode) {
  switch (mode) {
    case record::Mode::free:
      return word(Word::report_mode_free);
    case record::Mode::learn:
      return word(Word::report_mode_learn);
    case record::Mode::practise:
      return word(Word::report_mode_practise);
    case record::Mode::exam:
      return word(Word::report_mode_exam);
  }
  return {};
}

ReportMark mark_of(const scoring::Outcome& outcome) {
  const Standing standing = scoring::standing_of(outcome);
  const Tone tone = standing == Standing::met         ? Tone::good
                    : standing == Standing::not_met   ? Tone::bad
                    : standing == Standing::too_early ? Tone::open
                                                      : Tone::none;
  return {standing_word(standing), tone};
}

ReportMark mark_of(SelfMark mark) {
  switch (mark) {
    case SelfMark::met:
      return {word(Word::report_verdict_met), Tone::good};
    case SelfMark::unmet:
      return {word(Word::report_verdict_unmet), Tone::bad};
    case SelfMark::unknown:
      return {word(Word::report_self_unknown), Tone::none};
  }
  return {};
}

std::string figures_of(const scoring::Outcome& outcome) {
  if (!outcome.value) return {};
  std::string text = value_word(outcome.what) + " " + amount(outcome.quantity, *outcome.value);
  if (outcome.error > 0)
    text += " (" + say(Word::report_error, amount(outcome.quantity, outcome.error)) + ")";
  return text + ", " +
         say(outcome.at_least ? Word::report_at_least : Word::report_at_most,
             amount(outcome.quantity, outcome.threshold));
}

std::string reason_of(const scoring::Item& item, const scoring::Outcome& outcome) {
  if (outcome.reason.empty()) return {};
  if (!outcome.earned) return word(Word::report_unearned);
  if (!item.needs.empty() && outcome.reason.find('"' + item.needs + '"') != std::string::npos)
    return say(Word::report_requires, item.needs, standing_word(scoring::standing_of(outcome)));
  return sentence(outcome.reason);
}

}  // namespace burr::report
