#include "burr/haptics/proxy.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "burr/haptics/soft_contact.h"
#include "burr/haptics/thin.h"
#include "burr/math/elementary.h"
#include "burr/math/sums.h"
#include "burr/rt/simd.h"
#include "burr/volume/sample.h"

namespace burr::haptics {
namespace {

using math::Vec3;
using volume::BrickIndex;
using volume::kBrickEdge;

// how far beyond the request discs are collected, for later moves of the tick and the next ticks
// [voxel]
constexpr double kLookShare = 2.0, kLookLeast = 0.2, kLookMost = 1.5;
constexpr double kLeastGuess = 0.02;  // discs this near are always examined   [voxel]

// the soft layer, used for the force while bone is cut
constexpr double kLayer = 0.15;          // thickness: the size of the surface's steps  [voxel]
constexpr double kFollow = 0.03;         // share of its support's change followed per tick [-]
constexpr double kSoftening = 0.0625;    // change of its share in the force per tick [-]
constexpr double kFarthestShare = 0.25;  // of the radius: from the proxy to soft_.place [-]

}  // namespace

ScanKernel scan_kernel() noexcept {
  if constexpr (rt::kWideKernels) {
    if (rt::simd() == rt::Simd::avx512)
      return {avx512::find_near,  avx512::scan_blocks,   avx512::take_discs,
              avx512::scan_discs, avx512::most_violated, avx512::soft_push};
    if (rt::simd() == rt::Simd::avx2)
      return {avx2::find_near,  avx2::scan_blocks,   avx2::take_discs,
              avx2::scan_discs, avx2::most_violated, avx2::soft_push};
  }
  return {scalar::find_near,  scalar::scan_blocks,   scalar::take_discs,
          scalar::scan_discs, scalar::most_violated, scalar::soft_push};
}

Proxy::Proxy(const volume::IsoVertices& surface, const ProxySettings& settings, const Vec3& hand)
    : surface_(surface),
      grid_(surface.bone().grid()),
      settings_(settings),
      kernel_(scan_kernel()),
      near_(kMostNear + volume::IsoVertices::kMostBlocks),
      discs_(std::make_unique<NearDiscs>()),
      candidates_(std::make_unique<Candidates>()),
      smooth_(std::make_unique<Candidates>()),
      radius_(settings.radius / grid_.voxel),
      proxy_(hand),
      c_(grid_.grid_from_world(hand)) {}

void Proxy::set_friction(double mu_static, double mu_kinetic) BURR_RT {
  settings_.friction_static = mu_static;
  settings_.friction_kinetic = mu_kinetic;
}

bool Proxy::set_radius(double radius) BURR_RT {
  const double before = settings_.radius;
  settings_.radius = radius;
  radius_ = radius / grid_.voxel;
  if (radius <= before || is_free(proxy_)) return true;
  settings_.radius = before;
  radius_ = before / grid_.voxel;
  return false;
}

void Proxy::place(const Vec3& p) BURR_RT {
  proxy_ = p;
  c_ = grid_.grid_from_world(p);
  last_move_ = 0;
  sliding_ = false;
  soft_ = {};
  last_stretch_.known = false;
}

bool Proxy::is_free(const Vec3& p) BURR_RT {
  const Vec3 centre = grid_.grid_from_world(p);
  const math::Ijk at = (centre.array() + 0.5).floor().cast<int>();
  if (surface_.bone().field(at.x(), at.y(), at.z()) >= volume::kIso) return false;
  collect(centre, 0);
  return candidates_->count == 0;
}

// Stores the blocks that have a disc whose gap to a ball around `centre` may be below `reach`. One
// search serves all short moves of a tick, and the next ticks too while the surface does not
// change.
void Proxy::look_around(const Vec3& centre, double reach, bool crowded) BURR_RT {
  near_count_ = 0;
  near_centre_ = centre;
  near_reach_ = reach;
  near_radius_ = radius_;
  near_revision_ = surface_.revision();
  const double far = radius_ + reach + surface_.largest_disc();
  const math::Ijk& n = surface_.bone().bricks();
  // bricks whose vertices, which lie in [first - 1, first + 8], could be that near
  const auto first_brick = [](double from) {
    return static_cast<int>(std::max(std::ceil((from - kBrickEdge) / kBrickEdge), 0.0));
  };
  const auto last_brick = [](double to, int count) {
    return static_cast<int>(std::clamp(std::floor((to + 1) / kBrickEdge), -1.0, count - 1.0));
  };
  const auto beside = [](double at, int brick) {
    const double low = kBrickEdge * brick - 1.0, high = low + kBrickEdge + 1.0;
    return at < low ? low - at : at > high ? at - high : 0.0;
  };
  const auto cx = static_cast<float>(centre.x()), cy = static_cast<float>(centre.y()),
             cz = static_cast<float>(centre.z());
  const auto near = static_cast<float>(far);

  // Some blocks are chosen, and their data prefetched, before the first is examined: with cold
  // caches, waiting for memory takes most of the time.
  constexpr int kAtOnce = 64;
  struct Chosen {
    BrickIndex brick;
    std::int32_t at[3];
  } chosen[kAtOnce];
  int count = 0;
  bool full = false;
  const auto look_into = [&]() {
    int kept = 0;
    for (int b = 0; b < count; ++b) {
      const volume::BrickBall& ball = surface_.ball(chosen[b].brick);
      const float dx = ball.x - cx, dy = ball.y - cy, dz = ball.z - cz, touch = near + ball.radius;
      if (dx * dx + dy * dy + dz * dz > touch * touch) continue;
      chosen[kept++] = chosen[b];
      for (const volume::VertexBlock& block : surface_.blocks(chosen[b].brick)) {
        const auto* line = reinterpret_cast<const char*>(&block);
        for (std::size_t at = 0; at < sizeof block; at += 64) __builtin_prefetch(line + at);
      }
    }
    for (int b = 0; b < kept; ++b) {
      if (near_count_ >= kMostNear) {  // more than can be stored
        near_reach_ = -1;
        full = !crowded;
        if (full) return;
        scan_near(centre, reach, true);
        near_count_ = 0;
      }
      const Chosen& one = chosen[b];
      near_count_ += kernel_.find_near(surface_.blocks(one.brick).data(), surface_.count(one.brick),
                                       one.at, centre.data(), near, near_.data() + near_count_);
    }
    count = 0;
  };

  for (int bk = first_brick(centre.z() - far), bks = last_brick(centre.z() + far, n.z()); bk <= bks;
       ++bk) {
    const double aside_z = beside(centre.z(), bk), left_z = far * far - aside_z * aside_z;
    if (left_z < 0) continue;
    for (int bj = first_brick(centre.y() - far), bjs = last_brick(centre.y() + far, n.y());
         bj <= bjs; ++bj) {
      const double aside_y = beside(centre.y(), bj), left = left_z - aside_y * aside_y;
      if (left < 0) continue;
      const double half = std::sqrt(left);
      const int low = first_brick(centre.x() - half), high = last_brick(centre.x() + half, n.x());
      const std::uint64_t* row = surface_.row(bj, bk);
      for (int w = low / 64; w <= high / 64; ++w) {
        const int first = std::max(low - 64 * w, 0), last = std::min(high - 64 * w, 63);
        if (last < first) continue;
        std::uint64_t word = row[w] & (~0ULL << first) & (~0ULL >> (63 - last));
        for (; word != 0; word &= word - 1) {
          const int bi = 64 * w + std::countr_zero(word);
          const BrickIndex brick = surface_.bone().brick_at(bi, bj, bk);
          surface_.prefetch(brick);
          chosen[count++] = {brick, {kBrickEdge * bi, kBrickEdge * bj, kBrickEdge * bk}};
          if (count == kAtOnce) look_into();
          if (full) return;
        }
      }
    }
  }
  look_into();
}

// If the blocks found are few, copies their discs; the moves of this tick and of the next then use
// only the copies.
void Proxy::take_discs() BURR_RT {
  constexpr int kFew = NearDiscs::kMost / volume::kLanes;
  taken_ =
      near_reach_ >= 0 && near_count_ <= kFew &&
      kernel_.take(near_.data(), near_count_, near_centre_.data(),
                   static_cast<float>(radius_ + near_reach_ + surface_.largest_disc()), *discs_);
}

// Adds the near discs with a gap below `within` to the candidates.
void Proxy::scan_near(const Vec3& centre, double within, bool crowded) BURR_RT {
  constexpr int kChunk = 256;  // blocks; their discs fit into the room left by thinning
  Candidates& out = *candidates_;
  if (taken_ && !crowded) {
    const Vec3 offset = centre - near_centre_;
    const float from[3] = {static_cast<float>(offset.x()), static_cast<float>(offset.y()),
                           static_cast<float>(offset.z())};
    kernel_.scan_discs(*discs_, from, static_cast<float>(radius_), static_cast<float>(within),
                       surface_.largest_disc(), out);
    return;
  }
  const int chunk = crowded ? kChunk : near_count_;
  for (int first = 0; first < near_count_; first += chunk) {
    kernel_.scan(near_.data() + first, std::min(chunk, near_count_ - first), centre.data(),
                 static_cast<float>(radius_), static_cast<float>(within), surface_.largest_disc(),
                 out);
    if (crowded && out.count > Candidates::kMost / 2) thin(out);
  }
}

// Fills the candidates with every disc whose gap to a ball around `centre` is below `within`.
// crowded: there are known to be too many, so of discs that face the same way only the nearest is
// kept.
void Proxy::collect(const Vec3& centre, double within, bool crowded) BURR_RT {
  Candidates& out = *candidates_;
  out.count = 0;
  out.full = false;
  if (crowded) {
    look_around(centre, within, true);
  } else {
    const bool seen = near_revision_ == surface_.revision() && near_radius_ == radius_ &&
                      math::norm(centre - near_centre_) + within <= near_reach_;
    const double beyond = std::min(kLookShare * within + kLookLeast, kLookMost);
    if (!seen) {
      look_around(centre, within + beyond, false);
      if (near_reach_ < within) look_around(centre, within, false);
      take_discs();
    }
    out.full = near_reach_ < within;
  }
  if (!out.full) scan_near(centre, within, crowded);
}

// A violated disc (bone grew, or was rebuilt slightly higher) pushes the burr out slowly.
void Proxy::be_gentle() BURR_RT {
  const float deepest = -static_cast<float>(settings_.push_out_speed);
  Candidates& all = *candidates_;
  for (int j = 0; j < all.count; ++j) all.gap[j] = std::max(all.gap[j], deepest);
}

// The best move from `from` that the discs allow, at most `longest` long. Only discs with gap <
// |move| matter, so few are collected first, and more only if the move is longer than guessed.
LeastMove Proxy::move_toward(const Vec3& from, const Vec3& wanted, double longest, double& guess,
                             bool& cut_short) BURR_RT {
  cut_short = false;
  double within = std::clamp(guess, kLeastGuess, std::max(longest, kLeastGuess));
  for (;;) {
    collect(from, within);
    if (candidates_->full) {  // more than fit: a shorter move needs fewer
      if (within > kLeastGuess) {
        longest = within = std::max(within / 2, kLeastGuess);
        continue;
      }
      collect(from, within, true);  // still too many: keep the nearest of each direction
      candidates_->full = true;     // and report it
      longest = within;
    }
    be_gentle();
    LeastMove move = least_move(*candidates_, wanted, kernel_.most_violated);
    if (!move.solved) {  // violated discs on opposite sides: stay here
      for (int j = 0; j < candidates_->count; ++j)
        candidates_->gap[j] = std::max(candidates_->gap[j], 0.0F);
      move = least_move(*candidates_, wanted, kernel_.most_violated);
    }
    const double length = math::norm(move.p);
    if (length <= within) return move;
    if (within >= longest) {
      cut_short = true;
      move.p *= within / length;
      return move;
    }
    // without the missing planes the move looks longer than it is, so increase `within` step by
    // step
    within = std::min({1.1 * length, 3 * within + 0.1, longest});
  }
}

// Where the proxy would rest on the smooth surface that the discs approximate. At the foot of each
// pressing contact the field gives the distance and direction of the surface; the same projection
// as for the discs, onto these at most three planes, gives a place that turns and moves without
// jumps. Where the field is not a clean ramp (a sharp edge, noise, a thin wall) the disc's own
// plane is used, blended by how clean the ramp is.
Vec3 Proxy::on_smooth_surface(const LeastMove& last, const Vec3& hand,
                              double& pressing) const BURR_RT {
  constexpr int kRounds = 6;
  constexpr double kTurn = 1e-4;  // a normal that changes by less is final                    [rad]
  // from the result with discs; farther away the planes are not valid  [voxel]
  constexpr double kFarthest = 0.35;
  Candidates& few = *smooth_;
  Vec3 normals[3];
  for (int a = 0; a < last.active; ++a) {
    const int j = last.index[a];
    normals[a] =
        Vec3(static_cast<double>(candidates_->nx[j]), static_cast<double>(candidates_->ny[j]),
             static_cast<double>(candidates_->nz[j]));
  }
  Vec3 place = c_;
  Vec3 last_change[3];
  bool settled = false;
  for (int round = 0; round < kRounds && !settled; ++round) {
    few.count = last.active;
    settled = true;
    for (int a = 0; a < last.active; ++a) {
      const int j = last.index[a];
      const Vec3 disc(static_cast<double>(candidates_->nx[j]),
                      static_cast<double>(candidates_->ny[j]),
                      static_cast<double>(candidates_->nz[j]));
      const double disc_gap = static_cast<double>(candidates_->gap[j]) + math::dot(disc, last.p) +
                              math::dot(disc, place - c_);
      const Vec3 foot = place - radius_ * normals[a];
      const volume::Sample there = volume::sample_with_slope(surface_.bone(), foot);
      const double depth = 2 * volume::kRamp * (there.value - volume::kIsoShare);
      const Vec3 slope = 2 * volume::kRamp * there.slope;
      const double steep = math::norm(slope);  // 1 on a clean ramp
      const Vec3 faces = steep > 1e-6 ? Vec3(-slope / steep) : disc;
      const double clean = std::clamp((steep - 0.85) * 10.0, 0.0, 1.0) *
                           std::clamp((math::dot(faces, disc) - 0.90) * 20.0, 0.0, 1.0);
      // If the foot is off by an angle, the normal found there is off by -r/R of that angle on a
      // hill, +r/R in a hollow. Two rounds give this ratio, and with it the limit to which the
      // rounds converge (Aitken 1926).
      const Vec3 change = math::normalized((1 - clean) * disc + clean * faces) - normals[a];
      double ratio = -0.3;
      if (round > 0 && math::squared_norm(last_change[a]) > 1e-14)
        ratio = std::clamp(math::dot(change, last_change[a]) / math::squared_norm(last_change[a]),
                           -8.0, 0.7);
      last_change[a] = change / (1 - ratio);
      settled &= math::squared_norm(last_change[a]) < kTurn * kTurn;
      const Vec3 n = math::normalized(normals[a] + last_change[a]);
      const double gap = (1 - clean) * disc_gap - clean * depth;
      few.nx[a] = static_cast<float>(n.x());
      few.ny[a] = static_cast<float>(n.y());
      few.nz[a] = static_cast<float>(n.z());
      few.gap[a] = static_cast<float>(gap);
      normals[a] = n;
    }
    const LeastMove move = least_move(few, hand - place, kernel_.most_violated);
    if (!move.solved) break;
    place += move.p;
    // by the surface's own normals: between discs the normals of the contacts lean towards each
    // other
    pressing = 0;
    for (int a = 0; a < move.active; ++a) pressing += move.push[a];
    const Vec3 away = place - c_;
    const double far = math::norm(away);
    if (far > kFarthest) place = c_ + away * (kFarthest / far);
  }
  return place;
}

// Where the burr rests on the soft layer (soft_contact.h). The search starts from the place of the
// last tick, not from the proxy, which may be held by a rough place of the bone, far from the
// layer's minimum. False: too many discs; soft_ keeps its values and moves along with the proxy.
bool Proxy::rest_softly(const Vec3& hand) BURR_RT {
  constexpr int kRounds = 4;
  if (!soft_.known) soft_ = {c_, c_, 0, 0, soft_.share, true};
  Vec3 at = soft_.place;
  // slightly more than the last tick needed; doubled if that is too little  [voxel]
  double beyond = std::clamp(1.5 * soft_.move + 0.1, 0.2, 1.0);
  for (int round = 0; round < kRounds; ++round) {
    collect(at, kLayer + beyond);
    if (candidates_->full) {
      soft_.place += c_ - soft_.proxy;
      soft_.proxy = c_;
      return false;
    }
    if (round == 0) {
      // a burr rests on at least one disc; the layer must not be more than twice too soft or too
      // stiff
      const double now =
          std::max(kLayer, soft_support(*candidates_, c_ - at, kLayer, kernel_.soft_push));
      soft_.support =
          soft_.support > 0
              ? std::clamp(soft_.support + kFollow * (now - soft_.support), 0.5 * now, 2 * now)
              : now;
    }
    const SoftRest rest =
        soft_rest(*candidates_, hand - at, kLayer, soft_.support, kernel_.soft_push);
    soft_.pressing = rest.pressing;
    const double length = math::norm(rest.place);
    at += rest.place * std::min(1.0, beyond / std::max(length, 1e-9));
    if (length <= beyond) break;
    beyond *= 2;
  }
  soft_.move = math::norm(at - soft_.place);
  const Vec3 away = at - c_;
  const double farthest = kFarthestShare * radius_, far = math::norm(away);
  soft_.place = far > farthest ? Vec3(c_ + away * (farthest / far)) : at;
  soft_.proxy = c_;
  return true;
}

// The place whose stretch from the hand gives the force. `pressing`: sum of the contacts' spring
// lengths there.
Vec3 Proxy::force_place(const LeastMove& last, const Vec3& hand, double& pressing) BURR_RT {
  if (!settings_.smooth || last.active == 0) {
    soft_.known = false;
    return c_;
  }
  const Vec3 smooth = soft_.share < 1 ? on_smooth_surface(last, hand, pressing) : c_;
  if (soft_.share == 0) {
    soft_.known = false;
    return smooth;
  }
  // too many discs: fade from the place on the soft layer to the place without it
  if (!rest_softly(hand)) soft_.share = std::max(0.0, soft_.share - 2 * kSoftening);
  pressing = soft_.share * soft_.pressing + (1 - soft_.share) * pressing;
  return soft_.share * soft_.place + (1 - soft_.share) * smooth;
}

// Moves the proxy to the free place nearest to `target`, by short moves, each of which is free.
LeastMove Proxy::settle(const Vec3& target, double guess, int moves, Touch& touch) BURR_RT {
  LeastMove last;
  double stride = std::max(radius_ / 2, 2.0);  // bounds the work; doubled while nothing is touched
  touch.lagging = true;
  double left = 1.0;
  for (int move = 0; move < moves && touch.lagging; ++move) {
    bool cut_short = false;
    last = move_toward(c_, target - c_, stride, guess, cut_short);
    if (!last.solved) break;
    c_ += last.p;
    const double length = math::norm(last.p);
    if (move == 0) first_move_ = length;
    guess = 1.3 * length;
    touch.candidates = std::max(touch.candidates, candidates_->count);
    touch.overflow |= candidates_->full;
    touch.lagging = cut_short || (length >= settings_.close && last.active > 0);
    left = cut_short ? 1.0 : length;
    if (last.active == 0) stride *= 2;
  }
  touch.lagging &= left > 0.1;  // a move of less than a tenth of a voxel counts as rest
  return last;
}

// On a wall, in a hollow, and on a ball less than half its radius deep, the stretch changes no
// farther than the hand moves: only a slip, or bone that grows or vanishes, changes it faster.
// Bounding the change bounds the step of the force:
//     |F - F before| <= k (|hand - hand before| + slip)
void Proxy::limit_slip(const Vec3& hand, Touch& touch) BURR_RT {
  const Vec3 stretch =
      touch.touching ? Vec3(touch.depth * touch.normal + touch.tangential) : Vec3(Vec3::Zero());
  const Stretch last = last_stretch_;
  last_stretch_ = {hand, stretch, true};
  if (!last.known || settings_.slip <= 0) return;
  const Vec3 change = stretch - last.stretch;
  const double most = math::norm(hand - last.hand) + settings_.slip, length = math::norm(change);
  if (length <= most) return;
  const Vec3 limited = last.stretch + change * (most / length);
  last_stretch_.stretch = limited;
  const double along = touch.touching ? math::dot(limited, touch.normal) : 0;
  touch.touching = true;
  if (along > 0) {
    touch.depth = along;
    touch.tangential = limited - along * touch.normal;
  } else {
    touch.slipping = true;
    touch.depth = math::norm(limited);
    touch.normal = limited / std::max(touch.depth, 1e-12);
    touch.tangential = Vec3::Zero();
  }
}

Touch Proxy::step(const Vec3& hand) BURR_RT {
  const Vec3 x = grid_.grid_from_world(hand);
  const Vec3 before = c_;
  Touch touch;
  const bool cut = revision_ != surface_.revision();
  revision_ = surface_.revision();
  soft_.share = std::clamp(soft_.share + (cut ? kSoftening : -kSoftening), 0.0, 1.0);
  const LeastMove last = settle(x, 1.3 * last_move_, settings_.max_moves, touch);
  last_move_ = first_move_;
  touch.active = last.active;

  touch.touching = (last.active > 0 || !last.solved) && math::norm(c_ - x) > 1e-9;
  if (touch.touching) {
    double pressing = 0;
    for (int a = 0; a < last.active; ++a) pressing += last.push[a];
    const Vec3 free_place = force_place(last, x, pressing);
    const Vec3 stretch = free_place - x;
    const double depth = math::norm(stretch);
    double press = std::max(pressing, depth);
    if (settings_.wedge > 0) press = std::min(press, settings_.wedge * depth);
    const Vec3 normal = depth > 1e-12 ? Vec3(stretch / depth) : Vec3(math::normalized(c_ - x));
    touch.normal = grid_.frame.q * normal;
    touch.depth = depth * grid_.voxel;
    touch.pressing = press * grid_.voxel;

    // friction: the proxy may trail behind only within the friction cone
    if (settings_.friction_static > 0) {
      const Vec3 behind = before - free_place;
      const Vec3 trail = behind - math::dot(behind, normal) * normal;
      const double reach = math::norm(trail);
      if (!sliding_ && reach > settings_.friction_static * press) sliding_ = true;
      if (sliding_ &&
          math::angle_of(reach, press) < 0.6 * math::arctangent(settings_.friction_kinetic))
        sliding_ = false;
      const double allowed = sliding_ ? std::min(reach, settings_.friction_kinetic * press) : reach;
      if (allowed > 1e-9) {
        Touch aside;
        (void)settle(free_place + trail * (allowed / reach), allowed, 4, aside);
        touch.candidates = std::max(touch.candidates, aside.candidates);
        const Vec3 now = c_ - free_place;
        touch.tangential = grid_.frame.q * ((now - math::dot(now, normal) * normal) * grid_.voxel);
      }
      touch.stuck = !sliding_;
    }
  } else {
    sliding_ = false;
    soft_.known = false;
    if (!touch.lagging) c_ = x;
  }
  proxy_ = grid_.world_from_grid(c_);
  touch.proxy = proxy_;
  limit_slip(hand, touch);
  return touch;
}

}  // namespace burr::haptics
