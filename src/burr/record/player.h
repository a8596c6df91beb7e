// record/player.h - opens a recording: its session, its ticks in order, and the bone and the scene
// at any moment, without simulating anything.
//
//     auto player = Player::open("s.mcap");
//     StepCursor steps = (*player)->steps();       // for a replay: row and commands, tick by tick
//     while (steps.next(step)) { ... }
//     (*player)->bone_at(12.5, *bone);             // last keyframe, then the changes since
//
// An incomplete file opens like any other, but ends earlier; notices() says by how much.
// Thread: one at a time. Memory: indexes, one or two chunks, the changed bricks twice.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/course.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/schema.h"
#include "burr/record/session_info.h"
#include "burr/record/text_sums.h"
#include "burr/record/view.h"
#include "burr/tick/rows.h"
#include "burr/tool/state.h"
#include "burr/volume/bone.h"

namespace burr::record {

// One tick, as a replay needs it.
struct Step {
  tick::TickRow row;                    // the inputs of the tick and their results
  std::vector<tick::Command> commands;  // taken at the start of this tick, in order
  // The other hand in this tick; none: there is none, or the row is missing. What it is: SecondInfo.
  std::optional<tick::TickRow> second;
  bool missing = false;  // ticks before this one are: dropped, or in a damaged stretch
  // The same; or the session was left and continued here, so that the hand comes from elsewhere.
  bool gap = false;
};

class Player;
struct EarlierPart;

// Goes through the ticks in order. next() is false at the end; the player's notices() then say
// whether damaged parts were stepped over.
class StepCursor {
 public:
  [[nodiscard]] bool next(Step& step);

 private:
  friend class Player;
  StepCursor(Player& player, std::size_t chunk, std::uint64_t first_tick)
      : player_(&player), chunk_(chunk), first_tick_(first_tick) {}
  bool fill();
  void take(const McapMessage& message, std::uint64_t& reach);
  [[nodiscard]] bool take_second(ByteSpan message);
  Player* player_;
  std::size_t chunk_;  // index into step_chunks_
  std::uint64_t first_tick_;
  std::optional<std::uint64_t> last_tick_;
  std::vector<tick::TickRow> rows_;
  std::size_t row_ = 0;
  // each with the number of its message
  std::deque<std::pair<std::uint32_t, tick::CommandRow>> commands_;
  std::deque<tick::TickRow> second_;
};

// Goes through the changed bricks in the order in which the servo recorded them: whole contents.
class BrickCursor {
 public:
  [[nodiscard]] bool next(tick::BrickRow& row);

 private:
  friend class Player;
  explicit BrickCursor(Player& player) : player_(&player) {}
  Player* player_;
  std::size_t chunk_ = 0, row_ = 0;  // chunk_: in change_chunks_
  std::vector<tick::BrickRow> rows_;
  std::unordered_map<volume::BrickIndex, BrickContent> state_;
};

class Player {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Player>> open(const std::string& path);

  [[nodiscard]] const SessionInfo& info() const { return info_; }
  // A part of a session begins with this tick, which is not the first one.
  [[nodiscard]] bool begins_part(std::uint64_t tick) const {
    return std::any_of(continued_.begin(), continued_.end(),
                       [tick](const SessionInfo& part) { return part.first_tick == tick; });
  }
  // Of a session that was left and continued: each later part, with its first tick, in order. The
  // ticks, the ledger and the bone go on from part to part; settings are those of info() before.
  [[nodiscard]] const std::vector<SessionInfo>& continued() const { return continued_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  // False: incomplete (killed, power cut, or still being recorded) and opened as far as it goes; or the
  // session was stopped before its time by Ctrl-C or SIGTERM.
  [[nodiscard]] bool finished() const { return reader_->finished() && !stopped_; }
  [[nodiscard]] bool stopped() const { return stopped_; }
  [[nodiscard]] std::uint64_t lost_bytes() const { return reader_->lost_bytes(); }
  [[nodiscard]] const std::vector<std::string>& notices() const { return notices_; }
  // Parts of the ticks whose chunks are damaged; a notice names each. open() reads every chunk for
  // this, because the summary of a file knows nothing of its damage.
  struct Hole {
    std::uint64_t first = 0, end = 0;  // ticks, end excluded
  };
  [[nodiscard]] const std::vector<Hole>& holes() const { return holes_; }

  // The first tick, and one past the last; equal when there is none.
  [[nodiscard]] std::uint64_t first_tick() const { return first_tick_; }
  [[nodiscard]] std::uint64_t end_tick() const { return end_tick_; }
  // The ticks say which tool was in the hand. false: an older recording; row.tool of its ticks is
  // then an assumption (record/assumed_tool.h).
  [[nodiscard]] bool tool_is_recorded() const { return tool_is_recorded_; }
  [[nodiscard]] double seconds() const { return static_cast<double>(end_tick_) / info_.rate_hz; }
  // rows that the recorder had to drop, as counted in the file
  [[nodiscard]] std::uint64_t dropped_ticks() const { return dropped_ticks_; }
  [[nodiscard]] std::uint64_t dropped_commands() const { return dropped_commands_; }
  [[nodiscard]] std::uint64_t dropped_bricks() const { return dropped_bricks_; }
  [[nodiscard]] std::uint64_t dropped_notes() const { return dropped_notes_; }

  // ---- what the user saw and did (player_notes.cpp)
  // False: an older recording, which cannot say how the session ended.
  [[nodiscard]] bool has_course() const { return !course_channels_.empty(); }
  // In order of time. Empty: nothing happened, an older recording, or damaged; notices() then says so.
  [[nodiscard]] const std::vector<CourseEvent>& course() const { return course_; }
  // none: killed, still being recorded, or an older recording
  [[nodiscard]] std::optional<Ending> ending() const;
  // Reads the whole file. In order of time.
  [[nodiscard]] std::vector<View> views();
  // One sentence about what recordings of today hold and this one does not; empty: nothing.
  [[nodiscard]] std::string lacks() const;

  // ---- the texts of the file (player_texts.cpp)
  struct Texts {
    TextSums sums;
    bool whole = true;  // false: a part is damaged, so that the sums are of the rest
  };
  // Reads the parts of the file that hold texts.
  [[nodiscard]] Texts text_sums() const;
  // Error: session, commands, view, course or events are not those whose sums the account at the end says. Fine
  // where there is no account or one without sums (an unfinished or older recording), and where a part is damaged.
  [[nodiscard]] Status check_texts() const;

  // ---- in order
  [[nodiscard]] StepCursor steps(std::uint64_t first_tick = 0);
  [[nodiscard]] BrickCursor bricks();

  // ---- at a moment, t from the start of the session [s]; later than the end is the end
  // Gives `bone` its state at t. Pass it as it was opened, or as the last bone_at() of this player
  // left it. Takes at most 1 s, whatever the moment. Error: damage lies between the last keyframe
  // and t, or the bone is another one (by size), or it has no room for deposits (reserve_bricks).
  [[nodiscard]] Status bone_at(double t_s, volume::Bone& bone);
  // The last tick at or before t: pose, proxy, force ... for a picture.
  [[nodiscard]] Result<tick::TickRow> tick_at(double t_s);
  // The same with the commands of that tick and the other hand.
  [[nodiscard]] Result<Step> step_at(double t_s);

  // For a recorder that goes on with this recording (earlier_part.h). Error: it holds no tick, or
  // what the bone is at its end is not known.
  [[nodiscard]] Result<EarlierPart> earlier_part();

  // The bone at the start, if the recording holds it (info().embedded).
  [[nodiscard]] Result<std::unique_ptr<volume::Bone>> embedded_bone(
      std::size_t reserve_bricks) const;
  // with the room for deposits that it had
  [[nodiscard]] Result<std::unique_ptr<volume::Bone>> embedded_bone() const {
    return embedded_bone(static_cast<std::size_t>(info_.volume.recipe.reserve_bricks));
  }

 private:
  friend class StepCursor;
  friend class BrickCursor;
  using State = std::unordered_map<volume::BrickIndex, BrickContent>;
  // a position in the changes, for a state of the bone; chunk: index into change_chunks_
  struct Place {
    std::size_t chunk = 0, message = 0, row = 0;
    std::uint64_t next_batch = 1;
  };

  Player() = default;
  [[nodiscard]] Status read_session();
  void read_events();
  void read_course();
  void find_holes();
  void find_ends();
  void find_keyframes();
  [[nodiscard]] std::vector<std::size_t> chunks_with(const std::set<std::uint16_t>& channels) const;
  void notice(const std::string& sentence);
  void read_assumed_tools();
  [[nodiscard]] tool::ToolState assumed_tool(std::uint64_t tick);
  [[nodiscard]] std::uint64_t tick_of(double t_s) const;
  [[nodiscard]] std::uint64_t start_tick(std::size_t chunk) const;
  [[nodiscard]] std::uint64_t tick_of_ns(std::uint64_t time_ns) const;
  [[nodiscard]] std::size_t step_chunk_before(std::uint64_t tick) const;
  [[nodiscard]] bool load_keyframe(std::uint64_t tick);
  [[nodiscard]] Status advance(std::uint64_t tick);
  [[nodiscard]] Error broken_before(std::uint64_t tick) const;
  [[nodiscard]] Status show(volume::Bone& bone);

  std::string path_;
  std::unique_ptr<McapReader> reader_;
  SessionInfo info_;
  std::vector<SessionInfo> continued_;
  std::vector<std::string> notices_;
  using Channels = std::set<std::uint16_t>;  // of a topic; empty: the file does not have it
  Channels tick_channels_, command_channels_, event_channels_, change_channels_, keyframe_channels_,
      view_channels_, course_channels_, second_channels_;
  std::vector<CourseEvent> course_;
  // which chunks hold what; in the order of the time at which they begin, which is burr's order in the file
  std::vector<std::size_t> step_chunks_;  // ticks or commands
  std::vector<std::uint64_t>
      step_ends_;  // tick to which messages of these and all chunks before reach
  std::vector<std::size_t> change_chunks_;
  struct Keyframe {
    std::size_t chunk = 0;  // with a part of it
    std::uint64_t time_ns = 0;
  };
  std::vector<Keyframe> keyframes_;
  std::uint64_t first_tick_ = 0, end_tick_ = 0;
  bool stopped_ = false;
  std::vector<Hole> holes_;
  std::uint64_t dropped_ticks_ = 0, dropped_commands_ = 0, dropped_bricks_ = 0, dropped_notes_ = 0;

  // Where the ticks do not hold the tool: the first tick of each assumed state, and the state.
  // Filled when first needed.
  bool tool_is_recorded_ = false;
  std::vector<std::pair<std::uint64_t, tool::ToolState>> assumed_tools_;

  // state of the bone after the last bone_at()
  bool state_good_ = false;
  std::uint64_t state_tick_ = 0;
  State state_;
  Place place_;
  std::unordered_map<volume::BrickIndex, BrickContent> originals_;  // before the first change by
                                                                    // this player
};

}  // namespace burr::record
