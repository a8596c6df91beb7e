#include "burr/scenario/read_lesson.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <initializer_list>

#include "burr/scenario/fade.h"
#include "burr/scenario/rack.h"
#include "burr/scenario/read_texts.h"

namespace burr::scenario {
namespace {

constexpr double kMm = 1e-3, kMm3 = 1e-9;
constexpr double kNewest = 2;  // format
constexpr std::size_t kMostSteps = 200;

void scale(std::optional<Range>& range, double unit) {
  if (range) *range = {range->first * unit, range->second * unit};
}

void read_structure(Reader& reader, Structure& out) {
  reader.only({"name", "title", "names", "intact", "glass", "optional", "volume_mm3",
               "inscribed_mm", "pieces", "length_mm", "touches", "apart"});
  out.line = reader.line();
  reader.text("name", out.name, true);
  read_texts(reader, "title", out.title);
  reader.texts("names", out.names);
  if (out.names.empty()) out.names = {out.name};
  reader.choice<Intact>(
      "intact", out.intact,
      {{"solid", Intact::solid}, {"soft", Intact::soft}, {"plate", Intact::plate}});
  reader.flag("glass", out.glass);
  reader.flag("optional", out.optional);
  if (out.glass && out.intact != Intact::unsaid)
    reader.fail("glass",
                "burr draws a glass structure clear and lets it be cut; leave out glass or intact");
  reader.range("volume_mm3", out.volume);
  scale(out.volume, kMm3);
  reader.range("inscribed_mm", out.inscribed);
  scale(out.inscribed, kMm);
  reader.range("pieces", out.pieces);
  double length_mm = 0;
  reader.number("length_mm", length_mm, 0, 1000);
  out.length = length_mm * kMm;
  reader.texts("touches", out.touches);
  reader.texts("apart", out.apart);
}

void read_tool(Reader& reader, Step& out) {
  reader.only({"kind", "diameter_mm", "name"});
  tool::BurrKind kind = tool::BurrKind::cutting;
  if (!reader.has("kind") && !reader.has("diameter_mm") && !reader.has("name"))
    return reader.fail("kind", "is missing; give kind or diameter_mm, or the name of a tool");
  reader.text("name", out.tool);
  if (!out.tool.empty()) {
    if (const auto known = built_in_rack().get(out.tool); !known)
      reader.fail("name", known.error().text);
    for (const char* const other : {"kind", "diameter_mm"})
      if (reader.has(other)) reader.fail(other, "is for the round burr; leave it out beside name");
  }
  reader.choice<tool::BurrKind>(
      "kind", kind, {{"cutting", tool::BurrKind::cutting}, {"diamond", tool::BurrKind::diamond}});
  if (reader.has("kind")) out.kind = kind;
  reader.range("diameter_mm", out.diameter);
  scale(out.diameter, kMm);
}

void read_done(Reader& reader, Step& out) {
  DoneWhen& done = out.done.emplace();
  done.line = reader.line();
  done.structure = out.structure;
  done.region = out.region;
  reader.text("measure", done.measure, true);
  reader.text("structure", done.structure);
  reader.text("region", done.region);
  reader.text("along", done.along);
  reader.each_number({"measure", "structure", "region", "along"},
                     [&](std::string_view key, double value) { done.limits.emplace(key, value); });
}

void read_approach(Reader& reader, std::vector<math::Vec3>& out) {
  reader.vectors("approach", out);
  for (math::Vec3& direction : out) {
    if (direction.norm() < 1e-6) return reader.fail("approach", "a direction is [0, 0, 0]");
    direction.normalize();
  }
}

void read_step(Reader& reader, Step& out) {
  reader.only({"id", "title", "say", "structure", "region", "spare", "tool", "approach", "show",
               "must_precede", "done", "adds"});
  out.line = reader.line();
  reader.text("id", out.id, true);
  read_texts(reader, "title", out.title);
  read_texts(reader, "say", out.say, true);
  reader.text("structure", out.structure);
  reader.text("region", out.region);
  reader.texts("spare", out.spare);
  reader.table("tool", [&](Reader& inner) { read_tool(inner, out); });
  read_approach(reader, out.approach);
  reader.texts("show", out.show);
  reader.texts("must_precede", out.must_precede);
  reader.table("done", [&](Reader& inner) { read_done(inner, out); });
  reader.flag("adds", out.adds);
  if (out.adds && out.region.empty())
    reader.fail("adds", "needs the region that is filled; add region");
}

// The words that [feedback] knows, docs/use/cases.md.
constexpr std::array<std::string_view, 8> kWords = {
    "step", "target", "distance", "tone", "technique", "undo", "colours", "see-through"};

void read_feedback(Reader& reader, Feedback& out) {
  reader.only({"learn", "practise", "exam", "fade"});
  const auto words = [&](std::string_view mode, std::optional<std::vector<std::string>>& to) {
    if (!reader.has(mode)) return;
    reader.texts(mode, to.emplace());
    for (const std::string& word : *to) {
      std::string list;
      bool known = false;
      for (const std::string_view each : kWords) {
        known = known || word == each;
        list += (list.empty() ? "" : ", ") + std::string(each);
      }
      if (!known)
        reader.fail(mode,
                    fmt::format("\"{}\" is not known; use any of {}", base::printable(word), list));
    }
  };
  words("learn", out.learn);
  words("practise", out.practise);
  words("exam", out.exam);
  if (out.exam)
    for (const std::string& word : *out.exam)
      if (word != "colours" && word != "see-through")
        reader.fail("exam", fmt::format("an exam may offer colours and see-through, never \"{}\"",
                                        base::printable(word)));
  reader.text("fade", out.fade);
  if (!out.fade.empty() && !fade_of(out.fade))
    reader.fail("fade",
                "must be numbers of attempts, then on or off, for example \"2,alternate:4,off\"");
}

void read_reference(Reader& reader, Reference& out) {
  reader.only({"remove", "fill", "leave"});
  reader.texts("remove", out.remove);
  reader.texts("fill", out.fill);
  if (out.remove.empty()) reader.fail("remove", "is missing; give the regions that are gone");
  reader.each("leave", [&](Reader& inner) {
    inner.only({"structure", "mm"});
    auto& [name, thick] = out.leave.emplace_back();
    inner.text("structure", name, true);
    double mm = 0;
    inner.number("mm", mm, 0, 20, true);
    thick = mm * kMm;
  });
}

// format = 2, where the file has a table of it
void read_format(Reader& reader, CaseLesson& out) {
  double format = 1;
  reader.number("format", format, 0, 1e6);
  if (format > kNewest)
    reader.fail("format", "is newer than this burr, which knows 1 and 2; install a newer burr");
  else if (format != 1 && format != kNewest)
    reader.fail("format", "must be 1 or 2");
  out.format = static_cast<int>(std::min(format, kNewest));
  if (out.format == 2) return;
  for (const char* key : {"approach", "landmark", "region", "structure", "step", "complication",
                          "piece", "feedback", "reference"})
    if (reader.has(key))
      return reader.fail(key, "belongs to format 2; add the line format = 2 at the top");
}

}  // namespace

void read_lesson(Reader& reader, CaseLesson& out) {
  read_format(reader, out);
  read_texts(reader, "title", out.title);
  read_texts(reader, "description", out.description);
  read_approach(reader, out.approach);
  read_landmarks(reader, out);
  read_regions(reader, out);
  reader.each("structure",
              [&](Reader& inner) { read_structure(inner, out.structures.emplace_back()); });
  reader.each(
      "step", [&](Reader& inner) { read_step(inner, out.steps.emplace_back()); }, kMostSteps);
  reader.each("complication", [&](Reader& inner) {
    Complication& one = out.complications.emplace_back();
    inner.only({"id", "step", "structure", "say"});
    one.line = inner.line();
    inner.text("id", one.id, true);
    inner.text("step", one.step);
    inner.text("structure", one.structure);
    read_texts(inner, "say", one.say, true);
  });
  read_pieces(reader, out);
  reader.table("feedback", [&](Reader& inner) { read_feedback(inner, out.feedback); });
  reader.table("reference", [&](Reader& inner) { read_reference(inner, out.reference.emplace()); });
  check_names(reader, out);
}

}  // namespace burr::scenario
