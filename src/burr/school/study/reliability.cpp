#include "burr/school/study/reliability.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "burr/people/random_stream.h"
#include "burr/school/study/resample.h"

namespace burr::school::study {
namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Component component(double sum_of_squares, int freedom) {
  Component out;
  out.freedom = freedom;
  out.mean_square = freedom > 0 ? sum_of_squares / freedom : 0;
  return out;
}

void estimate(Component& of, double raw) {
  of.raw = raw;
  of.variance = std::max(0.0, raw);
}

double square(double x) { return x * x; }

// What does not change from sample to sample: the means of each person.
struct Means {
  std::vector<double> of_person;
  std::vector<std::vector<double>> of_both;  // (person, bone)
  std::vector<std::vector<double>> shared;   // each mark over the number of persons
  int persons = 0;

  explicit Means(const Balanced& marks) : persons(static_cast<int>(marks.values.size())) {
    const auto no = static_cast<std::size_t>(marks.occasions);
    for (const std::vector<double>& row : marks.values) {
      of_person.push_back(mean(row));
      std::vector<double>& both = of_both.emplace_back(static_cast<std::size_t>(marks.bones));
      std::vector<double>& share = shared.emplace_back();
      for (std::size_t n = 0; n < row.size(); ++n) {
        share.push_back(row[n] / persons);
        both[n / no] += row[n] / marks.occasions;
      }
    }
  }
};

// which: the numbers of the persons, each as often as it counts.
Reliability reliability_of(const Balanced& marks, const Means& means,
                           const std::vector<std::size_t>& which) {
  const int np = means.persons, nb = marks.bones, no = marks.occasions;
  const auto occasions = static_cast<std::size_t>(no);
  Reliability out;
  out.persons = np;
  out.bones = nb;
  out.occasions = no;
  std::vector<double> of_occasion(static_cast<std::size_t>(nb * no)),
      of_bone(static_cast<std::size_t>(nb));
  double all = 0;
  for (const std::size_t q : which) {
    all += means.of_person[q];
    for (std::size_t n = 0; n < of_occasion.size(); ++n) of_occasion[n] += means.shared[q][n];
  }
  all /= np;
  for (std::size_t n = 0; n < of_occasion.size(); ++n)
    of_bone[n / occasions] += of_occasion[n] / no;
  double p = 0, b = 0, o = 0, pb = 0, rest = 0;
  for (const double x : of_bone) b += np * no * square(x - all);
  for (std::size_t n = 0; n < of_occasion.size(); ++n)
    o += np * square(of_occasion[n] - of_bone[n / occasions]);
  for (const std::size_t q : which) {
    const std::vector<double>& both = means.of_both[q];
    p += nb * no * square(means.of_person[q] - all);
    for (std::size_t k = 0; k < of_bone.size(); ++k)
      pb += no * square(both[k] - means.of_person[q] - of_bone[k] + all);
    for (std::size_t n = 0; n < of_occasion.size(); ++n) {
      const std::size_t k = n / occasions;
      rest += square(marks.values[q][n] - both[k] - of_occasion[n] + of_bone[k]);
    }
  }
  out.person = component(p, np - 1);
  out.bone = component(b, nb - 1);
  out.occasion = component(o, nb * (no - 1));
  out.person_bone = component(pb, (np - 1) * (nb - 1));
  out.residual = component(rest, (np - 1) * nb * (no - 1));
  const double ms_p = out.person.mean_square, ms_b = out.bone.mean_square,
               ms_o = out.occasion.mean_square, ms_pb = out.person_bone.mean_square,
               ms_r = out.residual.mean_square;
  estimate(out.residual, ms_r);
  estimate(out.occasion, (ms_o - ms_r) / np);
  if (nb > 1) {
    estimate(out.person_bone, (ms_pb - ms_r) / no);
    estimate(out.bone, (ms_b - ms_o - ms_pb + ms_r) / (np * no));
    estimate(out.person, (ms_p - ms_pb) / (nb * no));
  } else {
    estimate(out.person, (ms_p - ms_r) / no);
  }
  return out;
}

}  // namespace

Result<Balanced> balance(const std::vector<Mark>& marks, int occasions, bool with_bones) {
  if (occasions < 2)
    return error(Trouble::usage, "reliability needs at least 2 marks of each person");
  std::vector<std::string> persons, bones;
  std::map<std::string, std::map<std::string, std::vector<double>>> of;
  for (const Mark& mark : marks) {
    const std::string bone = with_bones ? mark.bone : std::string();
    if (std::find(persons.begin(), persons.end(), mark.person) == persons.end())
      persons.push_back(mark.person);
    if (std::find(bones.begin(), bones.end(), bone) == bones.end()) bones.push_back(bone);
    of[mark.person][bone].push_back(mark.value);
  }
  Balanced out;
  out.bones = static_cast<int>(bones.size());
  out.occasions = occasions;
  for (const std::string& person : persons) {
    std::vector<double> row;
    for (const std::string& bone : bones) {
      const std::vector<double>& all = of[person][bone];
      if (static_cast<int>(all.size()) >= occasions)
        row.insert(row.end(), all.end() - occasions, all.end());
    }
    if (static_cast<int>(row.size()) != out.bones * occasions) {
      ++out.left_out;
      continue;
    }
    out.persons.push_back(person);
    out.values.push_back(std::move(row));
  }
  if (out.persons.size() < 2)
    return error(fmt::format(
        "reliability needs 2 persons with {} marks{}; there {}", occasions,
        with_bones && out.bones > 1 ? fmt::format(" on each of {} bones", out.bones) : "",
        out.persons.empty() ? "are none" : "is one"));
  return out;
}

Reliability reliability(const Balanced& marks) {
  std::vector<std::size_t> everybody(marks.values.size());
  std::iota(everybody.begin(), everybody.end(), std::size_t{0});
  return reliability_of(marks, Means(marks), everybody);
}

double Reliability::g(int of_occasions, int of_bones) const {
  const double error = square(standard_error(of_occasions, of_bones));
  return person.variance > 0 ? person.variance / (person.variance + error) : 0;
}

double Reliability::phi(int of_occasions, int of_bones) const {
  const double error = (bone.variance + person_bone.variance) / of_bones +
                       (occasion.variance + residual.variance) / (of_bones * of_occasions);
  return person.variance > 0 ? person.variance / (person.variance + error) : 0;
}

double Reliability::standard_error(int of_occasions, int of_bones) const {
  return std::sqrt(person_bone.variance / of_bones + residual.variance / (of_bones * of_occasions));
}

std::optional<int> Reliability::enough(double aim, int of_bones) const {
  for (int n = 1; n <= 100; ++n)
    if (g(n, of_bones) > aim) return n;
  return std::nullopt;
}

Interval interval_of_g(const Balanced& marks, int of_occasions, int draws, std::uint64_t seed) {
  const Means means(marks);
  std::vector<std::size_t> which(marks.values.size());
  return resampled(draws, seed, [&](people::RandomStream& random) -> std::optional<double> {
    for (std::size_t& one : which) one = static_cast<std::size_t>(random.below(means.persons));
    return reliability_of(marks, means, which).g(of_occasions, marks.bones);
  });
}

}  // namespace burr::school::study
