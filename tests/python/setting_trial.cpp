// For settings_test.py: tries values out of range in C++. A line for each, with tabs:
// word, option, property, place in a case, what one of the person's unit is in SI, value, what C++ says.
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/sim/session.h"
#include "burr/tick/setting_table.h"

namespace {

using namespace burr;
using tick::About;

// What a session says to a value in SI.
std::string said(const tick::Setting<tick::ServoSettings>& setting, double value) {
  const math::Vec3 corner = math::Vec3::Constant(4e-3);
  sim::SessionSettings settings;
  settings.threads = 1;
  setting.set(settings.servo, value);
  NoProgress quiet;
  const auto session = sim::Session::make(
      phantom::bone_from_distance(phantom::box_grid(-corner, corner, 0.5e-3), {}, phantom::slab(),
                                  8),
      std::make_unique<device::ReplayedHand>(device::DeviceSpec()), settings, quiet);
  return session ? "it takes this" : session.error().text;
}

// Out of range, and as the member can hold it; in the person's unit.
std::vector<double> beyond(const About& about) {
  const tick::Range& range = about.range;
  const double least = about.typed.from_si(range.least), most = about.typed.from_si(range.most);
  if (about.kind == About::Kind::number)
    return {std::floor(least) - 1, std::ceil(most) + 1, std::numeric_limits<double>::quiet_NaN(),
            std::numeric_limits<double>::infinity()};
  if (about.kind == About::Kind::whole && range.least > 0) return {least - 1, most + 1};
  return {most + 1};
}

}  // namespace

int main() {
  constexpr const char* kPlaces[] = {"", "session", "burr"};
  for (const auto& one : tick::servo_settings()) {
    const About& about = one.about;
    const tick::Typed& typed = about.typed;
    if (typed.word == nullptr || about.kind == About::Kind::flag) continue;  // no truth is 2
    const auto or_word = [&](const char* other) { return other != nullptr ? other : typed.word; };
    for (const double value : beyond(about))
      std::printf("%s\t%s\t%s\t%s\t%.17g\t%s\t%s\n", typed.word, or_word(typed.option),
                  or_word(typed.property), kPlaces[static_cast<int>(typed.place)], typed.to_si(1),
                  about.kind == About::Kind::choice ? "wrong" : tick::text_of(value).c_str(),
                  said(one, typed.to_si(value)).c_str());
  }
}
