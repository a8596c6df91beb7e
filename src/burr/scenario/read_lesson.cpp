#include "burr/scenario/read_lesson.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace burr::scenario {
namespace {

constexpr double kMm = 1e-3, kMm3 = 1e-9;
constexpr double kNewest = 2;  // format

// "2,alternate:4,off": so many attempts with full guidance, so many with every second one, then off
bool is_fade(std::string_view text) {
  const auto number = [](std::string_view digits) {
    int value = 0;
    const auto done = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return done.ec == std::errc() && done.ptr == digits.data() + digits.size() && value >= 0 &&
           value <= 1000;
  };
  constexpr std::string_view kAlternate = "alternate:";
  bool last = false;  // on or off must be the end
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const std::string_view part = text.substr(0, comma);
    if (last) return false;
    last = part == "on" || part == "off";
    const bool alternates = part.starts_with(kAlternate) && number(part.substr(kAlternate.size()));
    if (!last && !alternates && !number(part)) return false;
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return last;
}

void scale(std::optional<Range>& range, double unit) {
  if (range) *range = {range->first * unit, range->second * unit};
}

void read_structure(Reader& reader, Structure& out) {
  reader.only({"name", "names", "intact", "glass", "optional", "volume_mm3", "inscribed_mm",
               "pieces", "length_mm", "touches", "apart"});
  out.line = reader.line();
  reader.text("name", out.name, true);
  reader.texts("names", out.names);
  if (out.names.empty()) out.names = {out.name};
  reader.choice<Intact>(
      "intact", out.intact,
      {{"solid", Intact::solid}, {"soft", Intact::soft}, {"plate", Intact::plate}});
  reader.flag("glass", out.glass);
  reader.flag("optional", out.optional);
  if (out.glass && out.intact != Intact::unsaid)
    reader.fail("glass",
                "one looks through it, so it cannot be asked to stay intact; leave out one");
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
  reader.only({"kind", "diameter_mm"});
  tool::BurrKind kind = tool::BurrKind::cutting;
  if (!reader.has("kind") && !reader.has("diameter_mm"))
    return reader.fail("kind", "is missing; give kind or diameter_mm");
  reader.choice<tool::BurrKind>(
      "kind", kind, {{"cutting", tool::BurrKind::cutting}, {"diamond", tool::BurrKind::diamond}});
  if (reader.has("kind")) out.kind = kind;
  reader.range("diameter_mm", out.diameter);
  scale(out.diameter, kMm);
}

void read_step(Reader& reader, Step& out) {
  reader.only(
      {"id", "title", "say", "structure", "region", "spare", "tool", "show", "must_precede"});
  out.line = reader.line();
  reader.text("id", out.id, true);
  read_texts(reader, "title", out.title);
  read_texts(reader, "say", out.say, true);
  reader.text("structure", out.structure);
  reader.text("region", out.region);
  reader.texts("spare", out.spare);
  reader.table("tool", [&](Reader& inner) { read_tool(inner, out); });
  reader.texts("show", out.show);
  reader.texts("must_precede", out.must_precede);
}

// The words that [feedback] knows; what the program does with them is its own matter.
constexpr std::array<std::string_view, 8> kWords = {
    "step", "target", "distance", "tone", "technique", "undo", "colours", "see-through"};

void read_feedback(Reader& reader, Feedback& out) {
  reader.only({"learn", "practise", "exam", "fade"});
  const auto words = [&](std::string_view mode, std::vector<std::string>& to) {
    reader.texts(mode, to);
    for (const std::string& word : to) {
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
  reader.text("fade", out.fade);
  if (!out.fade.empty() && !is_fade(out.fade))
    reader.fail("fade",
                "must be numbers of attempts, then on or off, for example \"2,alternate:4,off\"");
}

void read_reference(Reader& reader, Reference& out) {
  reader.only({"remove", "leave"});
  reader.texts("remove", out.remove);
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
void read_format(Reader& reader, Lesson& out) {
  double format = 1;
  reader.number("format", format, 0, 1e6);
  if (format > kNewest)
    reader.fail("format", "is newer than this burr, which knows 1 and 2; install a newer burr");
  else if (format != 1 && format != kNewest)
    reader.fail("format", "must be 1 or 2");
  out.format = static_cast<int>(std::min(format, kNewest));
  if (out.format == 2) return;
  for (const char* key : {"approach", "landmark", "region", "structure", "step", "complication",
                          "feedback", "reference"})
    if (reader.has(key))
      return reader.fail(key, "belongs to format 2; add the line format = 2 at the top");
}

}  // namespace

void read_texts(Reader& reader, std::string_view key, Texts& out, bool needed) {
  if (reader.is_table(key))
    return reader.table(key, [&](Reader& inner) {
      inner.each_text([&](std::string_view language, const std::string& text) {
        if (language.size() != 2 || language[0] < 'a' || language[0] > 'z' || language[1] < 'a' ||
            language[1] > 'z')
          inner.fail(language, "is not a language; use two letters, en, sv, de");
        out.by_language[std::string(language)] = text;
      });
    });
  std::string text;
  reader.text(key, text, needed);
  if (!text.empty()) out.by_language["en"] = text;
}

void read_lesson(Reader& reader, Lesson& out) {
  read_format(reader, out);
  read_texts(reader, "title", out.title);
  read_texts(reader, "description", out.description);
  reader.vectors("approach", out.approach);
  for (math::Vec3& direction : out.approach) {
    if (direction.norm() < 1e-6) return reader.fail("approach", "a direction is [0, 0, 0]");
    direction.normalize();
  }
  read_landmarks(reader, out);
  read_regions(reader, out);
  reader.each("structure",
              [&](Reader& inner) { read_structure(inner, out.structures.emplace_back()); });
  reader.each("step", [&](Reader& inner) { read_step(inner, out.steps.emplace_back()); });
  reader.each("complication", [&](Reader& inner) {
    Complication& one = out.complications.emplace_back();
    inner.only({"id", "step", "structure", "say"});
    one.line = inner.line();
    inner.text("id", one.id, true);
    inner.text("step", one.step);
    inner.text("structure", one.structure);
    read_texts(inner, "say", one.say, true);
  });
  reader.table("feedback", [&](Reader& inner) { read_feedback(inner, out.feedback); });
  reader.table("reference", [&](Reader& inner) { read_reference(inner, out.reference.emplace()); });
  check_names(reader, out);
}

}  // namespace burr::scenario
