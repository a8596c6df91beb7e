// All drivers of burr, each with a player of its own.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <string>

#include "device/players/crtk_player.h"
#include "device/players/inverse_player.h"
#include "device/players/omega_player.h"
#include "device/players/polhem_player.h"
#include "device/players/touch_player.h"

namespace burr::test {

struct Driver {
  const char* name;
  std::unique_ptr<Player> (*player)();
};
inline void PrintTo(const Driver& driver, std::ostream* out) { *out << driver.name; }

template <class P>
std::unique_ptr<Player> made() {
  return std::make_unique<P>();
}
[[nodiscard]] inline auto every_driver() {
  return ::testing::Values(Driver{"Touch", &made<TouchPlayer>}, Driver{"Omega", &made<OmegaPlayer>},
                           Driver{"Inverse", &made<InversePlayer>},
                           Driver{"Polhem", &made<PolhemPlayer>},
                           Driver{"Crtk", &made<CrtkPlayer>});
}
[[nodiscard]] inline std::string name_of(const ::testing::TestParamInfo<Driver>& driver) {
  return driver.param.name;
}

}  // namespace burr::test
