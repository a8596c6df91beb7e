// Whether the texts of a recording are those that were recorded.
#include <fmt/core.h>

#include "burr/record/player.h"

namespace burr::record {

Player::Texts Player::text_sums() const {
  Texts found;
  std::map<std::uint16_t, std::string> topics;
  std::set<std::uint16_t> channels;
  for (const mcap::Channel& channel : reader_->channels())
    if (is_summed(channel.topic)) {
      topics[channel.id] = channel.topic;
      channels.insert(channel.id);
    }
  for (const std::size_t c : chunks_with(channels)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) {
      found.whole = false;
      continue;
    }
    for (const McapMessage& message : chunk->messages)
      if (const auto topic = topics.find(message.channel); topic != topics.end())
        add_to(found.sums, topic->second, message.data);
  }
  return found;
}

Status Player::check_texts() const {
  std::map<std::string, std::string> said;
  for (std::size_t n = 0; n < reader_->metadata().size(); ++n) {
    if (reader_->metadata()[n].name != kAccountName) continue;
    const auto account = reader_->read_metadata(n);
    if (!account) return fine();  // damaged: nothing to compare with
    for (const auto& [key, value] : *account)
      if (key.rfind(kSumOf, 0) == 0) said[key.substr(std::string_view(kSumOf).size())] = value;
  }
  if (said.empty() || !holes_.empty() || reader_->lost_bytes() > 0) return fine();
  const Texts found = text_sums();
  if (!found.whole) return fine();
  std::set<std::string> topics;
  for (const auto& [topic, unused] : said) topics.insert(topic);
  for (const auto& [topic, unused] : found.sums) topics.insert(topic);
  for (const std::string& topic : topics) {
    const auto is = found.sums.find(topic);
    const auto was = said.find(topic);
    if (was != said.end() && was->second == hex(is == found.sums.end() ? 0 : is->second)) continue;
    return error(fmt::format(
        "{}: {} was changed after it was recorded: its messages do not give the sum in "
        "the metadata {}, so nothing in this recording can be trusted; use the original file",
        path_, topic, kAccountName));
  }
  return fine();
}

}  // namespace burr::record
