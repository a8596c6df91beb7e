#include "burr/school/uuid.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "burr/school/session_record.h"
#include "school/made.h"

namespace burr::school {
namespace {

TEST(Sha1, GivesThePublishedDigests) {
  // FIPS 180, and the lengths around the end of a block, by sha1sum
  EXPECT_EQ(sha1(""), "da39a3ee5e6b4b0d3255bfef95601890afd80709");
  EXPECT_EQ(sha1("abc"), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(sha1("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
  EXPECT_EQ(sha1(std::string(1'000'000, 'a')), "34aa973cd4c4daa4f61eeb2bdbad27316534016f");
  EXPECT_EQ(sha1(std::string(55, 'a')), "c1c8bbdc22796e28c0e15163d20899b65621d65a");
  EXPECT_EQ(sha1(std::string(64, 'a')), "0098ba824b5c16427bd7a1122a5a442a25ec644d");
  const test::Folder folder;
  std::ofstream(folder / "abc") << "abc";
  EXPECT_EQ(*sha1_of_file(folder / "abc"), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_FALSE(sha1_of_file(folder / "none"));
}

TEST(Uuid, OfANameIsThatOfTheStandard) {
  // RFC 4122's space for names of hosts; the value is Python's uuid.uuid5(NAMESPACE_DNS, "python.org")
  EXPECT_EQ(uuid_of("6ba7b810-9dad-11d1-80b4-00c04fd430c8", "python.org"),
            "886313e1-3b8a-5372-9b90-0c9aee199e5d");
}

TEST(Uuid, AtRandomIsAnother) {
  std::set<std::string> all;
  for (int n = 0; n < 1000; ++n) {
    const std::string one = uuid_at_random();
    EXPECT_EQ(one.size(), 36U);
    EXPECT_EQ(one[14], '4');
    EXPECT_TRUE(one[19] == '8' || one[19] == '9' || one[19] == 'a' || one[19] == 'b') << one;
    all.insert(one);
  }
  EXPECT_EQ(all.size(), 1000U);
}

TEST(SessionRecord, ComesBackFromJsonToTheBit) {
  const SessionRecord one = test::made_session("kestrel-27", "a");
  const auto back = session_from_json(to_json(one), "x.json");
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_EQ(*back, one);
  for (const char* bad : {"", "{", "[]", "{\"learner\": 5}"})
    EXPECT_FALSE(session_from_json(bad, "x.json")) << bad;
  SessionRecord named = one;
  named.learner = "Ada Lovelace";
  EXPECT_FALSE(session_from_json(to_json(named), "x.json"));
}

}  // namespace
}  // namespace burr::school
