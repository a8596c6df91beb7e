// Where there are no threads (a page in a browser), none goes first. rt/thread_rights.cpp is the one for Linux.
#include "burr/rt/thread.h"

namespace burr::rt {

NormalPriority::NormalPriority() = default;
NormalPriority::~NormalPriority() {  // there is nothing to give back
}

bool has_realtime_priority() { return false; }

}  // namespace burr::rt
