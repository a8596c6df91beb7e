#include "burr/tick/flag_words.h"

#include <utility>

namespace burr::tick {
namespace {

constexpr std::pair<std::uint32_t, const char*> kWords[] = {
    {rt::kFlagNotFinite,
     "a hand position or a force was not a number; the force was released and comes back along "
     "the start ramp"},
    {rt::kFlagForceLimited, "the force was limited to the device's or the user's maximum"},
    {rt::kFlagSlewLimited, "the force grew faster than allowed and was limited"},
    {rt::kFlagRamp, "the start ramp was active"},
    {rt::kFlagWaiting, "not engaged: the hand has to be in free air once"},
    {rt::kFlagThermal, "the device's motors were warm: only the continuous force was sent"},
    {rt::kFlagWatchdog,
     "ticks were lost and the force was released; close other programs or allow real-time "
     "scheduling (docs/use/troubleshooting.md)"},
    {rt::kFlagJump,
     "the hand moved more than 20 mm in one tick and the reading was rejected; check the device's "
     "cable and calibration"},
    {rt::kFlagLagging,
     "the burr did not come to rest within the tick: the hand was very fast, or the hole is tight"},
    {rt::kFlagCandidates,
     "more contacts were found than the list holds; use a larger voxel or a smaller burr"},
    {rt::kFlagPutOff,
     "the machine was too slow, or the burr too large, to cut every brick in every tick; the "
     "bricks were cut in turn (docs/understand/realtime.md, \"Too much at once\")"},
    {rt::kFlagReserve,
     "there was no room left for new material or new surface; raise reserve_bricks"},
    {rt::kFlagUndoFull,
     "undo memory was full and the oldest stroke was forgotten; raise undo_bricks"},
    {rt::kFlagHandLost, "the device lost the hand's position; the force was released"},
    {rt::kFlagRestoring, "an undo or a reset was in progress"},
    {rt::kFlagGuarded,
     "the energy guard damped the hand: the spring is stiffer than this device can render; lower "
     "the stiffness"},
    {rt::kFlagStalled, "the bone stopped the spindle; press less, or raise the motor's torque"},
    {rt::kFlagShaft, "the shaft, or another part of the tool that does not cut, was on bone"},
    {rt::kFlagLaw,
     "the law of your own gave a number that cannot be, or could not answer: it was switched off, "
     "and the burr had no force from then on; put it to its trial again"},
    {rt::kFlagNotCut, "the burr was blocked and part of the requested volume was not cut"},
};

}  // namespace

std::vector<std::string> words(std::uint32_t flags) {
  std::vector<std::string> sentences;
  for (const auto& [flag, text] : kWords)
    if ((flags & flag) != 0) sentences.emplace_back(text);
  return sentences;
}

}  // namespace burr::tick
