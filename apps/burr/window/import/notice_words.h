// apps/burr/window/import/notice_words.h - what burr found in a scan and did about it, in the user's
// language and without the names that the library has for its settings.
//
//     notice_words("Noise of 31.2 HU is smoothed out along the surface; see `smooth`.")
//                      -> "Noise of 31.2 HU is smoothed out along the surface."
//
// The library says these sentences in English, for all who use it. The window knows the usual ones
// and says them in its own words; of the others it leaves out the names. Thread: any.
#pragma once

#include <string>

namespace burr::app {

[[nodiscard]] std::string notice_words(const std::string& sentence);

// Why it cannot become bone: a setting has the name that stands beside it on the page; where it
// stands there not, that of its option (shared/front_words.h).
[[nodiscard]] std::string trouble_words(const std::string& sentence);

// "0.31 mm³", "19 563 mm³" is "19.6 cm³": as many digits as a person needs. mm3: [mm^3].
[[nodiscard]] std::string volume_words(double mm3);

}  // namespace burr::app
