#include "burr/report/evidence.h"

#include <string_view>
#include <vector>

namespace burr::report {
namespace {

// The spot that is wrong and in the middle of those that are.
std::optional<math::Vec3> wrong_spot(const std::vector<scoring::Spot>& spots) {
  math::Vec3 sum = math::Vec3::Zero();
  std::size_t wrong = 0;
  for (const scoring::Spot& one : spots)
    if (one.kind != scoring::Spot::Kind::good) {
      sum += one.at;
      ++wrong;
    }
  if (wrong == 0) return std::nullopt;
  const math::Vec3 middle = sum / static_cast<double>(wrong);
  const scoring::Spot* best = nullptr;
  for (const scoring::Spot& one : spots)
    if (one.kind != scoring::Spot::Kind::good &&
        (best == nullptr || (one.at - middle).norm() < (best->at - middle).norm()))
      best = &one;
  return best->at;
}

// When the burr cut there; none: it never did.
std::optional<double> cut_there(const Scored& scored, const math::Vec3& place) {
  constexpr double kThere = 0.5e-3;  // from the surface of the burr [m]
  std::optional<double> at;
  double least = kThere;
  for (const metrics::TrackSample& one : scored.score.shown.track.samples) {
    if (!one.cutting()) continue;
    const double far = (one.raw - place).norm() - one.radius;
    if (far >= least) continue;
    least = far;
    at = one.t;
  }
  return at;
}

}  // namespace

Evidence evidence_of(const Scored& scored, std::size_t n) {
  const scoring::Outcome& outcome = scored.score.outcomes[n];
  const std::string_view measure = scored.judged.rubric.items[n].how->name;
  const bool region = measure == "removed" || measure == "kept";
  Evidence out;
  if (outcome.verdict == scoring::Verdict::not_assessable) return out;
  out.place = outcome.place;
  if (outcome.verdict == scoring::Verdict::unmet)
    if (auto spot = wrong_spot(outcome.spots)) out.place = spot;
  if (outcome.tick) {
    out.at_s = static_cast<double>(*outcome.tick) / scored.judged.player->info().rate_hz;
  } else if (out.place || region) {
    const auto cut = out.place ? cut_there(scored, *out.place) : std::nullopt;
    out.at_s = cut.value_or(scored.judged.player->seconds());
    out.at_end = !cut;
  }
  return out;
}

}  // namespace burr::report
