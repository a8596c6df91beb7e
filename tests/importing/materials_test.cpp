// The table of materials: the built-in one, a user's own, and the constants that tissues get.
#include "burr/importing/materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "burr/importing/tissues.h"
#include "io/folder_of_test.h"

namespace burr::importing {
namespace {

TEST(Materials, TheBuiltInTableSaysOfEveryConstantHowSureItIs) {
  const Materials& all = built_in_materials();
  for (const char* name : {"cortical bone", "trabecular bone", "dentine", "caries", "enamel",
                           "cement", "polyurethane foam", "soft tissue"})
    EXPECT_NE(all.find(name), nullptr) << name;
  for (const Material& material : all.all)
    for (const MaterialField& field : material_fields()) {
      const auto& constant = material.*(field.place);
      const bool thermal = std::string(field.key).find("conduct") == 0 ||
                           std::string(field.key).find("density") == 0 ||
                           std::string(field.key).find("specific") == 0;
      ASSERT_EQ(constant.has_value(), thermal || material.name != "soft tissue")
          << material.name << " " << field.key;
      if (!constant) continue;
      EXPECT_TRUE(constant->low <= constant->value && constant->value <= constant->high);
      EXPECT_FALSE(constant->source.empty());
      EXPECT_FALSE(constant->calibrated) << "nobody has measured anything for burr";
    }
}

// a tissue without any table must equal the table's cortical bone
TEST(Materials, CorticalBoneIsTheDefaultTissue) {
  volume::Tissue tissue;
  tissue.cutting_energy = tissue.friction = tissue.cutting_friction = 1;
  tissue.force.chip_tangential = 1;
  tissue.force.chip_radial = tissue.force.edge_tangential = tissue.force.edge_radial = 1;
  tissue.force.edge_onset = 1;
  apply_material(*built_in_materials().find("cortical bone"), tissue);
  const volume::Tissue usual;
  const auto same = [](double a, double b) { EXPECT_NEAR(a, b, 1e-12 * b); };
  same(tissue.cutting_energy, usual.cutting_energy);
  same(tissue.friction, usual.friction);
  same(tissue.cutting_friction, usual.cutting_friction);
  same(tissue.force.chip_tangential, usual.force.chip_tangential);
  same(tissue.force.chip_radial, usual.force.chip_radial);
  same(tissue.force.edge_tangential, usual.force.edge_tangential);
  same(tissue.force.edge_radial, usual.force.edge_radial);
  same(tissue.force.edge_onset, usual.force.edge_onset);
}

TEST(Materials, ForcesGrowWithTheEnergyOfCutting) {
  const Material& cortical = *built_in_materials().find("cortical bone");
  for (const Material& material : built_in_materials().all) {
    if (!material.cutting_energy) continue;
    const double harder = material.cutting_energy->value / cortical.cutting_energy->value;
    for (const auto place : {&Material::chip_tangential, &Material::chip_radial,
                             &Material::edge_tangential, &Material::edge_radial})
      EXPECT_NEAR((material.*place)->value / (cortical.*place)->value, harder, 1e-9 * harder)
          << material.name;
  }
}

TEST(Materials, CariesIsSofterThanDentineAndDentineThanEnamel) {
  const auto energy = [](const char* name) {
    return tissue_by_name({1, name, {1, 1, 1}}, true).cutting_energy;
  };
  EXPECT_LT(energy("caries"), energy("dentine"));
  EXPECT_LT(energy("Carious Dentin"), energy("dentine")) << "the rarer word counts";
  EXPECT_LT(energy("dentine"), energy("enamel"));
  EXPECT_LT(energy("trabecular bone"), energy("cortical bone"));
  EXPECT_LT(energy("PMMA cement"), energy("cortical bone"));
  EXPECT_EQ(energy("left mandible"), energy("cortical bone"));
  EXPECT_EQ(energy("cementum"), energy("dentine")) << "of the tooth, no PMMA";
}

TEST(Materials, SoftTissueOnlyWarms) {
  const Material& soft = built_in_materials().of("facial nerve", volume::TissueKind::soft);
  EXPECT_EQ(soft.name, "soft tissue");
  EXPECT_FALSE(soft.cutting_energy);
  EXPECT_NEAR(soft.specific_heat->value, 3600, 1e-9);
}

// ---- CT without labels

TEST(HuTissues, NoneIsHarderThanADenserOne) {
  const volume::TissueTable table = hu_tissues();
  double last = 0;
  volume::TissueId id = 0;
  for (double hu = -1000; hu < 4000; hu += 0.5) {
    const volume::TissueId now = hu_tissue(hu);
    ASSERT_GE(now, id);
    ASSERT_LT(now, table.tissues.size());
    id = now;
    ASSERT_GE(table[now].cutting_energy, last) << hu;
    last = table[now].cutting_energy;
  }
  EXPECT_EQ(id + 1U, table.tissues.size()) << "every class is somebody's";
}

TEST(HuTissues, TrabecularGoesWithTheSquareOfDensityAndCorticalIsAllOne) {
  const volume::TissueTable table = hu_tissues();
  const auto energy = [&table](double hu) { return table[hu_tissue(hu)].cutting_energy; };
  // middles of the classes: u / rho^2 is one constant
  const auto rho = [](double hu) { return 131 + 1.067 * hu; };
  const double share = energy(262.5) / std::pow(rho(262.5), 2);
  for (const double hu : {387.5, 512.5, 637.5})
    EXPECT_NEAR(energy(hu) / std::pow(rho(hu), 2), share, 1e-9 * share) << hu;
  EXPECT_NEAR(share * std::pow(rho(450), 2), 0.1e9, 1) << "the table's trabecular bone";
  // within 10 % of cortical bone's times (rho / rho_c)^2
  EXPECT_NEAR(share * std::pow(1950, 2), energy(1000), 0.1 * energy(1000));
  std::set<double> trabecular, cortical;
  for (double hu = 200; hu < 700; ++hu) trabecular.insert(energy(hu));
  for (double hu = 700; hu < 2000; ++hu) cortical.insert(energy(hu));
  EXPECT_EQ(trabecular.size(), 4U);
  EXPECT_EQ(cortical.size(), 1U);
  EXPECT_EQ(table[hu_tissue(200)].name, "trabecular bone 200-325 HU");
  EXPECT_EQ(table[hu_tissue(699)].name, "trabecular bone 575-700 HU");
}

// ---- a user's own file

constexpr const char* kMine = R"(
[[material]]
name = "Cortical_Bone"
cutting_energy_J_mm3 = { value = 2, low = 1.5, high = 2.5, source = "my drill", calibrated = true }

[[material]]
name = "balsa"
like = "polyurethane foam"
friction = { value = 0.4, low = 0.3, high = 0.5, source = "guess", calibrated = false }

[[material]]
name = "horn"
cutting_energy_J_mm3 = { value = 0.7, low = 0, high = 1, source = "guess", calibrated = false }
)";

TEST(Materials, AFileIsLaidOverTheBuiltInTable) {
  const auto mine = parse_materials(kMine, "mine.toml", built_in_materials());
  ASSERT_TRUE(mine.ok()) << mine.error().text;
  EXPECT_EQ(mine->all.size(), built_in_materials().all.size() + 2);
  const Material& bone = *mine->find("cortical bone");
  EXPECT_NEAR(bone.cutting_energy->value, 2e9, 1);
  EXPECT_NEAR(bone.cutting_energy->low, 1.5e9, 1);
  EXPECT_NEAR(bone.cutting_energy->high, 2.5e9, 1);
  EXPECT_EQ(bone.cutting_energy->source, "my drill");
  EXPECT_TRUE(bone.cutting_energy->calibrated);
  EXPECT_EQ(bone.friction->source, built_in_materials().find("cortical bone")->friction->source);
  const Material& balsa = *mine->find("balsa");
  EXPECT_NEAR(balsa.friction->value, 0.4, 1e-12);
  EXPECT_NEAR(balsa.cutting_energy->value, 0.1e9, 1) << "like foam";
  EXPECT_NEAR(mine->find("horn")->friction->value, 0.25, 1e-12) << "like cortical bone";
  EXPECT_EQ(mine->of("horn").name, "horn") << "a tissue of that name";
}

TEST(Materials, WrittenAndReadAgainIsTheSame) {
  std::vector<Material> made = built_in_materials().all;
  made.front().cutting_energy->source = "a \"quoted\" \\ name\nof two lines";
  made.front().cutting_energy->calibrated = true;
  const auto again = parse_materials(materials_toml(made), "again.toml", {});
  ASSERT_TRUE(again.ok()) << again.error().text;
  ASSERT_EQ(again->all.size(), made.size());
  EXPECT_EQ(again->all[0].cutting_energy->source, "a \"quoted\" \\ name of two lines");
  EXPECT_TRUE(again->all[0].cutting_energy->calibrated);
  for (std::size_t n = 0; n < made.size(); ++n) {
    EXPECT_EQ(again->all[n].name, made[n].name);
    for (const MaterialField& field : material_fields()) {
      const auto &a = again->all[n].*(field.place), &b = made[n].*(field.place);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (!a) continue;
      EXPECT_NEAR(a->value, b->value, 1e-8 * b->value);
      EXPECT_NEAR(a->low, b->low, 1e-8 * b->value);
      EXPECT_NEAR(a->high, b->high, 1e-8 * b->high);
    }
  }
}

TEST(Materials, BadFilesEndInOneSentence) {
  const std::string good = "low = 1, high = 3, source = \"s\", calibrated = false }\n";
  const auto with = [](const std::string& line) {
    return "[[material]]\nname = \"bone\"\n" + line;
  };
  const std::pair<std::string, const char*> cases[] = {
      {"[[material\n", "line 1"},
      {"", "no [[material]]"},
      {"material = 3\n", "no [[material]]"},
      {"material = [3]\n", "list of tables, [[material]]"},
      {"[[label]]\nvalue = 1\n", "label is not a known field"},
      {"[[material]]\nfriction = 1\n", "name is missing"},
      {"[[material]]\nname = \" \"\n", "name is missing"},
      {"[[material]]\nname = 3\n", "name is missing"},
      {with("cutting_energy = 1\n"), "cutting_energy is not a known field; use name, like, cu"},
      {with("friction = 0.3\n"), "write { value"},
      {with("friction = { value = 2, colour = 1, " + good), "colour is not a known field"},
      {with("friction = { low = 1, high = 3, source = \"s\", calibrated = false }\n"),
       "value is missing"},
      {with("friction = { value = \"2\", " + good), "value must be a number"},
      {with("friction = { value = nan, " + good), "value must be a number"},
      {with("friction = { value = inf, " + good), "value must be a number"},
      {with("friction = { value = 0, " + good), "must be above 0"},
      {with("friction = { value = -2, " + good), "must be above 0"},
      {with("friction = { value = 2.5, " + good), "at most 2"},
      {with("friction = { value = 0.5, " + good), "low 1 must be from 0 to the value 0.5"},
      {with("friction = { value = 1, low = -1, high = 1, source = \"s\", calibrated = false }\n"),
       "low -1"},
      {with("friction = { value = 1, low = 1, high = 0.5, source = \"s\", calibrated = false }\n"),
       "high 0.5"},
      {with("friction = { value = 1, low = 1, high = 1, calibrated = false }\n"),
       "source is missing"},
      {with("friction = { value = 1, low = 1, high = 1, source = \"\", calibrated = true }\n"),
       "source is missing"},
      {with("friction = { value = 1, low = 1, high = 1, source = \"s\", calibrated = 1 }\n"),
       "calibrated must be true or false"},
      {with("like = \"stone\"\n"), "must name a material"},
      {with("[[material]]\nname = \"BONE\"\n"), "appears twice"},
      {"[[material]]\nname = \"enamel\"\nlike = \"dentine\"\n", "like is only for new materials"},
  };
  for (const auto& [text, words] : cases) {
    const auto read = parse_materials(text, "mine.toml", built_in_materials());
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_EQ(read.error().text.find("mine.toml: "), 0U) << read.error().text;
    EXPECT_NE(read.error().text.find(words), std::string::npos) << text << "\n"
                                                                << read.error().text;
    EXPECT_EQ(read.error().text.find('\n'), std::string::npos) << read.error().text;
  }
}

using MaterialFiles = test::FolderTest;

TEST_F(MaterialFiles, AreReadAndMissedByTheirShortName) {
  std::ofstream(path("mine.toml")) << kMine;
  const auto read = read_materials(path("mine.toml"));
  ASSERT_TRUE(read.ok()) << read.error().text;
  EXPECT_NE(read->find("balsa"), nullptr);
  const auto missing = read_materials(path("no.toml"));
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().trouble, Trouble::io);
  std::ofstream(path("big.toml")) << std::string((1 << 20) + 1, '#');
  const auto big = read_materials(path("big.toml"));
  ASSERT_FALSE(big.ok());
  EXPECT_NE(big.error().text.find("too large"), std::string::npos);
}

TEST_F(MaterialFiles, ALabelMaySayItsMaterial) {
  io::Scan scan;
  scan.label_names = {{1, "part 7", {1, 1, 1}}, {2, "part 8", {1, 1, 1}}};
  std::array<bool, 256> present{};
  present[1] = present[2] = true;
  std::ofstream(path("t.toml")) << "[[label]]\nvalue = 1\nmaterial = \"Dentine\"\n"
                                   "[[label]]\nvalue = 2\nmaterial = \"enamel\"\n"
                                   "cutting_energy_J_mm3 = 7.0\n";
  const auto tissues = label_tissues(scan, present, path("t.toml"));
  ASSERT_TRUE(tissues.ok()) << tissues.error().text;
  EXPECT_NEAR(tissues->table[1].cutting_energy, 2e9, 1);
  EXPECT_NEAR(tissues->table[1].force.edge_tangential, 16e3, 1e-6);
  EXPECT_NEAR(tissues->table[2].cutting_energy, 7e9, 1) << "the label's own figure";
  EXPECT_NEAR(tissues->table[2].friction, 0.2, 1e-12);
  std::ofstream(path("t.toml")) << "[[label]]\nvalue = 1\nmaterial = \"stone\"\n";
  const auto wrong = label_tissues(scan, present, path("t.toml"));
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().text.find("t.toml: label 1: material \"stone\" is not known; use one of "
                                    "cortical bone"),
            std::string::npos)
      << wrong.error().text;
}

}  // namespace
}  // namespace burr::importing
