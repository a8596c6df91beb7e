// A recording with a valid container and odd content: any settings, impossible hands, bricks that
// do not exist, times that go back. It is opened, shown at several moments, and simulated again for
// as long as the result is the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "burr/record/bone_blob.h"
#include "burr/record/course.h"
#include "burr/record/mcap/mcap.h"
#include "burr/record/player.h"
#include "burr/record/schema.h"
#include "burr/record/session_info.h"
#include "burr/record/view.h"
#include "burr/sim/replay.h"
#include "burr/sim/session_words.h"
#include "burr/volume/bone.h"
#include "support.h"

namespace {

using namespace burr;
using record::BytesOut;
using record::mcap::Kind;

// half a block: bone below, air above
std::unique_ptr<volume::Bone> block() {
  volume::Grid grid;
  grid.size = {24, 24, 24};
  grid.voxel = 0.5e-3;
  std::vector<volume::Field> field(24 * 24 * 24);
  std::vector<volume::TissueId> tissue(field.size(), 1);
  for (std::size_t v = 0; v < field.size(); ++v)
    field[v] = volume::field_from_depth(11.3 - static_cast<double>(v / (24 * 24)));
  return volume::bone_from_arrays(grid, {}, field, tissue, {}, 4);
}

record::SessionInfo usual_session() {
  record::SessionInfo info;
  info.burr_version = "0";
  info.build = "0";
  sim::SessionSettings settings;
  settings.servo.burr.radius = 1.5e-3;
  settings.servo.undo_bricks = 16;  // little memory, so that many replays run in a second
  settings.surface.reserve_blocks = 64;
  sim::describe(settings, {}, info);
  const auto bone = block();
  info.volume.content_hash = bone->content_hash();
  info.volume.grid = bone->grid();
  info.volume.tissues = bone->tissues();
  info.volume.recipe.reserve_bricks = 4;
  return info;
}

double number(fuzz::Pieces& in) {
  constexpr std::array<double, 12> kOdd = {0,      1,
                                           -1,     1e-3,
                                           1e3,    1e9,
                                           1e300,  -1e300,
                                           1e-300, std::numeric_limits<double>::infinity(),
                                           -1e9,   std::numeric_limits<double>::quiet_NaN()};
  const std::uint8_t choice = in.byte();
  if (choice < kOdd.size()) return kOdd[choice];
  if (choice < 192) return 1e-4 * static_cast<double>(static_cast<std::int16_t>(in.word()));
  double value = 0;
  const fuzz::Bytes raw = in.take(sizeof value);
  std::memcpy(&value, raw.data(), raw.size());
  return value;
}

std::uint64_t count(fuzz::Pieces& in) {
  const std::uint8_t choice = in.byte();
  if (choice < 250) return choice;
  return choice == 255 ? ~std::uint64_t{0} : std::uint64_t{in.word()} << ((choice - 250) * 11);
}

std::string session(fuzz::Pieces& in) {
  record::SessionInfo info = usual_session();
  for (int changes = in.byte() % 4; changes > 0; --changes) {
    const std::size_t which = in.byte();
    const double value = number(in);
    if (which == 255) {
      info.rate_hz = value;
    } else if (which == 254) {
      info.volume.recipe.reserve_bricks = count(in);
    } else if (which == 253) {
      info.embedded = true;
    } else {
      auto entry = info.numbers.begin();
      std::advance(entry, static_cast<std::ptrdiff_t>(which % info.numbers.size()));
      entry->second = value;
    }
  }
  return record::to_json(info);
}

void ticks(fuzz::Pieces& in, std::uint64_t& tick, BytesOut& out) {
  std::vector<tick::TickRow> rows(in.byte() % 16U);
  tick::TickRow row;
  row.hand.world_from_tool.p = {6e-3, 6e-3, 7e-3};
  for (tick::TickRow& one : rows) {
    const std::uint8_t what = in.byte();
    if ((what & 1U) != 0) row.hand.world_from_tool.p = {number(in), number(in), number(in)};
    if ((what & 2U) != 0)
      row.hand.world_from_tool.q.coeffs() << number(in), number(in), number(in), number(in);
    if ((what & 4U) != 0) row.hand.velocity = {number(in), number(in), number(in)};
    if ((what & 8U) != 0) row.hand.pedal = number(in);
    if ((what & 16U) != 0) row.hand.buttons = in.word();
    if ((what & 32U) != 0) row.hand.valid = !row.hand.valid;
    if ((what & 64U) != 0) row.contact.flags = in.word();
    if ((what & 128U) != 0) tick = count(in);
    one = row;
    one.tick = tick++;
  }
  record::encode_ticks(rows, out);
}

void bricks(fuzz::Pieces& in, BytesOut& out) {
  record::Bricks rows;
  rows.batch = count(in);
  rows.part = in.byte();
  rows.parts = in.byte();
  for (int n = in.byte() % 4; n > 0; --n) {
    rows.tick.push_back(count(in));
    const auto index = static_cast<std::int32_t>(count(in));
    rows.brick.push_back((in.byte() & 1U) != 0 ? -index : index);
    record::BrickContent& content = rows.content.emplace_back();
    std::fill(std::begin(content.field.voxel), std::end(content.field.voxel), in.word());
    content.has_tissue = (in.byte() & 1U) != 0;
    content.tissue.fill(in.byte());
    rows.crc.push_back(content.crc());
  }
  record::encode_bricks(rows, out);
}

// Puts messages into a chunk with its indexes.
class File {
 public:
  File() {
    out_.raw(record::mcap::kMagic);
    BytesOut header;
    header.text("");
    header.text("");
    record::mcap::put_record(out_, Kind::header, header.span());
    for (std::uint16_t n = 0; n < record::kTopics.size(); ++n) {
      BytesOut channel;
      channel.put(static_cast<std::uint16_t>(n + 1));
      channel.put(std::uint16_t{0});
      channel.text(record::kTopics[n].name);
      channel.text(record::kTopics[n].encoding);
      record::mcap::put_pairs(channel, {});
      record::mcap::put_record(out_, Kind::channel, channel.span());
    }
  }
  void message(std::size_t topic, std::uint64_t time_ns, record::ByteSpan data) {
    const auto channel = static_cast<std::uint16_t>(topic + 1);
    has_[topic] = true;
    if (chunk_.empty()) start_ = end_ = time_ns;
    start_ = std::min(start_, time_ns);
    end_ = std::max(end_, time_ns);
    BytesOut message;
    message.put(channel);
    message.put(std::uint32_t{0});
    message.put(time_ns);
    message.put(time_ns);
    message.raw(data);
    record::mcap::put_record(chunk_, Kind::message, message.span());
  }
  void close_chunk() {
    if (chunk_.empty()) return;
    BytesOut chunk;
    chunk.put(start_);
    chunk.put(end_);
    chunk.put(std::uint64_t{chunk_.size()});
    chunk.put(std::uint32_t{0});  // no CRC
    chunk.text("");               // not compressed
    chunk.put(std::uint64_t{chunk_.size()});
    chunk.raw(chunk_.span());
    record::mcap::put_record(out_, Kind::chunk, chunk.span());
    for (std::uint16_t n = 0; n < record::kTopics.size(); ++n) {
      if (!has_[n]) continue;
      BytesOut index;
      index.put(static_cast<std::uint16_t>(n + 1));
      index.put(std::uint32_t{0});
      record::mcap::put_record(out_, Kind::message_index, index.span());
    }
    chunk_.clear();
    has_ = {};
  }
  void attach(record::ByteSpan data) {
    BytesOut attachment;
    attachment.put(std::uint64_t{0});
    attachment.put(std::uint64_t{0});
    attachment.text(record::kBoneAttachment);
    attachment.text(record::kBoneMediaType);
    attachment.put(std::uint64_t{data.size()});
    attachment.raw(data);
    attachment.put(std::uint32_t{0});
    record::mcap::put_record(out_, Kind::attachment, attachment.span());
  }
  [[nodiscard]] fuzz::Bytes bytes() const { return out_.span(); }

 private:
  BytesOut out_, chunk_;
  std::array<bool, record::kTopics.size()> has_{};
  std::uint64_t start_ = 0, end_ = 0;
};

record::View view(fuzz::Pieces& in) {
  record::View view;
  view.tick = count(in);
  view.eye = {number(in), number(in), number(in)};
  view.field_of_view = number(in);
  view.see_through = number(in);
  view.two_eyes = (in.byte() & 1U) != 0;
  return view;
}

record::CourseEvent course_event(fuzz::Pieces& in) {
  const auto text = [&in] {
    const fuzz::Bytes bytes = in.take(in.byte() % 16U);
    return std::string(bytes.begin(), bytes.end());
  };
  record::CourseEvent event;
  event.tick = count(in);
  event.kind = static_cast<record::CourseKind>(in.byte() % 15U);
  event.what = text();
  event.where = text();
  event.value = text();
  return event;
}

File file_of(fuzz::Pieces& in) {
  File file;
  std::uint64_t tick = 0, time_ns = 0;
  while (!in.empty()) {
    const std::uint8_t what = in.byte();
    const bool note = (what & 32U) != 0;  // a view or an event of the course
    const std::size_t low = what % 8U, topic = note ? 6 + low % 2 : low;  // of kTopics
    if (!note && low == 6) {
      file.close_chunk();
      continue;
    }
    if (!note && low == 7) {
      static const auto blob = record::bone_to_blob(*block());
      file.attach(blob);
      continue;
    }
    time_ns = (what & 64U) != 0 ? count(in) * 1'000'000 : time_ns + 1'000'000;
    BytesOut data;
    if ((what & 128U) != 0) {  // unchanged
      data.raw(in.take(in.byte()));
    } else if (topic == 0) {
      data.raw(record::as_bytes(session(in)));
    } else if (topic == 1) {
      ticks(in, tick, data);
    } else if (topic == 2) {
      const auto kind = static_cast<tick::CommandKind>(in.byte() % 9);
      data.raw(record::as_bytes(record::to_json(tick::CommandRow{count(in), {kind, number(in)}})));
    } else if (topic == 3) {
      data.raw(record::as_bytes("{\"dropped_ticks\":" + std::to_string(count(in)) + "}"));
    } else if (topic == 6) {
      data.raw(record::as_bytes(record::to_json(view(in))));
    } else if (topic == 7) {
      data.raw(record::as_bytes(record::to_json(course_event(in))));
    } else {
      bricks(in, data);
    }
    file.message(topic, time_ns, data.span());
  }
  file.close_chunk();
  return file;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Pieces in({data, size});
  const File file = file_of(in);
  auto opened = record::Player::open(fuzz::as_file("a.mcap", file.bytes()));
  fuzz::look_at_error(opened);
  if (!opened) return 0;
  record::Player& player = **opened;

  const auto bone = block();
  for (const double part : {1.0, 0.0, 0.5, -1.0}) {
    const double t = part * player.seconds();
    const Status shown = player.bone_at(t, *bone);
    fuzz::look_at_error(shown);
    const auto tick = player.tick_at(t);
    fuzz::look_at_error(tick);
  }
  for (const record::View& seen : player.views())
    fuzz::must(record::check(seen).ok(), "a view that is read is a view");
  for (const record::CourseEvent& event : player.course())
    fuzz::must(record::check(event).ok(), "an event that is read is an event");
  static_cast<void>(player.ending());
  if (const std::string lacks = player.lacks(); !lacks.empty()) fuzz::look_at(error(lacks));
  NoProgress progress;
  auto start = player.info().embedded ? player.embedded_bone(static_cast<std::size_t>(
                                            player.info().volume.recipe.reserve_bricks))
                                      : Result<std::unique_ptr<volume::Bone>>(block());
  fuzz::look_at_error(start);
  if (!start) return 0;
  const auto outcome = sim::replay(player, std::move(*start), progress);
  fuzz::look_at_error(outcome);
  for (const std::string& notice : player.notices()) fuzz::look_at(error(notice));
  return 0;
}
