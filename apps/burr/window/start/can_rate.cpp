#include "window/start/can_rate.h"

#include "burr/school/store.h"

namespace burr::app {

bool can_rate(const Desk& desk) {
  const auto place = school::place_of(desk.store, desk.places());
  return place && school::is_wanted(desk.store, *place);
}

}  // namespace burr::app
