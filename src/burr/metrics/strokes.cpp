#include "burr/metrics/strokes.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "burr/math/sums.h"
#include "burr/metrics/median.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using Piece = std::span<const TrackSample>;

constexpr std::size_t kArm = 8;        // k [samples]
constexpr double kLeastArm = 0.15e-3;  // [m]
constexpr double kLeastTime = 60e-3, kLeastWay = 0.5e-3;
constexpr std::size_t kLost = 10;  // samples: 0.1 s

// The k-cosine; 1 where there is no corner to look for.
double cosine_at(const Piece& piece, std::size_t n) {
  if (n < kArm || n + kArm >= piece.size()) return 1;
  const Vec3 u = piece[n].p - piece[n - kArm].p, v = piece[n + kArm].p - piece[n].p;
  const double a = math::norm(u), b = math::norm(v);
  return a > kLeastArm && b > kLeastArm ? math::dot(u, v) / (a * b) : 1;
}

// A stroke may go on from sample n - 1 to n.
bool goes_on(const TrackSample& before, const TrackSample& now) {
  return before.turning == now.turning && before.mode == now.mode;
}

void add(const Piece& part, std::vector<BurrStroke>& strokes) {
  if (part.size() < 2) return;
  BurrStroke stroke;
  stroke.begin = part.front().t;
  stroke.end = part.back().t;
  stroke.from = part.front().p;
  stroke.to = part.back().p;
  stroke.radius = part.back().radius;
  for (std::size_t n = 0; n < part.size(); ++n) {
    if (n > 0) stroke.length += math::norm(part[n].p - part[n - 1].p);
    stroke.d = std::fmin(stroke.d, part[n].d);  // of a number and none it takes the number
  }
  if (stroke.seconds() >= kLeastTime && stroke.length >= kLeastWay) strokes.push_back(stroke);
}

// Of a stretch in contact: divides it at its corners.
void divide(const Piece& stretch, std::vector<BurrStroke>& strokes) {
  std::size_t begin = 0;
  double before = cosine_at(stretch, 0), now = before;
  for (std::size_t n = 1; n + 1 < stretch.size(); ++n) {
    const double after = cosine_at(stretch, n + 1);
    if (n == 1) now = cosine_at(stretch, 1);
    if (now < 0 && now <= before && now < after) {
      add(stretch.subspan(begin, n + 1 - begin), strokes);
      begin = n;
    }
    before = now;
    now = after;
  }
  add(stretch.subspan(begin), strokes);
}

}  // namespace

double BurrStroke::straightness() const {
  return length > 0 ? std::min(1.0, math::norm(to - from) / length) : 1;
}

std::vector<BurrStroke> strokes_of(const Track& track) {
  std::vector<BurrStroke> strokes;
  track.for_each_piece([&](const Piece& piece) {
    std::size_t begin = 0, last = 0;  // of the stretch, and its last sample in contact
    bool open = false;
    for (std::size_t n = 0; n < piece.size(); ++n) {
      const bool in_contact = piece[n].touching && piece[n].turning;
      if (open && (n - last > kLost || !goes_on(piece[n - 1], piece[n]))) {
        divide(piece.subspan(begin, last + 1 - begin), strokes);
        open = false;
      }
      if (!in_contact) continue;
      if (!open) begin = n;
      open = true;
      last = n;
    }
    if (open) divide(piece.subspan(begin, last + 1 - begin), strokes);
  });
  return strokes;
}

Assessed<StrokeFigures> figures_of(const std::vector<BurrStroke>& strokes) {
  StrokeFigures out;
  std::vector<double> seconds, lengths;
  double all = 0, brief = 0, curved = 0;
  for (const BurrStroke& one : strokes) {
    seconds.push_back(one.seconds());
    lengths.push_back(one.length);
    all += one.seconds();
    if (one.seconds() < kShortStroke) ++brief;
    if (one.straightness() < kCurved) ++curved;
  }
  if (seconds.size() < 5) return NotAssessable{"fewer than five strokes"};
  out.count = seconds.size();
  const auto count = static_cast<double>(out.count);
  out.rate = count / all;
  out.short_share = brief / count;
  out.curved_share = curved / count;
  out.median_seconds = median(std::move(seconds));
  out.median_length = median(std::move(lengths));
  return out;
}

Assessed<StrokeFigures> figures_of(const std::vector<BurrStroke>& strokes, double from, double to) {
  std::vector<BurrStroke> within;
  bool known = strokes.empty();
  for (const BurrStroke& one : strokes) {
    known = known || !std::isnan(one.d);
    if (one.d >= from && one.d <= to) within.push_back(one);
  }
  if (!known) return NotAssessable{kNoStrokeDistance};
  return figures_of(within);
}

}  // namespace burr::metrics
