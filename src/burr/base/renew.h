// base/renew.h - move assignment for what must end whole before another takes its place.
//
// The default one moves member by member from the first to the last, so a member that others still use
// goes before them: a bone before the thread that reads it.
//
//     Session& operator=(Session&& other) noexcept { return base::renew(*this, other); }
//
// Thread: any.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace burr::base {

// Destroys `old`, its members in reverse order of declaration, and moves `fresh` into its place.
template <class T>
T& renew(T& old, T& fresh) noexcept {
  static_assert(std::is_nothrow_move_constructible_v<T>);
  if (&old == &fresh) return old;
  std::destroy_at(&old);
  return *std::construct_at(&old, std::move(fresh));
}

}  // namespace burr::base
