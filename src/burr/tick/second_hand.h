// tick/second_hand.h - another device in the other hand: with a suction tube, which feels the bone and
// never changes it, or with any tool of the rack, which touches and cuts as the first hand's does.
//
//     no tool   a ball at the tip rests on the bone by the proxy of three unknowns; nothing is cut. While a
//               piece of bone is out of the bone, the same ball has six, for it meets the piece
//     a tool    the proxy of six unknowns (haptics/six/tool_touch.h), and a carver of its own; it and
//               the first hand's tool feel each other (haptics/six/two_tools.h), unless that is felt by
//               the head alone
//
// Where a piece of bone was lifted (held_piece.h), either hand holds it: by its button. It feels it in place
// of its tool, and the tool of the other hand meets it. What this hand's tool meets while nobody holds it, is
// pushed. Its tool neither turns nor cuts meanwhile, and not before its button was up after that.
//
// It has its own proxy, law of force, guard and safety layer (hand.h). The servo takes each step of a
// tick with it directly after the first hand's, so that the same readings give the same bits. What it
// cuts is in the ledger and the strokes of the session; what it cut alone is in its own row.
//
// Thread: servo; view(), faults() one reader each, any. Frame: world. Memory: taken at construction.
// Cost: docs/understand/realtime.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "burr/device/device.h"
#include "burr/edit/account.h"
#include "burr/edit/bone_writer.h"
#include "burr/edit/undo.h"
#include "burr/haptics/force_law.h"
#include "burr/haptics/proxy.h"
#include "burr/haptics/safety/limit.h"
#include "burr/haptics/six/tool_touch.h"
#include "burr/haptics/six/two_tools.h"
#include "burr/rt/latest.h"
#include "burr/rt/rt.h"
#include "burr/tick/controls.h"
#include "burr/tick/cutting.h"
#include "burr/tick/fault_report.h"
#include "burr/tick/hand.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/rows.h"
#include "burr/tick/second_hand_settings.h"
#include "burr/tick/settings.h"
#include "burr/tool/shaped_tool.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

// What the second hand shares with the first hand.
struct SharedByHands {
  const volume::IsoVertices& surface;
  edit::UndoStore& undo;
  edit::BoneWriter& writer;
  const Controls& controls;  // of the session; laws, mirror and load hold for both hands
  const Cutting& beside;     // of the first hand
  HeldPiece& piece;
};

class SecondHand {
 public:
  // device: open
  SecondHand(const SharedByHands& shared, device::Device& device,
             const SecondHandSettings& settings);

  // ---- the steps of a tick
  // lost: as Servo::tick(). parted: bone may come back where it is (an undo): the force is released
  // until the hand is in free air again.
  void read(bool lost, bool parted) BURR_RT;
  // Its suction took a splinter of so many units.
  void took(std::int64_t units) BURR_RT { own_.moved += units; }
  // Touch of both hands: each alone, or together where their tools are near. feels: the first hand
  // feels in this tick, and has not yet.
  void feel_beside(Hand& first, bool feels) BURR_RT;
  void send() BURR_RT;
  // may, path_mark: as Cutting::cut()
  void cut(bool may, std::uint64_t path_mark) BURR_RT;
  void finish() BURR_RT;
  void publish() BURR_RT { view_.publish(row_); }

  // Of the last tick. Its ledger has what this hand alone asked for and removed; its tool's number is
  // 0, or -1 for a ball.
  [[nodiscard]] const TickRow& row() const BURR_RT { return row_; }
  [[nodiscard]] rt::Latest<TickRow>& view() BURR_RT { return view_; }
  [[nodiscard]] rt::Latest<FaultReport>& faults() BURR_RT { return hand_.faults().reports(); }
  // nullptr: it never cuts.
  [[nodiscard]] const Cutting* cutting() const BURR_RT { return cutting_.get(); }
  [[nodiscard]] const SecondHandSettings& settings() const { return settings_; }

 private:
  // What is solved together, if anything is.
  enum class Bodies { tools, tool_and_piece, piece_and_tool };  // of the first hand, of this one

  [[nodiscard]] bool will_feel() BURR_RT;
  [[nodiscard]] bool will_carry() BURR_RT;
  void take_what_is_its_own() BURR_RT;
  [[nodiscard]] bool feel_together(Hand& first) BURR_RT;
  [[nodiscard]] bool push_piece() BURR_RT;

  SecondHandSettings settings_;
  const Controls& session_;
  edit::BoneWriter& writer_;
  Controls controls_;  // this hand's
  haptics::Proxy proxy_;
  std::unique_ptr<haptics::ToolTouch> tool_;  // none: a ball
  std::unique_ptr<haptics::ToolTouch> ball_;  // the ball where a piece is lifted; none: a tool
  Hand hand_;
  std::unique_ptr<Cutting> cutting_;  // none: it never cuts
  haptics::TwoTools two_;
  edit::Account own_;  // what this hand did of the session's account
  HeldPiece& piece_;
  const Cutting& beside_;
  Bodies bodies_ = Bodies::tools;
  bool holds_ = false;  // the piece
  bool meets_ = false;  // a piece is lifted, which the ball meets
  bool grabs_ = false;  // in this tick
  bool waits_ = false;  // its tool, until its button was up
  bool lost_ = false, usable_ = false;
  math::Vec3 touched_ = math::Vec3::Zero();  // force of touch that was really sent [N]
  Hand::Sent sent_;
  std::uint64_t next_tick_ = 0, last_hash_ = 0;
  TickRow row_;
  rt::Latest<TickRow> view_;
};

}  // namespace burr::tick
