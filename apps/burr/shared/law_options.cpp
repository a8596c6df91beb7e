#include "shared/law_options.h"

namespace burr::app {

CLI::Option* add_law_options(CLI::App& command, LawChoice& law) {
  auto* file =
      command.add_option("--law", law.file,
                         "FILE.so: a force law of your own, compiled "
                         "(docs/develop/how_to_add_a_force_law.md); in real time only after "
                         "`burr verify law FILE.so`");
  command.add_option("--law-settings", law.settings, "FILE: the text that this law gets")
      ->needs(file);
  return file;
}

}  // namespace burr::app
