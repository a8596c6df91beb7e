// apps/burr/window/mill/loudspeaker.h - the sound of a session in the window: on, off, louder,
// quieter.
//
// Without a sound device it stays silent and says why. Each time it is switched on it looks for a
// device again, because one may have been plugged in or out. Thread: main.
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "burr/sound/speaker.h"
#include "burr/workshop/sound_tracker.h"

namespace burr::app {

class Loudspeaker {
 public:
  // warn_below: the warning sounds only below this distance to what must not be cut [m]
  // second: the tool of the other hand; nullptr: none that sounds
  Loudspeaker(const tick::ServoSettings& settings, workshop::SoundTracker::ToSpare to_spare,
              double warn_below = std::numeric_limits<double>::infinity(),
              const tool::ShapedTool* second = nullptr);

  // second: the newest row of the other hand; nullptr: there is none
  void update(const tick::TickRow& newest, const tick::TickRow* second = nullptr);
  // The burr is in a structure to spare; sounds however near the warning begins.
  void injury(bool is_in) { injured_ = is_in; }
  void toggle();
  double louder(int steps);  // steps of 3 dB, below 0: quieter; the new level [dB], 0: loudest
  [[nodiscard]] bool is_on() const { return speaker_ && speaker_->voice().is_on(); }

  // "" while there is a sound device; otherwise a sentence that says why there is no sound.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void open();
  [[nodiscard]] double loudness() const;

  workshop::SoundTracker hearing_;
  double warn_below_;
  bool injured_ = false;
  std::unique_ptr<sound::Speaker> speaker_;
  std::string trouble_;
  int steps_ = 0;  // steps below the loudest, 0 or less
};

}  // namespace burr::app
