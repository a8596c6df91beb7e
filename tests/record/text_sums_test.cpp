// A text of a recording that was changed, taken out or added is found from the file alone; so is what was done to a
// sealed file outside of its seal.
#include "burr/record/text_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/record/chain.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/player.h"
#include "burr/record/repair.h"
#include "burr/record/sealer.h"
#include "burr/tick/tick_hash.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

using test::Random;
using Words = std::map<std::string, std::string>;
// topic, text -> the texts that stand in its place
using Change = std::function<std::vector<std::string>(const std::string&, const std::string&)>;

constexpr const char* kTexts[] = {"/session", "/wishes", "/events", "/view", "/course"};

class FakeSealer final : public Sealer {
 public:
  std::optional<StartSeal> begin(const SessionInfo& info) override {
    EXPECT_FALSE(info.seal);
    return StartSeal{"station-3", "aa", 17, "bb"};
  }
  std::optional<Words> end(const std::string& file, std::uint64_t bytes) override {
    EXPECT_EQ(std::filesystem::file_size(file), bytes);  // nothing is on its way
    return Words{{"bytes", std::to_string(bytes)}};
  }
};

class TextSumsTest : public testing::Test {
 protected:
  std::string recorded(bool sealed) {
    std::string file = (own_.path() / ("s" + std::to_string(++count_) + ".mcap")).string();
    const auto bone = test::any_bone(random_);
    Recorder recorder(1000);
    if (sealed) recorder.set_sealer(std::make_shared<FakeSealer>());
    EXPECT_TRUE(recorder.start(file, test::info_of(*bone, random_), nullptr).ok());
    std::uint64_t last = 0;
    for (std::uint64_t tick = 0; tick < 200; ++tick) {
      if (tick == 50) {
        EXPECT_TRUE(recorder.commands().push({tick, {tick::CommandKind::spindle_speed, 0.5}}));
      }
      tick::TickRow row = test::any_tick(tick, random_);
      row.hash = last = tick::tick_hash(row, last);
      EXPECT_TRUE(recorder.ticks().push(row));
    }
    EXPECT_TRUE(recorder.note(View{.tick = 3}).ok());
    EXPECT_TRUE(recorder.note(CourseEvent{.tick = 9, .kind = CourseKind::done}).ok());
    EXPECT_TRUE(recorder.finish().ok());
    return file;
  }

  // Writes the file again, with its account as it was.
  std::string again(const std::string& from, const Change& change) {
    std::string to = (own_.path() / ("c" + std::to_string(++count_) + ".mcap")).string();
    const auto read = McapReader::open(from);
    EXPECT_TRUE(read.ok());
    const McapReader& file = **read;
    McapWriter out;
    EXPECT_TRUE(out.open(to, to).ok());
    for (const auto& schema : file.schemas()) EXPECT_TRUE(out.add(schema).ok());
    std::map<std::uint16_t, std::string> topics;
    for (const auto& channel : file.channels()) {
      EXPECT_TRUE(out.add(channel).ok());
      topics[channel.id] = channel.topic;
    }
    for (std::size_t c = 0; c < file.chunks().size(); ++c) {
      const auto chunk = file.read_chunk(c);
      for (const McapMessage& one : chunk->messages) {
        const std::string topic = topics[one.channel];
        std::vector<std::string> texts = {std::string(as_text(one.data))};
        if (is_summed(topic)) texts = change(topic, texts.front());
        for (const std::string& text : texts)
          out.add_message(one.channel, one.sequence, one.time_ns, as_bytes(text));
      }
      EXPECT_TRUE(out.close_chunk().ok());
    }
    for (std::size_t n = 0; n < file.metadata().size(); ++n)
      EXPECT_TRUE(out.add_metadata(file.metadata()[n].name, *file.read_metadata(n)).ok());
    EXPECT_TRUE(out.finish().ok());
    return to;
  }

  // "": nothing was found
  static std::string found_in(const std::string& file) {
    auto player = Player::open(file);
    EXPECT_TRUE(player.ok()) << player.error().text;
    NoProgress quiet;
    const Status whole = check_chain(**player, quiet);
    return whole ? "" : whole.error().text;
  }

  Random random_{20261201};
  const test::Folder own_;
  int count_ = 0;
};

TEST_F(TextSumsTest, AFileAsItWasWrittenIsWholeAlsoByAnotherWriter) {
  const std::string file = recorded(false);
  EXPECT_EQ(found_in(file), "");
  EXPECT_EQ(found_in(again(file, [](const auto&, const auto& text) { return std::vector{text}; })),
            "");
}

TEST_F(TextSumsTest, ATextThatWasChangedTakenOutOrAddedIsFound) {
  const std::string file = recorded(false);
  for (const std::string which : kTexts) {
    const auto only = [&which](const Change& change) {
      return [&which, change](const std::string& topic, const std::string& text) {
        return topic == which ? change(topic, text) : std::vector{text};
      };
    };
    const std::string changed = found_in(again(file, only([](const auto&, const auto& text) {
                                                 return std::vector{" " + text};  // the same JSON
                                               })));
    EXPECT_NE(changed.find(which + " was changed after it was recorded"), std::string::npos)
        << which << ": " << changed;
    const std::string twice = found_in(again(file, only([](const auto&, const auto& text) {
                                               return std::vector{text, text};
                                             })));
    EXPECT_NE(twice.find(which + " was changed"), std::string::npos) << which << ": " << twice;
    if (which == "/session") continue;  // without it nothing can be read
    const std::string without = found_in(
        again(file, only([](const auto&, const auto&) { return std::vector<std::string>(); })));
    EXPECT_NE(without.find(which + " was changed"), std::string::npos) << which << ": " << without;
  }
}

TEST_F(TextSumsTest, ASealIsTheLastRecordAndIsAboutAllBytesBeforeIt) {
  const std::string file = recorded(true);
  const auto seal = seal_in(file);
  ASSERT_TRUE(seal.ok()) << seal.error().text;
  ASSERT_TRUE(seal->has_value());
  EXPECT_EQ((*seal)->words.at("bytes"), std::to_string((*seal)->bytes));
  const auto player = Player::open(file);
  ASSERT_TRUE((*player)->info().seal.has_value());
  EXPECT_EQ(*(*player)->info().seal, (StartSeal{"station-3", "aa", 17, "bb"}));
  EXPECT_EQ(found_in(file), "");
  EXPECT_FALSE(seal_in(recorded(false))->has_value());

  // behind the seal, and twice
  const auto with = [&](const std::string& name) {
    const std::string to = (own_.path() / (name + ".mcap")).string();
    const auto read = McapReader::open(file);
    McapWriter out;
    EXPECT_TRUE(out.open(to, to).ok());
    for (std::size_t n = 0; n < (*read)->metadata().size(); ++n)
      EXPECT_TRUE(out.add_metadata((*read)->metadata()[n].name, *(*read)->read_metadata(n)).ok());
    EXPECT_TRUE(out.add_metadata(name, {}).ok());
    EXPECT_TRUE(out.finish().ok());
    const auto found = seal_in(to);
    return found ? std::string() : found.error().text;
  };
  EXPECT_NE(with("more").find("something was added behind"), std::string::npos);
  EXPECT_NE(with(kSealName).find("stands in it twice"), std::string::npos);

  // cut, and repaired: the seal was about other bytes
  std::vector<std::uint8_t> bytes = test::bytes_of_file(file);
  bytes.resize(bytes.size() - 20);
  const std::string cut = (own_.path() / "cut.mcap").string();
  test::write_file(cut, bytes);
  const auto torn = seal_in(cut);
  ASSERT_FALSE(torn.ok());
  EXPECT_NE(torn.error().text.find("is cut or damaged"), std::string::npos);
  NoProgress quiet;
  ASSERT_TRUE(repair(cut, cut, quiet).ok());
  EXPECT_FALSE(seal_in(cut)->has_value());
}

// The summary is not under the seal, and readers believe it.
TEST_F(TextSumsTest, ASummaryThatSaysSomethingElseIsFound) {
  const std::string file = recorded(true);
  std::vector<std::uint8_t> bytes = test::bytes_of_file(file);
  const std::string topic = "/course", other = "/coursE";
  std::size_t last = 0;  // in the summary
  for (std::size_t at = 0; at + topic.size() <= bytes.size(); ++at)
    if (std::equal(topic.begin(), topic.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at)))
      last = at;
  std::copy(other.begin(), other.end(), bytes.begin() + static_cast<std::ptrdiff_t>(last));
  // the CRC of the summary: 0 says that its writer computed none
  const std::size_t crc = bytes.size() - 8 - 4;
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(crc), 4, std::uint8_t{0});
  test::write_file(file, bytes);
  ASSERT_FALSE((*Player::open(file))->has_course()) << "the summary was not believed";
  const auto found = seal_in(file);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().text.find("its summary says something else"), std::string::npos);
}

}  // namespace
}  // namespace burr::record
