// Free pieces of bone on the page: noticed, taken, moved, put down.
#include <SDL2/SDL.h>

#include <utility>

#include "burr/workshop/second_tool.h"
#include "burr/workshop/suction_hand.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"

namespace burr::app {

using math::Vec3;

namespace {

// device: of this row's hand.
PieceMode::Carrier carrier(const tick::TickRow& row, const device::DeviceSpec& device, int which) {
  constexpr int kOrientation = 6;  // degrees of freedom
  const bool there = row.hand.valid && (row.hand.buttons & device::kLifted) == 0;
  return {row.hand.world_from_tool, there && row.hand.pedal > 0, device.sensed >= kOrientation,
          which};
}

}  // namespace

void Mill::look_at_pieces() {
  const bool open = menu_ == Menu::pieces;
  pieces_->suck(splinter_suction());
  note(pieces_->look(open, row_));
  carry_piece();
  pieces_->show(scene_, open);
}

// The tube of the other hand, or the one beside the tool (key 6): it takes splinters where it takes water.
std::optional<sim::PieceMover::Suction> Mill::splinter_suction() const {
  using workshop::SuctionHand;
  if (has_piece()) return {};
  sim::PieceMover::Suction by;
  if (hands_.suction != nullptr && workshop::sucks(hands_.suction->now())) {
    const tick::TickRow& row = hands_.suction->now();
    by = {row.contact.proxy, row.tool.radius + sim::PieceMover::kSuctionReach, row.tool.radius,
          true};
    return by;
  }
  if (!suction_) return {};
  by.mouth = scene_.burr.world_from_tool.p;
  by.reach = (grip_.burr() ? scene_.burr.radius : grip_.reach()) + kSuctionBeside +
             sim::PieceMover::kSuctionReach;
  by.bore = SuctionHand::kRadius;
  return by;
}

// The button that drives a tool carries the piece. Meanwhile the tool of the first hand stands
// still and only touches.
void Mill::carry_piece() {
  const bool rests = has_piece() && hands_.real != nullptr;
  if (rests && (!mode_before_ || drill_.mode() != tick::ToolMode::touch)) {
    mode_before_ = drill_.mode();  // or one that was chosen meanwhile: for afterwards
    static_cast<void>(drill_.set_mode(tick::ToolMode::touch));
    session_.command({tick::CommandKind::spindle_speed, 0});
  } else if (rests && row_.tool.full_speed != 0) {  // another tool or speed was chosen meanwhile
    session_.command({tick::CommandKind::spindle_speed, 0});
  } else if (!rests && mode_before_ && !(row_.hand.pedal > 0)) {  // not while the button is down
    static_cast<void>(drill_.set_mode(*std::exchange(mode_before_, {})));
    session_.command({tick::CommandKind::spindle_speed, drill_.full_speed()});
  }
  // from when it is taken, so before the hand can grab it
  if (hands_.real != nullptr) hands_.real->carry(has_piece());
  if (hands_.suction != nullptr) hands_.suction->carry(has_piece());
  if (!has_piece()) return;
  PieceMode::Carrier by;
  if (rests) by = carrier(row_, hands_.real->spec(), 0);
  if (other_hand_carries() && !by.grabs)
    by = carrier(hands_.suction->now(), hands_.suction->hand().spec(), 1);
  pieces_->carry(by);
}

// While the piece is still on its way out of the bone, a tool in the other hand would cut.
bool Mill::other_hand_carries() const {
  return hands_.suction != nullptr && hands_.suction->tool() == nullptr;
}

void Mill::draw_pieces_panel() {
  PiecesState state = pieces_->state();
  state.carries = hands_.real != nullptr || hands_.suction != nullptr;
  const PiecesPressed pressed = draw_pieces(desk_.ui(), state);
  if (pressed.typed) pieces_->set(pressed.mm, pressed.degrees);
  if (pressed.take) {
    lift();
    pieces_->take(*pressed.take);
  }
  if (pressed.put_down) pieces_->put_down();
  if (pressed.leave) pieces_->leave();
  if (pressed.close) menu_.reset();
}

// Keys that move the piece in the hand; false: this key is none of them.
bool Mill::piece_key(const SDL_Keysym& pressed) {
  if (!has_piece() || page_open()) return false;
  const bool fine = (pressed.mod & KMOD_SHIFT) != 0, turns = (pressed.mod & KMOD_CTRL) != 0;
  const render::Camera& camera = scene_.camera;
  const auto go = [&](const Vec3& way, const Vec3& axis) {
    if (turns)
      pieces_->turn(axis, fine ? PieceMode::kFineTurn : PieceMode::kTurn);
    else
      pieces_->shift((fine ? PieceMode::kFineStep : PieceMode::kStep) * way);
    return true;
  };
  switch (pressed.sym) {
    case SDLK_LEFT:
      return go(-camera.right(), -camera.above());
    case SDLK_RIGHT:
      return go(camera.right(), camera.above());
    case SDLK_UP:
      return go(camera.above(), -camera.right());
    case SDLK_DOWN:
      return go(-camera.above(), camera.right());
    case SDLK_PAGEUP:
      return go(-camera.backward(), camera.backward());
    case SDLK_PAGEDOWN:
      return go(camera.backward(), -camera.backward());
    case SDLK_RETURN:
    case SDLK_KP_ENTER:
      pieces_->put_down();
      return true;
    case SDLK_ESCAPE:
      pieces_->leave();
      return true;
    default:
      return false;
  }
}

// With the button that mills, in the plane of the picture.
void Mill::drag_piece(const SDL_MouseMotionEvent& motion) {
  const Uint32 mills = desk_.settings.left_handed ? SDL_BUTTON_RMASK : SDL_BUTTON_LMASK;
  if ((motion.state & mills) == 0) return;
  const double pixel = scene_.camera.view_height() / pointer_.height();
  pieces_->shift(pixel *
                 (motion.xrel * scene_.camera.right() - motion.yrel * scene_.camera.above()));
}

}  // namespace burr::app
