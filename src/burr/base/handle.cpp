#include "burr/base/handle.h"

#include <fcntl.h>
#include <unistd.h>

namespace burr::base {

Handle::Handle(int number) : number_(number) {
  constexpr int kFree = 10;
  if (number_ < 0 || number_ >= kFree) return;
  number_ = ::fcntl(number, F_DUPFD_CLOEXEC, kFree);
  ::close(number);
}

void Handle::reset() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

}  // namespace burr::base
