#include "burr/haptics/six/two_tools.h"

#include <algorithm>
#include <cmath>

#include "burr/haptics/six/held_rows.h"
#include "burr/math/sums.h"
#include "burr/math/turn.h"

namespace burr::haptics {
namespace {

using math::Quat;
using math::Vec3;
using twelve::Held;
using twelve::kTolerance;
using twelve::Name;
using twelve::Twelve;

constexpr int kPasses = 90;         // rows taken
constexpr double kAccepted = 4e-4;  // [voxel]
constexpr int kRounds = 10;
constexpr double kLeastMove = 0.02;  // [voxel]
constexpr double kRest = 0.1;        // of a move left over that counts as rest          [voxel]
constexpr int kHoldMoves = 3;        // to where friction holds the tools, in a round
constexpr int kHoldRounds = 4;       // of finding how much it holds

double length3(const Six& z, std::size_t first) BURR_RT {
  return std::sqrt(math::sum_of_three(z[first] * z[first], z[first + 1] * z[first + 1],
                                      z[first + 2] * z[first + 2]));
}

Six bone_row(const Rows& rows, int j) BURR_RT {
  return {static_cast<double>(rows.n[0][j]), static_cast<double>(rows.n[1][j]),
          static_cast<double>(rows.n[2][j]), static_cast<double>(rows.m[0][j]),
          static_cast<double>(rows.m[1][j]), static_cast<double>(rows.m[2][j])};
}

}  // namespace

struct TwoTools::Twist {
  Six a = {}, b = {};
  LeastTwist bone_a, bone_b;   // the rows of the bone it rests on, for SixProxy::report()
  Vec3 pushed = Vec3::Zero();  // by the pairs: stretch of a's spring  [voxel], p_grid
  int meets = 0;               // pairs it rests on
  bool solved = true, cut_short = false;
};

// Goldfarb & Idnani as in least_twist.h, over the rows of both tools and of their pairs.
void TwoTools::least(const SixProxy& a, const SixProxy& b, const Six& wanted_a, const Six& wanted_b,
                     Twist& twist) const BURR_RT {
  Twelve y, start;
  for (std::size_t k = 0; k < 6; ++k) {
    start[k] = wanted_a[k];
    start[k + 6] = weight_ * wanted_b[k];
  }
  y = start;
  Held held;
  double low = 0;
  bool fine = false;
  for (int pass = 0; pass < kPasses && !fine; ++pass) {
    float za[6], zb[6];
    for (std::size_t k = 0; k < 6; ++k) {
      za[k] = static_cast<float>(y[k]);
      zb[k] = static_cast<float>(y[k + 6] / weight_);
    }
    Name name;
    double worst = 0;
    const auto look = [&](int whose, int index, double value, double tolerance) BURR_RT {
      if (index < 0 || -value <= tolerance || value >= worst) return;
      for (int i = 0; i < held.count; ++i)  // as exact as floats allow
        if (held.name[i] == Name{whose, index}) return;
      worst = value;
      name = {whose, index};
    };
    float value = 0;
    int j = a.kernel_.worst(*a.rows_, za, value);
    look(0, j, static_cast<double>(value), kTolerance);
    value = 0;
    j = b.kernel_.worst(*b.rows_, zb, value);
    look(1, j, static_cast<double>(value), kTolerance);
    for (int p = 0; p < count_; ++p) {
      const Pair& pair = pairs_[static_cast<std::size_t>(p)];
      double at = pair.gap;
      for (std::size_t k = 0; k < 6; ++k) at += pair.a[k] * y[k] + pair.b[k] * y[k + 6] / weight_;
      look(2, p, at, pair.tolerance);
    }
    low = -worst;
    fine = name.whose < 0;
    if (fine) break;
    Twelve row = {};
    double gap = 0;
    if (name.whose != 1) {
      const Six of = name.whose == 0 ? bone_row(*a.rows_, name.index)
                                     : pairs_[static_cast<std::size_t>(name.index)].a;
      for (std::size_t k = 0; k < 6; ++k) row[k] = of[k];
    }
    if (name.whose != 0) {
      const Six of = name.whose == 1 ? bone_row(*b.rows_, name.index)
                                     : pairs_[static_cast<std::size_t>(name.index)].b;
      for (std::size_t k = 0; k < 6; ++k) row[k + 6] = of[k] / weight_;
    }
    gap = name.whose == 0   ? static_cast<double>(a.rows_->gap[name.index])
          : name.whose == 1 ? static_cast<double>(b.rows_->gap[name.index])
                            : pairs_[static_cast<std::size_t>(name.index)].gap;
    if (!take(held, y, row, gap, name)) break;
  }
  twist = {};
  if (!fine && low > kAccepted) {
    twist.solved = false;
    return;
  }
  // sums of many small steps: the pushes give the same move without their rounding
  y = start;
  for (int i = 0; i < held.count; ++i) {
    for (std::size_t k = 0; k < 12; ++k) y[k] += held.push[i] * held.row[i][k];
    if (held.name[i].whose == 2) {
      ++twist.meets;
      twist.pushed += held.push[i] * pairs_[static_cast<std::size_t>(held.name[i].index)].normal;
      continue;
    }
    const bool of_a = held.name[i].whose == 0;
    LeastTwist& bone = of_a ? twist.bone_a : twist.bone_b;
    if (bone.active == 6) continue;  // more cannot be independent
    bone.index[bone.active] = held.name[i].index;
    bone.push[bone.active++] = of_a ? held.push[i] : held.push[i] / (weight_ * weight_);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    twist.a[k] = y[k];
    twist.b[k] = y[k + 6] / weight_;
  }
}

void TwoTools::solve(SixProxy& a, SixProxy& b, const Six& wanted_a, const Six& wanted_b,
                     Twist& twist) BURR_RT {
  // what grew into a tool, or overlaps, is pushed out slowly
  const auto lift = [&](double deepest) BURR_RT {
    for (Rows* rows : {a.rows_.get(), b.rows_.get()})
      for (int j = 0; j < rows->count; ++j)
        rows->gap[j] = std::max(rows->gap[j], static_cast<float>(deepest));
    for (int p = 0; p < count_; ++p) {
      double& gap = pairs_[static_cast<std::size_t>(p)].gap;
      gap = std::max(gap, deepest);
    }
  };
  // a turn errs a little: a pair takes that back at once, as bone does
  lift(-a.settings_.push_out_speed);
  least(a, b, wanted_a, wanted_b, twist);
  if (twist.solved) return;
  lift(0);
  least(a, b, wanted_a, wanted_b, twist);
}

void TwoTools::move(SixProxy& a, SixProxy& b, const Six& wanted_a, const Six& wanted_b,
                    SixProxy::Limits& guess_a, SixProxy::Limits& guess_b, Twist& twist,
                    SixTouch& touch_a, SixTouch& touch_b) BURR_RT {
  struct Half {
    SixProxy& proxy;
    SixProxy::Limits& guess;
    SixTouch& touch;
    SixProxy::Limits most, now;
    double p = 0, t = 0;
    Half(SixProxy& which, SixProxy::Limits& first, SixTouch& result) BURR_RT
        : proxy(which),
          guess(first),
          touch(result),
          most(which.most_),
          now{std::clamp(first.move, kLeastMove, which.most_.move),
              std::clamp(first.turn, 1e-6, which.most_.turn)} {}
    bool collect() BURR_RT {
      if (proxy.collect(now)) {
        touch.candidates = std::max(touch.candidates, proxy.rows_->count);
        return true;
      }
      shorten();
      return false;
    }
    void shorten() BURR_RT {
      touch.overflow = true;
      most = {0.5 * now.move, 0.5 * now.turn};
      now = most;
    }
    void measure(const Six& z) BURR_RT {
      p = length3(z, 0);
      t = length3(z, 3) / proxy.lever_;
    }
    [[nodiscard]] bool within() const BURR_RT { return p <= now.move && t <= now.turn; }
    [[nodiscard]] bool at_most() const BURR_RT {
      return (p > now.move && now.move >= most.move) || (t > now.turn && now.turn >= most.turn);
    }
    [[nodiscard]] double share() const BURR_RT {
      return std::min(p > now.move ? now.move / p : 1.0, t > now.turn ? now.turn / t : 1.0);
    }
    void enlarge() BURR_RT {
      if (p > now.move) now.move = std::min({1.1 * p, 3 * now.move + 0.1, most.move});
      if (t > now.turn) now.turn = std::min({1.1 * t, 3 * now.turn + 1e-3, most.turn});
    }
  };
  Half one(a, guess_a, touch_a), other(b, guess_b, touch_b);
  for (int round = 0; round < kRounds; ++round) {
    const bool ready = one.collect();  // both proxies collect, also where the first is not ready
    if (!other.collect() || !ready) continue;
    if (!find_pairs(a, b, one.now, other.now)) {  // too many: shorter moves
      one.shorten();
      other.shorten();
      continue;
    }
    solve(a, b, wanted_a, wanted_b, twist);
    one.measure(twist.a);
    other.measure(twist.b);
    if (one.within() && other.within()) {
      guess_a = {1.3 * one.p, 1.3 * one.t};
      guess_b = {1.3 * other.p, 1.3 * other.t};
      return;
    }
    if (one.at_most() || other.at_most() || round + 1 == kRounds) {
      // rows hold for every shorter move in the same direction
      const double share = std::min(one.share(), other.share());
      for (double& part : twist.a) part *= share;
      for (double& part : twist.b) part *= share;
      twist.cut_short = true;
      guess_a = one.now;
      guess_b = other.now;
      return;
    }
    one.enlarge();
    other.enlarge();
  }
  twist = {};
  twist.solved = false;
  twist.cut_short = true;
}

// Both go towards their goals as far as the bone and the other tool let them. Returns how long the
// last move was.  [voxel]
double TwoTools::seek(SixProxy& a, SixProxy& b, const math::Pose& goal_a, const math::Pose& goal_b,
                      int most, Guesses& guess, Twist& twist, SixTouch& touch_a,
                      SixTouch& touch_b) BURR_RT {
  twist = {};
  twist.cut_short = true;
  double left = 1;
  const double close = a.settings_.close / a.grid_.voxel;
  for (int moves = 0; moves < most;) {
    move(a, b, a.wanted(goal_a.p, goal_a.q), b.wanted(goal_b.p, goal_b.q), guess.a, guess.b, twist,
         touch_a, touch_b);
    if (moves++ == 0) guess.first_a = guess.a, guess.first_b = guess.b;
    guess.moves = moves;
    if (!twist.solved) break;
    a.go(twist.a);
    b.go(twist.b);
    left = std::sqrt(dot6(twist.a, twist.a) + dot6(twist.b, twist.b));
    const int active = twist.bone_a.active + twist.bone_b.active + twist.meets;
    if (!twist.cut_short && (left < close || active == 0)) break;
  }
  return left;
}

// One tool of the two on the bone.
struct TwoTools::Rubbing {
  SixProxy& proxy;
  Rest& rest;
  math::Pose hand;  // p_grid
  Grip was, held;
  bool rubs;

  // then: the tool a tick ago; now: the hand
  Rubbing(SixProxy& which, Rest& at, const math::Pose& then, const math::Pose& now,
          const LeastTwist& bone, bool solved) BURR_RT : proxy(which),
                                                         rest(at),
                                                         hand(now),
                                                         was(which.grip_) {
    proxy.grip_ = {};
    rubs = solved && bone.active > 0 && proxy.friction_.sticks > 0 &&
           proxy.press(bone, proxy.wanted(hand.p, hand.q));
    if (!rubs) rest = {};
    if (!rubs) return;
    held.f = was.f;
    if (!rest.known) rest = {then, true};
  }
  // As if the hand were where friction holds the tool with its spring.
  [[nodiscard]] math::Pose goal() const BURR_RT {
    const Six& f = held.f;
    return {hand.p + Vec3(f[0], f[1], f[2]),
            math::turned(hand.q, Vec3(f[3], f[4], f[5]) / proxy.lever_)};
  }
  // Returns how much the hold changed.  [voxel]
  double improve() BURR_RT {
    if (!rubs) return 0;
    Six towards = proxy.wanted(rest.at.p, rest.at.q);
    for (std::size_t k = 0; k < 6; ++k) towards[k] += held.f[k];
    const Six last = held.f;
    held = hold(*proxy.pressed_, proxy.friction_, towards, was);
    double change = 0;
    for (std::size_t k = 0; k < 6; ++k) change += (held.f[k] - last[k]) * (held.f[k] - last[k]);
    return std::sqrt(change);
  }
  void report(SixTouch& touch) const BURR_RT {
    if (!rubs) return;
    proxy.grip_ = held;
    rest.known = held.whole;
    const Six& f = held.f;
    const Quat& frame = proxy.grid_.frame.q;
    touch.stuck = held.stuck;
    touch.held = frame * Vec3(Vec3(f[0], f[1], f[2]) * proxy.grid_.voxel);
    touch.held_turn = frame * Vec3(Vec3(f[3], f[4], f[5]) / proxy.lever_);
  }
};

// How friction holds one tool changes how hard it is pushed by the other. So what holds it is sought
// in rounds: f is the nearest to f + (rest - now) that its places can give. An error shrinks in a round by the
// other tool's share of the pair's stiffness, and the next tick goes on from there; so a tool that is
// held is drawn to the place where it first was, not to that of the tick before, or it would creep.
void TwoTools::rub(Rubbing& one, Rubbing& other, Guesses& guess, Twist& twist, SixTouch& touch_a,
                   SixTouch& touch_b) BURR_RT {
  if (!one.rubs && !other.rubs) return;
  const double close = one.proxy.settings_.close / one.proxy.grid_.voxel;
  const auto go = [&]() BURR_RT {
    SixProxy &a = one.proxy, &b = other.proxy;
    const math::Pose at_a{a.c_, a.r_}, at_b{b.c_, b.r_}, goal_a = one.goal(), goal_b = other.goal();
    Twist to;
    static_cast<void>(seek(a, b, goal_a, goal_b, kHoldMoves, guess, to, touch_a, touch_b));
    const bool solved = to.solved;
    if (!solved) {  // back, and the rows of that place again: the forces come from the rows
      a.c_ = at_a.p;
      a.r_ = at_a.q;
      b.c_ = at_b.p;
      b.r_ = at_b.q;
      move(a, b, a.wanted(goal_a.p, goal_a.q), b.wanted(goal_b.p, goal_b.q), guess.a, guess.b, to,
           touch_a, touch_b);
      touch_a.lagging = touch_b.lagging = true;
    }
    twist = to;
    return solved;
  };
  if (!go()) return;
  for (int round = 0; round < kHoldRounds; ++round) {
    const Grip last = one.held, last_of_other = other.held;
    const double change = one.improve() + other.improve();
    if (round > 0 && change < close) {  // not in the first round: slow slides are as short as that
      one.held = last;
      other.held = last_of_other;
      return;
    }
    if (!go()) return;
  }
}

// Friction of each by itself, where the tools rest on the bone only. False: it would draw one into the
// other; then both are where they were, but their rows are not.
bool TwoTools::rub_alone(SixProxy& a, SixProxy& b, const math::Pose& before_a,
                         const math::Pose& before_b, const math::Pose& goal_a,
                         const math::Pose& goal_b, const Twist& twist, SixTouch& touch_a,
                         SixTouch& touch_b) BURR_RT {
  const math::Pose at_a{a.c_, a.r_}, at_b{b.c_, b.r_};
  const Grip grip_a = a.grip_, grip_b = b.grip_;
  const SixTouch was_a = touch_a, was_b = touch_b;
  a.report(twist.bone_a, goal_a.p, goal_a.q, touch_a);
  b.report(twist.bone_b, goal_b.p, goal_b.q, touch_b);
  // rows of the last move: solved as far as twist says
  LeastTwist bone_a = twist.bone_a, bone_b = twist.bone_b;
  bone_a.solved = bone_b.solved = twist.solved;
  a.rub(bone_a, before_a, goal_a.p, goal_a.q, touch_a);
  b.rub(bone_b, before_b, goal_b.p, goal_b.q, touch_b);
  if (least_gap(a, b, 1) >= 0) {
    rests_a_ = rests_b_ = {};
    return true;
  }
  a.c_ = at_a.p;
  a.r_ = at_a.q;
  b.c_ = at_b.p;
  b.r_ = at_b.q;
  a.grip_ = grip_a;
  b.grip_ = grip_b;
  touch_a = was_a;
  touch_b = was_b;
  return false;
}

void TwoTools::step(const HeldTool& a, const HeldTool& b, SixTouch& touch_a,
                    SixTouch& touch_b) BURR_RT {
  weight_ = std::sqrt(std::max(b.stiffness, 1e-9) / std::max(a.stiffness, 1e-9));
  const auto goal = [](const HeldTool& one) BURR_RT {
    const volume::Grid& grid = one.proxy.grid_;
    return math::Pose{grid.grid_from_world(one.hand.p),
                      math::normalized(math::product(grid.frame.q.conjugate(), one.hand.q))};
  };
  const math::Pose goal_a = goal(a), goal_b = goal(b);
  SixProxy &one = a.proxy, &other = b.proxy;
  const math::Pose before_a{one.c_, one.r_}, before_b{other.c_, other.r_};
  touch_a = touch_b = {};
  Guesses guess{one.last_, other.last_, one.last_, other.last_};
  Twist twist;
  const int most = std::min(one.settings_.max_moves, other.settings_.max_moves);
  const double left = seek(one, other, goal_a, goal_b, most, guess, twist, touch_a, touch_b);
  one.last_ = guess.first_a;
  other.last_ = guess.first_b;
  touch_a.moves = touch_b.moves = guess.moves;
  const bool rests = twist.bone_a.active + twist.bone_b.active + twist.meets > 0;
  const bool lags = !twist.solved || twist.cut_short || (rests && left > kRest);
  touch_a.lagging = touch_b.lagging = lags;
  const bool rubs = one.friction_.sticks > 0 || other.friction_.sticks > 0;
  if (rubs && twist.meets == 0) {
    if (rub_alone(one, other, before_a, before_b, goal_a, goal_b, twist, touch_a, touch_b)) return;
    // that trial left the rows of other places
    move(one, other, one.wanted(goal_a.p, goal_a.q), other.wanted(goal_b.p, goal_b.q), guess.a,
         guess.b, twist, touch_a, touch_b);
  }
  Rubbing rubs_a(one, rests_a_, before_a, goal_a, twist.bone_a, twist.solved),
      rubs_b(other, rests_b_, before_b, goal_b, twist.bone_b, twist.solved);
  rub(rubs_a, rubs_b, guess, twist, touch_a, touch_b);
  one.report(twist.bone_a, goal_a.p, goal_a.q, touch_a);
  other.report(twist.bone_b, goal_b.p, goal_b.q, touch_b);
  rubs_a.report(touch_a);
  rubs_b.report(touch_b);
  touch_a.meets = touch_b.meets = twist.meets > 0;
  const Vec3 pushed = one.grid_.frame.q * Vec3(twist.pushed * one.grid_.voxel);
  touch_a.pushed = pushed;
  touch_b.pushed = -pushed / (weight_ * weight_);
}

}  // namespace burr::haptics
