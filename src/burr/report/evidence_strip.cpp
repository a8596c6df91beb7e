#include "burr/report/evidence_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/markup.h"
#include "burr/metrics/region.h"
#include "burr/metrics/stroke_direction.h"
#include "burr/metrics/tube_course.h"
#include "burr/report/report_words.h"
#include "burr/words/words.h"

namespace burr::report {

using words::say;
using words::Word;
using words::word;

namespace {

using metrics::TrackSample;
using scoring::Outcome;

constexpr std::size_t kParts = 180;   // of the line: what a strip shows apart
constexpr double kThere = 2e-3;       // from the burr's surface to what was measured [m]
constexpr double kBesideNear = 2e-3;  // as metrics/near.h has them for restraint [m]
constexpr double kBesideFar = 4e-3;

double seconds_of(const Scored& scored) {
  const auto& samples = scored.score.shown.track.samples;
  const double last = samples.empty() ? 0 : samples.back().t;
  return scored.judged.player ? std::max(last, scored.judged.player->seconds()) : last;
}

// Samples become parts of the line: good, bad, neutral, or none; of several in one part the bad one
// is shown first, then the neutral one. Neighbours of one kind become one span.
using Judge = std::function<Tone(const TrackSample& sample)>;
std::vector<ReportStrip::Span> spans_of(const Scored& scored, double seconds, std::size_t per_part,
                                        const Judge& judge) {
  std::vector<Tone> parts(kParts, Tone::none);
  std::vector<std::size_t> seen(kParts, 0);
  const auto rank = [](Tone tone) {
    return tone == Tone::bad ? 3 : tone == Tone::open ? 2 : tone == Tone::good ? 1 : 0;
  };
  for (const TrackSample& sample : scored.score.shown.track.samples) {
    const double share = seconds > 0 ? sample.t / seconds : 0;
    const auto at =
        std::min(kParts - 1, static_cast<std::size_t>(std::max(0.0, share * double{kParts})));
    if (seen[at] >= per_part) continue;
    const Tone tone = judge(sample);
    if (tone == Tone::none) continue;
    ++seen[at];
    if (rank(tone) > rank(parts[at])) parts[at] = tone;
  }
  std::vector<ReportStrip::Span> spans;
  const double each = seconds / double{kParts};
  for (std::size_t n = 0; n < kParts;) {
    std::size_t end = n + 1;
    while (end < kParts && parts[end] == parts[n]) ++end;
    if (parts[n] != Tone::none)
      spans.push_back(
          {each * static_cast<double>(n), each * static_cast<double>(end), parts[n], ""});
    n = end;
  }
  return spans;
}

// Every sample counts.
std::vector<ReportStrip::Span> all_spans(const Scored& scored, double seconds, const Judge& judge) {
  return spans_of(scored, seconds, std::numeric_limits<std::size_t>::max(), judge);
}

ReportStrip burr_strip(const Scored& scored, double seconds) {
  return {seconds,
          all_spans(scored, seconds,
                    [](const TrackSample& one) {
                      if (!one.cutting() || !(one.d < scoring::kNearCut)) return Tone::none;
                      return one.diamond || one.radius <= scoring::kSmallBurr + 1e-9 ? Tone::good
                                                                                     : Tone::bad;
                    }),
          word(Word::strip_burr)};
}

ReportStrip coolant_strip(const Scored& scored, double seconds) {
  return {seconds,
          all_spans(scored, seconds,
                    [](const TrackSample& one) {
                      if (!one.cutting()) return Tone::none;
                      return one.irrigated ? Tone::good : Tone::bad;
                    }),
          word(Word::strip_coolant)};
}

ReportStrip restraint_strip(const Scored& scored, const scoring::Item& item, double seconds) {
  double sum = 0, count = 0;
  for (const TrackSample& one : scored.score.shown.track.samples)
    if (one.touching && one.d > kBesideFar) {
      sum += one.force;
      ++count;
    }
  const double most = count > 0 ? item.limit("most") * sum / count : 0;
  return {seconds,
          all_spans(scored, seconds,
                    [most](const TrackSample& one) {
                      if (!one.touching || !(one.d < kBesideNear)) return Tone::none;
                      return most <= 0 ? Tone::open : one.force <= most ? Tone::good : Tone::bad;
                    }),
          say(Word::strip_restraint, most)};
}

using StrokeJudge = std::function<Tone(const metrics::BurrStroke& stroke)>;
ReportStrip stroke_strip(const Scored& scored, double seconds, const StrokeJudge& judge,
                         std::string caption) {
  ReportStrip strip{seconds, {}, std::move(caption)};
  for (const metrics::BurrStroke& stroke : scored.score.shown.strokes) {
    const Tone tone = judge(stroke);
    if (tone == Tone::none) continue;
    // thousands of strokes are a page of their own: those of one part of the line are one bar
    if (!strip.spans.empty() && strip.spans.back().tone == tone &&
        stroke.begin - strip.spans.back().to_s < seconds / double{kParts})
      strip.spans.back().to_s = stroke.end;
    else
      strip.spans.push_back({stroke.begin, stroke.end, tone, ""});
  }
  return strip;
}

ReportStrip strokes_strip(const Scored& scored, const scoring::Item& item, double seconds) {
  const double from = item.limit("from_mm"), least = item.limit("least_mm");
  return stroke_strip(
      scored, seconds,
      [from, least](const metrics::BurrStroke& stroke) {
        if (from > 0 && !(stroke.d >= from)) return Tone::none;
        return stroke.length >= least ? Tone::good : Tone::bad;
      },
      say(Word::strip_strokes, 1e3 * least));
}

ReportStrip direction_strip(const Scored& scored, const scoring::Item& item, double seconds) {
  const scenario::Landmark* curve = scored.judged.lesson.landmark(item.along);
  const metrics::Course course{curve != nullptr ? curve->points : std::vector<math::Vec3>{}};
  return stroke_strip(
      scored, seconds,
      [&course](const metrics::BurrStroke& stroke) {
        const auto cosine = metrics::along(stroke, course);
        if (!cosine) return Tone::none;
        return *cosine >= metrics::kAlong ? Tone::good : Tone::bad;
      },
      word(Word::strip_along));
}

// When the burr was in a region, or near the spots or the place that the measure looked at.
ReportStrip place_strip(const Scored& scored, const scoring::Item& item, const Outcome& outcome,
                        double seconds) {
  const std::string_view how = item.how->name;
  const bool adds = how == "filled" || how == "filled_beside";
  const auto& regions = scored.score.shown.regions;
  const auto region = regions.find(item.region);
  std::vector<math::Vec3> places;
  constexpr std::size_t kMost = 150;
  for (std::size_t n = 0; n < outcome.spots.size(); n += outcome.spots.size() / kMost + 1)
    places.push_back(outcome.spots[n].at);
  if (places.empty() && outcome.place) places.push_back(*outcome.place);
  const auto there = [&](const TrackSample& one) {
    if (region != regions.end() && region->second) return region->second(one.raw) > -one.radius;
    const double reach = one.radius + kThere;
    return std::any_of(places.begin(), places.end(), [&](const math::Vec3& place) {
      return (one.raw - place).squaredNorm() < reach * reach;
    });
  };
  ReportStrip strip{seconds, {}, word(adds ? Word::strip_added : Word::strip_cut)};
  strip.spans = spans_of(scored, seconds, 4, [&](const TrackSample& one) {
    const bool works =
        adds ? one.mode == tool::Mode::add && one.turning && one.touching : one.cutting();
    if (!works || !there(one)) return Tone::none;
    return how == "kept" ? Tone::bad : Tone::open;
  });
  if (strip.spans.empty()) strip.caption = word(adds ? Word::strip_never_added : Word::strip_never);
  return strip;
}

// The moment of the evidence; or when the burr was nearest.
ReportStrip safety_strip(const Scored& scored, const scoring::Item& item, const Outcome& outcome,
                         double seconds) {
  ReportStrip strip{seconds, {}, word(Word::strip_far)};
  if (outcome.tick && scored.judged.player) {
    const double t = static_cast<double>(*outcome.tick) / scored.judged.player->info().rate_hz;
    const bool met = outcome.verdict == scoring::Verdict::met;
    strip.spans.push_back({t, t, met ? Tone::open : Tone::bad, ""});
    strip.caption = say(Word::strip_moment, t);
    return strip;
  }
  if (outcome.place) return place_strip(scored, item, outcome, seconds);
  for (const metrics::NearnessOf& one : scored.score.shown.nearness) {
    if (one.name != item.structure || !one.found || !std::isfinite(one.found->least)) continue;
    strip.spans.push_back({one.found->least_at, one.found->least_at, Tone::open, ""});
    // a distance below 0 is within its error of half a voxel here: the item says whether it was entered
    strip.caption =
        say(Word::strip_near, std::max(0.0, 1e3 * one.found->least), one.found->least_at);
  }
  return strip;
}

ReportStrip order_strip(const Scored& scored, double seconds) {
  ReportStrip strip{seconds, {}, word(Word::strip_order)};
  for (const scoring::DoneStep& step : scored.score.shown.steps)
    strip.spans.push_back(
        {step.t, step.t, step.early ? Tone::bad : Tone::good, std::to_string(step.number)});
  return strip;
}

// Of a figure of the whole session: its largest moment, if it has one.
ReportStrip figure_strip(const Scored& scored, std::string_view how, double seconds) {
  ReportStrip strip{seconds, {}, measure_word(how)};
  if (!scored.score.shown.figures) return strip;
  const scoring::Figures& figures = *scored.score.shown.figures;
  const auto moment = [&](double from_s, double to_s) {
    strip.spans.push_back({from_s, to_s, Tone::open, ""});
    strip.caption = say(Word::strip_moment, from_s);
  };
  if (how == "dwell" && figures.dwell)
    moment(figures.dwell->longest_at, figures.dwell->longest_at + figures.dwell->longest);
  if (how == "shaft" && figures.shaft && figures.shaft->contacts > 0)
    moment(figures.shaft->largest_at, figures.shaft->largest_at);
  if (how == "motor_load" && figures.motor && figures.motor->peak_torque > 0)
    moment(figures.motor->peak_at, figures.motor->peak_at);
  return strip;
}

ReportStrip strip_for(const Scored& scored, const scoring::Item& item, const Outcome& outcome) {
  const std::string_view how = item.how->name;
  const double seconds = seconds_of(scored);
  if (how == "burr_choice") return burr_strip(scored, seconds);
  if (how == "coolant") return coolant_strip(scored, seconds);
  if (how == "restraint") return restraint_strip(scored, item, seconds);
  if (how == "strokes") return strokes_strip(scored, item, seconds);
  if (how == "stroke_direction") return direction_strip(scored, item, seconds);
  if (how == "order") return order_strip(scored, seconds);
  if (how == "intact_soft" || how == "intact_solid" || how == "untouched")
    return safety_strip(scored, item, outcome, seconds);
  if (how == "economy" || how == "reaction" || how == "shaft" || how == "dwell" ||
      how == "motor_load")
    return figure_strip(scored, how, seconds);
  return place_strip(scored, item, outcome, seconds);
}

}  // namespace

ReportStrip strip_of(const Scored& scored, std::size_t n) {
  const Outcome& outcome = scored.score.outcomes[n];
  ReportStrip strip = strip_for(scored, scored.judged.rubric.items[n], outcome);
  strip.open = outcome.verdict == scoring::Verdict::not_assessable;
  if (strip.open) strip.caption = reason_of(scored.judged.rubric.items[n], outcome);
  return strip;
}

// A line of time, bars above, on and below it, and the caption.
std::string strip_html(const ReportStrip& strip) {
  constexpr double kWide = 180, kLine = 12, kHigh = 25;
  const double seconds = strip.seconds > 0 ? strip.seconds : 1;
  const auto x = [&](double at_s) { return kWide * std::clamp(at_s / seconds, 0.0, 1.0); };
  const std::string caption = base::markup_text(strip.caption);
  std::string html = fmt::format(
      "<figure class=\"strip{0}\"><svg width=\"{1:.0f}\" height=\"{2:.0f}\" viewBox=\"0 0 {1:.0f} "
      "{2:.0f}\" role=\"img\" aria-label=\"{3}\" font-family=\"sans-serif\" font-size=\"9\">"
      "<path d=\"M0 {4:.0f}H{1:.0f}\" stroke=\"#999\"/>",
      strip.open ? " why" : "", kWide, kHigh, caption, kLine);
  for (const ReportStrip::Span& span : strip.spans) {
    const bool good = span.tone == Tone::good, bad = span.tone == Tone::bad;
    const double top = good ? kLine - 9 : bad ? kLine : kLine - 5;
    html += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.0f}\" width=\"{:.1f}\" height=\"{:.0f}\" fill=\"{}\"/>",
        std::min(x(span.from_s), kWide - 1), top, std::max(1.0, x(span.to_s) - x(span.from_s)),
        good || bad ? 9.0 : 10.0,
        good  ? "#00694c"
        : bad ? "#b04a00"
              : "#0060a0");
    if (!span.name.empty())
      html += fmt::format(
          "<text x=\"{:.1f}\" y=\"{:.0f}\"{}>{}</text>",
          x(span.to_s) + (x(span.to_s) > kWide - 14 ? -2 : 2), bad ? kLine + 10 : kLine - 2,
          x(span.to_s) > kWide - 14 ? " text-anchor=\"end\"" : "", base::markup_text(span.name));
  }
  return html + fmt::format("</svg><figcaption>{}</figcaption></figure>\n", caption);
}

}  // namespace burr::report
