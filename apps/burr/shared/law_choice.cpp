#include "shared/law_choice.h"

#include "burr/workshop/law_file.h"

namespace burr::app {

Result<std::shared_ptr<tick::OwnLaw>> own_law(const LawChoice& law, bool realtime) {
  if (law.file.empty()) return std::shared_ptr<tick::OwnLaw>();
  auto opened = workshop::LawFile::open(law.file, law.settings, workshop::law_passes());
  if (!opened) return opened.error();
  if (realtime)
    if (const Status fit = (*opened)->fit_for_real_time(); !fit) return fit.error();
  return std::shared_ptr<tick::OwnLaw>(std::move(*opened));
}

}  // namespace burr::app
