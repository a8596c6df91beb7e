#include "shared/hand_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace burr::app {

void add_homing_options(CLI::App& command, workshop::HandRequest& request) {
  command.add_flag("--home", request.home,
                   "allow a Force Dimension or CRTK arm to move by itself to its home position; "
                   "keep its space free");
  command.add_flag("--is-homed", request.is_homed,
                   "you have homed the arm yourself, and its library cannot report it");
}

void add_hand_options(CLI::App& command, workshop::HandRequest& request) {
  command.add_option(
      "--device", request.device,
      fmt::format("a haptic device: {}; NAME:WHICH if there are several", workshop::kinds_known()));
  command
      .add_option("--device-scale", request.scale,
                  "travel of the tip / travel of the hand; smaller: finer work, softer walls")
      ->check(CLI::Range(0.1, 10.0));
  add_homing_options(command, request);
  command.add_flag("--dead-man", request.dead_man,
                   "force only while the mill button of the device is held");
}

}  // namespace burr::app
