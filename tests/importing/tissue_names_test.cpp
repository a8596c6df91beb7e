// What names of labels say, in six languages and by code (importing/tissue_names.h).
#include "burr/importing/tissue_names.h"

#include <gtest/gtest.h>

#include "burr/importing/tissues.h"
#include "io/folder_of_test.h"

namespace burr::importing {
namespace {

using volume::TissueKind;

struct Names {
  TissueKind kind;
  bool spare;
  std::vector<const char*> names;
};

TEST(TissueNames, AreUnderstoodInSixLanguages) {
  const Names all[] = {
      {TissueKind::solid,
       false,
       {"Bone",
        "Unterkiefer",
        "Schläfenbein",
        "Os temporale",
        "Underkäke",
        "tinningben",
        "Mandibule",
        "Os temporal",
        "Hueso temporal",
        "mandíbula",
        "vertebrae_L1",
        "rib_left_4",
        "Tooth 36",
        "Zahn <36> & Wurzel",
        "Dentes",
        "Tänder",
        "Dents",
        "Zahnschmelz",
        "Felsenbein",
        "Mastoid",
        "processus mastoideus",
        "CorticalBone",
        "Oberkieferknochen links",
        "Schaedel",
        "Jochbein",
        "Ethmoid bone",
        "SIEBBEIN",
        "Maxillary sinus wall",
        "Crâne",
        "Cráneo",
        "lower_jaw",
        "Implantat",
        "Bony canal wall"}},
      {TissueKind::solid,
       true,
       {"Malleus", "Gehörknöchelchen", "Incus", "Steigbügel", "Osselets", "hörselbenen",
        "Bony_Labyrinth", "bony dura plate"}},
      {TissueKind::soft,
       true,
       {"Nervus facialis",
        "N. facialis",
        "N.facialis_li",
        "Nerv",
        "Gesichtsnerv",
        "Ansiktsnerv",
        "Ansiktsnerven höger",
        "Nerf facial",
        "Nervio facial",
        "FacialNerve",
        "facial_nerve_L",
        "cranial nerve VII",
        "Facial nerve (mastoid segment)",
        "Nerv des Unterkiefers",
        "nervus mandibularis",
        "Fazialis",
        "Arteria carotis interna",
        "A. carotis int.",
        "Halsschlagader",
        "arteria vertebralis",
        "Artère carotide",
        "halspulsåder",
        "Gefäße",
        "Gefaesse",
        "Blutgefässe",
        "sigmoid sinus",
        "Sinus sigmoideus",
        "Sinus_and_Dura",
        "vertebral artery",
        "Vena jugularis",
        "Dura mater",
        "Hirnhaut",
        "Dure-mère",
        "duramadre",
        "hårda hjärnhinnan",
        "Gehirn",
        "hjärna",
        "Cerveau",
        "Cerebro",
        "temporal lobe",
        "Rückenmark",
        "RUECKENMARK",
        "ryggmärg",
        "Moelle épinière",
        "Médula espinal",
        "Auge",
        "öga",
        "Œil",
        "Ojo izquierdo",
        "bulbus oculi",
        "Cochlea",
        "Hörschnecke",
        "hörselsnäckan",
        "Cochlée",
        "Labyrinth",
        "Bogengänge",
        "innerer Gehörgang",
        "Conduit auditif interne",
        "Meatus acusticus internus",
        "IAC",
        "Mandibularkanal",
        "Canal mandibulaire",
        "conducto dentario inferior",
        "Canalis mandibulae",
        "Left Inferior Alveolar Canal",
        "inferior_alveolar_nerve",
        "SCT 86117002"}},
      {TissueKind::soft,
       false,
       {"Haut", "Skin", "hud", "Peau", "Piel", "Muskel", "M. masseter", "Zahnfleisch", "Zunge",
        "Bandscheibe", "intervertebral disc", "Kiefergelenk", "brosk", "Pulpa dentis", "tongue",
        "Nasal cartilage", "Trommelfell"}},
      {TissueKind::air,
       false,
       {"Gehoergang",
        "Gehörgang",
        "Kieferhöhle",
        "Kieferhoehle re",
        "Kieferho\xCC\x88hle",
        "Stirnhöhle",
        "käkhåla",
        "bihålor",
        "Sinus maxillaris",
        "Sinus maxillaire",
        "Seno maxilar",
        "maxillary_sinus_L",
        "EAC",
        "ear canal",
        "hörselgång",
        "Conduit auditif externe",
        "Conducto auditivo externo",
        "Meatus acusticus externus",
        "mastoid air cells",
        "Mastoidzellen",
        "Cellulae mastoideae",
        "Cellules mastoïdiennes",
        "celdillas mastoideas",
        "Paukenhöhle",
        "Mittelohr",
        "Caisse du tympan",
        "cavum tympani",
        "Luft",
        "air",
        "Siebbeinzellen",
        "nasal_cavity_right",
        "Atemwege"}},
  };
  for (const Names& group : all)
    for (const char* name : group.names) {
      const NamedTissue says = tissue_named(name);
      EXPECT_TRUE(says.known) << name;
      EXPECT_EQ(says.kind, group.kind) << name;
      EXPECT_EQ(says.spare, group.spare) << name;
    }
}

using TissueNameFiles = test::FolderTest;

TEST(TissueNames, AreNotInvented) {
  for (const char* name : {"", "Segment_1", "part 7", "label 12", "A1", "V2", "M3", "xyz", "7",
                           "\xFF\xFE", "Left", "***", "des"})
    EXPECT_FALSE(tissue_named(name).known) << name;
  EXPECT_FALSE(tissue_named(std::string(100000, 'a')).known);
}

TEST_F(TissueNameFiles, ListsOfOtherProgramsNameTheLabels) {
  io::Scan scan;
  scan.label_names = {{.value = 3, .name = "", .in_file = 2035}};
  std::array<bool, 256> present{};
  present[1] = present[2] = present[3] = true;
  std::ofstream(path("snap.txt"))
      << "# list\n0 0 0 0 0 0 0 \"Clear Label\"\n1 255 0 0 1 1 1 \"Unterkiefer\"\n"
         "2 0 255 0 1 1 1 \"Nervus facialis\"\n2035 0 0 255 1 1 1 \"Kieferhöhle\"\n";
  const auto read = label_tissues(scan, present, path("snap.txt"));
  ASSERT_TRUE(read.ok()) << read.error().text;
  EXPECT_EQ(read->table[1].name, "Unterkiefer");
  EXPECT_EQ(read->table[1].colour[0], 1.0F);
  EXPECT_EQ(read->table[2].kind, TissueKind::soft);
  ASSERT_EQ(read->air.size(), 1U);
  EXPECT_EQ(read->air[0].name, "Kieferhöhle");
  std::ofstream(path("free.txt")) << "77 Left-Thalamus 0 118 14 0\n";
  const auto wrong = label_tissues(scan, present, path("free.txt"));
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().text.find("free.txt: none of its labels occurs"), std::string::npos);
  std::ofstream(path("t.toml")) << "[[label]]\nvalue = 2035\nkind = \"soft\"\n";
  const auto table = label_tissues(scan, present, path("t.toml"));
  ASSERT_TRUE(table.ok()) << table.error().text;
  EXPECT_EQ(table->table[3].kind, TissueKind::soft);
}

TEST(TissueNames, ThatAreNotUnderstoodAreSaid) {
  io::Scan scan;
  scan.label_names = {{.value = 1, .name = "Bone"},
                      {.value = 2, .name = "Qwerty"},
                      {.value = 3, .name = "Segment_3", .meaning = "Facial nerve SCT 56052001"},
                      {.value = 4, .name = "Knochen", .meaning = "Skin SCT 39937001"},
                      {.value = 5, .name = "", .meaning = "SCT 86117002"}};
  std::array<bool, 256> present{};
  present[1] = present[2] = present[3] = present[4] = present[5] = true;
  const auto read = label_tissues(scan, present, "");
  ASSERT_TRUE(read.ok());
  const auto says = [&](const std::string& words) {
    for (const std::string& notice : read->notices)
      if (notice.find(words) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(says("does not understand the name of label 2 (Qwerty)"));
  EXPECT_TRUE(says("`labels`"));
  EXPECT_FALSE(says("Segment_3"));
  EXPECT_TRUE(says("Label 4 is named Knochen, but its code says Skin"));
  EXPECT_EQ(read->table[3].kind, TissueKind::soft);
  EXPECT_TRUE(read->table[3].spare);
  EXPECT_EQ(read->table[4].kind, TissueKind::solid);
  EXPECT_EQ(read->table[5].kind, TissueKind::soft);
}

}  // namespace
}  // namespace burr::importing
