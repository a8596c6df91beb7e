#include "burr/workshop/other_bone.h"

#include <fmt/format.h>

#include "burr/base/printable.h"
#include "burr/phantom/phantoms.h"

namespace burr::workshop {

bool has_other_bones(const scenario::Case& work) {
  return !work.phantom.empty() && phantom::has_bones(work.phantom);
}

Status take_bone(scenario::Case& work, std::uint32_t bone_number) {
  if (bone_number == 0) return fine();
  if (!has_other_bones(work))
    return error(
        Trouble::usage,
        fmt::format("`bone_number` {}: the case \"{}\" has one bone only; leave out `bone_number`",
                    bone_number, base::printable(work.name)));
  const char joint = work.phantom.find('?') == std::string::npos ? '?' : ',';
  const std::string other = fmt::format("{}{}bone={}", work.phantom, joint, bone_number);
  if (const Status known = phantom::known(other); !known) return known;
  work.phantom = other;
  return fine();
}

}  // namespace burr::workshop
