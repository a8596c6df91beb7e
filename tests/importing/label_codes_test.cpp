// Codes of SNOMED CT in a table of labels: taken as they stand, and refused where they can be none.
#include "burr/importing/label_codes.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/folder_of_test.h"

namespace burr::importing {
namespace {

class LabelCodesTest : public test::FolderTest {
 protected:
  Result<std::vector<LabelCodes>> of(const std::string& text) {
    std::ofstream(path("t.toml")) << text;
    return label_codes(path("t.toml"));
  }
};

TEST_F(LabelCodesTest, ByValueAndByName) {
  const auto table =
      of("[[label]]\nvalue = 2\nname = \"renamed\"\nsct = \"91609006 Mandible\"\n"
         "[[label]]\nname = \"Facial_Nerve\"\nsct = \"56052001  Facial nerve\"\n"
         "sct_category = \"123037004 Body structure\"\n"
         "[[label]]\nvalue = 9\nkind = \"soft\"\n");
  ASSERT_TRUE(table.ok()) << table.error().text;
  ASSERT_EQ(table->size(), 2U) << "one entry has no code";
  const auto codes = codes_of(*table, {{.value = 2, .name = "facial nerve"},
                                       {.value = 4, .name = "facial nerve"},
                                       {.value = 5, .name = "renamed"},
                                       {.value = 6, .name = "x", .in_file = 2},
                                       {.value = 9, .name = "y"}});
  // 2 is both: the entry that comes later counts, as in the table of kinds
  EXPECT_EQ(codes.at(2).type->meaning, "Facial nerve");
  EXPECT_EQ(codes.at(4).type->value, "56052001");
  EXPECT_EQ(codes.at(4).type->scheme, "SCT");
  EXPECT_EQ(codes.at(4).category->meaning, "Body structure");
  EXPECT_EQ(codes.count(5), 0U) << "an entry with a value is not known by its name";
  EXPECT_EQ(codes.at(6).type->meaning, "Mandible") << "the number in the file";
  EXPECT_EQ(codes.count(9), 0U);
  EXPECT_TRUE(label_codes("").value().empty());
}

TEST_F(LabelCodesTest, RefusedInOneSentence) {
  for (const auto& [sct, words] : std::vector<std::pair<const char*, const char*>>{
           {"\"Mandible\"", "is no code; write the number of SNOMED CT"},
           {"\"91609006\"", "is no code"},
           {"\"91609006 \"", "is no code"},
           {"\"12345 Mandible\"", "is no code"},
           {"\"12345678901234567 Mandible\"", "is no code"},
           {"91609006", "must be text"},
           {"\"91609007 Mandible\"", "check digit"},
           {"\"91690006 Mandible\"", "check digit"}}) {
    const auto table = of(std::string("[[label]]\nvalue = 3\nsct = ") + sct + "\n");
    ASSERT_FALSE(table.ok()) << sct;
    EXPECT_NE(table.error().text.find(words), std::string::npos) << table.error().text;
    EXPECT_NE(table.error().text.find("t.toml: label 3"), std::string::npos) << table.error().text;
  }
  EXPECT_FALSE(label_codes(path("none.toml")).ok());
}

}  // namespace
}  // namespace burr::importing
