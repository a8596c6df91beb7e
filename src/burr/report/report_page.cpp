#include "burr/report/report_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "burr/base/base64.h"
#include "burr/base/markup.h"
#include "burr/report/evidence_strip.h"
#include "burr/report/time_line.h"
#include "burr/words/words.h"

namespace burr::report {

using words::Word;
using words::word;

namespace {

using base::markup_text;

constexpr const char* kStyle = R"(
body { font: 14px/1.4 system-ui, "DejaVu Sans", sans-serif; color: #1c1c1c; background: #fff; max-width: 960px; margin: 1.5em auto; padding: 0 1em }
h1 { font-size: 1.5em; margin: 0 0 .2em } h2 { font-size: 1.1em; margin: 1.3em 0 .4em; border-bottom: 1px solid #999 }
p { margin: .3em 0 } .soft { color: #555 } .warn { border-left: 4px solid #b04a00; padding: .3em .8em; background: #fdf3ea }
.head { display: grid; grid-template-columns: repeat(3, 1fr); gap: .15em 1.5em; margin: .6em 0 } .head dt, .head dd { display: inline; margin: 0 } .head dt { color: #555 } .head dt:after { content: ": " } .head dd { overflow-wrap: anywhere }
table { border-collapse: collapse; width: 100% } td, th { text-align: left; vertical-align: top; padding: .3em .5em; border-top: 1px solid #ddd }
th { color: #555; font-weight: 600; font-size: .9em } thead { display: table-header-group } tr { break-inside: avoid }
.mark { white-space: nowrap; font-weight: 600 } th.m { width: 7.2em } .good { color: #00694c } .bad { color: #b04a00 } .open { color: #0060a0 } .none { color: #555 }
.id { color: #777; font-size: .85em; white-space: nowrap } .small { font-size: .88em } .item { width: 25% } th.v { width: 60% }
.tag { border: 1px solid #b04a00; color: #b04a00; border-radius: .6em; padding: 0 .4em; font-size: .8em; white-space: nowrap }
.default { color: #777; font-size: .85em; font-style: italic; white-space: nowrap } .note { color: #555 }
figure { display: inline-block; margin: .2em .4em .2em 0; vertical-align: top } figcaption { font-size: .82em; color: #555 } img { display: block; max-width: 100%; height: auto }
.sides { display: grid; grid-template-columns: repeat(4, 1fr); gap: .5em } .sides.one { grid-template-columns: minmax(0, 60%) } .sides figure { margin: 0 } .proof { float: right; margin-left: .8em; width: 180px } .proof > svg { display: block } .proof figure { width: 180px; margin: .1em 0 }
.strip svg { display: block } .why { border-left: 3px solid #0060a0; padding-left: 5px; box-sizing: border-box } .why svg { width: 100% }
.legend span { display: inline-block; margin-right: 1.2em; font-size: .88em } .legend i { display: inline-block; width: .9em; height: .9em; border: 1px solid #777; margin-right: .35em; vertical-align: -.1em }
svg { max-width: 100%; height: auto; vertical-align: middle } .totals { display: grid; grid-template-columns: 1fr 1fr; gap: .3em 2em } .totals b { font-size: 1.15em }
ol { margin: .3em 0; padding-left: 1.5em } code { font-family: "DejaVu Sans Mono", monospace; font-size: .9em; overflow-wrap: anywhere }
@page { size: A4; margin: 10mm }
@media print { body { font-size: 8pt; line-height: 1.22; margin: 0; padding: 0; max-width: none } h2 { margin: .8em 0 .25em; break-after: avoid }
 td, th { padding: .12em .35em } .proof, .proof figure { width: 36mm } .proof img { width: 28mm; height: auto } figcaption { line-height: 1.15; padding-top: .25em } figure, svg, .warn, .whole { break-inside: avoid } .remarks p { margin: .1em 0 }
 * { -webkit-print-color-adjust: exact; print-color-adjust: exact } }
)";

const char* class_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "good";
    case Tone::bad:
      return "bad";
    case Tone::open:
      return "open";
    case Tone::none:
      return "none";
  }
  return "none";
}

// A sign besides the colour, for those who cannot tell colours apart.
const char* sign_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "✓ ";
    case Tone::bad:
      return "✗ ";
    case Tone::open:
      return "○ ";
    case Tone::none:
      return "– ";
  }
  return "";
}

std::string mark_html(const ReportMark& mark) {
  if (mark.word.empty()) return "–";
  return fmt::format("<span class=\"mark {}\">{}{}</span>", class_of(mark.tone), sign_of(mark.tone),
                     markup_text(mark.word));
}

std::string figure_html(const ReportPicture& picture) {
  if (picture.png.empty()) return {};
  return fmt::format(
      "<figure><img src=\"data:image/png;base64,{0}\" width=\"{1}\" height=\"{2}\" alt=\"{3}\"/>"
      "<figcaption>{3}</figcaption></figure>\n",
      base::base64(picture.png), picture.width, picture.height, markup_text(picture.caption));
}

std::string legend_html(const Legend& legend) {
  if (legend.empty()) return {};
  std::string html = "<p class=\"legend\">";
  for (const auto& [text, colour] : legend)
    html += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", markup_text(colour),
                        markup_text(text));
  return html + "</p>\n";
}

// From 0 to the end: the good side is green, the threshold a line, the value a dot with its error.
std::string scale_html(const ReportScale& scale) {
  constexpr double kWide = 180;
  const auto x = [&](double value) {
    return 3 + (kWide - 6) * std::clamp(value / scale.end, 0.0, 1.0);
  };
  const double edge = x(scale.threshold);
  const double from = scale.at_least ? edge : x(0), to = scale.at_least ? x(scale.end) : edge;
  const bool good =
      scale.at_least ? scale.value >= scale.threshold : scale.value <= scale.threshold;
  return fmt::format(
      "<svg width=\"{0:.0f}\" height=\"13\" viewBox=\"0 0 {0:.0f} 13\">"
      "<path d=\"M3 7H{1:.1f}\" stroke=\"#bbb\" stroke-width=\"3\"/>"
      "<path d=\"M{2:.1f} 7H{3:.1f}\" stroke=\"#8fcfb8\" stroke-width=\"3\"/>"
      "<path d=\"M{4:.1f} 1V13\" stroke=\"#222\"/>"
      "<path d=\"M{5:.1f} 7H{6:.1f}\" stroke=\"{8}\" stroke-width=\"1.5\"/>"
      "<circle cx=\"{7:.1f}\" cy=\"7\" r=\"3\" fill=\"{8}\"/></svg>",
      kWide, kWide - 3, from, to, edge, x(scale.value - scale.error), x(scale.value + scale.error),
      x(scale.value), good ? "#00694c" : "#b04a00");
}

std::string pairs_html(const std::vector<TextPair>& pairs) {
  std::string html = "<dl class=\"head\">\n";
  for (const auto& [name, value] : pairs)
    html +=
        fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", markup_text(name), markup_text(value));
  return html + "</dl>\n";
}

std::string head_html(const Report& report) {
  std::string html = fmt::format("<h1>{}</h1>\n<p class=\"soft\">{}</p>\n",
                                 markup_text(report.title), markup_text(report.no_patient));
  if (!report.unfinished.empty())
    html +=
        fmt::format("<p class=\"warn\" id=\"unfinished\">{}</p>\n", markup_text(report.unfinished));
  return html + pairs_html(report.head);
}

std::string safety_html(const Report& report) {
  if (report.gates.empty()) return {};
  std::string html = fmt::format(
      "<h2>{}</h2>\n<p class=\"soft small\">{}</p>\n<p><b>{}</b></p>\n<table id=\"safety\">\n",
      markup_text(word(Word::report_safety)), markup_text(word(Word::report_gates)),
      markup_text(report.safety));
  if (!report.beside.empty())
    html += fmt::format("<thead><tr><th></th><th>{}</th><th>{}</th></tr></thead>\n",
                        markup_text(report.machine), markup_text(report.beside));
  html += "<tbody>\n";
  for (const ReportGate& gate : report.gates) {
    html +=
        fmt::format("<tr><td>{}</td><td>{}{}</td>", markup_text(gate.text), mark_html(gate.mark),
                    gate.when.empty() ? "" : ", " + markup_text(gate.when));
    if (!report.beside.empty()) html += "<td>" + mark_html(gate.beside) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string totals_html(const Report& report) {
  std::string html =
      fmt::format("<h2>{}</h2>\n<div class=\"totals\">\n", markup_text(word(Word::report_totals)));
  for (const ReportPart& part : report.parts) {
    html += fmt::format("<div><p>{}</p><p><b>{}</b></p><p class=\"default\">{}</p>",
                        markup_text(part.title), markup_text(part.met), markup_text(part.note));
    if (!part.beside_met.empty())
      html += fmt::format("<p class=\"soft\">{}: {}</p>", markup_text(report.beside),
                          markup_text(part.beside_met));
    html += "</div>\n";
  }
  html += "</div>\n";
  if (!report.self.empty())
    html += fmt::format("<h2>{}</h2>\n<p id=\"self\">{}</p>\n",
                        markup_text(word(Word::report_self)), markup_text(report.self));
  return html;
}

std::string next_html(const Report& report) {
  if (report.next.empty() && report.nothing_next.empty()) return {};
  std::string html = fmt::format("<h2>{}</h2>\n", markup_text(word(Word::report_next)));
  if (report.next.empty()) return html + "<p>" + markup_text(report.nothing_next) + "</p>\n";
  html += "<ol id=\"next\">\n";
  for (const ReportAdvice& one : report.next)
    html += fmt::format("<li><b>{}</b> <span class=\"soft\">{}</span></li>\n", markup_text(one.say),
                        markup_text(one.why));
  return html + "</ol>\n";
}

// The value on its line, and what it was taken from: pictures, or a strip of time where there is none.
std::string proof_html(const ReportItem& item) {
  std::string html;
  if (item.scale) html += scale_html(*item.scale);
  for (const ReportPicture& picture : item.pictures) html += figure_html(picture);
  if (item.strip && item.pictures.empty()) html += strip_html(*item.strip);
  return html.empty() ? html : "<div class=\"proof\">\n" + html + "</div>";
}

std::string item_html(const Report& report, const ReportItem& item) {
  std::string html = fmt::format(
      "<tr id=\"item-{}\"><td class=\"item\">{} <span class=\"id\">{}</span>{}</td>\n",
      markup_text(item.id), markup_text(item.text), markup_text(item.id),
      item.gate
          ? fmt::format(" <span class=\"tag\">{}</span>", markup_text(word(Word::report_gate)))
          : "");
  if (report.has_self) html += "<td>" + mark_html(item.self) + "</td>";
  html += "<td>" + mark_html(item.machine) + "</td>";
  if (!report.beside.empty()) html += "<td>" + mark_html(item.beside) + "</td>";
  html += "<td class=\"remarks\">" + proof_html(item);
  if (!item.figures.empty())
    html += fmt::format("<p>{} <span class=\"default\">{}</span></p>", markup_text(item.figures),
                        markup_text(item.default_word));
  if (!item.beside_figures.empty())
    html += fmt::format("<p class=\"soft\">{}: {}</p>", markup_text(report.beside),
                        markup_text(item.beside_figures));
  if (!item.remarks.empty()) {
    html += "<p class=\"note small\">";
    for (const std::string& remark : item.remarks)
      if (!item.strip || remark != item.strip->caption || !item.pictures.empty())
        html += markup_text(remark) + " ";
    html += "</p>";
  }
  return html + "</td></tr>\n";
}

// The head of a column of marks.
std::string column_html(const std::string& name) {
  return "<th class=\"m\">" + markup_text(name) + "</th>";
}

std::string items_html(const Report& report) {
  std::string html = fmt::format("<h2>{}</h2>\n", markup_text(word(Word::report_items)));
  const bool proofs = std::any_of(report.parts.begin(), report.parts.end(), [](const auto& part) {
    return std::any_of(part.items.begin(), part.items.end(),
                       [](const auto& item) { return !item.pictures.empty(); });
  });
  if (proofs)
    html += legend_html(report.spots_legend) + "<p class=\"soft small\">" +
            markup_text(word(Word::report_most_pictures)) + "</p>\n";
  html += fmt::format("<table id=\"items\"><thead><tr><th>{}</th>",
                      markup_text(word(Word::report_item)));
  if (report.has_self) html += column_html(report.you);
  html += column_html(report.machine);
  if (!report.beside.empty()) html += column_html(report.beside);
  html += "<th class=\"v\">" + markup_text(word(Word::report_value)) + "</th></tr></thead>\n";
  const int columns = 3 + (report.has_self ? 1 : 0) + (report.beside.empty() ? 0 : 1);
  for (const ReportPart& part : report.parts) {
    html += fmt::format("<tbody><tr><th colspan=\"{}\">{}</th></tr>\n", columns,
                        markup_text(part.title));
    for (const ReportItem& item : part.items) html += item_html(report, item);
    html += "</tbody>\n";
  }
  return html + "</table>\n";
}

std::string sides_html(const Report& report) {
  if (report.sides.empty()) return {};
  std::string html =
      fmt::format("<div class=\"whole\"><h2>{}</h2>\n{}", markup_text(word(Word::report_sides)),
                  legend_html(report.sides_legend));
  for (const ReportSides& side : report.sides) {
    if (!side.whose.empty()) html += "<p><b>" + markup_text(side.whose) + "</b></p>\n";
    html += side.pictures.size() == 1 ? "<div class=\"sides one\">\n" : "<div class=\"sides\">\n";
    for (const ReportPicture& picture : side.pictures) html += figure_html(picture);
    html += "</div>\n";
  }
  return html + "</div>\n";
}

std::string lines_html(const Report& report) {
  std::string html = fmt::format("<h2>{}</h2>\n", markup_text(word(Word::report_line)));
  double seconds = 0;
  for (const ReportLine& line : report.lines) seconds = std::max(seconds, line.seconds);
  for (const ReportLine& line : report.lines) {
    if (!line.whose.empty()) html += "<p><b>" + markup_text(line.whose) + "</b></p>\n";
    html += svg_of(line, seconds);
    if (!line.nearest.empty())
      html += fmt::format("<p class=\"small\">{}: {}.</p>\n",
                          markup_text(word(Word::report_nearest)), markup_text(line.nearest));
  }
  const bool diamond = std::any_of(report.lines.begin(), report.lines.end(), [](const auto& line) {
    return std::find(line.diamond.begin(), line.diamond.end(), true) != line.diamond.end();
  });
  if (diamond)
    html += fmt::format("<p class=\"soft small\">{}: {}</p>\n",
                        markup_text(word(Word::report_line_burr)),
                        markup_text(word(Word::report_line_diamond)));
  return html;
}

std::string figures_html(const Report& report) {
  if (report.figures.empty()) return {};
  return fmt::format("<div class=\"whole\"><h2>{}</h2>\n{}</div>\n",
                     markup_text(word(Word::report_figures)), pairs_html(report.figures));
}

std::string pieces_html(const Report& report) {
  if (report.pieces.empty()) return {};
  return fmt::format(
      "<div class=\"whole\" id=\"pieces\"><h2>{}</h2>\n{}<p class=\"soft small\">{}</p></div>\n",
      markup_text(word(Word::report_pieces)), pairs_html(report.pieces),
      markup_text(word(Word::report_pieces_back)));
}

std::string small_html(const Report& report) {
  std::string html = fmt::format("<h2>{}</h2>\n<div class=\"small soft\" id=\"small\">\n",
                                 markup_text(word(Word::report_small)));
  for (const std::string& sentence : report.small) html += "<p>" + markup_text(sentence) + "</p>\n";
  html += "<p>";
  for (const auto& [name, value] : report.hashes)
    html += fmt::format("{}: <code>{}</code> &#160; ", markup_text(name), markup_text(value));
  html += "</p>\n";
  for (const std::string& command : report.commands)
    html += fmt::format("<p>{}: <code>{}</code></p>\n", markup_text(word(Word::report_again)),
                        markup_text(command));
  return html + "</div>\n";
}

}  // namespace

std::string page_of(const Report& report) {
  return fmt::format(
             "<!DOCTYPE html>\n<html lang=\"{}\"><head><meta charset=\"utf-8\"/>"
             "<meta name=\"viewport\" content=\"width=device-width\"/><title>{}</title>\n<style>{}"
             "</style></head>\n<body>\n",
             markup_text(report.language), markup_text(report.title), kStyle) +
         head_html(report) + safety_html(report) + totals_html(report) + next_html(report) +
         items_html(report) + sides_html(report) + lines_html(report) + pieces_html(report) +
         figures_html(report) + small_html(report) + "</body></html>\n";
}

}  // namespace burr::report
