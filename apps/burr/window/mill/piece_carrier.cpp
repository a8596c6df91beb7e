#include "window/mill/piece_carrier.h"

#include <utility>

#include "burr/workshop/second_tool.h"
#include "burr/workshop/suction_hand.h"
#include "window/mill/pieces_panel.h"

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

PieceCarrier::PieceCarrier(const MillSite& site, const Pointer& pointer, MillTools& tools)
    : desk_(site.desk),
      session_(site.session),
      scene_(site.scene),
      hands_(site.hands),
      options_(site.options),
      row_(site.row),
      notes_(site.notes),
      over_(site.over),
      pointer_(pointer),
      tools_(tools) {}

void PieceCarrier::begin() {
  pieces_.emplace(session_, options_.lesson ? &*options_.lesson : nullptr, options_.left.pieces);
}

void PieceCarrier::end() {
  pieces_->end();
  pieces_->show(scene_, false);
  pieces_.reset();
}

void PieceCarrier::look() {
  const bool open = over_.menu == Menu::pieces;
  pieces_->suck(has_piece() ? std::nullopt : tools_.splinter_suction());
  notes_.note(pieces_->look(open, row_));
  carry();
  pieces_->show(scene_, open);
}

// The button that drives a tool carries the piece. Meanwhile the tool of the first hand stands
// still and only touches.
void PieceCarrier::carry() {
  const bool rests = has_piece() && hands_.real != nullptr;
  if (rests && (!mode_before_ || tools_.drill().mode() != tick::ToolMode::touch)) {
    mode_before_ = tools_.drill().mode();  // or one that was chosen meanwhile: for afterwards
    static_cast<void>(tools_.drill().set_mode(tick::ToolMode::touch));
    session_.command({tick::CommandKind::spindle_speed, 0});
  } else if (rests && row_.tool.full_speed != 0) {  // another tool or speed was chosen meanwhile
    session_.command({tick::CommandKind::spindle_speed, 0});
  } else if (!rests && mode_before_ && !(row_.hand.pedal > 0)) {  // not while the button is down
    static_cast<void>(tools_.drill().set_mode(*std::exchange(mode_before_, {})));
    session_.command({tick::CommandKind::spindle_speed, tools_.drill().full_speed()});
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
bool PieceCarrier::other_hand_carries() const {
  return hands_.suction != nullptr && hands_.suction->tool() == nullptr;
}

bool PieceCarrier::draw_panel(Ui& ui) {
  PiecesState state = pieces_->state();
  state.carries = hands_.real != nullptr || hands_.suction != nullptr;
  const PiecesPressed pressed = draw_pieces(ui, state);
  if (pressed.typed) pieces_->set(pressed.mm, pressed.degrees);
  if (pressed.take) pieces_->take(*pressed.take);
  if (pressed.put_down) pieces_->put_down();
  if (pressed.leave) pieces_->leave();
  if (pressed.close) over_.menu.reset();
  return pressed.take.has_value();
}

bool PieceCarrier::key(const SDL_Keysym& pressed) {
  if (!has_piece() || over_.page()) return false;
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

void PieceCarrier::drag(const SDL_MouseMotionEvent& motion) {
  const Uint32 mills = desk_.settings.left_handed ? SDL_BUTTON_RMASK : SDL_BUTTON_LMASK;
  if ((motion.state & mills) == 0) return;
  const double pixel = scene_.camera.view_height() / pointer_.height();
  pieces_->shift(pixel *
                 (motion.xrel * scene_.camera.right() - motion.yrel * scene_.camera.above()));
}

}  // namespace burr::app
