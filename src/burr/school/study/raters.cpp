#include "burr/school/study/raters.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>

#include "burr/base/printable.h"
#include "burr/school/study/resample.h"

namespace burr::school::study {
namespace {

constexpr int kDraws = 2000;
constexpr int kMostKept = 4096;   // products of which the samples are kept: 32 MB
constexpr double kPoints = 0.05;  // how much less the machine may agree
constexpr const char* kMachine = "machine";

// Whole numbers, so that they can be added by four in the loop over all samples.
using Four = std::array<std::uint32_t, 4>;  // both, first, second, neither

struct Counts {
  double both = 0, first = 0, second = 0, neither = 0;

  Counts() = default;
  explicit Counts(const Four& of) : both(of[0]), first(of[1]), second(of[2]), neither(of[3]) {}
  [[nodiscard]] double all() const { return both + first + second + neither; }
  [[nodiscard]] double agreement() const { return (both + neither) / all(); }
  [[nodiscard]] std::optional<double> kappa() const {
    const double n = all(), a = (both + first) / n, b = (both + second) / n;
    const double expected = a * b + (1 - a) * (1 - b);
    if (expected >= 1 - 1e-12) return std::nullopt;
    return (agreement() - expected) / (1 - expected);
  }
  [[nodiscard]] double ac1() const {
    const double q = (2 * both + first + second) / (2 * all());
    const double expected = 2 * q * (1 - q);
    return (agreement() - expected) / (1 - expected);
  }
};

// Which products each sample takes. It depends on their number alone, so it is drawn once for all items and pairs of
// raters with so many products: with 16 of each that was nearly the whole time.
class Samples {
 public:
  explicit Samples(std::uint64_t seed) : seed_(seed) {}

  // The numbers of the products of sample n; valid until the next call.
  [[nodiscard]] std::span<const std::uint32_t> of(int products, int n) {
    const auto count = static_cast<std::size_t>(products);
    if (products > kMostKept) return drawn(products, n, now_);
    std::vector<std::uint32_t>& all = kept_[products];
    if (all.empty())
      for (int sample = 0; sample < kDraws; ++sample) {
        const auto one = drawn(products, sample, now_);
        all.insert(all.end(), one.begin(), one.end());
      }
    return std::span(all).subspan(count * static_cast<std::size_t>(n), count);
  }

 private:
  std::span<const std::uint32_t> drawn(int products, int n,
                                       std::vector<std::uint32_t>& into) const {
    people::RandomStream random(seed_, static_cast<std::uint64_t>(n));
    into.clear();
    for (int k = 0; k < products; ++k)
      into.push_back(static_cast<std::uint32_t>(random.below(products)));
    return into;
  }

  std::uint64_t seed_;
  std::map<int, std::vector<std::uint32_t>> kept_;
  std::vector<std::uint32_t> now_;
};

double square(double x) { return x * x; }

Interval ends_of(std::vector<double>& values) {
  if (values.empty()) return {std::nan(""), std::nan("")};
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

Agreement agreement_of(const std::vector<std::vector<Pair>>& products, Samples& samples) {
  std::vector<Four> of_products;
  Four all = {};
  for (const std::vector<Pair>& pairs : products) {
    Four& one = of_products.emplace_back();
    for (const Pair& pair : pairs)
      ++one[pair.first ? (pair.second ? 0 : 1) : (pair.second ? 2 : 3)];
    for (std::size_t n = 0; n < 4; ++n) all[n] += one[n];
  }
  const Counts counts(all);
  Agreement out;
  out.products = static_cast<int>(products.size());
  out.marks = static_cast<int>(counts.all());
  out.agreement = counts.agreement();
  out.kappa = counts.kappa();
  out.ac1 = counts.ac1();
  out.prevalence_index = std::abs(counts.both - counts.neither) / counts.all();
  // both figures of the same samples
  std::vector<double> shares, kappas;
  for (int sample = 0; sample < kDraws; ++sample) {
    Four sum = {};
    for (const std::uint32_t n : samples.of(out.products, sample))
      for (std::size_t k = 0; k < 4; ++k) sum[k] += of_products[n][k];
    const Counts again(sum);
    shares.push_back(again.agreement());
    if (const auto kappa = again.kappa()) kappas.push_back(*kappa);
  }
  out.kappa_95 = ends_of(kappas);
  out.agreement_95 = ends_of(shares);
  return out;
}

std::string& once(std::vector<std::string>& list, const std::string& text) {
  const auto found = std::find(list.begin(), list.end(), text);
  return found == list.end() ? list.emplace_back(text) : *found;
}

// rater -> product -> item -> mark
using Marks = std::map<std::string, std::map<std::string, std::map<std::string, bool>>>;

// The marks of two raters for one item, by product; "": for all items.
std::vector<std::vector<Pair>> pairs_of(const Marks& marks, const std::string& a,
                                        const std::string& b, const std::string& item) {
  std::vector<std::vector<Pair>> out;
  for (const auto& [product, items] : marks.at(a)) {
    const auto other = marks.at(b).find(product);
    if (other == marks.at(b).end()) continue;
    std::vector<Pair> pairs;
    for (const auto& [name, met] : items)
      if (item.empty() || name == item)
        if (const auto same = other->second.find(name); same != other->second.end())
          pairs.emplace_back(met, same->second);
    if (!pairs.empty()) out.push_back(std::move(pairs));
  }
  return out;
}

// Raters with enough products for a figure; one who has just begun must not take the figures of the others away.
std::vector<std::string> settled(const Marks& marks, const std::vector<std::string>& raters) {
  std::vector<std::string> out;
  for (const std::string& rater : raters)
    if (static_cast<int>(marks.at(rater).size()) >= kFewestProducts) out.push_back(rater);
  return out;
}

// The totals of the products that every one of these raters marked in full.
std::vector<std::vector<double>> totals_of(const Marks& marks, const RaterStudy& study,
                                           const std::vector<std::string>& raters) {
  std::vector<std::vector<double>> out;
  if (raters.size() < 2) return out;
  for (const auto& [product, unused] : marks.at(raters.front())) {
    std::vector<double> row;
    for (const std::string& rater : raters) {
      const auto found = marks.at(rater).find(product);
      if (found == marks.at(rater).end() || found->second.size() != study.items.size()) break;
      double met = 0;
      for (const auto& [item, mark] : found->second) met += mark ? 1 : 0;
      row.push_back(met);
    }
    if (row.size() == raters.size()) out.push_back(std::move(row));
  }
  return out;
}

// Pairs of people, and pairs of a person and the machine, that marked this item, with the mean of their agreement.
std::vector<std::string> items_for_a_person(const RaterStudy& study) {
  std::vector<std::string> out;
  for (const std::string& item : study.items) {
    double people = 0, machine = 0;
    int of_people = 0, of_machine = 0;
    for (const ItemAgreement& pair : study.pairs) {
      if (pair.item != item) continue;
      const bool with_machine = pair.first == kMachine || pair.second == kMachine;
      (with_machine ? machine : people) += pair.figures.agreement;
      ++(with_machine ? of_machine : of_people);
    }
    if (of_people > 0 && of_machine > 0 &&
        machine / of_machine < people / of_people - kPoints - 1e-12)
      out.push_back(item);
  }
  return out;
}

}  // namespace

Agreement agreement(const std::vector<std::vector<Pair>>& products, std::uint64_t seed) {
  Samples samples(seed);
  return agreement_of(products, samples);
}

double icc_a1(const std::vector<std::vector<double>>& totals) {
  const auto n = static_cast<double>(totals.size()), k = static_cast<double>(totals.front().size());
  std::vector<double> columns(totals.front().size()), rows;
  for (const std::vector<double>& row : totals) {
    double sum = 0;
    for (std::size_t c = 0; c < row.size(); ++c) {
      sum += row[c];
      columns[c] += row[c] / n;
    }
    rows.push_back(sum / k);
  }
  double all = 0;
  for (const double row : rows) all += row / n;
  double of_rows = 0, of_columns = 0, rest = 0;
  for (const double row : rows) of_rows += k * square(row - all);
  for (const double column : columns) of_columns += n * square(column - all);
  for (std::size_t r = 0; r < totals.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c)
      rest += square(totals[r][c] - rows[r] - columns[c] + all);
  const double msr = of_rows / (n - 1), msc = of_columns / (k - 1),
               mse = rest / ((n - 1) * (k - 1));
  const double below = msr + (k - 1) * mse + k * (msc - mse) / n;
  return below > 0 ? (msr - mse) / below : 0;
}

BlandAltman bland_altman(const std::vector<std::pair<double, double>>& totals) {
  BlandAltman out;
  out.products = static_cast<int>(totals.size());
  for (const auto& [a, b] : totals) out.mean += (a - b) / out.products;
  for (const auto& [a, b] : totals) out.deviation += square(a - b - out.mean);
  out.deviation = out.products > 1 ? std::sqrt(out.deviation / (out.products - 1)) : 0;
  out.limits = {out.mean - 1.96 * out.deviation, out.mean + 1.96 * out.deviation};
  return out;
}

Result<RaterStudy> study_raters(const std::vector<Rating>& ratings, std::uint64_t seed) {
  RaterStudy out;
  Marks marks;
  for (const Rating& one : ratings) {
    once(out.raters, one.rater);
    once(out.items, one.item);
    if (!marks[one.rater][one.product].emplace(one.item, one.met).second)
      return error(fmt::format("rater {} marked item {} of product {} twice; keep one mark",
                               base::printable(one.rater), base::printable(one.item),
                               base::printable(one.product)));
  }
  if (out.raters.size() < 2)
    return error("agreement needs the marks of two raters; here are those of one");
  std::map<std::string, int> marked;  // by how many raters
  for (const auto& [rater, products] : marks)
    for (const auto& [product, items] : products) ++marked[product];
  const auto shared =
      std::count_if(marked.begin(), marked.end(), [](const auto& one) { return one.second > 1; });
  if (shared < kFewestProducts)
    return error(fmt::format(
        "two raters marked {} products in common; below {} nothing can be said of their agreement",
        shared, kFewestProducts));
  std::vector<std::string> items = out.items;
  items.emplace_back();
  Samples samples(seed);
  for (const std::string& item : items)
    for (std::size_t a = 0; a < out.raters.size(); ++a)
      for (std::size_t b = a + 1; b < out.raters.size(); ++b) {
        const std::vector<std::vector<Pair>> pairs =
            pairs_of(marks, out.raters[a], out.raters[b], item);
        if (static_cast<int>(pairs.size()) >= kFewestProducts)
          out.pairs.push_back({item, out.raters[a], out.raters[b], agreement_of(pairs, samples)});
      }
  const std::vector<std::string> raters = settled(marks, out.raters);
  const std::vector<std::vector<double>> totals = totals_of(marks, out, raters);
  out.complete = static_cast<int>(totals.size());
  if (out.complete >= kFewestProducts) {
    out.icc = icc_a1(totals);
    for (std::size_t a = 0; a < raters.size(); ++a)
      for (std::size_t b = a + 1; b < raters.size(); ++b) {
        std::vector<std::pair<double, double>> both;
        for (const std::vector<double>& row : totals) both.emplace_back(row[a], row[b]);
        out.apart.push_back({raters[a], raters[b], bland_altman(both)});
      }
  }
  out.ask_a_person = items_for_a_person(out);
  return out;
}

}  // namespace burr::school::study
