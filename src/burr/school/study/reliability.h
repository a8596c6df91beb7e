// school/study/reliability.h - how far a mark would be the same on another day, and on another bone: generalisability.
//
// Persons x occasions (Brennan, Generalizability Theory, 2001, chapter 2): with n_p persons and n_o occasions and the
// mean squares of a two-way analysis of variance without replication
//
//     s2_po = MS_po     s2_p = (MS_p - MS_po) / n_o     s2_o = (MS_o - MS_po) / n_p
//     G(n) = s2_p / (s2_p + s2_po / n)                  for ranking persons
//     Phi(n) = s2_p / (s2_p + (s2_o + s2_po) / n)       for a mark against a fixed standard
//
// With at least two bones, persons x (occasions within bones) (the same book, chapter 3): further components s2_b of
// the bone and s2_pb of person and bone; with m bones and n occasions on each
//
//     G = s2_p / (s2_p + s2_pb / m + s2_po / (m n))
//     Phi = s2_p / (s2_p + (s2_b + s2_pb) / m + (s2_o + s2_po) / (m n))
//
// A component below 0 is an estimate of one that is small: it counts as 0, and `raw` keeps it. The standard error of a
// mean of n marks is sqrt(s2_po / n), with bones sqrt(s2_pb / m + s2_po / (m n)). Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/study/interval.h"

namespace burr::school::study {

struct Mark {
  std::string person;
  std::string bone;  // empty: not distinguished
  double value = 0;
};

// Marks of n_p persons, each with `bones` x `occasions` of them: values[person][bone * occasions + occasion].
struct Balanced {
  int bones = 1, occasions = 0;
  std::vector<std::string> persons;
  std::vector<std::vector<double>> values;
  int left_out = 0;  // persons with too few marks
};

// Takes the last `occasions` marks of each person (with_bones: on each bone that somebody worked on); marks stand in the
// order in which they were earned. Error: fewer than 2 persons or occasions remain.
[[nodiscard]] Result<Balanced> balance(const std::vector<Mark>& marks, int occasions,
                                       bool with_bones);

struct Component {
  double mean_square = 0;
  int freedom = 0;
  double raw = 0;       // as estimated
  double variance = 0;  // not below 0
};

struct Reliability {
  int persons = 0, bones = 1, occasions = 0;
  Component person, bone, occasion, person_bone,
      residual;  // bone and person_bone: with at least two bones

  // of the mean of `occasions` marks on each of `bones` bones
  [[nodiscard]] double g(int of_occasions, int of_bones = 1) const;
  [[nodiscard]] double phi(int of_occasions, int of_bones = 1) const;
  [[nodiscard]] double standard_error(int of_occasions, int of_bones = 1) const;
  // the fewest marks with g() above `aim`, 1 to 100
  [[nodiscard]] std::optional<int> enough(double aim = 0.8, int of_bones = 1) const;
};

[[nodiscard]] Reliability reliability(const Balanced& marks);

// 95 % interval of g(occasions): percentiles of `draws` samples of the persons, with replacement.
[[nodiscard]] Interval interval_of_g(const Balanced& marks, int of_occasions, int draws = 2000,
                                     std::uint64_t seed = 1);

}  // namespace burr::school::study
