#include "burr/record/repair.h"

#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/rename_and_sync.h"
#include "burr/record/schema.h"
#include "burr/record/session_info.h"

namespace burr::record {
namespace {

mcap::MessageIndexes indexes_of(const McapChunk& chunk) {
  mcap::MessageIndexes indexes;
  for (const McapMessage& message : chunk.messages)
    indexes[message.channel].emplace_back(message.time_ns, message.offset);
  return indexes;
}

Status copy(const McapReader& from, McapWriter& to, RepairReport& report, Progress& progress) {
  for (const mcap::Schema& schema : from.schemas())
    if (Status added = to.add(schema); !added.ok()) return added;
  for (const mcap::Channel& channel : from.channels())
    if (Status added = to.add(channel); !added.ok()) return added;
  for (std::size_t i = 0; i < from.metadata().size(); ++i) {
    const auto pairs = from.read_metadata(i);
    if (!pairs) {
      report.notices.push_back(pairs.error().text);
      continue;
    }
    if (Status added = to.add_metadata(from.metadata()[i].name, *pairs); !added.ok()) return added;
  }
  for (std::size_t i = 0; i < from.attachments().size(); ++i) {
    const auto data = from.read_attachment(i);
    if (!data) {
      report.notices.push_back(data.error().text);
      report.lost_bytes += from.attachments()[i].length;
      continue;
    }
    const mcap::AttachmentAt& at = from.attachments()[i];
    if (Status added = to.add_attachment(at.name, at.media_type, *data); !added.ok()) return added;
  }

  const std::uint16_t tick_channel = from.channel_of(kTicks.name);
  const std::uint64_t count = from.chunks().size();
  for (std::size_t i = 0; i < count; ++i) {
    progress.report(static_cast<double>(i) / static_cast<double>(count), "repairing");
    if (progress.cancelled())
      return error(Trouble::interrupted, "repair was stopped; the recording is unchanged");
    const auto chunk = from.read_chunk(i);
    const auto packed = from.read_packed(i);
    if (!chunk || !packed) {
      report.notices.push_back(chunk ? packed.error().text : chunk.error().text);
      report.lost_bytes += from.chunks()[i].length;
      continue;
    }
    if (Status added = to.add_chunk(from.chunks()[i], chunk->crc, *packed, indexes_of(*chunk));
        !added.ok())
      return added;
    ++report.chunks;
    std::vector<tick::TickRow> rows;
    for (const McapMessage& message : chunk->messages)
      if (message.channel == tick_channel) static_cast<void>(decode_ticks(message.data, rows));
    report.ticks += rows.size();
    if (!rows.empty()) report.seconds = static_cast<double>(rows.back().tick + 1);  // ticks, so far
  }
  progress.report(1, "repairing");
  return fine();
}

// Ticks per second, from the session's description; 0: the description is lost.
double rate_of(const McapReader& file) {
  const std::uint16_t channel = file.channel_of(kSession.name);
  for (std::size_t i = 0; i < file.chunks().size(); ++i) {
    if (!file.chunks()[i].index_offsets.contains(channel)) continue;
    const auto chunk = file.read_chunk(i);
    if (!chunk) continue;
    for (const McapMessage& message : chunk->messages) {
      if (message.channel != channel) continue;
      const auto info = session_from_json(as_text(message.data), "");
      if (info) return info->rate_hz;
    }
  }
  return 0;
}

}  // namespace

Result<RepairReport> repair(const std::string& path, const std::string& out, Progress& progress) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    return error(Trouble::io, path + ": does not exist; check the name");
  if (being_written(path))
    return error(Trouble::io,
                 path + ": is being recorded right now; wait until the session has ended");
  progress.report(0, "looking for damage");
  auto reader = McapReader::open(path, McapReader::Trust::nothing);
  if (!reader) return reader.error();
  const McapReader& from = **reader;

  RepairReport report;
  report.notices = from.notices();
  report.lost_bytes = from.lost_bytes();
  const double rate_hz = rate_of(from);
  if (rate_hz == 0)
    return error(path + ": nothing can be saved, because the description of the session is lost");

  // the target of a link is repaired, the link stays
  std::filesystem::path target = std::filesystem::weakly_canonical(out, ignored);
  if (target.empty()) target = out;
  const std::string beside = target.string() + ".part";
  McapWriter writer;
  const auto give_up = [&](const Error& problem) {
    ::unlink(beside.c_str());
    return problem;
  };
  if (Status opened = writer.open(beside, out); !opened.ok()) return opened.error();
  if (Status copied = copy(from, writer, report, progress); !copied.ok())
    return give_up(copied.error());
  report.seconds /= rate_hz;
  report.was_whole = from.finished() && report.lost_bytes == 0;
  if (report.was_whole) {
    ::unlink(beside.c_str());
    report.kept_bytes = from.size();
    return report;
  }
  if (Status finished = writer.finish(); !finished.ok()) return give_up(finished.error());
  report.kept_bytes = writer.size();
  if (Status placed = rename_and_sync(beside, target.string()); !placed.ok())
    return give_up(placed.error());
  return report;
}

}  // namespace burr::record
