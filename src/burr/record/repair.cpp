#include "burr/record/repair.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "burr/base/plain_file.h"
#include "burr/record/copy_records.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/rename_and_sync.h"
#include "burr/record/schema.h"
#include "burr/record/session_info.h"

namespace burr::record {
namespace {

Error stopped() {
  return error(Trouble::interrupted, "repair was stopped; the recording is unchanged");
}

// Looks at everything, and says what is lost and what can be kept.
Status examine(const McapReader& from, RepairReport& report, Progress& progress) {
  for (std::size_t i = 0; i < from.metadata().size(); ++i)
    if (const auto pairs = from.read_metadata(i); !pairs)
      report.notices.push_back(pairs.error().text);
  for (std::size_t i = 0; i < from.attachments().size(); ++i)
    if (const Status whole = from.check_attachment(i); !whole.ok()) {
      report.notices.push_back(whole.error().text);
      report.lost_bytes += from.attachments()[i].length;
    }
  const std::set<std::uint16_t> tick_channels = from.channels_of(kTicks.name);
  const std::uint64_t count = from.chunks().size();
  std::uint64_t end_tick = 0;
  for (std::size_t i = 0; i < count; ++i) {
    progress.report(0.5 * static_cast<double>(i) / static_cast<double>(count),
                    "looking for damage");
    if (progress.cancelled()) return stopped();
    if (McapReader::opaque(from.chunks()[i])) {
      // what is huge is no part of what burr wrote; what is packed otherwise may be
      if (from.chunks()[i].unpacked_size <= mcap::kLargestChunk)
        report.notices.push_back(from.read_chunk(i).error().text);
      ++report.chunks;
      continue;
    }
    const auto chunk = from.read_chunk(i);
    if (!chunk) {
      report.notices.push_back(chunk.error().text);
      report.lost_bytes += from.chunks()[i].length;
      continue;
    }
    ++report.chunks;
    std::vector<tick::TickRow> rows;
    for (const McapMessage& message : chunk->messages)
      if (tick_channels.contains(message.channel))
        static_cast<void>(decode_ticks(message.data, rows));
    report.ticks += rows.size();
    if (!rows.empty()) end_tick = std::max(end_tick, rows.back().tick + 1);
  }
  report.seconds = static_cast<double>(end_tick);  // ticks, so far
  return fine();
}

Status copy(const McapReader& from, McapWriter& to, Progress& progress) {
  if (Status begun = copy_beginning(from, to); !begun.ok()) return begun;
  const std::uint64_t count = from.chunks().size();
  for (std::size_t i = 0; i < count; ++i) {
    progress.report(0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(count), "repairing");
    if (progress.cancelled()) return stopped();
    if (Status added = copy_chunk(from, i, to); !added.ok()) return added;
  }
  progress.report(1, "repairing");
  return fine();
}

// Ticks per second, from the session's description; 0: the description is lost.
double rate_of(const McapReader& file) {
  const std::set<std::uint16_t> channels = file.channels_of(kSession.name);
  for (std::size_t i = 0; i < file.chunks().size(); ++i) {
    const auto& has = file.chunks()[i].index_offsets;
    if (std::none_of(channels.begin(), channels.end(),
                     [&has](std::uint16_t channel) { return has.contains(channel); }))
      continue;
    const auto chunk = file.read_chunk(i);
    if (!chunk) continue;
    for (const McapMessage& message : chunk->messages) {
      if (!channels.contains(message.channel)) continue;
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
  if (const Status plain = base::check_plain_file(path); !plain) return plain.error();
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

  if (Status seen = examine(from, report, progress); !seen.ok()) return seen.error();
  report.seconds /= rate_hz;
  report.was_whole = from.finished() && report.lost_bytes == 0;
  if (report.was_whole) {
    report.kept_bytes = from.size();
    return report;
  }

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
  if (Status copied = copy(from, writer, progress); !copied.ok()) return give_up(copied.error());
  if (Status finished = writer.finish(); !finished.ok()) return give_up(finished.error());
  report.kept_bytes = writer.size();
  if (Status placed = rename_and_sync(beside, target.string()); !placed.ok())
    return give_up(placed.error());
  return report;
}

}  // namespace burr::record
