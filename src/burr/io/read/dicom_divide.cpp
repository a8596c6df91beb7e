// One series may hold several volumes. They are divided by what the files state (kernel, energy, phase,
// acquisition, time), then where slices lie far from each other. Slices of two phases are never mixed.
#include "burr/io/read/dicom_divide.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace burr::io {
namespace {

struct Key {
  double number = 0;
  std::string text;
  bool operator==(const Key&) const = default;
  bool operator<(const Key& other) const {  // not every library of today can compare strings by <=>
    return std::tie(number, text) < std::tie(other.number, other.text);
  }
};

enum class Fact {
  energy,
  kernel,
  kvp,
  stack,
  temporal,
  cardiac,
  trigger,
  acquisition,
  echo,
  type,
  time
};
constexpr Fact kFacts[] = {Fact::energy,   Fact::kernel,  Fact::kvp,     Fact::stack,
                           Fact::temporal, Fact::cardiac, Fact::trigger, Fact::acquisition,
                           Fact::echo,     Fact::type,    Fact::time};
constexpr std::size_t kIndices = 8;  // of Dimension Index Values

Key key_of(const DicomPhase& p, Fact fact) {
  switch (fact) {
    case Fact::energy:
      return {p.energy_kev, ""};
    case Fact::kernel:
      return {0, p.kernel};
    case Fact::kvp:
      return {p.kvp, ""};
    case Fact::stack:
      return {0, p.stack};
    case Fact::temporal:
      return {static_cast<double>(p.temporal), ""};
    case Fact::cardiac:
      return {p.cardiac_percent, ""};
    case Fact::trigger:
      return {p.trigger_ms, ""};
    case Fact::acquisition:
      return {static_cast<double>(p.acquisition), ""};
    case Fact::echo:
      return {p.echo_ms, ""};
    case Fact::type:
      return {0, p.type};
    case Fact::time:
      return {p.time_s, ""};
  }
  return {};
}

// What a surgeon calls it.
std::string part_name(Fact fact, const Key& key, std::size_t index, std::size_t count) {
  const std::string place = fmt::format("{} of {}", index + 1, count);
  switch (fact) {
    case Fact::energy:
    case Fact::kernel:
      return {};  // the list names them for every volume
    case Fact::kvp:
      return fmt::format("{:g} kV", key.number);
    case Fact::stack:
      return "stack " + place;
    case Fact::cardiac:
      return fmt::format("{:g} % of the heartbeat", key.number);
    case Fact::trigger:
      return fmt::format("phase {} ({:g} ms after the trigger)", place, key.number);
    case Fact::acquisition:
      return fmt::format("phase {} (acquisition {:g})", place, key.number);
    case Fact::echo:
      return "echo " + place;
    case Fact::type:
      return "set " + place;
    case Fact::temporal:
    case Fact::time:
      break;
  }
  return "phase " + place;
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + ", " + b;
}

// Divides the slices of one size and orientation.
class Divider {
 public:
  explicit Divider(const Series& series) : series_(series) {}

  std::vector<SliceGroup> divide(Slices slices, bool ordered_by_place) {
    std::vector<SliceGroup> out;
    divide(std::move(slices), "", 0, out);
    if (ordered_by_place) out = blocks(std::move(out));
    return out;
  }

 private:
  using Parts = std::vector<std::pair<Key, Slices>>;

  [[nodiscard]] const DicomPhase& phase(const Slice& s) const { return frame_of(series_, s).phase; }

  static void sort(Slices& slices) {
    std::stable_sort(slices.begin(), slices.end(),
                     [](const Slice& a, const Slice& b) { return a.along_mm < b.along_mm; });
  }
  // of sorted slices
  static std::size_t places(const Slices& slices) {
    std::size_t n = slices.empty() ? 0 : 1;
    double last = slices.empty() ? 0 : slices.front().along_mm;
    for (const Slice& s : slices)
      if (s.along_mm - last > kSameSlicePlace) {
        ++n;
        last = s.along_mm;
      }
    return n;
  }
  // how many slices lie at the fullest place
  static std::size_t deepest(const Slices& slices) {
    std::size_t most = 0, here = 0;
    double last = -1e300;
    for (const Slice& s : slices) {
      if (s.along_mm - last > kSameSlicePlace) {
        here = 0;
        last = s.along_mm;
      }
      most = std::max(most, ++here);
    }
    return most;
  }

  template <class KeyOf>
  static Parts parts_by(const Slices& slices, KeyOf key) {
    std::map<Key, Slices> by;
    for (const Slice& s : slices) by[key(s)].push_back(s);
    return {std::make_move_iterator(by.begin()), std::make_move_iterator(by.end())};
  }
  static std::size_t doubled(const Parts& parts) {
    std::size_t n = 0;
    for (const auto& [key, slices] : parts) n += slices.size() - places(slices);
    return n;
  }
  static std::size_t largest(const Parts& parts) {
    std::size_t n = 0;
    for (const auto& part : parts) n = std::max(n, part.second.size());
    return n;
  }

  // Consecutive parts of one long scan: they share a slice or two where they meet.
  static bool meet_at_their_ends(const Slices& all, const Parts& parts) {
    constexpr double kOwn = 0.7;  // share of its places that a part has for itself
    std::map<long, int> users;    // of a place
    const auto place = [](const Slice& s) {
      return std::lround(s.along_mm / (10 * kSameSlicePlace));
    };
    for (const auto& part : parts) {
      std::set<long> own;
      for (const Slice& s : part.second) own.insert(place(s));
      for (const long at : own) ++users[at];
    }
    const std::size_t most = largest(parts);
    if (most == all.size()) return false;
    for (const auto& part : parts) {
      std::size_t own = 0;
      for (const Slice& s : part.second) own += users[place(s)] == 1 ? 1U : 0U;
      if (static_cast<double>(own) < kOwn * static_cast<double>(part.second.size())) return false;
    }
    return true;
  }

  void divide(Slices slices, const std::string& part, int depth, std::vector<SliceGroup>& out) {
    sort(slices);
    const std::size_t there = places(slices), twice = slices.size() - there;
    constexpr int kDeepest = 4;
    if (depth < kDeepest && there > 1) {
      if (twice > 0 ? by_fact(slices, part, depth, out) || by_order(slices, part, out)
                    : by_overlap(slices, part, depth, out))
        return;
    }
    SliceGroup group{std::move(slices), part, false, twice};
    // a slice or two may be there twice; more is two volumes that nothing tells apart
    group.mixed = twice > std::max<std::size_t>(2, there / 20);
    if (!group.mixed) keep_one_of_each(group.slices);
    out.push_back(std::move(group));
  }

  void keep_one_of_each(Slices& slices) const {
    std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
      if (std::abs(a.along_mm - b.along_mm) > 0.1 * kSameSlicePlace) return a.along_mm < b.along_mm;
      return series_.files[a.file].instance < series_.files[b.file].instance;
    });
    slices.erase(std::unique(slices.begin(), slices.end(),
                             [](const Slice& a, const Slice& b) {
                               return std::abs(a.along_mm - b.along_mm) < kSameSlicePlace;
                             }),
                 slices.end());
  }

  void take(Parts parts, Fact fact, const std::string& part, int depth,
            std::vector<SliceGroup>& out) {
    for (std::size_t n = 0; n < parts.size(); ++n)
      divide(std::move(parts[n].second),
             joined(part, part_name(fact, parts[n].first, n, parts.size())), depth + 1, out);
  }

  // By the fact that leaves the fewest places with two slices.
  bool by_fact(const Slices& slices, const std::string& part, int depth,
               std::vector<SliceGroup>& out) {
    const std::size_t there = places(slices), twice = slices.size() - there,
                      most = 2 * deepest(slices);
    Parts best;
    Fact best_fact = Fact::time;
    std::size_t least = twice;
    const auto offer = [&](Fact fact, Parts parts) {
      if (parts.size() < 2 || parts.size() > most) return;
      if (static_cast<double>(largest(parts)) < 0.4 * static_cast<double>(there)) return;
      const std::size_t left = doubled(parts);
      if (left >= least) return;
      least = left;
      best = std::move(parts);
      best_fact = fact;
    };
    for (const Fact fact : kFacts)
      offer(fact, parts_by(slices, [&](const Slice& s) { return key_of(phase(s), fact); }));
    for (std::size_t n = 0; n < kIndices && least > 0; ++n)
      offer(Fact::temporal, parts_by(slices, [&](const Slice& s) {
              const auto& index = phase(s).index;
              return Key{n < index.size() ? static_cast<double>(index[n]) : -1.0, ""};
            }));
    if (best.empty()) return false;
    if (meet_at_their_ends(slices, best)) {
      SliceGroup group{slices, part, false, twice};
      keep_one_of_each(group.slices);
      out.push_back(std::move(group));
      return true;
    }
    take(std::move(best), best_fact, part, depth, out);
    return true;
  }

  // By an order in which the volumes follow each other, or change from slice to slice.
  bool by_order(const Slices& slices, const std::string& part, std::vector<SliceGroup>& out) {
    const auto number = [&](const Slice& s) {
      return 1e6 * series_.files[s.file].instance + s.frame;
    };
    const auto time = [&](const Slice& s) { return phase(s).time_s; };
    const auto trigger = [&](const Slice& s) { return phase(s).trigger_ms; };
    return follow(slices, time, part, out) || follow(slices, trigger, part, out) ||
           follow(slices, number, part, out) || change(slices, trigger, part, out) ||
           change(slices, time, part, out) || change(slices, number, part, out);
  }

  template <class Value>
  [[nodiscard]] static bool stated(const Slices& slices, Value value) {
    return std::all_of(slices.begin(), slices.end(),
                       [&](const Slice& s) { return value(s) > DicomPhase::kUnknown; });
  }

  void put(std::vector<Slices> runs, const std::string& part, std::vector<SliceGroup>& out) const {
    for (std::size_t n = 0; n < runs.size(); ++n) {
      sort(runs[n]);
      out.push_back({std::move(runs[n]),
                     joined(part, fmt::format("phase {} of {}", n + 1, runs.size())), false, 0});
    }
  }

  template <class Value>
  bool follow(const Slices& slices, Value value, const std::string& part,
              std::vector<SliceGroup>& out) const {
    if (!stated(slices, value)) return false;
    const auto place = [](const Slice& s) { return std::lround(s.along_mm / kSameSlicePlace); };
    Slices sorted = slices;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Slice& a, const Slice& b) { return value(a) < value(b); });
    std::vector<Slices> runs(1);
    std::set<long> here;
    double last = -1e300;
    for (const Slice& s : sorted) {
      const double now = value(s);
      if (here.count(place(s)) != 0) {
        if (now == last) return false;  // the order of these two is not known
        runs.emplace_back();
        here.clear();
      }
      here.insert(place(s));
      runs.back().push_back(s);
      last = now;
    }
    const std::size_t there = places(slices);
    const bool few = runs.size() <= 2 * deepest(slices);
    const bool whole = std::all_of(runs.begin(), runs.end(),
                                   [&](const Slices& run) { return 2 * run.size() >= there; });
    if (!few || !whole) return false;
    put(std::move(runs), part, out);
    return true;
  }

  template <class Value>
  bool change(const Slices& slices, Value value, const std::string& part,
              std::vector<SliceGroup>& out) const {
    if (!stated(slices, value)) return false;
    const std::size_t depth = deepest(slices);
    if (depth * places(slices) != slices.size()) return false;
    std::vector<Slices> runs(depth);
    for (std::size_t at = 0; at < slices.size(); at += depth) {
      Slices here(slices.begin() + static_cast<std::ptrdiff_t>(at),
                  slices.begin() + static_cast<std::ptrdiff_t>(at + depth));
      std::stable_sort(here.begin(), here.end(),
                       [&](const Slice& a, const Slice& b) { return value(a) < value(b); });
      for (std::size_t n = 0; n < depth; ++n) {
        if (n > 0 && !(value(here[n]) > value(here[n - 1]))) return false;
        runs[n].push_back(here[n]);
      }
    }
    put(std::move(runs), part, out);
    return true;
  }

  static double usual_gap(const Slices& sorted) {
    std::vector<double> gaps;
    for (std::size_t n = 1; n < sorted.size(); ++n)
      gaps.push_back(sorted[n].along_mm - sorted[n - 1].along_mm);
    if (gaps.empty()) return 0;
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2),
                     gaps.end());
    return gaps[gaps.size() / 2];
  }

  // No place has two slices, yet two phases may lie between each other's slices.
  bool by_overlap(const Slices& slices, const std::string& part, int depth,
                  std::vector<SliceGroup>& out) {
    constexpr std::size_t kLeast = 4, kMost = 16;
    if (slices.size() < 2 * kLeast) return false;
    for (const Fact fact : {Fact::energy, Fact::kernel, Fact::kvp, Fact::temporal, Fact::cardiac,
                            Fact::acquisition}) {
      Parts parts = parts_by(slices, [&](const Slice& s) { return key_of(phase(s), fact); });
      if (parts.size() < 2 || parts.size() > kMost) continue;
      if (std::any_of(parts.begin(), parts.end(),
                      [](const auto& p) { return p.second.size() < kLeast; }))
        continue;
      if (!interleaved(parts)) continue;
      if (fact == Fact::acquisition && fill_each_other(slices, parts)) continue;
      take(std::move(parts), fact, part, depth, out);
      return true;
    }
    return false;
  }
  static bool interleaved(const Parts& parts) {
    for (const auto& a : parts)
      for (const auto& b : parts) {
        if (&a == &b) continue;
        const double lo = b.second.front().along_mm, hi = b.second.back().along_mm;
        const auto inside = std::count_if(a.second.begin(), a.second.end(), [&](const Slice& s) {
          return s.along_mm > lo && s.along_mm < hi;
        });
        if (2 * inside >= static_cast<std::ptrdiff_t>(a.second.size())) return true;
      }
    return false;
  }
  // Each takes the slices that the other one leaves out, as some scanners do in two passes.
  [[nodiscard]] bool fill_each_other(const Slices& all, const Parts& parts) const {
    const double thickness = frame_of(series_, all.front()).thickness_mm,
                 own = usual_gap(parts.front().second);
    if (thickness > 0) return own > 1.2 * thickness;
    const double gap = usual_gap(all);
    for (std::size_t n = 1; n < all.size(); ++n)
      if (std::abs(all[n].along_mm - all[n - 1].along_mm - gap) > 0.2 * gap) return false;
    return true;
  }

  // Slices far from each other are two scans, not one with a hole.
  static std::vector<SliceGroup> blocks(std::vector<SliceGroup> groups) {
    std::vector<SliceGroup> out;
    for (SliceGroup& group : groups) {
      const double gap = usual_gap(group.slices);
      std::vector<Slices> parts(1);
      for (const Slice& s : group.slices) {
        if (!parts.back().empty()) {
          const double step = s.along_mm - parts.back().back().along_mm;
          if (gap > kSameSlicePlace && (step > 25 * gap || (step > 30 && step > 3 * gap)))
            parts.emplace_back();
        }
        parts.back().push_back(s);
      }
      if (group.mixed || parts.size() == 1) {
        out.push_back(std::move(group));
        continue;
      }
      for (std::size_t n = 0; n < parts.size(); ++n) {
        const double length = parts[n].back().along_mm - parts[n].front().along_mm + gap;
        out.push_back({std::move(parts[n]),
                       joined(group.part, fmt::format("block {} of {}, {:.3g} mm long", n + 1,
                                                      parts.size(), length)),
                       false, n == 0 ? group.same_place : 0});
      }
    }
    return out;
  }

  const Series& series_;
};

}  // namespace

std::vector<SliceGroup> divide_slices(const Series& series, Slices slices, bool ordered_by_place) {
  return Divider(series).divide(std::move(slices), ordered_by_place);
}

}  // namespace burr::io
