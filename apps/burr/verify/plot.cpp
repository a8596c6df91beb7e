// Draws curves over axes with units, ticks and a legend, as SVG.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "burr/base/markup.h"
#include "page.h"

namespace burr::app {
namespace {

constexpr double kWide = 520, kHigh = 330;  // size of one pair of axes  [px]
constexpr double kLeft = 62, kRight = 12, kTop = 30, kBottom = 46;
constexpr std::size_t kMostPoints = 1200;  // of a curve; more are not visible
// colours of K. Okabe and M. Ito, which colour-blind people can distinguish
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000"};

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool log = false;
  void take(double value) {
    if (!std::isfinite(value) || (log && value <= 0)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void settle() {
    if (!(low <= high)) {
      low = log ? 1 : 0;
      high = log ? 10 : 1;
    }
    if (log) {
      low = std::pow(10, std::floor(std::log10(low)));
      high = std::pow(10, std::ceil(std::log10(high)));
      if (high <= low) high = 10 * low;
      return;
    }
    if (high - low < 1e-12 * std::max(1.0, std::abs(high))) {
      const double half = std::max(1e-9, 0.05 * std::abs(high));
      low -= half;
      high += half;
    }
    const double air = 0.04 * (high - low);
    low -= air;
    high += air;
  }
  [[nodiscard]] double share(double value) const {
    return log ? std::log10(value / low) / std::log10(high / low) : (value - low) / (high - low);
  }
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> all;
    if (log) {
      for (double at = low; at <= high * 1.0001; at *= 10) all.push_back(at);
      return all;
    }
    const double rough = (high - low) / 5, scale = std::pow(10, std::floor(std::log10(rough)));
    const double whole = rough / scale;
    const double step = scale * (whole < 1.5 ? 1 : whole < 3.5 ? 2 : whole < 7.5 ? 5 : 10);
    for (double at = std::ceil(low / step) * step; at <= high; at += step)
      all.push_back(std::abs(at) < 1e-9 * step ? 0 : at);
    return all;
  }
};

std::string axes_svg(const Axes& axes, double x0, double y0) {
  Range x, y;
  x.log = axes.log_x;
  y.log = axes.log_y;
  for (const Line& line : axes.lines) {
    for (const double value : line.x) x.take(value);
    for (const double value : line.y) y.take(value);
  }
  x.settle();
  y.settle();
  const double wide = kWide - kLeft - kRight, high = kHigh - kTop - kBottom;
  const double left = x0 + kLeft, top = y0 + kTop;
  const auto px = [&](double value) { return left + wide * x.share(value); };
  const auto py = [&](double value) { return top + high * (1 - y.share(value)); };
  std::string out = fmt::format(
      "<text x=\"{:.0f}\" y=\"{:.0f}\" font-weight=\"bold\">{}</text>\n"
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#888\"/>\n",
      left, y0 + 18, base::markup_text(axes.title), left, top, wide, high);
  for (const double at : x.ticks())
    out += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}v{2:.1f}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3:.1f}\" "
        "text-anchor=\"middle\">{4:.4g}</text>\n",
        px(at), top, high, top + high + 15, at);
  for (const double at : y.ticks())
    out += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}h{2:.1f}\" stroke=\"#ddd\"/><text x=\"{3:.1f}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:.4g}</text>\n",
        left, py(at), wide, left - 5, py(at) + 4, at);
  out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>\n",
                     left + wide / 2, top + high + 34, base::markup_text(axes.x));
  out += fmt::format(
      "<text transform=\"translate({:.0f} {:.0f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
      x0 + 13, top + high / 2, base::markup_text(axes.y));
  for (std::size_t n = 0; n < axes.lines.size(); ++n) {
    const Line& line = axes.lines[n];
    const char* colour = kColours[n % kColours.size()];
    std::string points;
    const std::size_t count = std::min(line.x.size(), line.y.size());
    const std::size_t step = line.dots ? 1 : std::max<std::size_t>(1, count / kMostPoints);
    bool pen_down = false;
    for (std::size_t i = 0; i < count; i += step) {
      const bool there = std::isfinite(line.x[i]) && std::isfinite(line.y[i]) &&
                         (!x.log || line.x[i] > 0) && (!y.log || line.y[i] > 0);
      if (there && line.dots)
        out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n",
                           px(line.x[i]), py(line.y[i]), colour);
      if (there)
        points +=
            fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", px(line.x[i]), py(line.y[i]));
      pen_down = there;
    }
    const char* dash = line.dashed ? " stroke-dasharray=\"6 4\"" : "";
    if (!line.dots)
      out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"{}/>\n",
                         points, colour, dash);
    if (line.legend.empty()) continue;
    const double at = top + 14 + 15 * static_cast<double>(n);
    out += fmt::format(
        "<path d=\"M{0:.0f} {1:.0f}h22\" stroke=\"{2}\" stroke-width=\"2\"{3}/><text x=\"{4:.0f}\" "
        "y=\"{5:.0f}\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\">{6}</text>\n",
        left + 8, at, colour, dash, left + 36, at + 4, base::markup_text(line.legend));
  }
  return out;
}

}  // namespace

std::string svg(const Plot& plot) {
  const auto columns = static_cast<std::size_t>(std::max(1, plot.columns));
  const std::size_t rows = (plot.axes.size() + columns - 1) / columns;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 "
      "0 "
      "{0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n",
      kWide * static_cast<double>(columns), kHigh * static_cast<double>(rows));
  for (std::size_t n = 0; n < plot.axes.size(); ++n)
    out += axes_svg(plot.axes[n], kWide * static_cast<double>(n % columns),
                    kHigh * static_cast<double>(n / columns));
  return out + "</svg>";
}

}  // namespace burr::app
