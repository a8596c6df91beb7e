// tests/record/forged.h - a recording whose ticks somebody changed: all else is as it was.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "burr/record/copy_records.h"
#include "burr/record/schema.h"

namespace burr::record::test {

// change: false leaves the tick out. topic: of one hand or the other.
inline void forge(const std::string& path, const std::function<bool(tick::TickRow&)>& change,
                  const char* topic = kTicks.name) {
  const std::string beside = path + ".forged";
  {
    const auto from = McapReader::open(path);
    ASSERT_TRUE(from) << from.error().text;
    McapWriter to;
    ASSERT_TRUE(to.open(beside, beside));
    ASSERT_TRUE(copy_beginning(**from, to));
    const auto of_topic = (*from)->channels_of(topic);
    for (std::size_t i = 0; i < (*from)->chunks().size(); ++i) {
      const auto chunk = (*from)->read_chunk(i);
      ASSERT_TRUE(chunk) << chunk.error().text;
      for (const McapMessage& message : chunk->messages) {
        std::vector<tick::TickRow> rows;
        BytesOut bytes;
        if (of_topic.contains(message.channel)) {
          ASSERT_TRUE(decode_ticks(message.data, rows));
          std::erase_if(rows, [&change](tick::TickRow& row) { return !change(row); });
          encode_ticks(rows, bytes);
        } else {
          bytes.raw(message.data);
        }
        to.add_message(message.channel, message.sequence, message.time_ns, bytes.span());
      }
      ASSERT_TRUE(to.close_chunk());
    }
    ASSERT_TRUE(to.finish());
  }
  std::filesystem::rename(beside, path);
}

}  // namespace burr::record::test
