// school/study/raters.h - how far two raters, or a rater and the machine, agree on items that are met or not, and on totals.
//
//     agreement     p_o = share of products on which both gave the same mark
//     Cohen 1960    kappa = (p_o - p_e) / (1 - p_e),  p_e = sum over marks of the product of both raters' shares
//     Gwet 2008     AC1   = (p_o - p_g) / (1 - p_g),  p_g = 2 q (1 - q), q = mean share of "met" of both raters
//     Byrt 1993     prevalence index = |n_11 - n_00| / n
//     McGraw and Wong 1996, Shrout and Fleiss 1979 (their ICC 2,1), for k raters of n products
//                   ICC(A,1) = (MSR - MSE) / (MSR + (k-1) MSE + k (MSC - MSE) / n)
//     Bland and Altman 1986: mean difference, and limits of agreement 1.96 standard deviations around it
//
// Kappa is low where nearly all products get the same mark, however well raters agree (Feinstein and Cicchetti 1990); AC1
// is less so. Both are given. Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/study/interval.h"

namespace burr::school::study {

constexpr int kFewestProducts = 10;  // with fewer products burr gives no figures of raters

using Pair = std::pair<bool, bool>;  // the marks of two raters for one item of one product

struct Agreement {
  int products = 0,
      marks = 0;  // marks: pairs of them; as many as products where it is about one item
  double agreement = 0, prevalence_index = 0;
  std::optional<double> kappa;  // none where both raters gave the same mark to all
  double ac1 = 0;
  Interval kappa_95 = {}, agreement_95 = {};  // of 2000 samples of the products
};
// products: the pairs of each, at least one in all. A sample takes a product with all its pairs, since they belong together.
[[nodiscard]] Agreement agreement(const std::vector<std::vector<Pair>>& products,
                                  std::uint64_t seed = 1);

// totals[product][rater], at least 2 products and 2 raters.
[[nodiscard]] double icc_a1(const std::vector<std::vector<double>>& totals);

struct BlandAltman {
  int products = 0;
  double mean = 0, deviation = 0;  // of first minus second
  Interval limits = {};
};
[[nodiscard]] BlandAltman bland_altman(const std::vector<std::pair<double, double>>& totals);

// One mark of one rater.
struct Rating {
  std::string product, rater, item;
  bool met = false;
};

// Two raters and one item; item "": all items together.
struct ItemAgreement {
  std::string item, first, second;
  Agreement figures;
};

// The totals of two raters.
struct TotalsApart {
  std::string first, second;
  BlandAltman figures;
};

struct RaterStudy {
  std::vector<std::string> raters, items;
  std::vector<ItemAgreement> pairs;  // by item, then by pair of raters; then all items together
  // Totals (items met) of products on which every rater marked every item; raters with fewer than kFewestProducts products
  // are left out.
  int complete = 0;
  std::optional<double> icc;
  std::vector<TotalsApart> apart;
  // Items on which the machine agrees with people by more than 5 points less than people with each other: ask a person.
  // Only where there are two people and the rater "machine".
  std::vector<std::string> ask_a_person;
};
// Error: fewer than 2 raters, fewer than kFewestProducts products that two of them marked, or two marks of one rater for
// one item of one product.
[[nodiscard]] Result<RaterStudy> study_raters(const std::vector<Rating>& ratings,
                                              std::uint64_t seed = 1);

}  // namespace burr::school::study
