// scoring/outcome.h - the answer to one item of a rubric, and the arithmetic on many.
//
//     total = 100 * sum(weight * credit) / sum(weight of the assessable)
//
// credit: 1 for a met item, 0 for an unmet one; of a graded item what credit_of() says.
//
// Product and process are never added. There is no total when more than a fifth of the weight is not
// assessable. A gate that is not met does not change the total. A gate is what people read as an item of
// safety. Thread: any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/scoring/measure_list.h"
#include "burr/scoring/rubric.h"

namespace burr::scoring {

enum class Verdict { met, unmet, not_assessable };
// For machines: "met", "unmet", "not assessable". People read the words of Standing.
[[nodiscard]] const char* word_of(Verdict verdict);

// A place that an item looked at, for a picture.
struct Spot {
  enum class Kind {
    good,  // as it should be: thin bone, an even layer
    left,  // bone that is too much there
    bare,  // bone that is missing there
  };
  math::Vec3 at = math::Vec3::Zero();  // world, LPS [m]
  Kind kind = Kind::good;
};
inline constexpr std::size_t kMostSpots = 1200;  // of one item

struct Outcome {
  std::string id;
  Verdict verdict = Verdict::not_assessable;
  // Within the error of its threshold: a person should look. The verdict counts all the same.
  bool borderline = false;
  // False: it is as it should be only because little was done; it is unmet then.
  bool earned = true;
  // Why it is not assessable; or why it is unmet though its value would do; otherwise empty.
  std::string reason;

  // The number that decided, if there is one: what it is, in SI.
  std::string what;  // "share under at most that much bone"
  Quantity quantity = Quantity::share;
  bool at_least = true;  // met: value >= threshold; false: value <= threshold
  std::optional<double> value;
  double threshold = 0, error = 0;

  // Workpiece, where there is one.
  std::optional<math::Vec3> place;    // world, LPS [m]
  std::optional<std::uint64_t> tick;  // of the recording
  std::vector<Spot> spots;            // at most kMostSpots; the bare ones are kept first
};

// What people are told. There are three outcomes; the fourth says that there is none.
enum class Standing {
  met,
  not_met,
  too_early,  // nothing is wrong, and too little was done to say more
  not_assessable,
};
[[nodiscard]] Standing standing_of(const Outcome& outcome);
// "met", "not met", "too early to say", "not assessable"
[[nodiscard]] const char* word_of(Standing standing);

// True: the work did harm there. It is not met, and it judges what must stay as it was: a gate, or an
// item whose measure does (Measure::guards).
[[nodiscard]] bool did_harm(const Item& item, const Outcome& outcome);

struct Total {
  std::optional<double> points;  // 0..100; none: too little is assessable
  // too_early: of the assessable; they earn nothing yet
  std::size_t met = 0, too_early = 0, assessable = 0, items = 0;
  double not_assessable = 0;  // share of the weight
};
inline constexpr double kMostUnknown = 0.2;  // share of the weight that may be not assessable

// 0..1: what an assessable item earns. A graded item that is not earned, or unmet because of what it
// requires, earns nothing.
[[nodiscard]] double credit_of(const Item& item, const Outcome& outcome);

// outcomes: one for each item of the rubric, in its order, here and below.
[[nodiscard]] Total total_of(const Rubric& rubric, std::span<const Outcome> outcomes, Part part);

// The numbers of the items of a part: what did harm comes first, the others as in the rubric.
[[nodiscard]] std::vector<std::size_t> in_order(const Rubric& rubric,
                                                std::span<const Outcome> outcomes, Part part);

// `requires`: a met item becomes what its required item is: unmet, not earned, or not assessable. Follows
// `requires` of the required item first. The rubric must have no circle.
void apply_requires(const Rubric& rubric, std::span<Outcome> outcomes);

}  // namespace burr::scoring
