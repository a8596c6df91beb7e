#include "devices/springs_words.h"

#include <fmt/format.h>

#include "burr/haptics/safety/coupling.h"
#include "burr/tick/controls.h"

namespace burr::app {

std::vector<std::string> springs_words(const device::DeviceSpec& spec) {
  if (spec.peak_torque <= 0)
    return {"It cannot turn the hand: the torque of a contact is computed and recorded, not felt."};
  const haptics::Coupling springs =
      haptics::coupling_of(spec, spec.max_stiffness, spec.native_rate);
  std::vector<std::string> sentences = {fmt::format(
      "It turns the hand: the torque of a contact is felt, with a spring of {:.2g} N m/rad{}.",
      springs.turn_stiffness,
      springs.measured ? "" : " (assumed: its stiffness and damping of turning are not known)")};
  if (spec.lever > 0)
    sentences.push_back(fmt::format(
        "The tip is {:.0f} mm from where it pushes: the border of stiffness there is {:.0f} N/m, "
        "and burr uses at most {:.0f} N/m.",
        1e3 * spec.lever, springs.border, springs.stiffness));
  return sentences;
}

}  // namespace burr::app
