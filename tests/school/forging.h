// tests/school/forging.h - a sealed recording is written again with something changed; every sum, and the head, are then
// those of the new file, as a forger who knows all of burr would have them.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/schema.h"
#include "burr/record/sealer.h"
#include "burr/record/session_info.h"
#include "burr/record/text_sums.h"
#include "burr/school/signing_key.h"

namespace burr::test {

using Words = std::map<std::string, std::string>;
using Bytes = std::vector<std::uint8_t>;

// What a forger does with a recording: each message, and the words of its seal.
struct Forgery {
  // none: the message is left out
  std::function<std::optional<Bytes>(const std::string& topic, record::ByteSpan)> message =
      [](const std::string&, record::ByteSpan data) { return Bytes(data.begin(), data.end()); };
  std::function<void(Words& seal)> seal = [](Words&) {
  };  // has the new head already; empty it: no seal
  bool account = true;
  Words more = {};  // metadata of the forger's own
};

inline std::string topic_of_channel(const record::McapReader& file, std::uint16_t channel) {
  for (const record::mcap::Channel& one : file.channels())
    if (one.id == channel) return one.topic;
  return {};
}

inline Words words_of(const record::McapReader& file, const std::string& name) {
  for (std::size_t n = 0; n < file.metadata().size(); ++n)
    if (file.metadata()[n].name == name) return *file.read_metadata(n);
  return {};
}

// The sums of the texts, head and all, are those of the forged file.
inline void forge(const std::string& from, const std::string& to, const Forgery& by) {
  const auto read = record::McapReader::open(from, record::McapReader::Trust::nothing);
  ASSERT_TRUE(read) << read.error().text;
  const record::McapReader& file = **read;
  record::McapWriter out;
  ASSERT_TRUE(out.open(to, to));
  ASSERT_TRUE(out.add_metadata("burr.format", words_of(file, "burr.format")));
  for (const auto& schema : file.schemas()) ASSERT_TRUE(out.add(schema));
  for (const auto& channel : file.channels()) ASSERT_TRUE(out.add(channel));
  record::TextSums sums;
  for (std::size_t c = 0; c < file.chunks().size(); ++c) {
    const auto chunk = file.read_chunk(c);
    ASSERT_TRUE(chunk);
    for (const record::McapMessage& one : chunk->messages) {
      const std::string topic = topic_of_channel(file, one.channel);
      const auto data = by.message(topic, one.data);
      if (!data) continue;
      if (record::is_summed(topic)) record::add_to(sums, topic, *data);
      out.add_message(one.channel, one.sequence, one.time_ns, *data);
    }
    ASSERT_TRUE(out.close_chunk());
  }
  if (!by.more.empty()) {
    ASSERT_TRUE(out.add_metadata("forger", by.more));
  }
  Words account = words_of(file, record::kAccountName);
  for (const auto& [topic, sum] : sums) account[record::kSumOf + topic] = record::hex(sum);
  if (by.account) {
    ASSERT_TRUE(out.add_metadata(record::kAccountName, account));
  }
  Words seal = words_of(file, record::kSealName);
  const auto head = school::sha256_of_beginning(to, out.size());
  ASSERT_TRUE(head);
  seal["head"] = *head;
  by.seal(seal);
  if (!seal.empty()) {
    ASSERT_TRUE(out.add_metadata(record::kSealName, seal));
  }
  ASSERT_TRUE(out.finish());
}

inline Bytes bytes_of_text(const std::string& text) { return {text.begin(), text.end()}; }

// A forgery of /session alone.
inline Forgery session_forged(const std::function<void(nlohmann::json&)>& change) {
  Forgery by;
  by.message = [change](const std::string& topic, record::ByteSpan data) -> std::optional<Bytes> {
    if (topic != record::kSession.name) return Bytes(data.begin(), data.end());
    nlohmann::json session = nlohmann::json::parse(record::as_text(data));
    change(session);
    return bytes_of_text(session.dump(1));
  };
  return by;
}

}  // namespace burr::test
