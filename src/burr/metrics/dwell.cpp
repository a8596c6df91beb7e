#include "burr/metrics/dwell.h"

#include "burr/math/sums.h"

namespace burr::metrics {

void DwellMaker::end() {
  if (stay_ > kDwell) {
    ++found_.count;
    found_.seconds += stay_;
  }
  if (stay_ > found_.longest) {
    found_.longest = stay_;
    found_.longest_at = begin_;
    found_.place = place_;
  }
  stays_ = false;
  stay_ = 0;
}

void DwellMaker::add(const Moment& now) {
  const bool rubs = now.touching && now.turning;
  touched_ = touched_ || rubs;
  if (stays_ && (!rubs || now.gap || math::norm(math::Vec3(now.centre - place_)) > kDwellBall))
    end();
  if (!rubs) return;
  if (!stays_) {
    stays_ = true;
    begin_ = now.t;
    place_ = now.centre;
  }
  stay_ += now.dt;
}

Assessed<Dwell> DwellMaker::finish() {
  if (!touched_) return NotAssessable{"a turning burr never touched the bone"};
  end();
  return found_;
}

}  // namespace burr::metrics
