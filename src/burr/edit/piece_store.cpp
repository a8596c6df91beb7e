#include "burr/edit/piece_store.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "burr/base/hash.h"
#include "burr/edit/piece_body.h"
#include "burr/edit/piece_print.h"
#include "burr/volume/volume_of.h"

namespace burr::edit {

using math::Ijk;
using math::Pose;
using math::Quat;
using math::Vec3;
using piece_print::find_changed;
using piece_print::lay;
using piece_print::lies_there;
using piece_print::Print;
using piece_print::take_out;
using piece_print::way_of;
using piece_print::Work;
using volume::Bone;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickVoxels;
using volume::TissueId;

struct PieceStore::Place {
  PieceMove move;
  std::vector<Print> prints;
  bool where_it_came_free = false;
};

struct PieceStore::Kept {
  std::shared_ptr<const Bone> piece;  // as it came free
  Ijk seed = Ijk::Zero();
  Ijk low = Ijk::Zero(), high = Ijk::Zero();  // box of everything that is not zero
  Vec3 centre_grid = Vec3::Zero();
  double volume = 0;
  std::vector<std::shared_ptr<const Place>> places;  // the first: where it came free
};

struct PieceStore::ToAccept {
  std::shared_ptr<Kept> kept;
  std::shared_ptr<const Place> place;
  std::uint32_t number = 0;
};

bool is_dust(const Bone& bone, const volume::PieceFinder& finder, std::size_t piece) {
  const double voxel = bone.grid().voxel,
               voxels = static_cast<double>(finder.pieces()[piece].voxels);
  return voxels * voxel * voxel * voxel < kDust &&
         voxels < kDustOfBone * static_cast<double>(finder.pieces()[0].voxels);
}

Pose pose_of(const PieceMove& move, const Vec3& centre) {
  const Quat turn(move.turn[3], move.turn[0], move.turn[1], move.turn[2]);
  return {centre + Vec3(move.by[0], move.by[1], move.by[2]) - turn * centre, turn};
}

const PieceStore::Place* PieceStore::place_of(const Bone& bone, const Kept& kept) const {
  for (std::size_t n = kept.places.size(); n-- > 0;) {
    const Place& place = *kept.places[n];
    if (std::all_of(place.prints.begin(), place.prints.end(),
                    [&bone](const Print& print) { return lies_there(bone, print); }))
      return &place;
  }
  return nullptr;
}

namespace {

// Does the dust lie in a pore of the piece? From its first voxel along the three axes and back, nowhere
// other bone comes first, and in four of the six directions the piece does: a pore may be open to the cut.
bool in_pore(const Bone& bone, const volume::PieceFinder& finder, std::size_t dust,
             std::size_t piece) {
  const volume::Piece& speck = finder.pieces()[dust];
  const volume::Piece& around = finder.pieces()[piece];
  if ((speck.low.array() < around.low.array()).any() ||
      (speck.high.array() > around.high.array()).any())
    return false;
  int met = 0;
  for (int way = 0; way < 6; ++way) {
    Ijk step = Ijk::Zero();
    step[way / 2] = way % 2 == 0 ? 1 : -1;
    for (Ijk at = speck.seed + step;
         (at.array() >= around.low.array()).all() && (at.array() <= around.high.array()).all();
         at += step) {
      if (bone.field(at.x(), at.y(), at.z()) < volume::kIso) continue;
      const int of = finder.piece_of(at);
      if (of > 0 && of != static_cast<int>(piece) &&
          is_dust(bone, finder, static_cast<std::size_t>(of)))
        continue;  // it, or another speck
      if (of != static_cast<int>(piece)) return false;
      ++met;
      break;
    }
  }
  return met >= 4;
}

}  // namespace

std::shared_ptr<PieceStore::Kept> PieceStore::take(const Bone& bone,
                                                   const volume::PieceFinder& finder,
                                                   std::size_t piece, bool specks) const {
  std::vector<std::size_t> with;
  for (std::size_t dust = 1; specks && dust < finder.pieces().size(); ++dust)
    if (dust != piece && is_dust(bone, finder, dust) && in_pore(bone, finder, dust, piece))
      with.push_back(dust);
  auto alone = volume::piece_as_bone(bone, finder, piece, with);
  if (!alone) return nullptr;
  auto kept = std::make_shared<Kept>();
  kept->seed = finder.pieces()[piece].seed;
  kept->low = Ijk::Constant(std::numeric_limits<int>::max());
  kept->high = Ijk::Constant(-1);
  auto place = std::make_shared<Place>();
  place->where_it_came_free = true;
  std::array<std::int64_t, 3> sum = {0, 0, 0};
  std::int64_t inside = 0;
  for (BrickIndex brick = 0; brick < (*alone)->brick_count(); ++brick) {
    const Field* const field = (*alone)->brick_field(brick);
    if (field == nullptr) continue;
    Print& print = place->prints.emplace_back();
    print.brick = brick;
    std::memset(print.under, 0, sizeof print.under);
    std::memcpy(print.put, field, sizeof print.put);
    std::memcpy(print.tissue, (*alone)->brick_tissue(brick), sizeof print.tissue);
    std::memcpy(print.under_tissue, print.tissue, sizeof print.under_tissue);
    const Ijk first = bone.brick_ijk(brick);
    for (int v = 0; v < kBrickVoxels; ++v) {
      if (field[v] == 0) continue;
      const Ijk at = first + Ijk(v & 7, v >> 3 & 7, v >> 6);
      kept->low = kept->low.cwiseMin(at);
      kept->high = kept->high.cwiseMax(at);
      if (field[v] < volume::kIso) continue;
      ++inside;
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += at[static_cast<int>(axis)];
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    kept->centre_grid[static_cast<int>(axis)] =
        static_cast<double>(sum[axis]) / static_cast<double>(std::max<std::int64_t>(inside, 1));
  kept->volume = volume::volume_of(**alone);
  kept->piece = std::shared_ptr<const Bone>(std::move(*alone));
  kept->places.push_back(std::move(place));
  return kept;
}

std::vector<PieceStore::Found> PieceStore::list(const Bone& bone) const {
  std::vector<Found> all;
  const volume::PieceFinder finder(bone);
  if (finder.pieces().empty()) return all;
  std::vector<bool> known(finder.pieces().size());
  for (std::size_t n = 0; n < kept_.size(); ++n) {
    const Kept& kept = *kept_[n];
    const Place* const place = place_of(bone, kept);
    if (place == nullptr) continue;
    Found& found = all.emplace_back();
    found.number = static_cast<std::uint32_t>(n);
    found.seed = kept.seed;
    found.volume = kept.volume;
    found.centre = bone.grid().world_from_grid(kept.centre_grid);
    found.now = pose_of(place->move, found.centre);
    found.bone = kept.piece;
    // if it lies free it is one of the finder's, too
    for (const Print& print : place->prints) {
      std::array<std::int32_t, kBrickVoxels> labels;
      finder.label(print.brick, labels);
      for (std::size_t v = 0; v < labels.size(); ++v)
        if (labels[v] > 0 && print.put[v] >= volume::kIso)
          known[static_cast<std::size_t>(labels[v])] = true;
    }
  }
  std::size_t free = 0;
  for (std::size_t piece = 1; piece < finder.pieces().size() && free < kMostFree; ++piece) {
    if (known[piece] || is_dust(bone, finder, piece)) continue;
    const auto kept = take(bone, finder, piece, true);
    if (!kept) continue;
    ++free;
    Found& found = all.emplace_back();
    found.number = static_cast<std::uint32_t>(kept_.size());
    found.seed = kept->seed;
    found.volume = kept->volume;
    found.centre = bone.grid().world_from_grid(kept->centre_grid);
    found.bone = kept->piece;
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Found& a, const Found& b) { return a.volume > b.volume; });
  return all;
}

namespace {

// Distance from p to the nearest inside voxel of a piece that has moved by `now` [m].
double distance_to(const Bone& piece, const Pose& now, const Vec3& p) {
  const Vec3 at = piece.grid().grid_from_world(now.inverse() * p);
  double least = std::numeric_limits<double>::infinity();
  for (BrickIndex brick = 0; brick < piece.brick_count(); ++brick) {
    const Field* const field = piece.brick_field(brick);
    if (field == nullptr) continue;
    const Ijk first = piece.brick_ijk(brick);
    for (int v = 0; v < kBrickVoxels; ++v)
      if (field[v] >= volume::kIso)
        least = std::min(
            least, (Vec3(first.x() + (v & 7), first.y() + (v >> 3 & 7), first.z() + (v >> 6)) - at)
                       .norm());
  }
  return least * piece.grid().voxel;
}

}  // namespace

Result<PieceStore::Found> PieceStore::find(const Bone& bone, const Vec3& p, double within) const {
  const std::vector<Found> all = list(bone);
  if (all.empty())
    return error(Trouble::usage,
                 "no piece of the bone has come free; a bridge one voxel thin still holds it");
  const Found* best = nullptr;
  double least = within;
  for (const Found& found : all) {
    const double far = distance_to(*found.bone, found.now, p);
    if (far > least) continue;
    least = far;
    best = &found;
  }
  if (best == nullptr) {
    constexpr std::size_t kTold = 4;  // of them
    char text[192];
    std::snprintf(text, sizeof text,
                  "no free piece lies within %g mm of %.1f,%.1f,%.1f mm; free are:", 1e3 * within,
                  1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
    std::string why = text;
    for (std::size_t n = 0; n < std::min(all.size(), kTold); ++n) {
      const Vec3 at = 1e3 * (all[n].now * all[n].centre);
      std::snprintf(text, sizeof text, "%s %.1f mm3 at %.1f,%.1f,%.1f", n == 0 ? "" : ";",
                    1e9 * all[n].volume, at.x(), at.y(), at.z());
      why += text;
    }
    return error(Trouble::usage, why);
  }
  return *best;
}

// Where the piece lies, and which it is.
Result<const PieceStore::Place*> PieceStore::look_up(const Bone& bone, const PieceMove& move,
                                                     ToAccept& ready) const {
  ready.number = move.piece;
  if (move.piece < kept_.size()) {
    ready.kept = kept_[move.piece];
    const Place* const from = place_of(bone, *ready.kept);
    if (from == nullptr)
      return error(
          "the piece was cut, or bone grew on it, after it was moved; undo that, or cut it free");
    return from;
  }
  const volume::PieceFinder finder(bone);
  const Ijk seed(move.seed[0], move.seed[1], move.seed[2]);
  const int piece = finder.piece_of(seed);
  if (move.piece == kept_.size() && piece > 0)
    ready.kept = take(bone, finder, static_cast<std::size_t>(piece), move.specks);
  if (!ready.kept) return error("there is no free piece any more where the move begins");
  return ready.kept->places.front().get();
}

Result<PieceStore::NewBricks> PieceStore::prepare_lift(const Bone& bone,
                                                       const PieceMove& move) const {
  NewBricks out;
  const auto bricks = std::make_shared<MovedBricks>();
  out.bricks = bricks;
  out.ready = std::make_shared<ToAccept>();
  const auto from = look_up(bone, move, *out.ready);
  if (!from) return from.error();
  const Kept& kept = *out.ready->kept;
  auto body = body_of(*kept.piece, kept.low, kept.high, kept.centre_grid);
  if (!body) return body.error();
  const Vec3 centre = bone.grid().world_from_grid(kept.centre_grid);
  const Pose now = pose_of((*from)->move, centre);
  bricks->body.tool = body->tool;
  bricks->body.at = {now * centre, now.q};
  bricks->body.hash = body->hash;
  for (int axis = 0; axis < 3; ++axis)
    bricks->body.hash = base::mix(bricks->body.hash, bricks->body.at.p[axis]);
  for (const double part : {now.q.x(), now.q.y(), now.q.z(), now.q.w()})
    bricks->body.hash = base::mix(bricks->body.hash, part);
  Work work(bone);
  take_out((*from)->prints, work);
  find_changed(bone, work, *bricks);
  bricks->writes = move.writes;
  return out;
}

Result<PieceStore::NewBricks> PieceStore::prepare(const Bone& bone, const PieceMove& move) const {
  NewBricks out;
  const auto bricks = std::make_shared<MovedBricks>();
  out.bricks = bricks;
  out.ready = std::make_shared<ToAccept>();
  ToAccept& ready = *out.ready;
  Work work(bone);
  if (move.lifted) {  // the bone is without it already
    if (move.piece >= kept_.size()) return error("there is no such piece in the hand");
    ready.number = move.piece;
    ready.kept = kept_[move.piece];
  } else {
    const auto from = look_up(bone, move, ready);
    if (!from) return from.error();
    take_out((*from)->prints, work);
  }
  const Kept& kept = *ready.kept;

  // put down
  const auto way = way_of(bone.grid(), kept.centre_grid, kept.low, kept.high, move);
  if (!way) return way.error();
  auto place = std::make_shared<Place>();
  place->move = move;
  if (!lay(*kept.piece, *way, bone, work, place->prints, bricks->overlap))
    return error(Trouble::usage, "the piece would leave the volume; move it less");
  find_changed(bone, work, *bricks);
  bricks->writes = move.writes;
  place->move.bricks = bricks->hash;
  ready.place = std::move(place);
  return out;
}

Result<std::shared_ptr<const MovedBricks>> PieceStore::prepare_splinter(
    const Bone& bone, const PieceMove& move) const {
  const volume::PieceFinder finder(bone);
  const Ijk seed(move.seed[0], move.seed[1], move.seed[2]);
  const int piece = bone.grid().contains(seed) ? finder.piece_of(seed) : volume::PieceFinder::kNone;
  if (piece <= 0 || !is_dust(bone, finder, static_cast<std::size_t>(piece)))
    return error("no splinter lies there any more");
  const auto kept = take(bone, finder, static_cast<std::size_t>(piece), false);
  if (kept == nullptr) return error("no splinter lies there any more");
  const auto bricks = std::make_shared<MovedBricks>();
  Work work(bone);
  take_out(kept->places.front()->prints, work);
  find_changed(bone, work, *bricks);
  bricks->writes = move.writes;
  return std::shared_ptr<const MovedBricks>(bricks);
}

void PieceStore::accept(const NewBricks& prepared) {
  const ToAccept& ready = *prepared.ready;
  if (ready.number == kept_.size()) kept_.push_back(ready.kept);
  if (ready.place) {
    ready.kept->places.push_back(ready.place);
    out_.reset();
  } else {
    out_ = ready.number;  // it was lifted
  }
}

std::optional<PieceStore::Out> PieceStore::out(const Bone& bone) const {
  if (!out_) return {};
  const Kept& kept = *kept_[*out_];
  if (place_of(bone, kept) != nullptr) return {};
  return piece(*out_);
}

std::optional<PieceStore::Out> PieceStore::piece(std::uint32_t number) const {
  if (number >= kept_.size()) return {};
  const Kept& kept = *kept_[number];
  return Out{number, kept.volume, kept.piece->grid().world_from_grid(kept.centre_grid), kept.piece};
}

std::vector<PieceStore::Moved> PieceStore::moved(const Bone& bone) const {
  std::vector<Moved> all;
  for (std::size_t n = 0; n < kept_.size(); ++n) {
    const Kept& kept = *kept_[n];
    const Place* const place = place_of(bone, kept);
    if (place == nullptr || place->where_it_came_free) continue;
    Moved& one = all.emplace_back();
    one.number = static_cast<std::uint32_t>(n);
    one.volume = kept.volume;
    one.centre = bone.grid().world_from_grid(kept.centre_grid);
    one.move = place->move;
    one.now = pose_of(place->move, one.centre);
    auto alone =
        std::make_shared<Bone>(bone.grid(), bone.tissues(), place->prints.size(), 0, false);
    for (const Print& print : place->prints)
      alone->build_brick(print.brick, print.put, print.tissue);
    alone->pack();
    one.piece = std::move(alone);
    one.came_free = kept.piece;
  }
  return all;
}

std::unique_ptr<Bone> PieceStore::without_moved(const Bone& bone) const {
  return taken_out(bone, false);
}

std::unique_ptr<Bone> PieceStore::with_pieces_back(const Bone& bone) const {
  return taken_out(bone, true);
}

// back: each is put where it came free.
std::unique_ptr<Bone> PieceStore::taken_out(const Bone& bone, bool back) const {
  Work work(bone);
  std::vector<const Kept*> out_of_place;
  // the newest first: what lay under it may be a piece, too
  for (std::size_t n = kept_.size(); n-- > 0;) {
    const Place* const place = place_of(bone, *kept_[n]);
    if (place == nullptr || place->where_it_came_free) continue;
    take_out(place->prints, work);
    out_of_place.push_back(kept_[n].get());
  }
  if (const auto lifted = out(bone)) out_of_place.push_back(kept_[lifted->number].get());
  for (const Kept* const kept : out_of_place) {
    if (!back) break;
    for (const Print& print : kept->places.front()->prints) {
      KeptBrick& brick = work.at(print.brick);
      for (int v = 0; v < kBrickVoxels; ++v) {
        if (print.put[v] <= brick.field.voxel[v]) continue;
        brick.field.voxel[v] = print.put[v];
        brick.tissue[v] = print.tissue[v];
      }
    }
  }
  auto out = std::make_unique<Bone>(bone.grid(), bone.tissues(),
                                    bone.used_slots() + work.all().size(), 0, false);
  constexpr TissueId kNoTissue[kBrickVoxels] = {};
  for (BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const auto changed = work.all().find(brick);
    if (changed != work.all().end()) {
      out->build_brick(brick, changed->second->field.voxel, changed->second->tissue);
      continue;
    }
    const Field* const field = bone.brick_field(brick);
    if (field == nullptr) continue;
    const TissueId* const tissue = bone.brick_tissue(brick);
    out->build_brick(brick, field, tissue != nullptr ? tissue : kNoTissue);
  }
  out->pack();
  return out;
}

}  // namespace burr::edit
