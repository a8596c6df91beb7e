#include "burr/phantom/phantoms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "burr/importing/tissues.h"
#include "burr/volume/sample.h"
#include "burr/volume/volume_of.h"

namespace burr::phantom {
namespace {

using volume::Bone;
using volume::TissueId;
using volume::TissueKind;

std::unique_ptr<Bone> make(std::string_view name, double voxel_mm, int threads = 2) {
  NoProgress nobody;
  auto bone = phantom(name, voxel_mm, nobody, 0, threads);
  EXPECT_TRUE(bone.ok()) << (bone.ok() ? "" : bone.error().text);
  return std::move(*bone);
}

TissueId id_of(const Bone& bone, std::string_view name) {
  const auto& all = bone.tissues().tissues;
  for (std::size_t id = 0; id < all.size(); ++id)
    if (all[id].name == name) return static_cast<TissueId>(id);
  ADD_FAILURE() << "no tissue named " << name;
  return 0;
}

template <class Do>
void each_voxel(const Bone& bone, Do&& what) {
  const math::Ijk& size = bone.grid().size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) what(math::Ijk(i, j, k));
}

const std::map<std::string_view, double> kTestVoxelMm = {
    {"temporal-bone", 0.4}, {"jaw", 0.4},   {"tooth", 0.2}, {"spine", 0.8},
    {"skull", 1.2},         {"block", 0.5}, {"ball", 0.5}};

// Made once, used often.
const Bone& of(std::string_view name) {
  static std::map<std::string_view, std::unique_ptr<Bone>> made;
  std::unique_ptr<Bone>& bone = made[name];
  if (bone == nullptr) bone = make(name, kTestVoxelMm.at(name));
  return *bone;
}

TEST(Phantoms, EveryNameMakesABoneAndNothingReachesTheBorder) {
  for (const std::string_view name : phantom_names()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(kTestVoxelMm.contains(name));
    const Bone* bone = &of(name);
    EXPECT_GT(default_voxel_mm(name), 0);
    EXPECT_GT(volume::volume_of(*bone),
              0.02 * std::pow(bone->grid().voxel * bone->grid().size.minCoeff(), 3));
    const math::Ijk last = bone->grid().size - math::Ijk::Ones();
    int open = 0;
    each_voxel(*bone, [&](const math::Ijk& v) {
      const bool border = (v.array() == 0).any() || (v.array() == last.array()).any();
      open += border && bone->field(v.x(), v.y(), v.z()) >= volume::kIso ? 1 : 0;
    });
    EXPECT_EQ(open, 0) << "the surface is closed inside the grid";
  }
}

TEST(Phantoms, EveryTissueIsThereAndHasItsOwnNameAndLabel) {
  for (const std::string_view name : phantom_names()) {
    SCOPED_TRACE(name);
    const Bone* bone = &of(name);
    const auto& tissues = bone->tissues().tissues;
    std::vector<std::size_t> count(tissues.size());
    each_voxel(*bone, [&](const math::Ijk& v) {
      const TissueId id = bone->tissue(v.x(), v.y(), v.z());
      ASSERT_LT(id, tissues.size());
      ++count[id];
      // a voxel inside the surface must have a solid tissue
      if (bone->field(v.x(), v.y(), v.z()) >= volume::kIso) {
        ASSERT_EQ(tissues[id].kind, TissueKind::solid)
            << tissues[id].name << " at " << v.transpose();
      }
    });
    std::set<std::string> names;
    std::set<int> labels;
    for (std::size_t id = 1; id < tissues.size(); ++id) {
      EXPECT_GT(count[id], 0U) << tissues[id].name;
      EXPECT_TRUE(names.insert(tissues[id].name).second) << tissues[id].name;
      EXPECT_TRUE(labels.insert(tissues[id].label).second || tissues.size() == 2);
    }
  }
}

// A phantom written as .seg.nrrd and read again is the same bone: the names alone decide what is
// solid.
TEST(Phantoms, NamesSayWhatIsSolidSoftAndAir) {
  for (const std::string_view name : phantom_names()) {
    const Phantom made = name == "temporal-bone" ? temporal_bone(1e-3)
                         : name == "jaw"         ? jaw(1e-3)
                         : name == "tooth"       ? tooth(1e-3)
                         : name == "spine"       ? spine(1e-3)
                                                 : skull(1e-3);
    for (const volume::Tissue& tissue : made.tissues.tissues) {
      if (&tissue == &made.tissues.tissues.front()) continue;
      const volume::Tissue read =
          importing::tissue_by_name({tissue.label, tissue.name, tissue.colour}, true);
      EXPECT_EQ(read.kind, tissue.kind) << name << ": " << tissue.name;
    }
  }
}

TEST(Phantoms, SameBitsWhateverTheNumberOfThreads) {
  for (const std::string_view name : {"temporal-bone", "jaw", "spine"}) {
    SCOPED_TRACE(name);
    const double voxel_mm = name == "spine" ? 1.5 : 0.9;
    EXPECT_EQ(make(name, voxel_mm, 1)->content_hash(), make(name, voxel_mm, 3)->content_hash());
  }
}

// Bricks are skipped by a bound on the slope of the formula. If the bound were wrong, bone would be
// missing.
TEST(Phantoms, NoBrickIsSkippedThatHoldsBone) {
  for (const std::string_view name : phantom_names()) {
    SCOPED_TRACE(name);
    const double voxel = 1e-3 * kTestVoxelMm.at(name);
    const Bone* bone = &of(name);
    Formula formula;
    if (name == "temporal-bone") formula = temporal_bone(voxel).formula;
    if (name == "jaw") formula = jaw(voxel).formula;
    if (name == "tooth") formula = tooth(voxel).formula;
    if (name == "spine") formula = spine(voxel).formula;
    if (name == "skull") formula = skull(voxel).formula;
    if (!formula.depth) continue;
    int wrong = 0;
    each_voxel(*bone, [&](const math::Ijk& v) {
      if ((v.x() + 3 * v.y() + 7 * v.z()) % 7 != 0) return;
      const Vec3 p = bone->grid().world_from_grid(v.cast<double>());
      const volume::Field field = volume::field_from_depth(formula.depth(p) / bone->grid().voxel);
      wrong += field != bone->field(v.x(), v.y(), v.z()) ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0);
  }
}

TEST(Phantoms, TemporalBoneHasItsStructuresWhereTheyBelong) {
  const Bone& bone = of("temporal-bone");
  struct Extent {
    math::Aabb box;
    double voxels = 0;
  };
  std::map<std::string, Extent> at;
  each_voxel(bone, [&](const math::Ijk& v) {
    const TissueId id = bone.tissue(v.x(), v.y(), v.z());
    if (id == 0) return;
    if (bone.tissues()[id].kind == TissueKind::solid &&
        bone.field(v.x(), v.y(), v.z()) < volume::kIso)
      return;  // the ramp above a surface
    Extent& extent = at[bone.tissues()[id].name];
    extent.box.extend(1e3 * bone.grid().world_from_grid(v.cast<double>()));
    extent.voxels += 1;
  });
  const double mm3 = std::pow(1e3 * bone.grid().voxel, 3);

  // a right ear: x runs inwards, y back, z up; the origin is the opening of the ear canal
  EXPECT_LT(at["ear canal"].box.lo.x(), 1);
  EXPECT_GT(at["antrum air"].box.centre().y(), at["middle ear"].box.centre().y())
      << "antrum behind";
  EXPECT_GT(at["antrum air"].box.centre().z(), 3) << "antrum above the canal";
  EXPECT_GT(at["sigmoid sinus"].box.hi.y(), 25) << "sinus at the back";
  EXPECT_LT(at["mastoid air cells"].box.lo.z(), -15) << "cells down to the tip";
  EXPECT_GT(at["bony dura plate (tegmen)"].box.centre().z(), 8) << "dura above";
  EXPECT_GT(at["labyrinth (otic capsule)"].box.lo.x(), at["antrum air"].box.centre().x());
  EXPECT_GT(at["cochlea (soft tissue)"].box.centre().x(), at["middle ear"].box.centre().x());
  // the nerve runs from the internal auditory meatus to the stylomastoid foramen
  EXPECT_GT(at["facial nerve"].box.hi.x(), 33);
  EXPECT_LT(at["facial nerve"].box.lo.z(), -16);
  // sizes from textbooks, within a factor
  const double antrum_ml = 1e-3 * mm3 * at["antrum air"].voxels;
  EXPECT_GT(antrum_ml, 0.1);
  EXPECT_LT(antrum_ml, 1.0);
  const double cells_ml = 1e-3 * mm3 * at["mastoid air cells"].voxels;
  EXPECT_GT(cells_ml, 0.1) << "only what is two voxels from a wall counts";
  EXPECT_LT(cells_ml, 12);
  for (const char* little : {"malleus", "incus", "stapes"}) {
    EXPECT_GT(mm3 * at[little].voxels, 0.5) << little;
    EXPECT_LT(mm3 * at[little].voxels, 40) << little;
  }
}

// Seen from the side, over the antrum, a surgeon meets bone before any structure to spare.
TEST(Phantoms, WhatMustBeSparedLiesUnderBone) {
  const Bone& bone = of("temporal-bone");
  const volume::Grid& grid = bone.grid();
  int ways = 0;
  for (double y = 8; y <= 18; y += 1)
    for (double z = -14; z <= 6; z += 1) {
      ++ways;
      for (double x = -8; x < 40; x += 0.1) {
        const Vec3 p = grid.grid_from_world(1e-3 * Vec3(x, y, z));
        const math::Ijk v = p.array().round().cast<int>();
        const volume::Tissue& tissue = bone.tissues()[bone.tissue(v.x(), v.y(), v.z())];
        ASSERT_FALSE(tissue.spare) << tissue.name << " lies open at " << y << ' ' << z;
        if (volume::sample(bone, p) >= volume::kIsoShare) break;
      }
    }
  EXPECT_GT(ways, 100);
}

TEST(Phantoms, TheFacialNerveIsOneWholeAndHasBoneOrAirAboutIt) {
  const Bone& bone = of("temporal-bone");
  const TissueId nerve = id_of(bone, "facial nerve");
  std::vector<math::Ijk> open;
  std::set<std::tuple<int, int, int>> left;
  each_voxel(bone, [&](const math::Ijk& v) {
    if (bone.tissue(v.x(), v.y(), v.z()) == nerve) left.insert({v.x(), v.y(), v.z()});
  });
  ASSERT_GT(left.size(), 300U);
  const auto first = *left.begin();
  open.emplace_back(std::get<0>(first), std::get<1>(first), std::get<2>(first));
  left.erase(left.begin());
  while (!open.empty()) {
    const math::Ijk v = open.back();
    open.pop_back();
    for (int n = 0; n < 27; ++n) {
      const auto next = left.find({v.x() + n % 3 - 1, v.y() + n / 3 % 3 - 1, v.z() + n / 9 - 1});
      if (next == left.end()) continue;
      open.emplace_back(std::get<0>(*next), std::get<1>(*next), std::get<2>(*next));
      left.erase(next);
    }
  }
  EXPECT_TRUE(left.empty()) << left.size() << " voxels of the nerve are cut off";
}

// The bits that recordings of earlier versions replay on.
TEST(Phantoms, WithoutAVariantTheBitsStay) {
  EXPECT_EQ(of("jaw").content_hash(), 0xb8e662d4826f298bULL);
  EXPECT_EQ(of("tooth").content_hash(), 0x6086fcd78a90a554ULL);
  EXPECT_EQ(of("temporal-bone").content_hash(), 0x8fc36a0aea74c2d4ULL);
  EXPECT_EQ(of("spine").content_hash(), 0xe9068ff718f5483dULL);
}

// Of every variant alone: other bits than without, closed inside its grid, each tissue there, names that
// say what is solid, and no brick left out by the bound on the formula's slope.
TEST(Phantoms, EveryVariantIsAWholeBone) {
  for (const std::string_view name : phantom_names())
    for (const VariantWord& variant : variants_of(name)) {
      const std::string full = std::string(name) + "?" + std::string(variant.word);
      SCOPED_TRACE(full);
      EXPECT_TRUE(known(full));
      EXPECT_FALSE(variant.what.empty());
      const double voxel_mm = (name == "tooth" ? 1.0 : 1.6) * kTestVoxelMm.at(name);
      const auto bone = make(full, voxel_mm);
      EXPECT_NE(bone->content_hash(), make(name, voxel_mm)->content_hash());
      const Variant words({std::string(variant.word)});
      const double voxel = 1e-3 * voxel_mm;
      const Phantom made = name == "temporal-bone" ? temporal_bone(voxel, words)
                           : name == "jaw"         ? jaw(voxel, words)
                           : name == "tooth"       ? tooth(voxel, words)
                                                   : spine(voxel, words);
      std::vector<std::size_t> count(made.tissues.tissues.size());
      int open = 0, wrong = 0;
      const math::Ijk last = bone->grid().size - math::Ijk::Ones();
      each_voxel(*bone, [&](const math::Ijk& v) {
        const volume::Field field = bone->field(v.x(), v.y(), v.z());
        const bool border = (v.array() == 0).any() || (v.array() == last.array()).any();
        open += border && field >= volume::kIso ? 1 : 0;
        ++count.at(bone->tissue(v.x(), v.y(), v.z()));
        if ((v.x() + 3 * v.y() + 7 * v.z()) % 97 != 0) return;
        const double depth = made.formula.depth(bone->grid().world_from_grid(v.cast<double>()));
        wrong += volume::field_from_depth(depth / bone->grid().voxel) != field ? 1 : 0;
      });
      EXPECT_EQ(open, 0);
      EXPECT_EQ(wrong, 0);
      for (std::size_t id = 1; id < count.size(); ++id) {
        const volume::Tissue& tissue = made.tissues.tissues[id];
        if (variant.word != "sclerotic" || tissue.name != "mastoid air cells") {
          EXPECT_GT(count[id], 0U) << tissue.name;
        }
        EXPECT_EQ(importing::tissue_by_name({tissue.label, tissue.name, tissue.colour}, true).kind,
                  tissue.kind)
            << tissue.name;
      }
    }
}

TEST(Phantoms, AVariantThatIsNotThereIsTurnedDownWithWhatThereIs) {
  NoProgress nobody;
  const auto bad = phantom("jaw?long,tall", 0.4, nobody);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().trouble, Trouble::usage);
  EXPECT_NE(bad.error().text.find("no variant 'tall'; use one or more of long, high-nerve"),
            std::string::npos)
      << bad.error().text;
  EXPECT_FALSE(known("block?long"));
  EXPECT_FALSE(known("jaw?"));
  EXPECT_FALSE(known("elbow?long"));
  EXPECT_EQ(default_voxel_mm("jaw?tall"), 0);
  EXPECT_EQ(default_voxel_mm("jaw?long"), default_voxel_mm("jaw"));
}

const Landmark& landmark_of(const std::vector<Landmark>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Landmark& one) { return one.name == name; });
  EXPECT_NE(found, all.end()) << name;
  return *found;
}

// "low-dura=1.5" lowers by that much: a landmark on what moves goes along, and the word without a number
// is the usual amount.
TEST(Phantoms, AnAmountMovesByThatMuch) {
  const auto nerve = [](const std::string& name) {
    return landmark_of(landmarks(name), "inferior alveolar nerve").points;
  };
  const auto usual = nerve("jaw"), some = nerve("jaw?high-nerve=1.5"),
             all = nerve("jaw?high-nerve");
  double least = 1, most = 0, whole = 0;
  for (std::size_t n = 0; n < usual.size(); ++n) {
    const double by = some[n].z() - usual[n].z();
    least = std::min(least, by);
    most = std::max(most, by);
    whole = std::max(whole, all[n].z() - usual[n].z());
  }
  EXPECT_NEAR(most, 1.5e-3, 1e-9);
  EXPECT_NEAR(whole, 2.5e-3, 1e-9);
  EXPECT_GE(least, 0);
  EXPECT_EQ(make("jaw?high-nerve=2.5", 0.5)->content_hash(),
            make("jaw?high-nerve", 0.5)->content_hash());
  EXPECT_EQ(make("tooth?graded,shallow=0.8", 0.3)->content_hash(),
            make("tooth?graded,shallow", 0.3)->content_hash());
  EXPECT_NE(make("spine?thin-pedicle=1", 1.0)->content_hash(),
            make("spine?thin-pedicle", 1.0)->content_hash());
}

// The bone of a number is what drawn_bone() says, the same bits, and no word that was written is drawn over.
TEST(Phantoms, ANumberDrawsABone) {
  for (const std::string name : {"temporal-bone", "jaw", "tooth", "spine"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(has_bones(name));
    std::set<std::string> different;
    for (std::uint32_t number = 1; number <= 200; ++number) {
      const std::string drawn = drawn_bone(name, number);
      EXPECT_EQ(drawn, drawn_bone(name + "?bone=3", number));
      different.insert(drawn);
      const std::string whole = name + (drawn.empty() ? "" : "?" + drawn);
      ASSERT_TRUE(known(whole)) << whole;
      const auto here = landmarks(name + "?bone=" + std::to_string(number));
      const auto there = landmarks(whole);
      ASSERT_EQ(here.size(), there.size());
      for (std::size_t n = 0; n < here.size(); ++n)
        for (std::size_t p = 0; p < here[n].points.size(); ++p)
          ASSERT_EQ(here[n].points[p], there[n].points[p]) << here[n].name;
    }
    EXPECT_GE(different.size(), 12U);
  }
  EXPECT_EQ(make("jaw?bone=7", 0.6)->content_hash(),
            make("jaw?" + drawn_bone("jaw", 7), 0.6)->content_hash());
  EXPECT_EQ(make("jaw?bone=7,high-nerve=0.3", 0.6)->content_hash(),
            make("jaw?high-nerve=0.3", 0.6)->content_hash());
  EXPECT_FALSE(has_bones("block"));
  // so that the bone of a recording stays the same for ever
  EXPECT_EQ(drawn_bone("temporal-bone", 2), "forward-sinus=3,low-dura=1.1");
  EXPECT_EQ(drawn_bone("tooth", 2), "shallow=0.5,deep=0.4");
}

TEST(Phantoms, AnAmountOrANumberThatCannotBeIsTurnedDown) {
  NoProgress nobody;
  const auto said = [&](const std::string& name) {
    const auto made = phantom(name, 0.6, nobody);
    EXPECT_FALSE(made.ok()) << name;
    return made ? std::string() : made.error().text;
  };
  for (const std::string_view one : {"=0", "=-1", "=9", "=", "=x", "=nan", "=1mm", "=1e-400"})
    EXPECT_NE(said("jaw?high-nerve" + std::string(one)).find("at most 2.5 mm"), std::string::npos)
        << one;
  EXPECT_NE(said("jaw?long=2").find("takes no amount"), std::string::npos);
  for (const std::string_view one : {"", "=", "=0", "=-1", "=1000001", "=4294967297", "=1.5"})
    EXPECT_NE(said("jaw?bone" + std::string(one)).find("bone=1 to bone=1000000"), std::string::npos)
        << one;
  EXPECT_NE(said("block?bone=2").find("has no others"), std::string::npos);
}

TEST(Phantoms, BadNamesAndVoxelsAreTurnedDownWithWhatThereIs) {
  NoProgress nobody;
  const auto unknown = phantom("elbow", 0.3, nobody);
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().trouble, Trouble::usage);
  EXPECT_NE(unknown.error().text.find("elbow"), std::string::npos);
  EXPECT_NE(unknown.error().text.find("temporal-bone, jaw, tooth"), std::string::npos);
  for (const double voxel_mm : {-1.0, 1e-3, 50.0, std::nan(""), 1e300}) {
    const auto bad = phantom("temporal-bone", voxel_mm, nobody);
    ASSERT_FALSE(bad.ok()) << voxel_mm;
    EXPECT_EQ(bad.error().trouble, Trouble::usage);
    EXPECT_NE(bad.error().text.find("0.25 mm"), std::string::npos) << bad.error().text;
  }
  EXPECT_EQ(default_voxel_mm("elbow"), 0);
}

}  // namespace
}  // namespace burr::phantom
