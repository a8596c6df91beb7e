// Draws the time line of a report: curves one over the other, on one axis of time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "burr/base/markup.h"
#include "burr/report/time_line.h"
#include "burr/words/words.h"

namespace burr::report {

using words::Word;
using words::word;

namespace {

constexpr double kWide = 780, kNames = 112, kRight = 12;  // of the whole, names at the left [px]
constexpr double kPlot = kWide - kNames - kRight;

class Strip {
 public:
  explicit Strip(double seconds) : seconds_(seconds > 0 ? seconds : 1) {}
  [[nodiscard]] double x(double at_s) const {
    return kNames + kPlot * std::clamp(at_s / seconds_, 0.0, 1.0);
  }
  // The middle of part n of `parts` parts of a line.
  [[nodiscard]] double x(const ReportLine& line, std::size_t n, std::size_t parts) const {
    return x(line.seconds * (static_cast<double>(n) + 0.5) / static_cast<double>(parts));
  }
  void name(Word which, double high) {
    out_ += fmt::format("<text x=\"{:.0f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                        kNames - 26, y_ + high / 2 + 4, base::markup_text(word(which)));
  }
  // A curve from 0 to `most`, with lines at `marks`.
  void curve(const ReportLine& line, const std::vector<float>& values, double most, double high,
             const char* colour, std::initializer_list<double> marks) {
    for (const double mark : marks) {
      const double at = y_ + high * (1 - mark / most);
      out_ += fmt::format(
          "<path d=\"M{0:.0f} {1:.1f}h{2:.0f}\" stroke=\"#ccc\"/><text x=\"{3:.0f}\" y=\"{4:.1f}\" "
          "text-anchor=\"end\" fill=\"#666\">{5:g}</text>\n",
          kNames, at, kPlot, kNames - 4, at + 4, mark);
    }
    std::string path;
    bool down = false;
    for (std::size_t n = 0; n < values.size(); ++n) {
      if (std::isnan(values[n])) {
        down = false;
        continue;
      }
      const double share = std::clamp(static_cast<double>(values[n]) / most, 0.0, 1.0);
      path += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", x(line, n, values.size()),
                          y_ + high * (1 - share));
      down = true;
    }
    out_ += fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\" "
        "stroke-linejoin=\"round\"/>"
        "\n",
        path, colour);
    next(high);
  }
  void bar(double from_s, double to_s, double top, double high, const char* colour) {
    out_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
        x(from_s), y_ + top, std::max(1.0, x(to_s) - x(from_s)), high, colour);
  }
  void text(double at_s, double low, const std::string& text, const char* colour) {
    const bool at_the_end = x(at_s) > kNames + 0.85 * kPlot;
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\"{}>{}</text>\n",
                        x(at_s) + (at_the_end ? -3 : 3), y_ + low, colour,
                        at_the_end ? " text-anchor=\"end\"" : "", base::markup_text(text));
  }
  void next(double high) { y_ += high + 10; }
  // The axis below all, and the whole picture.
  std::string finish() {
    const double rough = seconds_ / 8, power = std::pow(10, std::floor(std::log10(rough)));
    const double whole = rough / power;
    const double step = power * (whole < 1.5 ? 1 : whole < 3.5 ? 2 : whole < 7.5 ? 5 : 10);
    std::string grid;  // below the curves
    for (int n = 0; n * step <= seconds_ * (1 + 1e-9); ++n)
      grid += fmt::format(
          "<path d=\"M{0:.1f} 4V{1:.1f}\" stroke=\"#e4e4e4\"/><text x=\"{0:.1f}\" y=\"{2:.1f}\" "
          "text-anchor=\"middle\">{3:g}</text>\n",
          x(n * step), y_, y_ + 12, n * step);
    out_ += fmt::format("<text x=\"{:.0f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                        kNames - 26, y_ + 12, base::markup_text(word(Word::report_line_seconds)));
    return fmt::format(
               "<svg class=\"line\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
               "{1:.0f}\" font-family=\"sans-serif\" font-size=\"11\" fill=\"#222\">\n",
               kWide, y_ + 18) +
           grid + out_ + "</svg>\n";
  }

 private:
  double seconds_, y_ = 8;
  std::string out_;
};

// A round number not below the largest value.
double top_of(const std::vector<float>& values) {
  double most = 1;
  for (const float value : values)
    if (!std::isnan(value)) most = std::max(most, static_cast<double>(value));
  return std::ceil(most);
}

const char* colour_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "#00694c";
    case Tone::bad:
      return "#b04a00";
    case Tone::open:
      return "#0060a0";
    case Tone::none:
      return "#666";
  }
  return "#666";
}

// Neighbouring parts of one kind become one bar.
template <class Kind, class Draw>
void runs(const ReportLine& line, const Kind& kind, const Draw& draw) {
  const std::size_t parts = line.cutting.size();
  const double each = line.seconds / static_cast<double>(std::max<std::size_t>(1, parts));
  for (std::size_t n = 0; n < parts;) {
    std::size_t end = n + 1;
    while (end < parts && kind(end) == kind(n)) ++end;
    draw(n, each * static_cast<double>(n), each * static_cast<double>(end));
    n = end;
  }
}

}  // namespace

std::string svg_of(const ReportLine& line, double seconds) {
  Strip strip(seconds);
  const double most = top_of(line.force_n);
  strip.name(Word::report_line_force, 56);
  strip.curve(line, line.force_n, most, 56, "#b04a00", {0, most});
  // a case without anything to spare has no distances
  if (std::any_of(line.nearest_mm.begin(), line.nearest_mm.end(),
                  [](float mm) { return !std::isnan(mm); })) {
    strip.name(Word::report_line_nearest, 56);
    strip.curve(line, line.nearest_mm, kFarthestMm, 56, "#0060a0", {0, 2, kFarthestMm});
  }

  strip.name(Word::report_line_burr, 12);
  const auto burr = [&](std::size_t n) {
    const float size = line.diameter_mm[n];
    return std::pair(std::isnan(size) ? 0.F : size, bool(line.diamond[n]));
  };
  runs(line, burr, [&](std::size_t n, double from_s, double to_s) {
    if (burr(n).first <= 0) return;
    strip.bar(from_s, to_s, burr(n).second ? 2 : 5, burr(n).second ? 8 : 2, "#666");
    if (to_s - from_s > 0.03 * seconds)
      strip.text(from_s, burr(n).second ? 0 : 3, fmt::format("{:.2g}", burr(n).first), "#222");
  });
  strip.next(14);
  strip.name(Word::report_line_cutting, 8);
  runs(
      line, [&](std::size_t n) { return bool(line.cutting[n]); },
      [&](std::size_t n, double from_s, double to_s) {
        if (line.cutting[n]) strip.bar(from_s, to_s, 0, 8, "#888");
      });
  strip.next(8);
  if (!line.steps.empty()) {
    strip.name(Word::report_line_steps, 12);
    for (const ReportLine::Span& step : line.steps) {
      strip.bar(step.from_s, step.to_s, 0, 12, "#cfe3d8");
      strip.text(step.from_s, 10, step.name, "#222");
      strip.next(4);
    }
    strip.next(2);
  }
  if (!line.events.empty()) {
    strip.name(Word::report_line_events, 12);
    double free_s = -1;  // where the next text has room
    for (const ReportLine::Event& event : line.events) {
      strip.bar(event.at_s, event.at_s, 0, 14, colour_of(event.tone));
      if (event.at_s < free_s) continue;
      strip.text(event.at_s, 11, event.word, colour_of(event.tone));
      free_s = event.at_s + 0.12 * seconds;
    }
    strip.next(14);
  }
  return strip.finish();
}

}  // namespace burr::report
