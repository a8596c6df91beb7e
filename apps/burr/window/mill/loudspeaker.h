// apps/burr/window/mill/loudspeaker.h - the sound of a session in the window: on and off, louder and quieter.
//
// Without a device it stays silent and says why. Switched on again it looks for the device anew:
// one that was unplugged, or plugged in since. Main thread.
#pragma once

#include <memory>
#include <string>

#include "burr/sound/speaker.h"
#include "burr/workshop/hearing.h"

namespace burr::app {

class Loudspeaker {
 public:
  Loudspeaker(const tick::ServoSettings& settings, workshop::Hearing::ToSpare to_spare);

  void hear(const tick::TickRow& newest);
  void toggle();
  double louder(int steps);  // of 3 dB, below 0: quieter; how loud it is then [dB], 0 the loudest
  [[nodiscard]] bool is_on() const { return speaker_ && speaker_->voice().is_on(); }

  // "" while there is a device, or the sentence that says why it does not.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void open();
  [[nodiscard]] double loudness() const;

  workshop::Hearing hearing_;
  std::unique_ptr<sound::Speaker> speaker_;
  std::string trouble_;
  int steps_ = 0;  // from the loudest, 0 or less
};

}  // namespace burr::app
