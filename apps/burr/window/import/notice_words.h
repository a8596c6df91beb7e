// apps/burr/window/import/notice_words.h - what burr found in a scan and did about it, in the user's
// language and without options of the command line.
//
//     notice_words("Noise of 31.2 HU is smoothed out along the surface; see --smooth.")
//                      -> "Noise of 31.2 HU is smoothed out along the surface."
//
// The library says these sentences in English, for people who type commands. The window knows the
// usual ones and says them in its own words; of the others it leaves out the options. Thread: any.
#pragma once

#include <string>

namespace burr::app {

[[nodiscard]] std::string notice_words(const std::string& sentence);

// "0.31 mm³", "19 563 mm³" is "19.6 cm³": as many digits as a person needs. mm3: [mm^3].
[[nodiscard]] std::string volume_words(double mm3);

}  // namespace burr::app
