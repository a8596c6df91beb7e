// report/report.h - what a report on a session says, as plain data: texts in the user's
// language, small tables, pictures as PNG bytes, curves. report_page.h writes it as a page for a
// browser; a window may show the same.
//
// Texts are plain: whoever writes them into a page escapes them. Units are in the names or, within
// the texts, beside the number. Thread: any.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::report {

using TextPair = std::pair<std::string, std::string>;  // name, value

struct ReportPicture {
  std::string png;  // bytes of the file; empty: it could not be drawn
  std::string caption;
  int width = 0, height = 0;  // [pixel]
};

// How a mark is shown, with a sign and a colour, beside its word.
enum class Tone { good, bad, open, none };

struct ReportMark {
  std::string word;  // "met"; empty: there is no mark
  Tone tone = Tone::none;
};

// A value on a short line from 0 to `end`, with its error and its threshold.
struct ReportScale {
  double value = 0, error = 0, threshold = 0, end = 1;
  bool at_least = true;  // met: at or above the threshold
};

// When what an item judges happened (evidence_strip.h).
struct ReportStrip {
  double seconds = 0;  // of the line
  struct Span {
    double from_s = 0, to_s = 0;
    Tone tone = Tone::open;  // good: above the line, bad: below it, open: on it
    std::string name;        // short; empty: none
  };
  std::vector<Span> spans = {};
  std::string caption = {};
  bool open = false;  // of an item that could not be judged
};

struct ReportItem {
  std::string id, text;             // text: what is to be done
  bool gate = false;                // an item of safety
  bool harm = false;                // it is not met, and that did harm: such items come first
  std::optional<double> at_s;       // when the evidence is seen best; none: it cannot be seen
  bool at_end = false;              // that is the end of the session
  std::optional<math::Vec3> place;  // of it: world, LPS [m]
  ReportMark self, machine, beside;
  std::string figures;               // "share removed 12 % (error 3 %), at least 80 %"
  std::string default_word;          // beside the threshold; empty: it was compared with people
  std::string beside_figures;        // of the other session
  std::optional<ReportScale> scale;  // none: there is no number
  std::vector<std::string> remarks;  // why, borderline, the moment, what the measure means
  std::vector<ReportPicture> pictures;
  std::optional<ReportStrip> strip;
};

struct ReportPart {
  std::string title;  // "Product: the bone at the end"
  std::string met;    // "3 of 26 items met, 5 too early to say, 1 more not assessable"
  std::string note;   // points, or that the thresholds are defaults
  std::string beside_met;
  std::vector<ReportItem> items;
};

// An item of safety.
struct ReportGate {
  std::string text, when;  // when: "12.3 s"; empty: no moment
  ReportMark mark, beside;
};

struct ReportAdvice {
  std::string say, why;
};

// Some rows of pictures: of the session, and of the one beside it.
struct ReportSides {
  std::string whose;  // empty: there is only one
  std::vector<ReportPicture> pictures;
};

// Curves over one axis of time.
struct ReportLine {
  std::string whose;   // empty: there is only one
  double seconds = 0;  // of the axis
  // One entry for each of equal parts of the time; a part without data: not a number.
  std::vector<float> force_n;      // the largest
  std::vector<float> nearest_mm;   // the least; beyond what is measured: kFarthest_mm
  std::vector<float> diameter_mm;  // of the burr
  std::vector<bool> diamond, cutting;
  struct Span {
    double from_s = 0, to_s = 0;
    std::string name;
    std::string id = {};  // of the step
  };
  std::vector<Span> steps;
  struct Event {
    double at_s = 0;
    std::string word;
    Tone tone = Tone::none;
    std::string kind = {};  // record::word_of(CourseKind)
  };
  std::vector<Event> events;
  std::string nearest;  // a sentence: each structure, how near, when
};
inline constexpr double kFarthestMm = 12;  // distances are measured to here

// A word of a legend and its colour, "#d55e00".
using Legend = std::vector<TextPair>;

struct Report {
  std::string title, language;  // language: "en"
  std::string no_patient;
  std::string unfinished;         // a sentence; empty: declared done
  std::vector<TextPair> head;     // "Case", "Mastoidectomy"
  std::vector<ReportGate> gates;  // what did harm comes first
  std::string safety;             // their sum: "3 of 10 items met, 7 too early to say"; empty: none
  std::vector<ReportPart> parts;  // product, process
  std::string self;               // agreement with the learner's own marks, or that there are none
  std::vector<ReportAdvice> next;
  std::string nothing_next;  // in place of advice
  bool has_self = false;
  std::string you, machine, beside;  // names of the columns; beside: empty without one
  Legend sides_legend, spots_legend;
  std::vector<ReportSides> sides;
  std::vector<TextPair> figures;  // that earn nothing
  std::vector<TextPair> pieces;   // of bone that were moved; they earn nothing either
  std::vector<ReportLine> lines;
  std::vector<std::string> small;            // sentences
  math::Vec3 towards = math::Vec3::UnitZ();  // from the bone to the surgeon; unit
  std::vector<TextPair> hashes;
  std::vector<std::string> commands;  // that compute it again
};

}  // namespace burr::report
